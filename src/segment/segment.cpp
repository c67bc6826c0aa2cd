// SPDX-License-Identifier: Apache-2.0
// The segment's stations and its clock. What happens to a transmission is in line.cpp.
#include <dpchip/segment/segment.hpp>

#include <algorithm>

#include <dpchip/core/assert.hpp>
#include <dpchip/fdl/telegram.hpp>

namespace dpchip::segment {

const char* name(AttachError error) {
    switch (error) {
    case AttachError::full: return "no room for another station";
    case AttachError::already_attached: return "the station is already on this line";
    case AttachError::address_taken: return "another station on this line has the same address";
    }
    return "unknown";
}

Segment::Segment() {
    at_.fill(kNobody);
    taps_.reserve(kMaxStations);
    names_.reserve(kMaxStations);
    flights_.resize(kMaxFlights);
}

// ---- stations ----------------------------------------------------------------------------------------------------

core::Result<StationIndex, AttachError> Segment::attach(StationRef station, std::string_view name,
                                                        const TapOptions& options) {
    std::size_t place = taps_.size();
    for (std::size_t i = 0; i < taps_.size(); ++i) {
        if (!taps_[i].on) place = std::min(place, i);
        else if (taps_[i].station.object() == station.object()) return AttachError::already_attached;
    }
    if (place == kMaxStations) return AttachError::full;
    if (find(station.address()) != kNobody) return AttachError::address_taken;
    if (place == taps_.size()) {
        taps_.emplace_back();
        names_.emplace_back();
        schedule_.reserve(taps_.size());
    }
    const auto i = static_cast<StationIndex>(place);
    Tap& tap = taps_[i];
    tap = Tap{};
    tap.station = station;
    tap.on = true;
    tap.plain = options.crystal_ppb == 0;
    tap.clock = core::Clock{options.crystal_ppb};
    tap.position = options.position;
    names_[i] = name.empty() ? "station " + std::to_string(place) : std::string{name};
    delayed_ = std::ranges::any_of(taps_, [](const Tap& t) { return t.on && t.position != Ticks{}; });
    on_.add(i);
    station.advance(local_time(tap, now_));
    refresh(i);
    return i;
}

void Segment::detach(StationIndex i) {
    if (!attached(i)) return;
    readdress(i, kNoAddress);
    on_.remove(i);
    ears_.remove(i);
    heard_last_.remove(i);
    if (taps_[i].announced) --announced_;
    taps_[i] = Tap{};
    schedule_.remove(i);
    for (Flight& f : flights_)
        if (f.used && f.sender == i) f.sender = kNobody;
    delayed_ = std::ranges::any_of(taps_, [](const Tap& t) { return t.on && t.position != Ticks{}; });
    replan();
}

void Segment::touch(StationIndex i) {
    if (!attached(i)) return;
    wake(i);
    refresh(i);
    advance(now_);
}

void Segment::settle() {
    on_.each([&](StationIndex i) { taps_[i].station.advance(local_time(taps_[i], now_)); });
}

StationIndex Segment::find(std::uint8_t address) const {
    if (address >= fdl::kBroadcast) return kNobody;
    if (at_[address] != kSeveral) return at_[address];
    for (std::size_t i = 0; i < taps_.size(); ++i)
        if (taps_[i].on && taps_[i].address == address) return static_cast<StationIndex>(i);
    return kNobody;
}

std::size_t Segment::count(std::uint8_t address) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(taps_, [&](const Tap& t) { return t.on && t.address == address; }));
}

void Segment::unobserve(const void* observer) {
    std::erase_if(observers_, [&](const ObserverRef& o) { return o.object() == observer; });
}

void Segment::readdress(StationIndex i, std::uint8_t address) {
    const std::uint8_t before = taps_[i].address;
    taps_[i].address = address;
    recount(before);
    recount(address);
}

void Segment::recount(std::uint8_t address) {
    if (address >= fdl::kBroadcast) return;
    at_[address] = kNobody;
    for (std::size_t i = 0; i < taps_.size(); ++i) {
        if (!taps_[i].on || taps_[i].address != address) continue;
        at_[address] = at_[address] == kNobody ? static_cast<StationIndex>(i) : kSeveral;
    }
}

