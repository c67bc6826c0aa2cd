// SPDX-License-Identifier: Apache-2.0
// Set_Slave_Add: the four octets and what follows (reference 3.3).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/core/bits.hpp>
#include <dpchip/core/result.hpp>

namespace dpchip::dp {

inline constexpr std::size_t kSetSlaveAddHeader = 4;
inline constexpr std::uint8_t kDefaultAddress = 126;   ///< of a slave that has not been given one
inline constexpr std::uint8_t kMaxSlaveAddress = 125;  ///< highest address that may be given

struct SetSlaveAdd {
    std::uint8_t address{};  ///< New_Slave_Address
    std::uint16_t ident{};
    bool no_add_chg{};                         ///< the address may not be changed again
    std::span<const std::uint8_t> rem_data{};  ///< Rem_Slave_Data
};

enum class SetSlaveAddError : std::uint8_t { too_short, no_room };

constexpr core::Result<SetSlaveAdd, SetSlaveAddError> decode_set_slave_add(std::span<const std::uint8_t> octets) {
    if (octets.size() < kSetSlaveAddHeader) return SetSlaveAddError::too_short;
    return SetSlaveAdd{octets[0], core::word(octets[1], octets[2]), octets[3] != 0, octets.subspan(4)};
}

/// Writes the data unit into `out`; returns its length.
constexpr core::Result<std::size_t, SetSlaveAddError> encode(const SetSlaveAdd& s, std::span<std::uint8_t> out) {
    const std::size_t length = kSetSlaveAddHeader + s.rem_data.size();
    if (length > out.size()) return SetSlaveAddError::no_room;
    out[0] = s.address;
    out[1] = core::high(s.ident);
    out[2] = core::low(s.ident);
    out[3] = s.no_add_chg ? 0xFF : 0x00;
    for (std::size_t i = 0; i < s.rem_data.size(); ++i) out[kSetSlaveAddHeader + i] = s.rem_data[i];
    return length;
}

}  // namespace dpchip::dp
