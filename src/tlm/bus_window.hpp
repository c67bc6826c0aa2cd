// SPDX-License-Identifier: Apache-2.0
// Where a chip lies in the address space of a TLM bus, and which of its addresses an access means. The wiring is the
// board's: incomplete decoding mirrors the chip (mask), a 16-bit bus without byte swapper gives it every second octet
// (stride 2; VPC3+C manual 8.1.6, the 80286 example).
#pragma once

#include <cstdint>

namespace dpchip::tlm {

/// Octet `base + i` of the bus, i below `size`, is chip address (i & mask) / stride; what is no multiple of the stride is
/// nobody's: it reads FFH, and writes to it are lost.
struct BusWindow {
    std::uint64_t base = 0;      ///< first bus address
    std::uint64_t size = 0x1000; ///< octets of bus addresses; an access that leaves the window is an address error
    std::uint64_t mask = 0xFFF;  ///< the address lines that are wired, relative to `base`
    unsigned stride = 1;         ///< bus octets per chip address: 1, or 2 when A0 of the bus is left unconnected

    /// `length` octets from `address` on lie inside.
    constexpr bool holds(std::uint64_t address, std::uint64_t length) const {
        return address >= base && length <= size && address - base <= size - length;
    }
    /// The chip drives this octet of the bus.
    constexpr bool selects(std::uint64_t address) const { return ((address - base) & mask) % stride == 0; }
    constexpr std::uint16_t chip_address(std::uint64_t address) const {
        return static_cast<std::uint16_t>(((address - base) & mask) / stride);
    }
};

}  // namespace dpchip::tlm
