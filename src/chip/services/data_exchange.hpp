// SPDX-License-Identifier: Apache-2.0
// Write_Read_Data / Data_Exchange, default SAP, and the User_Watchdog_Timer (6.2.5; reference 3.8, 4.9).
#pragma once

#include <dpchip/chip/dp_sm.hpp>
#include <dpchip/chip/isom.hpp>
#include <dpchip/chip/mac.hpp>

namespace dpchip::chip::data_exchange {

using Data = std::span<const std::uint8_t>;

template <class C>
void leave_after_answer(C& c, regmap::LeaveCause cause) {
    c.s.leave_after_answer = static_cast<std::uint8_t>(core::to_underlying(cause) + 1);
}

/// DX_Out according to DX_Int_Mode and DX_Int_Mode_2; `same` only matters for the latter.
template <class C>
void interrupt(C& c, bool outputs, bool same) {
    if ((c.s.mode3 & regmap::mode3::dx_int_mode_2) != 0) {
        if (!same) isom::dx_out(c);
    } else if (outputs || dout::interrupt_without_outputs(c.s)) {
        isom::dx_out(c);
    }
}

template <class C>
void take_outputs(C& c, Data d) {
    const bool compare = (c.s.mode3 & regmap::mode3::dx_int_mode_2) != 0;
    const bool same = compare && dpram::equal(c, dout::segment(c.s, Slot::u), d);
    dout::fill(c, d);
    if (c.s.sync_mode != 0) {
        c.s.dout_d_filled = 1;
        return;
    }
    dout::shift(c);
    interrupt(c, true, same);
}

/// Counts down; reload when the user has asked for it. False when the count has just run out.
template <class C>
bool user_watchdog_content(C& c) {
    if ((c.s.mode1 & regmap::mode1::res_user_wd) != 0) {
        c.s.mode1 &= static_cast<std::uint8_t>(~regmap::mode1::res_user_wd);
        c.s.user_wd_timer = core::word(dpram::cell(c.s, regmap::org::r_user_wd_value_high),
                                       dpram::cell(c.s, regmap::org::r_user_wd_value_low));
        c.fact(Fact::user_wd, c.s.user_wd_timer);
        return true;
    }
    if (c.s.user_wd_timer == 0) return true;
    --c.s.user_wd_timer;
    c.fact(Fact::user_wd, c.s.user_wd_timer);
    return c.s.user_wd_timer != 0;
}

/// Outputs of a length that was not configured: answered, then the master is left with Cfg_Fault.
template <class C>
Answer wrong_length(C& c, bool too_long) {
    const auto option = c.options.dx_len_error_answer;
    const bool rr = option == regmap::DxLenErrorAnswer::rr || (option == regmap::DxLenErrorAnswer::by_case && too_long);
    if (!rr) {
        leave_after_answer(c, regmap::LeaveCause::output_length);
        return Answer::data_exchange;
    }
    dp::leave_with_fault(c, regmap::LeaveCause::output_length, &State::cfg_fault);
    return Answer::rr;
}

/// Stores the outputs; false when their length is wrong.
template <class C>
bool accept(C& c, Data d) {
    const std::size_t expected = dout::length(c.s);
    const bool fail_safe = (c.s.mode0 & regmap::mode0::spec_clear_mode) != 0;
    if (d.size() != expected && !(d.empty() && fail_safe)) return false;
    if (expected == 0) interrupt(c, false, true);
    else if (d.empty()) {
        dout::clear(c);
        interrupt(c, true, false);
    } else take_outputs(c, d);
    return true;
}

/// MSRD is for publishers only; others do not even answer it.
template <class C>
bool refused_multicast(const C& c) {
    return mac::function_code(c.s).request() == fdl::Request::msrd && c.s.publisher_enable == 0;
}

template <class C>
Answer serve(C& c) {
    if (refused_multicast(c)) return Answer::none;
    if (c.s.dp_state != DpState::data_exch || !dp::is_owner(c.s, mac::master(c.s))) return Answer::rs;
    const Data d = mac::data(c.s);
    if (!accept(c, d)) return wrong_length(c, d.size() > dout::length(c.s));
    if (!user_watchdog_content(c)) leave_after_answer(c, regmap::LeaveCause::user_wd);
    return Answer::data_exchange;
}

/// What an answer had to wait for: LEAVE-MASTER by a wrong length or by the user watchdog.
template <class C>
void after_answer(C& c) {
    if (c.s.leave_after_answer == 0) return;
    const auto cause = static_cast<regmap::LeaveCause>(c.s.leave_after_answer - 1);
    c.s.leave_after_answer = 0;
    if (cause == regmap::LeaveCause::output_length) dp::leave_with_fault(c, cause, &State::cfg_fault);
    else dp::leave_master(c, cause);
}

}  // namespace dpchip::chip::data_exchange
