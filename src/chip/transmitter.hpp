// SPDX-License-Identifier: Apache-2.0
// The transmitter: from a decided answer to octets on the line, RTS and XCTS (8.3; reference 1.5, 2.7, 4.13).
//
// XCTS is looked at before the first character. Between characters pins/ looks at it and says hold() and sent().
#pragma once

#include <dpchip/chip/data_buffers.hpp>
#include <dpchip/chip/diag_buffers.hpp>
#include <dpchip/chip/idle_timer.hpp>
#include <dpchip/chip/mac.hpp>
#include <dpchip/chip/sap_list.hpp>

namespace dpchip::chip::transmitter {

using fdl::Response;

/// Where the data of an answer begin in tx: behind `68 LE LE 68 DA SA FC` and the SAP octets.
constexpr std::size_t data_at(const State& s) { return 7u + (mac::has_ssap(s) ? 1u : 0u) + (mac::has_dsap(s) ? 1u : 0u); }

constexpr void compose_sd1(State& s, Response code) {
    s.tx_count = static_cast<std::uint16_t>(fdl::encode_sd1(s.tx, mac::master(s), s.ts, fdl::response_fc(code)));
}

/// SD2 around `octets` data that already stand at data_at(). The SAPs change places; real slaves answer SD2 at any length.
constexpr void compose_sd2(State& s, std::uint8_t da, Response code, std::size_t octets) {
    std::size_t at = 7;
    if (mac::has_ssap(s)) s.tx[at++] = mac::ssap(s);
    if (mac::has_dsap(s)) s.tx[at++] = mac::dsap(s);
    const auto sa = static_cast<std::uint8_t>(s.ts | (s.request_da & 0x80u));
    s.tx_count = static_cast<std::uint16_t>(fdl::finish_sd2(s.tx, da, sa, fdl::response_fc(code), at - 7 + octets));
}

/// Room for data in one telegram beside the SAP octets.
constexpr std::size_t room(const State& s) { return fdl::kMaxDataUnit - (data_at(s) - 7u); }

template <class C>
std::size_t copy(C& c, std::uint8_t segment, std::size_t octets) {
    const std::size_t n = std::min(octets, room(c.s));
    dpram::read(c, segment, {c.s.tx.data() + data_at(c.s), n});
    return n;
}

template <class C>
void compose_sc(C& c) {
    c.s.tx[0] = fdl::kSc;
    c.s.tx_count = 1;
    c.s.last_answer = Answer::sc;
}

/// A diagnosis is waiting but there are no inputs to say so with (reference 3.8).
template <class C>
void compose_dh_without_inputs(C& c) {
    switch (c.options.dh_without_inputs) {
    case regmap::DhWithoutInputs::dummy_octet:
        c.s.tx[data_at(c.s)] = 0;
        return compose_sd2(c.s, c.s.request_sa, Response::dh, 1);
    case regmap::DhWithoutInputs::sd1: return compose_sd1(c.s, Response::dh);
    case regmap::DhWithoutInputs::sc: return compose_sc(c);
    }
}

template <class C>
void fetch_inputs(C& c) {
    if (c.s.retry == 0 && c.s.freeze_mode == 0) din::fetch(c);
}

template <class C>
void compose_data_exchange(C& c) {
    fetch_inputs(c);
    const bool multicast = mac::function_code(c.s).request() == fdl::Request::msrd;
    const bool high = c.s.retry != 0 ? c.s.last_fc == fdl::response_fc(Response::dh) : c.s.diag_flag != 0;
    c.s.last_fc = fdl::response_fc(high ? Response::dh : Response::dl);
    const std::uint8_t inputs = din::length(c.s);
    if (inputs == 0) return high ? compose_dh_without_inputs(c) : compose_sc(c);
    const std::size_t n = copy(c, din::segment(c.s, Slot::d), inputs);
    const std::uint8_t da = multicast ? fdl::kBroadcast : c.s.request_sa;
    compose_sd2(c.s, da, high ? Response::dh : Response::dl, n);
}

template <class C>
void compose_data(C& c, std::uint8_t segment, std::size_t octets) {
    if (octets == 0) return compose_sc(c);
    compose_sd2(c.s, c.s.request_sa, Response::dl, copy(c, segment, octets));
}

template <class C>
void compose_diagnosis(C& c) {
    diag::begin_sending(c);
    const unsigned number = diag::own(c.s);
    if (number == 0) return compose_sd1(c.s, Response::rr);
    const std::size_t n = copy(c, diag::segment(c.s, number), diag::length(c, number));
    const auto header = diag::header(c.s);
    std::copy(header.begin(), header.end(), c.s.tx.begin() + static_cast<std::ptrdiff_t>(data_at(c.s)));
    compose_sd2(c.s, c.s.request_sa, Response::dl, n);
}

/// A response of the SAP list, with the function code its user gave it. It is kept for a repetition: the user may have
/// written the next one into its buffer by then.
template <class C>
void compose_response(C& c) {
    const std::uint8_t segment = c.s.resp_segment;
    const std::size_t n = std::min<std::size_t>(sap_list::octet(c, segment, sap_list::length), room(c.s));
    for (std::size_t i = 0; i < n; ++i) c.s.tx[data_at(c.s) + i] = sap_list::octet(c, segment, sap_list::kHeaderOctets + i);
    const auto code = static_cast<Response>(sap_list::octet(c, segment, sap_list::function_code) & 0x0F);
    compose_sd2(c.s, c.s.request_sa, code, n);
    c.s.kept = c.s.tx;
    c.s.kept_count = c.s.tx_count;
}

constexpr void compose_kept(State& s) {
    s.tx = s.kept;
    s.tx_count = s.kept_count;
}

/// Fetches the buffers and builds the answer, at the moment RTS rises.
template <class C>
void compose(C& c) {
    switch (c.s.answer) {
    case Answer::none: break;
    case Answer::sc: return compose_sc(c);
    case Answer::fdl_status: return compose_sd1(c.s, Response::ok);
    case Answer::rs: return compose_sd1(c.s, Response::rs);
    case Answer::rr: return compose_sd1(c.s, Response::rr);
    case Answer::data_exchange: return compose_data_exchange(c);
    case Answer::rd_input:
        fetch_inputs(c);
        return compose_data(c, din::segment(c.s, Slot::d), din::length(c.s));
    case Answer::rd_output: return compose_data(c, dout::segment(c.s, Slot::u), dout::length(c.s));
    case Answer::get_cfg:
        return compose_data(c, dpram::pointer(c.s, regmap::org::r_read_cfg_buf_ptr),
                            dpram::cell(c.s, regmap::org::r_len_read_cfg_data));
    case Answer::slave_diag: return compose_diagnosis(c);
    case Answer::response: return compose_response(c);
    case Answer::kept: return compose_kept(c.s);
    }
}

/// Plans the answer to the request that has just been worked on.
template <class C>
void plan(C& c, Answer answer) {
    c.s.answer = answer;
    c.s.answer_bit = idle::bit(c.s);
    const Ticks lead = core::kClk * c.options.rts_lead_clk;
    timers::start(c.s, Timer::rts_on, std::max(c.s.now, c.s.answer_at - lead));
}

/// Values of xcts_hold: which character waits for XCTS.
inline constexpr std::uint8_t kNotHeld = 0, kHeldFirst = 1, kHeldLater = 2;

template <class C>
void set_rts(C& c, bool on) {
    if ((c.s.rts != 0) == on) return;
    c.s.rts = on ? 1 : 0;
    outputs::changed(c, Fact::rts, Pin::rts);
}

template <class C>
void rts_on(C& c) {
    timers::stop(c.s, Timer::rts_on);
    timers::stop(c.s, Timer::rts_off);
    set_rts(c, true);
    compose(c);
    if (c.s.xcts_high != 0) c.s.xcts_hold = kHeldFirst;
    else timers::start(c.s, Timer::answer_start, std::max(c.s.now, c.s.answer_at));
}

/// XCTS went low: the held first character may go.
template <class C>
void clear_to_send(C& c) {
    if (c.s.xcts_hold != kHeldFirst) return;
    c.s.xcts_hold = kNotHeld;
    c.s.answer_at = std::max(c.s.now, c.s.answer_at);
    timers::start(c.s, Timer::answer_start, c.s.answer_at);
}

template <class C>
void begin(C& c) {
    timers::stop(c.s, Timer::answer_start);
    c.s.answer_ready = 1;
    timers::start(c.s, Timer::answer_end, c.s.now + c.s.answer_bit * (fdl::kCharacterBits * c.s.tx_count));
    const bool sc = c.s.tx_count == 1;
    const std::uint8_t fc = sc ? c.s.tx[0] : c.s.tx[c.s.tx[0] == fdl::kSd1 ? 3 : 6];
    const std::uint8_t da = sc ? std::uint8_t{0} : c.s.tx[c.s.tx[0] == fdl::kSd1 ? 1 : 4];
    c.fact(Fact::answer, static_cast<std::uint16_t>(fc << 8 | da), c.s.tx_count);
}

template <class C>
void end(C& c) {
    timers::stop(c.s, Timer::answer_end);
    timers::start(c.s, Timer::rts_off, c.s.now + core::kClk * c.options.rts_trail_clk);
    c.s.answer_ready = 0;
    c.s.rx_state = RxState::hunt;
    c.s.rx_count = c.s.rx_size = 0;
    c.s.line_idle_since = c.s.now;
    c.fact(Fact::answer_end, 0);
}

/// An answer is planned or held back but has not begun.
constexpr bool planned(const State& s) {
    return timers::running(s, Timer::rts_on) || timers::running(s, Timer::answer_start) || s.xcts_hold == kHeldFirst;
}
constexpr bool sending(const State& s) { return timers::running(s, Timer::answer_end) || s.xcts_hold == kHeldLater; }

/// XCTS holds a later character: when sending ends is open until sent().
constexpr void hold(State& s) {
    if (!timers::running(s, Timer::answer_end)) return;
    timers::stop(s, Timer::answer_end);
    s.xcts_hold = kHeldLater;
}

/// Whoever sends the bits knows when the last of them leaves the line.
constexpr void sent(State& s, Ticks at) {
    if (!sending(s)) return;
    s.xcts_hold = kNotHeld;
    timers::start(s, Timer::answer_end, std::max(at, s.now));
}

template <class C>
void give_up(C& c) {
    timers::stop(c.s, Timer::rts_on);
    timers::stop(c.s, Timer::answer_start);
    c.s.xcts_hold = kNotHeld;
    set_rts(c, false);
    c.fact(Fact::answer_given_up, 0);
    c.find(Rule::answer_lost, core::to_underlying(c.s.answer));
}

}  // namespace dpchip::chip::transmitter
