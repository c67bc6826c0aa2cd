// SPDX-License-Identifier: Apache-2.0
// The receiver: characters become telegrams (8.3; reference 1.3, 1.4). Two paths, one behaviour.
//
// Whole undamaged telegrams are taken in one step; everything else goes character by character through the same states.
// Bit-level sampling is the business of pins/.
#pragma once

#include <cstring>

#include <dpchip/chip/dxb.hpp>
#include <dpchip/chip/idle_timer.hpp>
#include <dpchip/chip/mac.hpp>
#include <dpchip/fdl/transmission.hpp>

namespace dpchip::chip::receiver {

/// Offline the receiver is off; while RTS is active it hears only its own echo.
constexpr bool deaf(const State& s) { return s.passive_idle == 0 || s.rts != 0; }

constexpr void to_hunt(State& s) {
    s.rx_state = RxState::hunt;
    s.rx_count = s.rx_size = 0;
}

/// Gives the telegram up and waits for an idle line.
template <class C>
void reject(C& c, fdl::Reject reason) {
    c.fact(Fact::rejected, core::to_underlying(reason), c.s.rx_count);
    c.s.rx_state = RxState::unsync;
    c.s.rx_count = c.s.rx_size = 0;
    c.s.rx_busy = 0;
}

/// To the MAC, or to the DXB subscriber: data of a publisher are an answer to somebody else.
template <class C>
void deliver(C& c, const fdl::Telegram& t) {
    if (!t.has_fc() || t.fc.is_request() || c.s.wd_state == WdState::baud_search) return mac::deliver(c, t);
    if (!dxb::wants(c, t)) return;
    c.fact(Fact::heard, mac::addresses(t), mac::summary(t));
    mac::keep(c, t);
}

/// All octets of a telegram have come.
template <class C>
void complete(C& c) {
    const auto telegram = fdl::decode({c.s.rx.data(), c.s.rx_count});
    if (!telegram) return reject(c, telegram.error());
    to_hunt(c.s);
    c.s.rx_busy = 0;
    deliver(c, *telegram);
}

template <class C>
void append(C& c, std::uint8_t octet) {
    c.s.rx[c.s.rx_count++] = octet;
    if (c.s.rx_size == 0) {
        const auto size = fdl::telegram_size({c.s.rx.data(), c.s.rx_count});
        if (!size && size.error() != fdl::Reject::need_more) return reject(c, size.error());
        if (size) c.s.rx_size = static_cast<std::uint16_t>(*size);
    }
    if (c.s.rx_count == c.s.rx_size) complete(c);
}

template <class C>
fdl::Reject check(const C& c, const fdl::Character& ch) {
    if ((ch.faults & fdl::fault_collision) != 0) return fdl::Reject::collision;
    if ((ch.faults & fdl::fault_parity) != 0) return fdl::Reject::parity;
    const bool stop_checked = (c.s.mode0 & regmap::mode0::dis_stop_control) == 0;
    if ((ch.faults & fdl::fault_stop) != 0 && stop_checked) return fdl::Reject::stop_bit;
    if (c.s.rx_state == RxState::frame && !idle::in_start_window(c, ch.start)) return fdl::Reject::gap;
    return fdl::Reject::need_more;
}

template <class C>
void take_character(C& c, const fdl::Character& ch) {
    if (deaf(c.s)) return;
    if (idle::synchronised(c.s, ch.start)) to_hunt(c.s);
    const bool at_my_rate = ch.bit == idle::bit(c.s);
    const Ticks idle_from = at_my_rate ? ch.last_low_end() : ch.end();
    c.s.line_idle_since = std::max(c.s.line_idle_since, idle_from);
    if (c.s.rx_state == RxState::unsync) return;
    if (!at_my_rate) return reject(c, fdl::Reject::stop_bit);
    if (const auto fault = check(c, ch); fault != fdl::Reject::need_more) return reject(c, fault);
    c.s.rx_state = RxState::frame;
    c.s.character_due = ch.start + ch.bit * fdl::kCharacterBits;
    append(c, ch.octet);
}

/// One character, at its end. The receiver is busy only inside a telegram that may still become one.
template <class C>
void character(C& c, const fdl::Character& ch) {
    take_character(c, ch);
    c.s.rx_busy = c.s.rx_state == RxState::frame ? 1 : 0;
}

template <class C>
void characters(C& c, const fdl::Transmission& t) {
    for (std::size_t i = 0; i < t.length; ++i) character(c, t.character(i));
}

/// True when the transmission is one good telegram that the receiver, as it stands, takes in whole.
template <class C>
bool takes_whole(const C& c, const fdl::Transmission& t) {
    if (t.damaged || t.length == 0 || t.bit != idle::bit(c.s)) return false;
    return c.s.rx_state == RxState::hunt || t.synchronised || idle::synchronised(c.s, t.start);
}

/// A transmission that has ended now.
template <class C>
void transmission(C& c, const fdl::Transmission& t) {
    if (deaf(c.s)) {
        c.s.rx_busy = 0;
        return;
    }
    if (!takes_whole(c, t)) return characters(c, t);
    std::memcpy(c.s.rx.data(), t.octets.data(), t.length);
    const auto telegram = fdl::decode({c.s.rx.data(), t.length});
    if (!telegram || telegram->size != t.length) return characters(c, t);
    to_hunt(c.s);
    const auto last = t.character(t.length - 1u);
    c.s.line_idle_since = last.last_low_end();
    c.s.character_due = t.end();
    c.s.rx_busy = 0;
    deliver(c, *telegram);
}

}  // namespace dpchip::chip::receiver
