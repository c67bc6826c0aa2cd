// SPDX-License-Identifier: Apache-2.0
// Medium access: which telegrams concern the chip, repetitions by the frame count bit (2.1, 5.4; reference 2.4 to 2.7).
#pragma once

#include <dpchip/chip/idle_timer.hpp>
#include <dpchip/chip/wd_sm.hpp>
#include <dpchip/fdl/telegram.hpp>

namespace dpchip::chip::mac {

inline constexpr std::uint8_t kNoSap = 0xFF;

/// One word for the trace: FC, DSAP, SSAP and the number of data octets.
constexpr std::uint32_t summary(const fdl::Telegram& t) {
    const bool saps = t.saps_present();
    const std::uint32_t dsap = saps && t.has_dsap() ? t.dsap() : kNoSap;
    const std::uint32_t ssap = saps && t.has_ssap() ? t.ssap() : kNoSap;
    const auto octets = static_cast<std::uint32_t>(saps ? t.data().size() : t.unit.size());
    return static_cast<std::uint32_t>(t.fc.octet) << 24 | dsap << 16 | ssap << 8 | octets;
}
constexpr std::uint16_t addresses(const fdl::Telegram& t) { return static_cast<std::uint16_t>(t.da << 8 | t.sa); }

constexpr bool known_function(fdl::FunctionCode fc) {
    if ((fc.octet & 0x80u) != 0) return fc.clock_value();
    constexpr unsigned kKnown = 1u << 0 | 1u << 3 | 1u << 4 | 1u << 5 | 1u << 6 | 1u << 7 | 1u << 9 | 1u << 12 | 1u << 13 | 1u << 14 | 1u << 15;
    return ((kKnown >> fc.function()) & 1u) != 0;
}

/// Reference 2.4 from the third row on: requests to this station, or to everybody when they want no answer.
constexpr bool concerns(const State& s, const fdl::Telegram& t) {
    if (!t.has_fc() || !t.fc.is_request() || t.source() == fdl::kBroadcast) return false;
    if (!t.saps_present()) return false;
    if (t.destination() == fdl::kBroadcast) {
        const bool clock = t.fc.request() == fdl::Request::time_event;
        return t.fc.clock_value() || ((t.fc.octet & 0x80u) == 0 && (clock || fdl::is_sdn(t.fc.request())));
    }
    return t.destination() == s.ts;
}

/// Reference 2.5. Keeps the frame count bit and says whether the request is a repetition.
constexpr bool is_retry(State& s, const fdl::Telegram& t) {
    if (!fdl::uses_frame_count(t.fc.request())) return false;
    const bool fcb = t.fc.fcb();
    if (t.fc.fcv() && s.fcb_valid != 0 && s.fcb_sa == t.source() && (s.fcb_last != 0) == fcb) {
        return s.answered_negative == 0;  // a request that was refused is looked at again
    }
    s.fcb_valid = (t.fc.fcv() || fcb) ? 1 : 0;
    s.fcb_sa = t.source();
    s.fcb_last = fcb ? 1 : 0;
    return false;
}

/// Keeps what the telegram in rx wants, to be worked on at t0 + 1 clk.
template <class C>
void keep(C& c, const fdl::Telegram& t) {
    c.s.request_end = c.s.now;
    c.s.answer_at = idle::answer_at(c);  // with the minTSDR of now, whatever this telegram sets
    c.s.request_da = t.da;
    c.s.request_sa = t.sa;
    c.s.request_fc = t.fc.octet;
    c.s.request_data_at = static_cast<std::uint8_t>(t.size - 2 - t.data().size());
    c.s.request_length = static_cast<std::uint8_t>(t.data().size());
    c.s.suppress_answer = 0;
    timers::start(c.s, Timer::telegram, c.s.now + core::kClk);
}

/// A telegram without error has ended now; its octets stand in rx.
template <class C>
void deliver(C& c, const fdl::Telegram& t) {
    if (!t.has_fc()) return;
    if (c.s.wd_state == WdState::baud_search) {
        if (t.sd == fdl::kSd3 && !c.traits->sd3_proves_baud) return;
        c.fact(Fact::proof, addresses(t), summary(t));
        timers::stop(c.s, Timer::watchdog);
        timers::start(c.s, Timer::telegram, c.s.now + core::kClk);
        return;
    }
    if (!concerns(c.s, t)) return;
    c.fact(Fact::heard, addresses(t), summary(t));
    const bool to_me = t.destination() == c.s.ts;
    const bool from_owner = c.s.owner != 0xFF && c.s.owner == t.source();
    if (to_me || c.options.gc_triggers_wd) wd::trigger(c, from_owner);
    if (!known_function(t.fc)) return;

    c.s.retry = is_retry(c.s, t) ? 1 : 0;
    keep(c, t);
}

/// The request being served.
constexpr std::uint8_t master(const State& s) { return s.request_sa & 0x7Fu; }
constexpr bool has_dsap(const State& s) { return (s.request_da & 0x80u) != 0; }
constexpr bool has_ssap(const State& s) { return (s.request_sa & 0x80u) != 0; }
constexpr std::uint8_t ssap(const State& s) { return s.rx[s.request_data_at - 1u]; }
constexpr std::uint8_t dsap(const State& s) { return s.rx[s.request_data_at - (has_ssap(s) ? 2u : 1u)]; }
constexpr fdl::FunctionCode function_code(const State& s) { return {s.request_fc}; }
inline std::span<const std::uint8_t> data(const State& s) {
    return {s.rx.data() + s.request_data_at, s.request_length};
}

}  // namespace dpchip::chip::mac
