// SPDX-License-Identifier: Apache-2.0
// Stations on a line whose bits are elsewhere: what they send is known when it has ended.
#include <algorithm>

#include <dpchip/fdl/telegram.hpp>

#include "error.hpp"
#include "line.hpp"

namespace dpchip::capi {

int Line::join(fdl::BaudCode rate) {
    if (!is_virtual()) return fail(DPCHIP_E_STATE, "only a sim: line is joined; on this line the wire is the port");
    Joined& station = joined_.emplace_back();
    const auto index = segment().attach(station, "joined");
    if (!index) {
        joined_.pop_back();
        return fail(DPCHIP_E_STATE, segment::name(index.error()));
    }
    station.index = *index;
    station.bit = fdl::baud(rate).bit;
    return station.index;
}

Line::Joined* Line::joined(int station) {
    const auto at = std::ranges::find_if(joined_, [&](const Joined& j) { return j.index == station; });
    if (at != joined_.end()) return &*at;
    fail(DPCHIP_E_ARGUMENT, "no station with this number has joined the line");
    return nullptr;
}

int Line::joined_begins(int station) {
    Joined* j = joined(station);
    if (j == nullptr) return DPCHIP_E_ARGUMENT;
    if (j->sending) return fail(DPCHIP_E_STATE, "the station is sending already");
    j->sending = true;
    j->since = now();
    segment().announce(j->index);
    segment().settle();
    return DPCHIP_OK;
}

int Line::joined_sent(int station, std::span<const std::uint8_t> octets, const std::uint8_t* faults, Ticks start) {
    Joined* j = joined(station);
    if (j == nullptr) return DPCHIP_E_ARGUMENT;
    if (!j->sending) return fail(DPCHIP_E_STATE, "the station has not begun to send");
    fdl::Transmission t;
    t.assign(start, j->bit, octets);
    if (start < Ticks{} || start > now() || t.end() > now()) return fail(DPCHIP_E_ARGUMENT, "it cannot have ended by now");
    const auto telegram = fdl::decode(octets);
    t.faults.fill(fdl::fault_none);
    if (faults != nullptr) std::copy_n(faults, octets.size(), t.faults.begin());
    const bool faulty = std::any_of(t.faults.begin(), t.faults.begin() + t.length, [](std::uint8_t f) { return f != fdl::fault_none; });
    t.damaged = faulty || !telegram || telegram->size != octets.size();
    j->sending = false;
    segment().inject(j->index, t);
    segment().settle();
    return DPCHIP_OK;
}

}  // namespace dpchip::capi
