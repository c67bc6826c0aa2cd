// SPDX-License-Identifier: Apache-2.0
// Interrupt Controller: IRR, IMR, IR, IAR, EOI and X/INT (5.3, figure 5-8; reference 4.4).
#pragma once

#include <dpchip/chip/outputs.hpp>
#include <dpchip/chip/timers.hpp>

namespace dpchip::chip::irq {

using namespace core::literals;

inline constexpr Ticks kInactiveTimeShort = 48_clk;     // 1 us
inline constexpr Ticks kInactiveTimeLong = 48000_clk;   // 1 ms

constexpr std::uint16_t ir(const State& s) { return static_cast<std::uint16_t>(s.irr & ~s.imr); }

/// X/INT follows the sum of IR through its latch: it becomes active when an event is pending and no inactive time runs.
template <class C>
void update_x_int(C& c) {
    if (c.s.x_int_active != 0 || ir(c.s) == 0 || timers::running(c.s, Timer::eoi)) return;
    c.s.x_int_active = 1;
    outputs::changed(c, Fact::x_int, Pin::x_int);
}

template <class C>
void set_irr(C& c, std::uint16_t value) {
    change(c, Fact::irr, c.s.irr, value);
    update_x_int(c);
}

constexpr std::int64_t clk_period(Ticks t) { return t / core::kClk; }

/// An event of the chip: stored whatever the masks say, and kept against an IAR write in the same CLK period.
template <class C>
void raise(C& c, std::uint16_t events) {
    const auto known = static_cast<std::uint16_t>(events & c.traits->interrupts);
    if (clk_period(c.s.irr_fresh_at) != clk_period(c.s.now)) c.s.irr_fresh = 0;
    c.s.irr_fresh_at = c.s.now;
    c.s.irr_fresh |= known;
    set_irr(c, c.s.irr | known);
}

/// The processor sets events for debugging; a 0 leaves a bit as it is.
template <class C>
void set_by_user(C& c, std::uint16_t events) {
    set_irr(c, static_cast<std::uint16_t>(c.s.irr | (events & c.traits->interrupts)));
}

/// What an acknowledgement command, not the IAR, takes away (5.3.2).
template <class C>
void clear(C& c, std::uint16_t events) {
    set_irr(c, static_cast<std::uint16_t>(c.s.irr & ~events));
}

/// Events that may still meet an acknowledgement in their own CLK period.
constexpr std::uint16_t arriving(const State& s) {
    return clk_period(s.irr_fresh_at) == clk_period(s.now) ? s.irr_fresh : std::uint16_t{0};
}

/// IAR: a 1 clears, except where only the state machines may, and except an event that arrives at the same time.
template <class C>
void acknowledge(C& c, std::uint16_t events) {
    const auto guarded = static_cast<std::uint16_t>(events & c.s.irr & regmap::interrupt::by_acknowledgement);
    if (guarded != 0) c.find(Rule::iar_protected, guarded);
    clear(c, static_cast<std::uint16_t>(events & ~regmap::interrupt::by_acknowledgement & ~arriving(c.s)));
}

/// Once the processor has read IRR or IR, an acknowledgement refers to what it saw.
constexpr void seen(State& s, std::uint16_t bits) { s.irr_fresh &= static_cast<std::uint16_t>(~bits); }

template <class C>
void set_imr(C& c, std::uint16_t value) {
    c.s.imr = value;
    update_x_int(c);
}

/// EOI: X/INT goes inactive with this edge and stays so for the inactive time.
template <class C>
void end_of_interrupt(C& c) {
    const bool was_active = c.s.x_int_active != 0;
    const bool long_time = (c.s.mode0 & regmap::mode0::eoi_time_base) != 0;
    c.s.x_int_active = 0;
    timers::start(c.s, Timer::eoi, c.s.now + (long_time ? kInactiveTimeLong : kInactiveTimeShort));
    if (was_active) outputs::changed(c, Fact::x_int, Pin::x_int);
}

template <class C>
void inactive_time_over(C& c) {
    timers::stop(c.s, Timer::eoi);
    update_x_int(c);
}

}  // namespace dpchip::chip::irq
