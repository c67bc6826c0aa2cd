// SPDX-License-Identifier: Apache-2.0
// The UART character: start bit, eight data bits (least significant first), even parity, stop bit (reference 1.1).
#pragma once

#include <bit>
#include <cstdint>

#include <dpchip/core/ticks.hpp>

namespace dpchip::fdl {

using core::Ticks;

inline constexpr std::int64_t kCharacterBits = 11;
inline constexpr std::int64_t kTsynBits = 33;  ///< idle time that synchronises a receiver

constexpr bool even_parity(std::uint8_t octet) { return (std::popcount(octet) & 1) != 0; }

/// What can be wrong with a received character. Bit mask.
enum CharacterFault : std::uint8_t {
    fault_none = 0,
    fault_parity = 1,      ///< the parity bit is inverted
    fault_stop = 2,        ///< the stop bit is 0
    fault_collision = 4,   ///< two stations sent at once: octet is arbitrary, parity cannot be trusted
};

/// One character on the line.
struct Character {
    Ticks start{};              ///< falling edge of the start bit
    Ticks bit{};                ///< bit time it was sent with
    std::uint8_t octet{};
    std::uint8_t faults{};      ///< mask of CharacterFault

    constexpr Ticks end() const { return start + bit * kCharacterBits; }

    /// End of the last low bit: from here on the line is idle as far as an idle counter can tell.
    constexpr Ticks last_low_end() const {
        const bool parity = even_parity(octet) != ((faults & fault_parity) != 0);
        if ((faults & (fault_stop | fault_collision)) != 0) return end();
        if (!parity) return start + bit * 10;
        return start + bit * (1 + (8 - std::countl_one(octet)));
    }
};

}  // namespace dpchip::fdl
