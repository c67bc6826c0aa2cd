// SPDX-License-Identifier: Apache-2.0
// The three-buffer machine behind Din, Dout and DXBout (6.1, 6.2.5, figures 6-12, 6-14, 7-12; reference 4.5).
//
// Its state is exactly the octet that the processor reads at 08H, 0AH and 12H: F, U, N and D in two bits each. Data never
// move, only buffer numbers do. Dout and DXBout: the chip publishes D, the user fetches into U. Din: the user publishes U,
// the chip fetches into D.
#pragma once

#include <cstdint>

namespace dpchip::chip {

/// Position of a two-bit buffer number in the register.
enum class Slot : std::uint8_t { d = 0, n = 2, u = 4, f = 6 };

class BufferSm {
public:
    constexpr explicit BufferSm(std::uint8_t raw) : raw_{raw} {}

    /// The register as the processor reads it.
    [[nodiscard]] constexpr std::uint8_t raw() const { return raw_; }
    /// Number of the buffer in `slot`: 1..3, or 0 for Nil.
    [[nodiscard]] constexpr std::uint8_t at(Slot slot) const { return (raw_ >> static_cast<unsigned>(slot)) & 3u; }

    /// The producer's end: what is in `from` becomes the next one; `from` gets the free buffer, else the old next one.
    constexpr void publish(Slot from) {
        const Slot spare = at(Slot::f) != 0 ? Slot::f : Slot::n;
        const std::uint8_t filled = at(from), fresh = at(spare);
        set(spare, 0);
        set(from, fresh);
        set(Slot::n, filled);
    }

    /// The consumer's end: takes the next one into `to` and frees the old one. False when there is no next one.
    constexpr bool fetch(Slot to) {
        if (at(Slot::n) == 0) return false;
        const std::uint8_t old = at(to);
        set(to, at(Slot::n));
        set(Slot::n, 0);
        set(Slot::f, old);
        return true;
    }

    /// Each buffer stands in exactly one slot, D and U are never Nil, one of N and F is.
    [[nodiscard]] constexpr bool valid() const {
        unsigned seen = 0;
        for (const Slot slot : {Slot::d, Slot::n, Slot::u, Slot::f}) seen += 1u << (4 * at(slot));
        return (seen >> 4) == 0x111 && at(Slot::d) != 0 && at(Slot::u) != 0;
    }

private:
    constexpr void set(Slot slot, unsigned number) {
        const auto shift = static_cast<unsigned>(slot);
        raw_ = static_cast<std::uint8_t>((raw_ & ~(3u << shift)) | (number << shift));
    }

    std::uint8_t raw_;
};

}  // namespace dpchip::chip
