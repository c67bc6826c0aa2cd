// SPDX-License-Identifier: Apache-2.0
// Micro Sequencer: the only file that orders the blocks in time (2.1; reference 4.8, 4.13). Everybody else only reacts.
#pragma once

#include <dpchip/chip/receiver.hpp>
#include <dpchip/chip/saps.hpp>
#include <dpchip/chip/start_checks.hpp>
#include <dpchip/chip/transmitter.hpp>
#include <dpchip/chip/user_clock.hpp>

namespace dpchip::chip::ms {

using namespace core::literals;

/// Go_Offline on an idle line is over within 1 us (reference 4.8).
inline constexpr Ticks kOfflineDelay = 48_clk;

/// A telegram is coming in, being worked on or being answered.
constexpr bool busy(const State& s) {
    return s.rx_busy != 0 || timers::running(s, Timer::telegram) || transmitter::planned(s) || transmitter::sending(s);
}

template <class C>
void go_offline(C& c) {
    c.s.offline_requested = 0;
    timers::stop(c.s, Timer::offline);
    if (c.s.passive_idle != 0) {
        c.fact(Fact::leave_master, core::to_underlying(regmap::LeaveCause::go_offline), 0);
        dp::leave_actions(c);
        change(c, Fact::passive_idle, c.s.passive_idle, std::uint8_t{0});
        wd::search_again(c);
        timers::stop(c.s, Timer::watchdog);
        user_clock::stop(c.s);
        c.s.ts = 0xFF;
        c.s.rx_busy = 0;
        c.s.fcb_valid = 0;
        clock_sync::dispatch(c, clock_sync::Event::stop);
    }
    c.s.mode1 &= static_cast<std::uint8_t>(~(regmap::mode1::go_offline | regmap::mode1::start_vpc3));
    if ((c.s.mode0 & regmap::mode0::cs_supported) == 0 || !c.traits->clock_sync) irq::raise(c, regmap::interrupt::mac_reset);
}

/// Go_Offline, or a RAM access violation: at the end of the request, at once when there is none. A telegram that is
/// never completed holds it up no longer than the longest one would.
template <class C>
void request_offline(C& c) {
    if (c.s.offline_requested != 0) return;
    c.s.offline_requested = 1;
    const Ticks longest = idle::bit(c.s) * (fdl::kCharacterBits * static_cast<std::int64_t>(fdl::kMaxTelegram) + fdl::kTsynBits);
    timers::start(c.s, Timer::offline, c.s.now + (c.s.rx_busy != 0 ? longest : kOfflineDelay));
}

template <class C>
void offline_due(C& c) {
    timers::stop(c.s, Timer::offline);
    c.s.rx_busy = 0;
    if (!busy(c.s)) go_offline(c);
}

/// End of a message cycle, answered or not.
template <class C>
void cycle_over(C& c) {
    set_slave_add::address_becomes_valid(c);
    data_exchange::after_answer(c);
    // The answer's own buffer may have been the one beyond the RAM.
    if (c.s.offline_requested != 0 || c.s.ram_access_violation != 0) go_offline(c);
}

constexpr bool is_negative(Answer a) { return a == Answer::rs || a == Answer::rr; }

/// t0 + 1 clk: the request takes effect and its answer is planned. A telegram that proves the baud rate is not answered.
template <class C>
void telegram(C& c) {
    timers::stop(c.s, Timer::telegram);
    if (c.s.wd_state == WdState::baud_search) {
        wd::dispatch(c, wd::Event::baud_detected);
        return cycle_over(c);
    }
    if (!mac::function_code(c.s).is_request()) {
        dxb::receive(c);
        return cycle_over(c);
    }
    if (c.s.retry != 0) c.fact(Fact::retry, 0);
    const Answer answer = saps::serve(c);
    if (fdl::uses_frame_count(mac::function_code(c.s).request())) {
        c.s.answered_negative = is_negative(answer) ? 1 : 0;
        c.s.last_answer = answer;
    }
    if (c.s.ram_access_violation != 0) request_offline(c);
    if (answer == Answer::none || c.s.suppress_answer != 0) {
        sap_list::given_up(c);
        return cycle_over(c);
    }
    transmitter::plan(c, answer);
}

template <class C>
void answer_end(C& c) {
    transmitter::end(c);
    if (c.s.answer == Answer::slave_diag) slave_diag::sent(c);
    if (c.s.answer == Answer::response) sap_list::sent(c);
    cycle_over(c);
}

/// Somebody else sends before the planned answer has begun (reference 4.13: bus conflict).
template <class C>
void carrier(C& c) {
    if (receiver::deaf(c.s) && !transmitter::planned(c.s)) return;
    c.s.rx_busy = c.s.passive_idle;
    if (timers::running(c.s, Timer::telegram)) c.s.suppress_answer = 1;
    if (!transmitter::planned(c.s)) return;
    transmitter::give_up(c);
    diag::end_sending(c);
    sap_list::given_up(c);
    cycle_over(c);
}

template <class C>
void start(C& c) {
    dpram::latch(c.s);
    start_checks::run(c);
    c.s.ts = dpram::cell(c.s, regmap::org::r_ts_adr);
    c.s.next_ts = set_slave_add::kNone;
    c.s.ram_access_violation = 0;
    c.s.mode1 = static_cast<std::uint8_t>((c.s.mode1 | regmap::mode1::start_vpc3) & ~regmap::mode1::go_offline);
    c.s.prescaler_origin = c.s.now;
    c.s.user_wd_timer = core::word(dpram::cell(c.s, regmap::org::r_user_wd_value_high),
                                   dpram::cell(c.s, regmap::org::r_user_wd_value_low));
    c.s.din_sm = c.options.initial_din_sm;
    c.s.dout_sm = c.options.initial_dout_sm;
    c.s.dxbout_sm = c.options.initial_dxb_sm;
    c.s.diag_sm = c.options.initial_diag_sm;
    c.s.dout_cleared = c.s.dout_d_filled = c.s.diag_pending = c.s.diag_control = c.s.diag_flag = c.s.ssa_busy = 0;
    c.s.gc_command_before = c.s.gc_group_before = 0;
    c.s.prm_req = 1;
    c.s.prm_fault = c.s.cfg_fault = c.s.not_supported = 0;
    c.s.owner = c.s.master_add = dp::kNoMaster;
    if (c.traits->presets_gc_command) dpram::set_cell(c.s, regmap::org::r_gc_command, 0);
    change(c, Fact::passive_idle, c.s.passive_idle, std::uint8_t{1});
    user_clock::start(c.s);
    wd::search_again(c);
    dout::clear(c);
    irq::raise(c, regmap::interrupt::dx_out);
    diag::refresh_both(c);
}

/// A timer is due now.
template <class C>
void due(C& c, Timer timer) {
    switch (timer) {
    case Timer::telegram: return telegram(c);
    case Timer::rts_on: return transmitter::rts_on(c);
    case Timer::answer_start: return transmitter::begin(c);
    case Timer::answer_end: return answer_end(c);
    case Timer::rts_off:
        timers::stop(c.s, Timer::rts_off);
        return transmitter::set_rts(c, false);
    case Timer::watchdog: return dp::watchdog_expired(c);
    case Timer::eoi: return irq::inactive_time_over(c);
    case Timer::offline: return offline_due(c);
    case Timer::dxb_monitor: return dxb::monitor(c);
    case Timer::sync: return isom::pulse_edge(c);
    case Timer::clock_sync: return clock_sync::timer_due(c);
    case Timer::count: break;
    }
}

/// When the chip wants to be woken, given the earliest deadline.
constexpr Ticks wake_at(const State& s, Ticks soonest) { return std::min(soonest, user_clock::visible(s)); }
constexpr Ticks next(const State& s) { return wake_at(s, timers::soonest(s)); }

/// Runs everything due up to and including `to`, in order.
template <class C>
void run(C& c, Ticks to) {
    Ticks at = timers::soonest(c.s);
    while (at <= to) {
        user_clock::catch_up(c, at);
        c.s.now = std::max(c.s.now, at);
        due(c, timers::due_at(c.s, at));
        at = timers::soonest(c.s);
    }
    user_clock::catch_up(c, to);
    c.s.now = to;
    c.s.next = wake_at(c.s, at);
}

}  // namespace dpchip::chip::ms
