// SPDX-License-Identifier: Apache-2.0
// Clock synchronisation: the time receiver and its buffer at the end of RAM (7.3.3, figures 7-20 to 7-24; reference 6.3).
//
// Receive_Delay_Time is not counted but computed: from the end of the Time_Event until the processor reads its first octet.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include <dpchip/chip/dpram.hpp>
#include <dpchip/chip/irq.hpp>
#include <dpchip/chip/mac.hpp>
#include <dpchip/chip/state_table.hpp>

namespace dpchip::chip::clock_sync {

/// Offsets in the Clock_Sync-Buffer.
enum Cell : std::uint16_t {
    status = 0, command = 1, cv_status1 = 2, cv_status2 = 3, time_event = 4, receive_delay_time = 12, previous_te = 16,
    interval_high = 24, interval_low = 25, buffer_octets = 26,
};
inline constexpr std::uint8_t kSetTime = 0x01, kViolation = 0x02;
inline constexpr std::uint8_t kStop = 0x01, kIgnoreCyclic = 0x02, kCheckEna = 0x04;
inline constexpr std::size_t kClockValueOctets = 18, kTimeOctets = 8;
inline constexpr Ticks kDelayOverflow = core::microseconds(std::int64_t{1} << 32);

enum class Event : std::uint8_t {
    interval_written,  ///< the low octet of a Clock_Sync_Interval other than 0
    time_event,
    good_value,        ///< Clock_Value of the right length, and of the expected previous time if that is checked
    bad_value,
    timeout,           ///< 2 * T_CSI after the Time_Event
    stop,              ///< Stop_Clock_Sync, or Set_Prm and LEAVE-MASTER unless they are ignored
    count
};
enum class Action : std::uint8_t { lock_interval, start_delay, take_value, violation, halt };
struct Row { CsState from; Event on; CsState to; Action action; std::string_view section; };
struct Ignored { CsState in; Event on; std::string_view because; };

// clang-format off
inline constexpr Row kRows[]{
    // from              on event                 next state         action                 manual
    {CsState::stopped, Event::interval_written, CsState::wait_te, Action::lock_interval, "7.3.3: started by this write"},
    {CsState::wait_te, Event::time_event,       CsState::wait_cv, Action::start_delay,   "7.3.3"},
    {CsState::wait_te, Event::good_value,       CsState::wait_te, Action::violation,     "figure 7-23: wrong telegram"},
    {CsState::wait_te, Event::bad_value,        CsState::wait_te, Action::violation,     "figure 7-23: wrong telegram"},
    {CsState::wait_cv, Event::time_event,       CsState::wait_cv, Action::start_delay,   "reference 6.3"},
    {CsState::wait_cv, Event::good_value,       CsState::wait_te, Action::take_value,    "7.3.3"},
    {CsState::wait_cv, Event::bad_value,        CsState::wait_te, Action::violation,     "figure 7-23: wrong telegram"},
    {CsState::wait_cv, Event::timeout,          CsState::wait_te, Action::violation,     "figure 7-23: 2 * T_CSI"},
    {CsState::wait_te, Event::stop,             CsState::stopped, Action::halt,          "figure 7-23"},
    {CsState::wait_cv, Event::stop,             CsState::stopped, Action::halt,          "figure 7-23"},
};
inline constexpr Ignored kIgnored[]{
    {CsState::stopped, Event::time_event,       "the time receiver does not run"},
    {CsState::stopped, Event::good_value,       "the time receiver does not run"},
    {CsState::stopped, Event::bad_value,        "the time receiver does not run"},
    {CsState::stopped, Event::timeout,          "nothing is supervised"},
    {CsState::stopped, Event::stop,             "already stopped"},
    {CsState::wait_te, Event::interval_written, "the interval is locked"},
    {CsState::wait_te, Event::timeout,          "supervision ended with the value"},
    {CsState::wait_cv, Event::interval_written, "the interval is locked"},
};
// clang-format on
inline constexpr auto kTable = total_table<3, Event>(kRows, kIgnored);

template <class C>
bool enabled(const C& c) { return c.traits->clock_sync && (c.s.mode0 & regmap::mode0::cs_supported) != 0; }

/// 7E0H in 2 KB mode, FE0H in 4 KB mode.
template <class C>
std::uint16_t base(const C& c) { return static_cast<std::uint16_t>(dpram::size(c.s, *c.traits) - 0x20); }

template <class C>
std::uint8_t& cell(C& c, std::uint16_t offset) { return c.s.ram[base(c) + offset]; }

template <class C>
Ticks interval(C& c) {
    return core::milliseconds(10) * core::word(cell(c, interval_high), cell(c, interval_low));
}

/// The buffer belongs to the user until he has acknowledged the interrupt.
constexpr bool interrupt_pending(const State& s) { return (s.irr & regmap::interrupt::clock_sync) != 0; }

/// When the timer is wanted next: for the supervision, or for the overflow of the delay.
template <class C>
void plan_timer(C& c) {
    const Ticks overflow = c.s.delay_running != 0 ? c.s.delay_from + kDelayOverflow : core::kNever;
    const Ticks supervision = c.s.cs_state == CsState::wait_cv ? c.s.time_event_at + interval(c) * 2 : core::kNever;
    timers::start(c.s, Timer::clock_sync, std::min(overflow, supervision));
}

template <class C>
void set_status(C& c, std::uint8_t value) {
    if (!interrupt_pending(c.s)) cell(c, status) = value;
    irq::raise(c, regmap::interrupt::clock_sync);
}

template <class C>
void take_value(C& c) {
    const auto d = mac::data(c.s);
    if (interrupt_pending(c.s)) return;
    for (std::size_t i = 0; i < kTimeOctets; ++i) {
        cell(c, static_cast<std::uint16_t>(time_event + i)) = d[i];
        cell(c, static_cast<std::uint16_t>(previous_te + i)) = d[kTimeOctets + i];
    }
    cell(c, cv_status1) = d[16];
    cell(c, cv_status2) = d[17];
    c.s.delay_from = c.s.time_event_at;
    c.s.delay_running = 1;
    set_status(c, kSetTime);
}

template <class C>
void act(C& c, Action action) {
    switch (action) {
    case Action::start_delay: c.s.time_event_at = c.s.request_end; break;
    case Action::take_value: take_value(c); break;
    case Action::violation: set_status(c, kViolation); break;
    case Action::lock_interval:
    case Action::halt: break;
    }
}

template <class C>
void dispatch(C& c, Event event) {
    const std::int8_t row = kTable[static_cast<std::size_t>(c.s.cs_state)][static_cast<std::size_t>(event)];
    if (row == kIgnoredPair) return;
    c.s.cs_state = kRows[row].to;
    act(c, kRows[row].action);
    plan_timer(c);
}

template <class C>
bool good_value(C& c) {
    const auto d = mac::data(c.s);
    if (d.size() != kClockValueOctets) return false;
    if ((cell(c, command) & kCheckEna) == 0) return true;
    return std::equal(c.s.last_time_event.begin(), c.s.last_time_event.end(), d.begin() + kTimeOctets);
}

/// Time_Event or Clock_Value, at t0 + 1 clk.
template <class C>
void receive(C& c) {
    if (!enabled(c)) return;
    if (!mac::function_code(c.s).clock_value()) return dispatch(c, Event::time_event);
    const Event event = good_value(c) ? Event::good_value : Event::bad_value;
    // Time_Last_Rcvd: also of a value that failed the check, or the check would never pass again after a lost sequence.
    const auto d = mac::data(c.s);
    if (c.s.cs_state == CsState::wait_cv && d.size() == kClockValueOctets) std::copy_n(d.begin(), kTimeOctets, c.s.last_time_event.begin());
    dispatch(c, event);
}

/// Set_Prm and LEAVE-MASTER stop the time receiver unless it is told to ignore them.
template <class C>
void cyclic_state_machine_changed(C& c) {
    if (c.s.cs_state != CsState::stopped && (cell(c, command) & kIgnoreCyclic) == 0) dispatch(c, Event::stop);
}

template <class C>
void timer_due(C& c) {
    const bool overflow = c.s.delay_running != 0 && c.s.now >= c.s.delay_from + kDelayOverflow;
    if (overflow) {
        c.s.delay_running = 0;
        cell(c, status) = 0;
        plan_timer(c);
        return;
    }
    dispatch(c, Event::timeout);
}

// ---- the processor's side ------------------------------------------------------------------------------------------

/// True when an access to RAM address `a` is more than an access to RAM.
template <class C>
bool watches(const C& c, std::uint16_t a) {
    return enabled(c) && c.s.passive_idle != 0 && a >= base(c) && a < base(c) + buffer_octets;
}

/// An octet of Receive_Delay_Time, most significant first, as it stands now.
template <class C>
std::uint8_t running_delay(const C& c, unsigned octet) {
    const auto us = static_cast<std::uint32_t>((c.s.now - c.s.delay_from) / core::microseconds(1));
    return static_cast<std::uint8_t>(us >> (8 * (3 - octet)));
}

template <class C>
std::uint8_t peek(const C& c, std::uint16_t a) {
    const auto offset = static_cast<unsigned>(a - base(c) - receive_delay_time);
    return c.s.delay_running != 0 && offset < 4 ? running_delay(c, offset) : c.s.ram[a];
}

/// Reading the first octet of Receive_Delay_Time stops it and keeps all four.
template <class C>
std::uint8_t read(C& c, std::uint16_t a) {
    if (c.s.delay_running != 0 && a == base(c) + receive_delay_time) {
        for (unsigned i = 0; i < 4; ++i) cell(c, static_cast<std::uint16_t>(receive_delay_time + i)) = running_delay(c, i);
        c.s.delay_running = 0;
        plan_timer(c);
    }
    return peek(c, a);
}

template <class C>
void write(C& c, std::uint16_t a, std::uint8_t value) {
    const auto offset = static_cast<unsigned>(a - base(c));
    const bool locked = c.s.cs_state != CsState::stopped;
    if (locked && (offset == interval_high || offset == interval_low)) return;
    const bool stop = offset == command && (value & kStop) != 0;
    c.s.ram[a] = stop ? static_cast<std::uint8_t>(value & ~kStop) : value;
    if (stop) dispatch(c, Event::stop);
    if (offset == interval_low && interval(c) != Ticks{}) dispatch(c, Event::interval_written);
}

}  // namespace dpchip::chip::clock_sync
