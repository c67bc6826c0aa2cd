// SPDX-License-Identifier: Apache-2.0
// A line of levels in virtual time: stations that drive and read it edge by edge, with distance, distortion and noise.
//
// Who drives nothing leaves the line to its termination, which holds it high; where two drive against each other the low
// level wins. So a line is low where and while any station is heard to be low. Order within one tick: stations by index
// do what is due, edges arrive, stations sample.
//
// Not modelled: voltages and reflections. On a real line nobody knows who wins a collision; here it is the low level.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <dpchip/core/assert.hpp>
#include <dpchip/core/fixed_queue.hpp>
#include <dpchip/pins/bit_station.hpp>

namespace dpchip::pins {

/// What the way from every driver to every receiver does to bits.
struct Distortion {
    Ticks bit{};                    ///< the percentages are of this bit time
    std::int32_t low_longer = 0;    ///< percent by which low levels are longer (rising edges late), -99 .. 99
    std::int32_t jitter = 0;        ///< percent by which every edge may be later, at random, 0 .. 99
    std::uint64_t seed = 1;
};

/// A level that everybody sees, whatever the stations drive.
struct Spike {
    Ticks at{}, length{};
    PinLevel level = PinLevel::low;
};

class BitLine {
public:
    static constexpr std::size_t kStations = 16;
    using Index = std::size_t;
    static constexpr Index kNobody = kStations;

    /// Puts a station on the line; it stays the caller's and must stay where it is. `position`: as signal time from one
    /// end (about 5 ns a metre). kNobody when 16 hang on it.
    template <BitStation S>
    Index attach(S& station, Ticks position = {}) {
        return add(StationRef{&station, &kTable<S>}, position);
    }
    void set_distortion(const Distortion& distortion) { distortion_ = distortion; random_ = distortion.seed; }
    /// Adds a spike; in order of time, not overlapping, at most 64 ahead. False when it cannot be.
    bool disturb(const Spike& spike);

    Ticks now() const { return now_; }
    Ticks next() const;
    /// Does everything due up to and including `to`.
    void advance(Ticks to);

    /// The level that station `i` receives now.
    PinLevel level(Index i) const { return taps_[i].level; }
    std::size_t size() const { return count_; }
    /// Edges lost because more than 256 of one sender were under way.
    std::uint64_t overruns() const { return overruns_; }
    /// Times at which two or more drove the line low at once.
    std::uint64_t collisions() const { return collisions_; }

private:
    struct Table {
        Ticks (*next)(const void*);
        void (*run)(void*, Ticks);
        void (*sample)(void*);
        void (*set_rxd)(void*, Ticks, PinLevel);
        PinLevel (*txd)(const void*);
    };
    template <class S>
    static constexpr Table kTable{
        [](const void* o) { return static_cast<const S*>(o)->next(); },
        [](void* o, Ticks t) { static_cast<S*>(o)->run(t); },
        [](void* o) { static_cast<S*>(o)->sample(); },
        [](void* o, Ticks t, PinLevel l) { static_cast<S*>(o)->set_rxd(t, l); },
        [](const void* o) { return static_cast<const S*>(o)->txd(); },
    };
    struct StationRef {
        void* object = nullptr;
        const Table* table = nullptr;
    };
    /// An edge as it leaves its sender, distortion included.
    struct Way {
        Ticks at{};
        bool low = false;
    };
    static constexpr std::size_t kWays = 256;
    struct Tap {
        StationRef station;
        Ticks position{};
        bool drives_low = false;
        std::array<Way, kWays> ways{};
        std::uint64_t sent = 0;                        ///< edges put into ways
        std::array<std::uint64_t, kStations> seen{};   ///< per sender: edges of it that have arrived here
        std::uint32_t lows = 0;                        ///< senders that are low as seen from here
        PinLevel level = PinLevel::high;
    };

    Index add(StationRef station, Ticks position);
    Ticks delay(Index from, Index to) const;
    Ticks distorted(Ticks at, bool low);
    void look(Index i);
    void arrive(Index i);
    void update(Index i);
    Ticks next_arrival(Index i) const;
    PinLevel noise() const;
    Ticks next_noise() const;
    void noise_due();

    Ticks now_{};
    std::array<Tap, kStations> taps_{};
    std::size_t count_ = 0;
    Distortion distortion_{};
    std::uint64_t random_ = 1;
    core::FixedQueue<Spike, 64> spikes_;
    Ticks last_spike_end_{};
    Spike spike_{};          ///< the one that begins next, or lasts
    bool spiking_ = false;   ///< it lasts
    bool spike_waits_ = false;
    std::uint64_t overruns_ = 0, collisions_ = 0;
};

}  // namespace dpchip::pins
