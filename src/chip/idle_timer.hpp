// SPDX-License-Identifier: Apache-2.0
// Bus times: when the line counts as idle, when a start bit is in its window, when an answer may begin (2.1; reference 1.3, 1.6, 3.4.4).
#pragma once

#include <algorithm>

#include <dpchip/chip/context.hpp>
#include <dpchip/fdl/character.hpp>

namespace dpchip::chip::idle {

inline constexpr std::uint8_t kLeastMinTsdr = 11;

/// Bit time the receiver works with.
constexpr Ticks bit(const State& s) { return fdl::baud(s.probe).bit; }

/// TSYN: the line has been idle for 33 bit times when a start bit falls at `at`.
constexpr bool synchronised(const State& s, Ticks at) { return at - s.line_idle_since >= bit(s) * fdl::kTsynBits; }

/// The no-gap rule. Dis_Start_Control accepts any edge from the sample before the stop bit's end until TSYN.
template <class C>
bool in_start_window(const C& c, Ticks start) {
    const Ticks sample{bit(c.s).n / 4};
    const Ticks off = start - c.s.character_due;
    if ((c.s.mode0 & regmap::mode0::dis_start_control) != 0) return off >= Ticks{} - sample * 2;
    const Ticks window = sample * c.options.start_window_samples;
    return off >= Ticks{} - window && off <= window + bit(c.s) * c.options.allow_gap_tbits;
}

/// When the first start bit of an answer falls: max(minTSDR, T_proc) after the request.
template <class C>
Ticks answer_at(const C& c) {
    const Ticks tsdr = bit(c.s) * std::max(c.s.min_tsdr, kLeastMinTsdr);
    const Ticks processing = core::kClk * c.options.t_proc_clk;
    return c.s.request_end + std::max(tsdr, processing);
}

}  // namespace dpchip::chip::idle
