// SPDX-License-Identifier: Apache-2.0
// User_Timer_Clock: an event every 1 ms or 10 ms while online (5.1.1 bit 10, 5.3.1 bit 4).
//
// The clock is not a timer of its own: a tick matters only when it changes IRR, so ticks are caught up with on demand.
// That keeps 125 silent chips from waking a thousand times a second each.
#pragma once

#include <dpchip/chip/irq.hpp>

namespace dpchip::chip::user_clock {

constexpr Ticks period(const State& s) {
    return (s.mode0 & regmap::mode0::user_time_base) != 0 ? core::milliseconds(10) : core::milliseconds(1);
}

constexpr void start(State& s) { s.user_clock_due = s.now + period(s); }
constexpr void stop(State& s) { s.user_clock_due = core::kNever; }

/// Does every tick up to and including `to`, each at its own time.
template <class C>
void catch_up(C& c, Ticks to) {
    if (c.s.user_clock_due > to) return;
    const Ticks step = period(c.s);
    if ((c.s.irr & regmap::interrupt::user_timer_clock) == 0 && c.traits->user_timer) {
        c.s.now = c.s.user_clock_due;
        irq::raise(c, regmap::interrupt::user_timer_clock);
    }
    const Ticks last = c.s.user_clock_due + step * ((to - c.s.user_clock_due) / step);
    c.s.user_clock_due = last + step;
    if (!c.traits->user_timer) return;
    c.s.now = last;
    irq::raise(c, regmap::interrupt::user_timer_clock);  // pending already, but an IAR write in this CLK must not lose it
}

/// When the chip must be woken for a tick that X/INT would show; kNever when it changes nothing that is seen.
constexpr Ticks visible(const State& s) {
    const auto bit = regmap::interrupt::user_timer_clock;
    return ((s.irr | s.imr) & bit) != 0 ? core::kNever : s.user_clock_due;
}

}  // namespace dpchip::chip::user_clock
