// SPDX-License-Identifier: Apache-2.0
// The transmitter's half of the UART: octets become levels on TXD, from the sampling grid on (8.3; reference 1.5, 9.1).
//
// TXD is high-resistance while RTS is low, high in the lead and in the trail. XCTS is looked at where a character ends
// and another follows; a character that is held begins at the first sample after XCTS fell.
#pragma once

#include <dpchip/pins/uart_receiver.hpp>

namespace dpchip::pins::transmitter {

inline constexpr std::uint8_t kBits = 11, kFrameEnd = kBits;

/// The eleven bits of a character, first bit lowest.
constexpr unsigned frame(std::uint8_t octet) {
    return static_cast<unsigned>(octet) << 1 | (fdl::even_parity(octet) ? 1u << 9 : 0u) | 1u << 10;
}
constexpr bool bit_of(unsigned frame, unsigned slot) { return ((frame >> slot) & 1u) != 0; }

/// The next bit boundary behind `slot` at which TXD changes, or the end of the character.
constexpr std::uint8_t next_change(unsigned frame, std::uint8_t slot) {
    std::uint8_t next = static_cast<std::uint8_t>(slot + 1);
    while (next < kFrameEnd && bit_of(frame, next) == bit_of(frame, slot)) ++next;
    return next;
}

constexpr Ticks next(const UartState& s) { return s.tx == TxPhase::bits ? s.tx_start + s.tx_bit * s.tx_slot : core::kNever; }

/// A character may begin at `at` at the earliest: on the grid, or on CLK when the chip has another rate by now.
constexpr Ticks on_grid(const UartState& s, Ticks at) {
    const Ticks step = s.tx_bit == fdl::baud(s.rate).bit ? receiver::quarter(s) : core::kClk;
    const std::int64_t since = at.n - s.grid_origin.n, n = step.n;
    const std::int64_t steps = since >= 0 ? (since + n - 1) / n : -(-since / n);
    return s.grid_origin + step * steps;
}

/// The end of the last stop bit when nothing holds a character any more.
constexpr Ticks end(const UartState& s) { return s.tx_start + s.tx_bit * (kBits * (s.tx_count - s.tx_index)); }

/// One step of the transmitter that is due at `at`; `drive(at, level)` puts a level on TXD.
template <class Host, class Drive>
void step(UartState& s, Host& host, Ticks at, Drive&& drive) {
    const unsigned bits = frame(host.state().tx[s.tx_index]);
    if (s.tx_slot == 0) {
        drive(at, PinLevel::low);
        s.tx_slot = next_change(bits, 0);
        return;
    }
    if (s.tx_slot < kFrameEnd) {
        drive(at, to_level(bit_of(bits, s.tx_slot)));
        s.tx_slot = next_change(bits, s.tx_slot);
        return;
    }
    ++s.tx_index;
    if (s.tx_index == s.tx_count) {
        s.tx = TxPhase::trail;
    } else if (host.state().xcts_high != 0) {
        s.tx = TxPhase::held;
        host.hold();
    } else {
        s.tx_start = at;
        s.tx_slot = 0;
    }
}

/// The chip's answer has begun: its first character follows on the grid.
template <class Host>
void begin(UartState& s, Host& host, const fdl::Transmission& t) {
    s.tx_bit = t.bit;
    s.tx_count = t.length;
    s.tx_index = 0;
    s.tx_slot = 0;
    s.tx_start = on_grid(s, t.start);
    s.tx = TxPhase::bits;
    if (s.tx_start != t.start) host.sent(end(s));
}

/// XCTS is low again.
template <class Host>
void release(UartState& s, Host& host, Ticks now) {
    if (s.tx != TxPhase::held) return;
    s.tx_start = on_grid(s, now);
    s.tx_slot = 0;
    s.tx = TxPhase::bits;
    host.sent(end(s));
}

/// RTS as the chip has it decides who drives TXD.
template <class Drive>
void follow_rts(UartState& s, bool rts, Ticks now, Drive&& drive) {
    if (rts == (s.tx != TxPhase::off)) return;
    s.tx = rts ? TxPhase::lead : TxPhase::off;
    drive(now, rts ? PinLevel::high : PinLevel::z);
}

}  // namespace dpchip::pins::transmitter
