// SPDX-License-Identifier: Apache-2.0
// The receiver's half of the UART: RXD, sampled four times a bit, becomes characters (8.3; reference 1.3).
//
// s0 is the first sample that reads 0 after one that read 1. The start bit is looked at again at s0+2, data bit n at
// s0+6+4n, parity at s0+38, stop at s0+42, and the next edge may come from s0+43 on. A character is handed over at
// s0+44, where it ends. Only samples at which something can happen are computed; the others cannot be told from them.
//
// Not modelled: metastability and the synchroniser's delay. A sample at the very tick of an edge sees the new level.
#pragma once

#include <algorithm>

#include <dpchip/fdl/character.hpp>
#include <dpchip/pins/uart_state.hpp>

namespace dpchip::pins::receiver {

inline constexpr std::int64_t kSamplesPerBit = 4;
inline constexpr std::int64_t kStartCheck = 2, kFirstBit = 6, kStop = 42, kEnd = 44;
inline constexpr std::int64_t kLatestNext = 45;  ///< s0' of the next character of a telegram, at the latest
inline constexpr std::int64_t kNoSample = core::kNever.n;
inline constexpr std::uint8_t kParityBit = 8, kStopBit = 9;

/// A quarter of a bit at the grid's rate.
constexpr Ticks quarter(const UartState& s) { return {fdl::baud(s.rate).bit.n / kSamplesPerBit}; }
constexpr Ticks time_of(const UartState& s, std::int64_t sample) { return s.grid_origin + quarter(s) * sample; }
/// The first sample at or after `at`; 0 before the grid begins.
constexpr std::int64_t sample_from(const UartState& s, Ticks at) {
    const Ticks since = at - s.grid_origin;
    if (since <= Ticks{}) return 0;
    return (since.n + quarter(s).n - 1) / quarter(s).n;
}

/// The chip works at another rate from `now` on: the divider starts again at a CLK edge, what was coming in is lost.
constexpr void restart(UartState& s, fdl::BaudCode rate, Ticks now, Ticks clk_phase) {
    const std::int64_t clk = core::kClk.n, since = now.n - clk_phase.n;
    const std::int64_t edges = since <= 0 ? 0 : (since + clk - 1) / clk;
    s.grid_origin = {clk_phase.n + edges * clk};
    s.rate = rate;
    s.sampled = 0;
    s.changed = s.before = -1;
    s.s0 = s.done_s0 = 0;
    s.level = s.rxd;
    s.rx = RxPhase::hunt;
    s.done = 0;
}

constexpr void edge(UartState& s, Ticks at, PinLevel level) {
    if (level == PinLevel::z) level = PinLevel::high;  // the pull-up of the transceiver's side
    if (level == s.rxd) return;
    s.rxd = level;
    s.rxd_since = at;
}

/// The sample that looks at the next bit; kNoSample while hunting.
constexpr std::int64_t next_look(const UartState& s) {
    switch (s.rx) {
    case RxPhase::hunt: return kNoSample;
    case RxPhase::check: return s.s0 + kStartCheck;
    case RxPhase::bits: return s.s0 + kFirstBit + kSamplesPerBit * s.bit;
    }
    return kNoSample;
}

/// The next sample at which something happens.
constexpr std::int64_t next_sample(const UartState& s) {
    std::int64_t next = next_look(s);
    if (s.done != 0) next = std::min(next, s.done_s0 + kEnd);
    if (s.rxd != s.level) next = std::min(next, std::max(s.sampled, sample_from(s, s.rxd_since)));
    return next;
}
constexpr Ticks next(const UartState& s) {
    const std::int64_t sample = next_sample(s);
    return sample == kNoSample ? core::kNever : time_of(s, sample);
}

/// True when the chip has not yet worked on a telegram, or has an answer ready that it has not begun.
constexpr bool answer_pending(const chip::State& s) {
    const auto running = [&](chip::Timer t) { return s.timers[static_cast<std::size_t>(t)] != core::kNever; };
    return running(chip::Timer::telegram) || running(chip::Timer::rts_on) || running(chip::Timer::answer_start) || s.xcts_hold != 0;
}

/// The start bit is still low in its middle: a character. Whether it begins a transmission is known by what was before.
template <class Host>
void confirm(UartState& s, Host& host, Ticks at) {
    const bool follows = s.before >= 0 && s.s0 - s.before <= kLatestNext;
    host.line_low(s.idle_since);
    if (!follows || answer_pending(host.state())) host.carrier(at);
    if (host.state().rts != 0) {  // the chip's own voice, or nobody that it would hear
        s.rx = RxPhase::hunt;
        return;
    }
    s.before = s.s0;
    s.rx = RxPhase::bits;
    s.bit = s.octet = s.faults = 0;
}

constexpr void finish(UartState& s) {
    s.rx = RxPhase::hunt;
    s.done = 1;
    s.done_s0 = s.s0;
    s.done_octet = s.octet;
    s.done_faults = s.faults;
}

/// Looks at the bit that is due.
template <class Host>
void look(UartState& s, Host& host, Ticks at) {
    const bool one = s.level == PinLevel::high;
    if (s.rx == RxPhase::check) {
        if (one) s.rx = RxPhase::hunt;
        else confirm(s, host, at);
        return;
    }
    if (s.bit < kParityBit) {
        s.octet = static_cast<std::uint8_t>(s.octet | (one ? 1u << s.bit : 0u));
    } else if (s.bit == kParityBit) {
        if (one != fdl::even_parity(s.octet)) s.faults |= fdl::fault_parity;
    } else {
        if (!one) s.faults |= fdl::fault_stop;
        return finish(s);
    }
    ++s.bit;
}

template <class Host>
void hand_over(UartState& s, Host& host) {
    s.done = 0;
    host.hear_character({time_of(s, s.done_s0), quarter(s) * kSamplesPerBit, s.done_octet, s.done_faults});
}

/// Takes sample `k`, the next one at which something happens: what ends comes first, then what begins. Where nothing but
/// the end of a character falls, RXD is not looked at, and an edge that comes later in the same tick is still seen.
template <class Host>
void take(UartState& s, Host& host, std::int64_t k) {
    const Ticks at = time_of(s, k);
    const bool looked = k == next_look(s), stop = looked && s.rx == RxPhase::bits && s.bit == kStopBit;
    if (s.done != 0 && k == s.done_s0 + kEnd) hand_over(s, host);
    if (!looked && s.level == s.rxd) return;
    s.sampled = k + 1;
    if (s.level != s.rxd && s.rxd_since <= at) {
        s.level = s.rxd;
        s.changed = k;
        if (s.level == PinLevel::high) s.idle_since = at;
    }
    if (looked) look(s, host, at);
    // The window of reference 1.3: the stop bit's own sample may be an edge only under Dis_Start_Control.
    const bool armed = !stop || (host.state().mode0 & regmap::mode0::dis_start_control) != 0;
    if (s.rx != RxPhase::hunt || s.level != PinLevel::low || s.changed != k || !armed) return;
    s.rx = RxPhase::check;
    s.s0 = k;
}

}  // namespace dpchip::pins::receiver
