// SPDX-License-Identifier: Apache-2.0
// Dual-Port RAM: segment addressing and what happens beyond its end (4.1, 6.1; APC3 3.1; reference 4.1, 4.11).
#pragma once

#include <cstring>
#include <span>

#include <dpchip/chip/context.hpp>

namespace dpchip::chip::dpram {

/// Octets of RAM at present.
constexpr std::uint16_t size(const State& s, const regmap::Traits& t) {
    return (s.mode2 & regmap::mode2::mode_4kb) != 0 ? t.max_ram_bytes : t.ram_bytes;
}

/// A segment base address: 8 octets each, 16 in 4 KB mode.
constexpr std::uint16_t base(const State& s, std::uint8_t segment) {
    return static_cast<std::uint16_t>(segment << ((s.mode2 & regmap::mode2::mode_4kb) != 0 ? 4 : 3));
}

/// APC3 and SPC3: an address beyond the RAM is folded by 400H; the chip notes it and goes Offline after the request.
template <class C>
std::uint16_t fold(C& c, std::uint16_t address) {
    c.find(Rule::ram_access_violation, address);
    c.s.ram_access_violation = 1;
    return static_cast<std::uint16_t>(address - 0x400);
}

/// Physical address of an octet that the Micro Sequencer wants: VPC3+ wraps at the end, APC3 folds.
template <class C>
std::uint16_t physical(C& c, std::uint8_t segment, std::size_t offset) {
    const auto sum = static_cast<std::uint16_t>(base(c.s, segment) + offset);
    if (!c.traits->access_violation) return static_cast<std::uint16_t>(sum & (size(c.s, *c.traits) - 1));
    const auto address = static_cast<std::uint16_t>(sum & 0x7FFu);
    return address < c.traits->ram_bytes ? address : fold(c, address);
}

template <class C>
bool contiguous(C& c, std::uint8_t segment, std::size_t octets) {
    return base(c.s, segment) + octets <= size(c.s, *c.traits);
}

/// Writes a buffer. The usual case, a buffer inside the RAM, is one copy.
template <class C>
void write(C& c, std::uint8_t segment, std::span<const std::uint8_t> data) {
    c.ram_used(data.size());
    if (contiguous(c, segment, data.size())) {
        if (!data.empty()) std::memcpy(c.s.ram.data() + base(c.s, segment), data.data(), data.size());
        return;
    }
    for (std::size_t i = 0; i < data.size(); ++i) c.s.ram[physical(c, segment, i)] = data[i];
}

template <class C>
void read(C& c, std::uint8_t segment, std::span<std::uint8_t> data) {
    c.ram_used(data.size());
    if (contiguous(c, segment, data.size())) {
        if (!data.empty()) std::memcpy(data.data(), c.s.ram.data() + base(c.s, segment), data.size());
        return;
    }
    for (std::size_t i = 0; i < data.size(); ++i) data[i] = c.s.ram[physical(c, segment, i)];
}

template <class C>
void zero(C& c, std::uint8_t segment, std::size_t octets) {
    c.ram_used(octets);
    for (std::size_t i = 0; i < octets; ++i) c.s.ram[physical(c, segment, i)] = 0;
}

template <class C>
bool equal(C& c, std::uint8_t segment, std::span<const std::uint8_t> data) {
    c.ram_used(data.size());
    for (std::size_t i = 0; i < data.size(); ++i)
        if (c.s.ram[physical(c, segment, i)] != data[i]) return false;
    return true;
}

/// An organizational parameter, read anew at each use (lengths, Ident, watchdog value).
constexpr std::uint8_t cell(const State& s, std::uint16_t address) { return s.ram[address]; }
constexpr void set_cell(State& s, std::uint16_t address, std::uint8_t value) { s.ram[address] = value; }

/// A pointer as latched at Start.
constexpr std::uint8_t& pointer(State& s, std::uint16_t address) { return s.latched[address - regmap::org::first]; }
constexpr std::uint8_t pointer(const State& s, std::uint16_t address) { return s.latched[address - regmap::org::first]; }

/// Moves a pointer to another buffer, in the latch and in the cell that the processor reads.
constexpr void set_pointer(State& s, std::uint16_t address, std::uint8_t segment) {
    pointer(s, address) = segment;
    set_cell(s, address, segment);
}

/// Start latches the organizational parameters.
inline void latch(State& s) { std::memcpy(s.latched.data(), s.ram.data() + regmap::org::first, s.latched.size()); }

}  // namespace dpchip::chip::dpram
