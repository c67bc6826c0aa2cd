// SPDX-License-Identifier: Apache-2.0
// Who is due next: the earliest of up to 256 stations, ties to the lower index.
//
// A tournament tree holds for every station a tick that is never later than its true one; a station that moved its
// deadline away (a watchdog, again) costs nothing until the old tick comes up. The few stations that are due soon, the
// one that answers and the one that waits for the answer, stand beside the tree and never touch it.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <dpchip/core/assert.hpp>
#include <dpchip/core/ticks.hpp>
#include <dpchip/segment/station_set.hpp>

namespace dpchip::segment {

using core::Ticks;

class Schedule {
public:
    struct Due {
        Ticks at = core::kNever;
        StationIndex station = kNobody;
        constexpr bool before(const Due& o) const { return at < o.at || (at == o.at && station < o.station); }
    };

    Schedule() { keys_.fill(core::kNever); resize(2); }

    /// The station to look at next. Its true tick may be later than `at`: ask it, then call settle().
    Due top() const {
        Due first{keys_[winners_[1]], winners_[1]};
        for (std::size_t i = 0; i < near_count_; ++i)
            if (near_[i].before(first)) first = near_[i];
        return first;
    }

    /// Station `i` may want to be called at `at` now. Cheap when `at` is later than what is known.
    void update(StationIndex i, Ticks at) {
        for (std::size_t n = 0; n < near_count_; ++n) {
            if (near_[n].station != i) continue;
            if (at < keys_[i]) near_[n].at = at;
            else near_[n] = near_[--near_count_];
            return;
        }
        if (at >= keys_[i]) return;
        if (near_count_ < kNear) near_[near_count_++] = {at, i};
        else replay(i, at);
    }

    /// Station `i`, which was top(), wants to be called at `at` and no earlier.
    void settle(StationIndex i, Ticks at) {
        for (std::size_t n = 0; n < near_count_; ++n)
            if (near_[n].station == i) return update(i, at);
        replay(i, at);
    }

    /// Something may be due for station `i` at or before `at`.
    bool due_by(StationIndex i, Ticks at) const {
        if (keys_[i] <= at) return true;
        for (std::size_t n = 0; n < near_count_; ++n)
            if (near_[n].station == i) return near_[n].at <= at;
        return false;
    }
    /// Station `i` is not called before `at`, whatever it says.
    void defer(StationIndex i, Ticks at) {
        update(i, core::kNever);
        replay(i, at);
    }

    /// Makes room for stations 0 .. count-1.
    void reserve(std::size_t count) {
        DPCHIP_ASSERT(count <= kMaxStations);
        if (count > leaves_) resize(std::bit_ceil(count));
    }
    void remove(StationIndex i) {
        update(i, core::kNever);
        replay(i, core::kNever);
    }

private:
    static constexpr std::size_t kNear = 4;

    void resize(std::size_t leaves) {
        leaves_ = leaves;
        for (std::size_t i = 0; i < leaves; ++i) winners_[leaves + i] = static_cast<std::uint8_t>(i);
        for (std::size_t node = leaves - 1; node >= 1; --node) decide(node);
    }
    void replay(StationIndex i, Ticks at) {
        keys_[i] = at;
        for (std::size_t node = (leaves_ + i) / 2; node >= 1; node /= 2) decide(node);
    }
    void decide(std::size_t node) {
        const std::uint8_t left = winners_[2 * node], right = winners_[2 * node + 1];
        winners_[node] = keys_[right] < keys_[left] ? right : left;
    }

    std::array<Ticks, kMaxStations> keys_;
    std::array<std::uint8_t, 2 * kMaxStations> winners_{};  // [1]: the first of all; [leaves_ ..]: the stations
    std::array<Due, kNear> near_{};
    std::size_t near_count_ = 0;
    std::size_t leaves_ = 0;
};

}  // namespace dpchip::segment
