// SPDX-License-Identifier: Apache-2.0
// Bits, slices and the four small helpers that C++20 on g++ 12 lacks.
#pragma once

#include <cstdint>
#include <type_traits>

#include <dpchip/core/assert.hpp>

namespace dpchip::core {

/// The enumerator's number (std::to_underlying is C++23).
template <class E>
    requires std::is_enum_v<E>
constexpr auto to_underlying(E e) { return static_cast<std::underlying_type_t<E>>(e); }

/// True when bit `n` of `value` is 1.
constexpr bool bit(unsigned value, unsigned n) { DPCHIP_ASSERT(n < 32); return ((value >> n) & 1u) != 0; }

/// `width` bits of `value`, the lowest of them bit `lsb`.
constexpr std::uint8_t slice(unsigned value, unsigned lsb, unsigned width) {
    DPCHIP_ASSERT(width >= 1 && width <= 8 && lsb + width <= 32);
    return static_cast<std::uint8_t>((value >> lsb) & ((1u << width) - 1u));
}

constexpr std::uint8_t low(std::uint16_t word) { return static_cast<std::uint8_t>(word & 0xFFu); }
constexpr std::uint8_t high(std::uint16_t word) { return static_cast<std::uint8_t>(word >> 8); }
constexpr std::uint16_t word(std::uint8_t high_octet, std::uint8_t low_octet) {
    return static_cast<std::uint16_t>(high_octet << 8 | low_octet);
}

}  // namespace dpchip::core