/// Notes what station `i` wants after anything that may have changed its mind.
void Segment::refresh(StationIndex i) {
    const Tap& tap = taps_[i];
    const std::uint8_t address = tap.station.address();
    if (address != tap.address) [[unlikely]] readdress(i, address);
    const bool ears = tap.station.hears_all();
    if (ears != ears_.has(i)) [[unlikely]] ears_.set(i, ears);
    schedule_.update(i, station_next(i));
}

/// Moves station `i` to now() and takes what it begins to send.
void Segment::wake(StationIndex i) {
    Tap& tap = taps_[i];
    tap.station.advance(local_time(tap, now_));
    const std::uint8_t f = allocate();
    if (f == kNoFlight) [[unlikely]] {
        fdl::Transmission lost;
        if (tap.station.take(lost)) ++counters_.overrun;
        return;
    }
    if (tap.station.take(flights_[f].sent)) launch(f, i);
    else release(f);
}

/// Moves a station that is about to hear something to now(); what is due by then comes first.
void Segment::catch_up(StationIndex i) {
    if (schedule_.due_by(i, now_)) [[unlikely]] wake(i);
    else taps_[i].station.advance(local_time(taps_[i], now_));
}

bool Segment::concerns(StationIndex i, const fdl::Transmission& t) const {
    StationSet all;
    add_audience(all, t);
    return all.has(i);
}

/// Adds to `all` who hears `t`, its sender included. The single station comes last: whole sets are copied and joined
/// in wide steps, and a wide load right behind a narrow store waits for it.
void Segment::add_audience(StationSet& all, const fdl::Transmission& t) const {
    std::uint8_t address = kNoAddress;
    switch (t.octets[0]) {
    case fdl::kSd1:
    case fdl::kSd3: address = t.octets[1] & 0x7Fu; break;
    case fdl::kSd2: address = t.octets[4] & 0x7Fu; break;
    default: break;
    }
    if (t.damaged || address == fdl::kBroadcast) {
        all |= on_;
        return;
    }
    all |= ears_;
    if (address == kNoAddress) return;
    const StationIndex i = at_[address];
    if (i < kMaxStations) all.add(i);
    else if (i == kSeveral)
        for (std::size_t k = 0; k < taps_.size(); ++k)
            if (taps_[k].on && taps_[k].address == address) all.add(static_cast<StationIndex>(k));
}

// ---- time --------------------------------------------------------------------------------------------------------

Ticks Segment::next() {
    for (;;) {
        if (launched_count_ != 0) return now_;
        const Schedule::Due top = schedule_.top();
        if (wire_next_ <= top.at) return std::max(wire_next_, now_);
        const Ticks at = station_next(top.station);
        if (at <= top.at) return std::max(top.at, now_);
        schedule_.settle(top.station, at);
    }
}

void Segment::advance(Ticks to) {
    for (;;) {
        const Schedule::Due top = schedule_.top();
        if (launched_count_ != 0 && wire_next_ > now_ && top.at > now_) {
            begin_launched();
            continue;
        }
        if (wire_next_ <= top.at) {
            if (wire_next_ > to || wire_next_ == core::kNever) break;
            now_ = std::max(now_, wire_next_);
            wire_due();
            continue;
        }
        if (top.at > to) break;
        const Ticks at = station_next(top.station);
        if (at > top.at) {
            schedule_.settle(top.station, at);
            continue;
        }
        now_ = std::max(now_, top.at);
        stations_due(top.station);
    }
    if (to > now_ && to != core::kNever) now_ = to;
}

/// All stations that are due now, by index; `first` is known to be.
void Segment::stations_due(StationIndex first) {
    for (StationIndex i = first;;) {
        wake(i);
        refresh(i);
        const Ticks next = station_next(i);
        DPCHIP_ASSERT(next > now_);  // "everything due up to and including t"
        if (next <= now_) schedule_.defer(i, now_ + Ticks{1});
        for (;;) {
            const Schedule::Due top = schedule_.top();
            if (top.at > now_) return;
            const Ticks at = station_next(top.station);
            i = top.station;
            if (at <= top.at) break;
            schedule_.settle(top.station, at);
        }
    }
}

}  // namespace dpchip::segment
