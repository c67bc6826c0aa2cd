// SPDX-License-Identifier: Apache-2.0
// The life of a transmission: taken, perhaps spoilt, begun, perhaps hit by another, heard.
#include <algorithm>
#include <cstring>

#include <dpchip/core/assert.hpp>
#include <dpchip/fdl/telegram.hpp>
#include <dpchip/segment/segment.hpp>

namespace dpchip::segment {

namespace {

using fdl::Transmission;

void make_damaged(Transmission& t) {
    if (t.damaged) return;
    t.damaged = true;
    std::fill_n(t.faults.begin(), t.length, std::uint8_t{fdl::fault_none});
}

/// What two senders make of an octet: arbitrary, but the same in every run.
std::uint8_t garbled(std::uint8_t octet, Ticks at) {
    return static_cast<std::uint8_t>(Random{static_cast<std::uint64_t>(at.n) * 257u + octet}.next());
}

/// Spoils the characters of `t` that overlap [from, to).
void garble(Transmission& t, Ticks from, Ticks to) {
    make_damaged(t);
    for (std::size_t i = 0; i < t.length; ++i) {
        const fdl::Character c = t.character(i);
        if (c.end() <= from || c.start >= to) continue;
        t.octets[i] = garbled(t.octets[i], c.start);
        t.faults[i] = static_cast<std::uint8_t>(t.faults[i] | fdl::fault_collision);
    }
}

}  // namespace

// ---- launch ------------------------------------------------------------------------------------------------------

std::uint8_t Segment::allocate() {
    for (std::uint8_t f = 0; f < kMaxFlights; ++f) {
        if (flights_[f].used) continue;
        flights_[f].used = true;
        return f;
    }
    return kNoFlight;
}

void Segment::release(std::uint8_t f) {
    flights_[f].used = false;
    const auto end = order_.begin() + static_cast<std::ptrdiff_t>(flying_);
    const auto at = std::find(order_.begin(), end, f);
    if (at == end) return;
    std::copy(at + 1, end, at);
    --flying_;
}

/// A station has filled flight `f`: it begins now unless a fault has other plans.
void Segment::launch(std::uint8_t f, StationIndex sender) {
    Flight& flight = flights_[f];
    Transmission& t = flight.sent;
    t.start = now_;
    if (t.length == 0 || t.length > fdl::kMaxTelegram || t.bit <= Ticks{}) return release(f);
    flight.sender = sender;
    flight.begun = flight.seen = false;
    flight.event = now_;
    order_[flying_++] = f;
    ++counters_.transmissions;
    if (faults_) [[unlikely]] spoil(f);
    if (!flight.used) return;
    if (sender < taps_.size()) {
        taps_[sender].sends_from = t.start;
        taps_[sender].sends_to = t.end();
    }
    if (t.start == now_) {
        flight.event = core::kNever;
        launched_[launched_count_++] = f;
    } else {
        replan();
    }
}

/// Lets the fault source have its way with flight `f`.
void Segment::spoil(std::uint8_t f) {
    Transmission& t = flights_[f].sent;
    const Fault fault = faults_(t, flights_[f].sender, counters_.transmissions - 1);
    if (fault.kind == FaultKind::none) return;
    const std::size_t octet = fault.octet % t.length;
    const Ticks pause = t.bit * std::max<std::int64_t>(fault.bits, 1);
    switch (fault.kind) {
    case FaultKind::none: return;
    case FaultKind::flip:
        make_damaged(t);
        t.octets[octet] ^= fault.mask;
        if (fdl::even_parity(fault.mask)) t.faults[octet] ^= fdl::fault_parity;
        return;
    case FaultKind::parity: make_damaged(t); t.faults[octet] ^= fdl::fault_parity; return;
    case FaultKind::stop: make_damaged(t); t.faults[octet] |= fdl::fault_stop; return;
    case FaultKind::truncate:
        make_damaged(t);
        t.length = static_cast<std::uint16_t>(octet);
        if (octet == 0) release(f);
        return;
    case FaultKind::gap:
        if (octet != 0) return split(f, octet, pause);
        [[fallthrough]];
    case FaultKind::late:
        t.start += pause;
        flights_[f].event = t.start;
        return;
    case FaultKind::drop: return release(f);
    case FaultKind::noise: {
        std::array<std::uint8_t, 15> octets{};
        for (std::size_t i = 0; i < octets.size(); ++i) octets[i] = static_cast<std::uint8_t>(fault.mask + 37 * i);
        const std::size_t count = 1 + fault.octet % octets.size();
        disturb(t.end() + pause, t.bit, std::span{octets}.first(count));
        return;
    }
    }
}

/// Cuts flight `f` in two: what begins with `octet` comes later by `gap`.
void Segment::split(std::uint8_t f, std::size_t octet, Ticks gap) {
    const std::uint8_t second = allocate();
    if (second == kNoFlight) return;
    Transmission& head = flights_[f].sent;
    Flight& tail = flights_[second];
    make_damaged(head);
    tail.sent.bit = head.bit;
    tail.sent.start = head.character(octet).start + gap;
    tail.sent.damaged = true;
    tail.sent.synchronised = false;
    tail.sent.length = static_cast<std::uint16_t>(head.length - octet);
    std::copy_n(head.octets.begin() + static_cast<std::ptrdiff_t>(octet), tail.sent.length, tail.sent.octets.begin());
    std::copy_n(head.faults.begin() + static_cast<std::ptrdiff_t>(octet), tail.sent.length, tail.sent.faults.begin());
    head.length = static_cast<std::uint16_t>(octet);
    tail.sender = flights_[f].sender;
    tail.begun = tail.seen = false;
    tail.event = tail.sent.start;
    order_[flying_++] = second;
    replan();
}

bool Segment::disturb(Ticks at, Ticks bit, std::span<const std::uint8_t> octets,
                      std::span<const std::uint8_t> faults) {
    if (octets.empty() || octets.size() > fdl::kMaxTelegram || bit <= Ticks{} || at < now_) return false;
    const std::uint8_t f = allocate();
    if (f == kNoFlight) return false;
    Flight& flight = flights_[f];
    flight.sent.assign(at, bit, octets);
    make_damaged(flight.sent);
    std::copy_n(faults.begin(), std::min<std::size_t>(faults.size(), flight.sent.length), flight.sent.faults.begin());
    flight.sender = kNobody;
    flight.begun = flight.seen = false;
    flight.event = at;
    order_[flying_++] = f;
    replan();
    return true;
}

// ---- begin -------------------------------------------------------------------------------------------------------

/// Everything that was launched at this tick begins; only now, so that equal starts collide.
void Segment::begin_launched() {
    for (std::size_t n = 0; n < launched_count_; ++n) begin(launched_[n]);
    launched_count_ = 0;
    replan();
}

Ticks Segment::delay(StationIndex from, StationIndex to) const {
    if (!delayed_ || from >= taps_.size()) return {};
    const Ticks d = taps_[to].position - taps_[from].position;
    return d < Ticks{} ? Ticks{} - d : d;
}

void Segment::begin(std::uint8_t f) {
    Flight& flight = flights_[f];
    for (std::size_t n = 0; n < flying_; ++n) {
        Flight& other = flights_[order_[n]];
        if (&other != &flight && other.begun) collide(other, flight);
    }
    if (announced_ != 0) [[unlikely]]
        for (Tap& tap : taps_)
            if (tap.announced) collide_announced(tap, flight);
    flight.begun = true;
    for (const ObserverRef& o : observers_) o.see_begin({flight.sent, flight.sender});
    StationSet carrier = heard_last_;
    add_audience(carrier, flight.sent);
    heard_last_ = {};
    if (flight.sender < taps_.size()) carrier.remove(flight.sender);
    if (delayed_) flight.carrier = carrier;
    if (flight.sent.damaged || delayed_) flight.told.fill(delayed_ ? 0 : 1);
    if (!delayed_) carrier.each([&](StationIndex i) { hear_carrier(i); });
    plan(flight);
}

/// Two transmissions that overlap anywhere on the cable spoil each other.
void Segment::collide(Flight& a, Flight& b) {
    Ticks far{};
    if (b.sender < taps_.size()) far = delay(a.sender, b.sender);
    const Ticks from = b.sent.start, to = std::min(a.sent.end() + far, b.sent.end());
    if (from >= to) return;
    ++counters_.collisions;
    const bool direct_before = direct(a);
    garble(a.sent, from - far, to);
    garble(b.sent, from, to);
    if (direct_before) a.told.fill(1);  // carrier was given, no character was
    plan(a);
}

/// What `tap` sends without anybody knowing what, and `f` spoil each other from now on.
void Segment::collide_announced(Tap& tap, Flight& f) {
    if (f.sent.end() <= now_) return;
    ++counters_.collisions;
    tap.hit_from = std::min(tap.hit_from, now_);
    tap.hit_to = std::max(tap.hit_to, f.sent.end());
    const bool direct_before = direct(f);
    garble(f.sent, now_, f.sent.end());
    if (direct_before) f.told.fill(1);
    plan(f);
}

// ---- delivery ----------------------------------------------------------------------------------------------------

bool Segment::busy() const {
    if (announced_ != 0) return true;
    for (std::size_t n = 0; n < flying_; ++n)
        if (flights_[order_[n]].begun) return true;
    return false;
}

void Segment::replan() {
    wire_next_ = core::kNever;
    for (std::size_t n = 0; n < flying_; ++n) wire_next_ = std::min(wire_next_, flights_[order_[n]].event);
}

void Segment::show(Flight& f) {
    f.seen = true;
    for (const ObserverRef& o : observers_) o.see({f.sent, f.sender});
}

/// The flights that need attention now, in the order they were launched.
void Segment::wire_due() {
    std::array<std::uint8_t, kMaxFlights> due;
    std::size_t count = 0;
    for (std::size_t n = 0; n < flying_; ++n)
        if (flights_[order_[n]].event <= now_) due[count++] = order_[n];
    for (std::size_t n = 0; n < count; ++n)
        if (flights_[due[n]].begun) direct(flights_[due[n]]) ? deliver_directly(due[n]) : deliver_stepwise(due[n]);
    for (std::size_t n = 0; n < count; ++n) {
        Flight& f = flights_[due[n]];
        if (!f.used || f.begun || f.event > now_) continue;
        f.event = core::kNever;
        launched_[launched_count_++] = due[n];
    }
    replan();
}

/// The whole telegram to those it concerns: the hot path.
void Segment::deliver_directly(std::uint8_t f) {
    Flight& flight = flights_[f];
    show(flight);
    StationSet all;
    add_audience(all, flight.sent);
    if (flight.sender < taps_.size()) all.remove(flight.sender);
    all.each([&](StationIndex i) { hear_whole(i, flight.sent, {}); });
    heard_last_ = all;
    release(f);
}

void Segment::hear_carrier(StationIndex i) {
    if (!taps_[i].on) return;
    catch_up(i);
    taps_[i].station.carrier(local_time(taps_[i], now_));
    refresh(i);
}

/// Station `i` hears `t`, which ended `late` ago where it was sent.
void Segment::hear_whole(StationIndex i, const Transmission& t, Ticks late) {
    const Tap& tap = taps_[i];
    catch_up(i);
    if (tap.plain && late == Ticks{}) {
        tap.station.hear(t);
    } else {
        Transmission there = t;
        there.start = local_time(tap, t.end() + late) - t.bit * (fdl::kCharacterBits * t.length);
        tap.station.hear(there);
    }
    refresh(i);
}

void Segment::hear_one(StationIndex i, const fdl::Character& c) {
    Tap& tap = taps_[i];
    if (c.start < tap.heard_to) return;  // swallowed by the garbled character before it
    if (c.end() > tap.sends_from && c.start < tap.sends_to) return;
    tap.heard_to = c.end();
    catch_up(i);
    fdl::Character there = c;
    if (!tap.plain) there.start = local_time(tap, c.end()) - c.bit * fdl::kCharacterBits;
    tap.station.hear_character(there);
    heard_last_.add(i);
    refresh(i);
}

/// When station `i` is to be told the next thing about `f`; kNever when it knows all.
Ticks Segment::due(const Flight& f, StationIndex i) const {
    const std::size_t told = f.told[i];
    if (i == f.sender) return core::kNever;
    if (told == 0) return f.sent.start + delay(f.sender, i);
    if (told > f.sent.length) return core::kNever;
    const Ticks end = f.sent.damaged ? f.sent.character(told - 1u).end() : f.sent.end();
    return end + delay(f.sender, i);
}

/// Works out when a flight needs attention next.
void Segment::plan(Flight& f) {
    f.event = f.seen ? core::kNever : f.sent.end();
    if (direct(f)) return;
    on_.each([&](StationIndex i) { f.event = std::min(f.event, due(f, i)); });
    f.event = std::max(f.event, now_);
}

/// One station after the other, one thing after the other: damage, or a cable with length.
void Segment::deliver_stepwise(std::uint8_t f) {
    Flight& flight = flights_[f];
    if (!flight.seen && flight.sent.end() <= now_) show(flight);
    const StationSet all = on_;
    all.each([&](StationIndex i) {
        while (due(flight, i) <= now_) deliver_step(flight, i);
    });
    plan(flight);
    if (flight.event == core::kNever) release(f);
}

void Segment::deliver_step(Flight& f, StationIndex i) {
    const std::uint16_t told = f.told[i]++;
    if (told == 0) {
        if (f.carrier.has(i)) hear_carrier(i);
        return;
    }
    const Ticks late = delay(f.sender, i);
    if (f.sent.damaged) {
        fdl::Character c = f.sent.character(told - 1u);
        c.start += late;
        return hear_one(i, c);
    }
    f.told[i] = static_cast<std::uint16_t>(f.sent.length + 1);
    if (!concerns(i, f.sent)) return;
    heard_last_.add(i);
    hear_whole(i, f.sent, late);
}

void Segment::finish(StationIndex sender) {
    if (!attached(sender)) return;
    Tap& tap = taps_[sender];
    for (std::size_t n = 0; n < flying_; ++n) {
        Flight& f = flights_[order_[n]];
        if (!f.begun || f.sender != sender || f.sent.end() <= now_) continue;
        f.sent.start = now_ - (f.sent.end() - f.sent.start);
        tap.sends_to = now_;
        tap.station.sent(local_time(tap, now_));
        plan(f);
    }
    refresh(sender);
    replan();
    advance(now_);
}

void Segment::announce(StationIndex sender) {
    if (!attached(sender) || taps_[sender].announced) return;
    Tap& mine = taps_[sender];
    for (std::size_t n = 0; n < flying_; ++n)
        if (Flight& f = flights_[order_[n]]; f.begun) collide_announced(mine, f);
    for (Tap& other : taps_) {
        if (!other.announced) continue;
        ++counters_.collisions;
        for (Tap* tap : {&mine, &other}) {
            tap->hit_from = std::min(tap->hit_from, now_);
            tap->hit_to = core::kNever;
        }
    }
    mine.announced = true;
    ++announced_;
    mine.sends_from = now_;
    mine.sends_to = core::kNever;
    StationSet carrier = heard_last_;
    carrier |= ears_;
    carrier.remove(sender);
    heard_last_ = {};
    carrier.each([&](StationIndex i) { hear_carrier(i); });
    replan();
    advance(now_);
}

void Segment::inject(StationIndex sender, const Transmission& t) {
    if (sender >= taps_.size() || !taps_[sender].announced) return hear_injected(sender, t);
    Tap& tap = taps_[sender];
    Transmission heard = t;
    if (tap.hit_from < tap.hit_to) garble(heard, tap.hit_from, tap.hit_to);
    tap.announced = false;
    --announced_;
    tap.sends_from = t.start;
    tap.sends_to = t.end();
    tap.hit_from = core::kNever;
    tap.hit_to = {};
    hear_injected(sender, heard);
}

void Segment::hear_injected(StationIndex sender, const Transmission& t) {
    DPCHIP_ASSERT(t.end() <= now_);
    ++counters_.transmissions;
    const Sighting sighting{t, sender};
    for (const ObserverRef& o : observers_) o.see_begin(sighting);
    StationSet carrier = heard_last_;
    add_audience(carrier, t);
    if (sender < taps_.size()) carrier.remove(sender);
    carrier.each([&](StationIndex i) { hear_carrier(i); });
    for (const ObserverRef& o : observers_) o.see(sighting);
    StationSet all;
    add_audience(all, t);  // again: somebody may have pricked up its ears
    if (sender < taps_.size()) all.remove(sender);
    heard_last_ = all;
    if (t.damaged)
        for (std::size_t n = 0; n < t.length; ++n) all.each([&](StationIndex i) { hear_one(i, t.character(n)); });
    else
        all.each([&](StationIndex i) { hear_whole(i, t, now_ - t.end()); });
    advance(now_);
}

}  // namespace dpchip::segment
