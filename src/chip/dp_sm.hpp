// SPDX-License-Identifier: Apache-2.0
// DP state machine: WAIT-PRM, WAIT-CFG, DATA-EXCH, and LEAVE-MASTER (6.2; reference 3.11 to 3.13).
#pragma once

#include <string_view>

#include <dpchip/chip/aux_buffers.hpp>
#include <dpchip/chip/clock_sync.hpp>
#include <dpchip/chip/data_buffers.hpp>
#include <dpchip/chip/diag_buffers.hpp>
#include <dpchip/chip/dxb.hpp>
#include <dpchip/chip/isom.hpp>
#include <dpchip/chip/state_table.hpp>
#include <dpchip/chip/wd_sm.hpp>

namespace dpchip::chip::dp {

inline constexpr std::uint8_t kNoMaster = 0xFF;

enum class Event : std::uint8_t {
    prm_accepted,      ///< Set_Prm passed the full check
    all_acknowledged,  ///< the user has acknowledged all parameters and the configuration
    leave_master,
    count
};
enum class Action : std::uint8_t { none, enter_data_exch, leave };

struct Row { DpState from; Event on; DpState to; Action action; std::string_view section; };
struct Ignored { DpState in; Event on; std::string_view because; };

// clang-format off
inline constexpr Row kRows[]{
    // from                on event                  next state           action                   source
    {DpState::wait_prm,  Event::prm_accepted,     DpState::wait_cfg,  Action::none,            "reference 3.4.3: before the user acknowledges"},
    {DpState::wait_cfg,  Event::prm_accepted,     DpState::wait_cfg,  Action::none,            "reference 3.4.2"},
    {DpState::data_exch, Event::prm_accepted,     DpState::data_exch, Action::none,            "reference 3.4.2: stays"},
    {DpState::wait_cfg,  Event::all_acknowledged, DpState::data_exch, Action::enter_data_exch, "6.2.3"},
    {DpState::wait_cfg,  Event::leave_master,     DpState::wait_prm,  Action::leave,           "6.2.3, 6.2.5"},
    {DpState::data_exch, Event::leave_master,     DpState::wait_prm,  Action::leave,           "5.4.3, 6.2.3, 6.2.5"},
};
inline constexpr Ignored kIgnored[]{
    {DpState::wait_prm,  Event::all_acknowledged, "nothing can be acknowledged there: 03H Not_Allowed"},
    {DpState::data_exch, Event::all_acknowledged, "already there"},
    {DpState::wait_prm,  Event::leave_master,     "there is no master to leave"},
};
// clang-format on

inline constexpr auto kTable = total_table<3, Event>(kRows, kIgnored);

constexpr bool is_owner(const State& s, std::uint8_t master) { return s.owner != kNoMaster && s.owner == master; }

template <class C>
void set_state(C& c, DpState to) {
    const bool was = c.s.dp_state == DpState::data_exch, is = to == DpState::data_exch;
    change(c, Fact::dp_state, c.s.dp_state, to);
    if (was == is) return;
    outputs::changed(c, Fact::xdataexch_sync, Pin::xdataexch_sync);
    irq::raise(c, regmap::interrupt::go_leave_data_exch);
}

/// Reference 3.12, in its order. Also Go_Offline does this, from any state.
template <class C>
void leave_actions(C& c) {
    set_state(c, DpState::wait_prm);
    dout::clear_with_interrupt(c);
    change(c, Fact::sync_mode, c.s.sync_mode, std::uint8_t{0});
    change(c, Fact::freeze_mode, c.s.freeze_mode, std::uint8_t{0});
    c.s.group_ident = 0;
    c.s.prm_req = 1;
    c.s.wd_on = 0;
    c.s.owner = kNoMaster;
    if (!c.options.quirk_keep_master_add) c.s.master_add = kNoMaster;
    aux::drop_all(c);
    c.s.cfg_okay = c.s.chk_cfg_seen = c.s.din_given = 0;
    if (c.options.leave_master_stops_wd) wd::dispatch(c, wd::Event::leave_master);
    clock_sync::cyclic_state_machine_changed(c);
    dxb::stop_monitoring(c.s);
    isom::stop(c);
    c.s.dpv1_enable = c.s.publisher_enable = c.s.fail_safe = 0;
    diag::refresh_both(c);
}

template <class C>
void dispatch(C& c, Event event) {
    const std::int8_t row = kTable[static_cast<std::size_t>(c.s.dp_state)][static_cast<std::size_t>(event)];
    if (row == kIgnoredPair) return;
    switch (kRows[row].action) {
    case Action::none: set_state(c, kRows[row].to); break;
    case Action::enter_data_exch:
        c.s.user_wd_timer = core::word(dpram::cell(c.s, regmap::org::r_user_wd_value_high),
                                       dpram::cell(c.s, regmap::org::r_user_wd_value_low));
        set_state(c, kRows[row].to);
        dxb::start_monitoring(c);
        diag::refresh(c);
        break;
    case Action::leave: leave_actions(c); break;
    }
}

/// LEAVE-MASTER with its cause in the trace. In WAIT-PRM there is nothing to leave.
template <class C>
void leave_master(C& c, regmap::LeaveCause cause) {
    if (c.s.dp_state != DpState::wait_prm) c.fact(Fact::leave_master, core::to_underlying(cause), 0);
    dispatch(c, Event::leave_master);
}

/// Faults that end in LEAVE-MASTER show in the diagnosis whether or not there was a master to leave.
template <class C>
void leave_with_fault(C& c, regmap::LeaveCause cause, std::uint8_t State::*fault) {
    c.s.*fault = 1;
    leave_master(c, cause);
    diag::refresh(c);
}

/// 6.2.3: DATA-EXCH when the configuration is acknowledged and no counter runs; APC3 also wants the first inputs (5.2.3).
template <class C>
void enter_data_exch_if_ready(C& c) {
    if (c.s.dp_state != DpState::wait_cfg || c.s.cfg_okay == 0 || c.s.prm_counter != 0 || c.s.cfg_counter != 0) return;
    if (c.traits->din_gates_data_exch && din::length(c.s) != 0 && c.s.din_given == 0) return;
    dispatch(c, Event::all_acknowledged);
}

/// The watchdog timer of the present WD_State has run out.
template <class C>
void watchdog_expired(C& c) {
    const bool master_lost = c.s.wd_state == WdState::dp_control;
    wd::dispatch(c, wd::Event::timeout);
    if (master_lost) leave_master(c, regmap::LeaveCause::wd_timeout);
}

}  // namespace dpchip::chip::dp
