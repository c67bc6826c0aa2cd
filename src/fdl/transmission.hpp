// SPDX-License-Identifier: Apache-2.0
// A transmission: what one station puts on the line in one go, normally one telegram, with its exact place in time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include <dpchip/core/ticks.hpp>
#include <dpchip/fdl/character.hpp>

namespace dpchip::fdl {

inline constexpr std::size_t kMaxTelegram = 255;  ///< SD2 with LE = 249

/// Octets sent back to back from `start` on, 11 bit times each.
struct Transmission {
    Ticks start{};                 ///< falling edge of the first start bit
    Ticks bit{};                   ///< bit time
    std::uint16_t length{};        ///< octets used
    bool damaged{};                ///< some octet is not what its sender meant: receivers take the character path
    bool synchronised{};           ///< the line vouches for TSYN before it: set on live lines, whose bit times mean nothing
    std::array<std::uint8_t, kMaxTelegram> octets;
    std::array<std::uint8_t, kMaxTelegram> faults;  ///< per octet, mask of CharacterFault; valid only when damaged

    /// End of the last stop bit.
    constexpr Ticks end() const { return start + bit * (kCharacterBits * length); }
    constexpr std::span<const std::uint8_t> bytes() const { return {octets.data(), length}; }
    constexpr std::span<std::uint8_t> buffer() { return octets; }

    /// The i-th character with its faults and its time.
    constexpr Character character(std::size_t i) const {
        return {start + bit * (kCharacterBits * static_cast<std::int64_t>(i)), bit, octets[i],
                damaged ? faults[i] : std::uint8_t{fault_none}};
    }

    void assign(Ticks at, Ticks bit_time, std::span<const std::uint8_t> bytes) {
        start = at;
        bit = bit_time;
        damaged = synchronised = false;
        length = static_cast<std::uint16_t>(bytes.size() < kMaxTelegram ? bytes.size() : kMaxTelegram);
        std::memcpy(octets.data(), bytes.data(), length);
    }
};

}  // namespace dpchip::fdl
