// SPDX-License-Identifier: Apache-2.0
// Watchdog state machine: baud rate search, baud rate monitoring, response time monitoring (5.4, figure 5-12; reference 4.10).
#pragma once

#include <algorithm>
#include <string_view>

#include <dpchip/chip/irq.hpp>
#include <dpchip/chip/state_table.hpp>

namespace dpchip::chip::wd {

enum class Event : std::uint8_t {
    baud_detected,  ///< a complete telegram without error
    timeout,        ///< the watchdog timer of the present state
    prm_wd_on,      ///< accepted Set_Prm with WD_On = 1
    prm_wd_off,     ///< accepted Set_Prm with WD_On = 0
    leave_master,   ///< with option leave_master_stops_wd
    count
};
enum class Action : std::uint8_t { start_search, next_rate, found, monitor_baud, monitor_master, master_timeout };

struct Row { WdState from; Event on; WdState to; Action action; std::string_view section; };
struct Ignored { WdState in; Event on; std::string_view because; };

// clang-format off
inline constexpr Row kRows[]{
    // from                  on event               next state             action                  manual
    {WdState::baud_search,  Event::timeout,       WdState::baud_search,  Action::next_rate,      "5.4.1: the next lower baud rate"},
    {WdState::baud_search,  Event::baud_detected, WdState::baud_control, Action::found,          "5.4.1"},
    {WdState::baud_control, Event::timeout,       WdState::baud_search,  Action::start_search,   "5.4.2"},
    {WdState::baud_control, Event::prm_wd_on,     WdState::dp_control,   Action::monitor_master, "5.4.2"},
    {WdState::dp_control,   Event::prm_wd_on,     WdState::dp_control,   Action::monitor_master, "5.4.3: new factors"},
    {WdState::dp_control,   Event::prm_wd_off,    WdState::baud_control, Action::monitor_baud,   "figure 5-12"},
    {WdState::dp_control,   Event::timeout,       WdState::baud_control, Action::master_timeout, "5.4.3"},
    {WdState::dp_control,   Event::leave_master,  WdState::baud_control, Action::monitor_baud,   "reference 3.12"},
};
inline constexpr Ignored kIgnored[]{
    {WdState::baud_search,  Event::prm_wd_on,     "no telegram is accepted before a rate is found"},
    {WdState::baud_search,  Event::prm_wd_off,    "no telegram is accepted before a rate is found"},
    {WdState::baud_search,  Event::leave_master,  "nothing monitors a master"},
    {WdState::baud_control, Event::baud_detected, "already found"},
    {WdState::baud_control, Event::prm_wd_off,    "stays (5.4.2)"},
    {WdState::baud_control, Event::leave_master,  "nothing monitors a master"},
    {WdState::dp_control,   Event::baud_detected, "already found"},
};
// clang-format on

inline constexpr auto kTable = total_table<3, Event>(kRows, kIgnored);

/// The n-th tick of the free-running prescaler after now: between n-1 and n units of time away (reference 4.10).
constexpr Ticks nth_prescaler_tick(const State& s, Ticks unit, std::int64_t n) {
    return s.prescaler_origin + unit * ((s.now - s.prescaler_origin) / unit + n);
}

/// Monitoring time of BAUD_CONTROL: 10 ms times the square of WD_BAUD_CONTROL_Val.
template <class C>
void restart_baud_control(C& c) {
    const std::int64_t root = std::max<std::int64_t>(c.s.wd_baud_control_val, 1);
    timers::start(c.s, Timer::watchdog, nth_prescaler_tick(c.s, core::milliseconds(10), root * root));
}

/// When T_WD = WD_Base * WD_Fact_1 * WD_Fact_2 is over, counted from now.
template <class C>
Ticks t_wd_end(const C& c) {
    const Ticks unit = core::milliseconds((c.s.mode0 & regmap::mode0::wd_base) != 0 ? 1 : 10);
    return nth_prescaler_tick(c.s, unit, std::int64_t{c.s.wd_fact_1} * c.s.wd_fact_2);
}

template <class C>
void restart_dp_control(C& c) { timers::start(c.s, Timer::watchdog, t_wd_end(c)); }

/// How long one rate is tried.
template <class C>
Ticks probe_time(const C& c) {
    const std::uint32_t ms = c.options.baud_probe_ms[static_cast<std::size_t>(c.s.probe)];
    if (ms != 0) return core::milliseconds(ms);
    return std::max(core::milliseconds(100), fdl::baud(c.s.probe).bit * 6000);
}

/// The receiver works at another rate from now on: it must see the line idle before it trusts it.
template <class C>
void try_rate(C& c, fdl::BaudCode rate) {
    c.s.probe = rate;
    c.s.rx_state = RxState::unsync;
    c.s.rx_count = c.s.rx_size = 0;
    c.s.line_idle_since = std::max(c.s.line_idle_since, c.s.now);
    c.fact(Fact::baud_probe, core::to_underlying(rate));
    timers::start(c.s, Timer::watchdog, c.s.now + probe_time(c));
}

template <class C>
void set_baud(C& c, fdl::BaudCode code) { change(c, Fact::baud, c.s.baud, code); }

template <class C>
void act(C& c, Action action) {
    switch (action) {
    case Action::start_search:
        set_baud(c, fdl::BaudCode::not_found);
        try_rate(c, fdl::BaudCode::mbit_12);
        break;
    case Action::next_rate: {
        const auto next = (static_cast<std::size_t>(c.s.probe) + 1) % fdl::kBaudRates;
        try_rate(c, static_cast<fdl::BaudCode>(next));
        break;
    }
    case Action::found:
        set_baud(c, c.s.probe);
        irq::raise(c, regmap::interrupt::baud_rate_detect);
        restart_baud_control(c);
        break;
    case Action::monitor_baud: restart_baud_control(c); break;
    case Action::monitor_master: restart_dp_control(c); break;
    case Action::master_timeout:
        irq::raise(c, regmap::interrupt::wd_dp_control_timeout);
        restart_baud_control(c);
        break;
    }
}

/// Changes the state, then does what the row says. The LEAVE-MASTER of a master timeout is the DP_SM's business.
template <class C>
void dispatch(C& c, Event event) {
    const std::int8_t row = kTable[static_cast<std::size_t>(c.s.wd_state)][static_cast<std::size_t>(event)];
    if (row == kIgnoredPair) return;
    change(c, Fact::wd_state, c.s.wd_state, kRows[row].to);
    act(c, kRows[row].action);
}

/// Start and Go_Offline: back to the search from any state.
template <class C>
void search_again(C& c) {
    change(c, Fact::wd_state, c.s.wd_state, WdState::baud_search);
    act(c, Action::start_search);
}

/// An error-free telegram to the own address. `from_owner`: a request of the master that owns the slave.
template <class C>
void trigger(C& c, bool from_owner) {
    if (c.s.wd_state == WdState::baud_control) restart_baud_control(c);
    if (c.s.wd_state == WdState::dp_control && from_owner) restart_dp_control(c);
}

}  // namespace dpchip::chip::wd
