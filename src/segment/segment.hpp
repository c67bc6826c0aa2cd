// SPDX-License-Identifier: Apache-2.0
// An RS-485 line in virtual time: stations, their telegrams, collisions, propagation delay, crystals and faults.
//
// Order: by tick; within one tick the line first (what ends is heard), then stations that are due, by index, then
// what they begin to send. Nothing depends on how far advance() is asked to go at a time.
//
// An undamaged telegram reaches the station it addresses (all of them for 127) and those that hear everything, in one
// call each. Anything damaged is heard by everybody, character by character. Nobody hears itself. Those who will hear
// it, and those who heard the telegram before it and may be about to answer, are told when it begins.
// When a collision spoils a telegram after it has begun, its earlier characters are handed over at that moment, with
// their own times.
//
// Not modelled: signal levels, reflections, bit distortion by repeaters. A crystal's error acts between telegrams, not
// within one: 255 characters at 100 ppm would be off by a quarter of a bit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <dpchip/core/clock.hpp>
#include <dpchip/core/result.hpp>
#include <dpchip/core/ticks.hpp>
#include <dpchip/fdl/transmission.hpp>
#include <dpchip/segment/fault.hpp>
#include <dpchip/segment/observer.hpp>
#include <dpchip/segment/schedule.hpp>
#include <dpchip/segment/station.hpp>
#include <dpchip/segment/station_set.hpp>

namespace dpchip::segment {

/// Why a station cannot be attached.
enum class AttachError : std::uint8_t {
    full,              ///< kMaxStations are attached
    already_attached,  ///< this very object is on the line
    address_taken,     ///< another station answers to its address
};
const char* name(AttachError error);

/// How a station hangs on the line.
struct TapOptions {
    std::int32_t crystal_ppb = 0;  ///< its crystal runs so many parts per billion fast; -1'000'000 .. 1'000'000
    Ticks position{};              ///< its place along the cable, as signal time from one end (about 5 ns a metre)
};

struct SegmentCounters {
    std::uint64_t transmissions = 0;  ///< begun or lost by a fault
    std::uint64_t collisions = 0;     ///< pairs of overlapping transmissions
    std::uint64_t overrun = 0;        ///< not carried because too many overlapped
};

class Segment {
public:
    Segment();

    // ---- stations (setting up; may allocate) --------------------------------------------------------------------
    /// Puts a station on the line from now() on. It must outlive its attachment and stay where it is in memory.
    core::Result<StationIndex, AttachError> attach(StationRef station, std::string_view name = {},
                                                   const TapOptions& options = {});
    template <Station S>
    core::Result<StationIndex, AttachError> attach(S& station, std::string_view name = {},
                                                   const TapOptions& options = {}) {
        return attach(StationRef{station}, name, options);
    }
    /// Takes a station off. What it is sending stays on the line. Its index is given to the next station attached.
    void detach(StationIndex i);
    /// Somebody poked the station from outside (a processor access): what it wants may have changed.
    void touch(StationIndex i);
    /// Brings every station's own time up to now(); for reading them. Changes nothing else.
    void settle();

    std::size_t size() const { return taps_.size(); }
    bool attached(StationIndex i) const { return i < taps_.size() && taps_[i].on; }
    const std::string& name(StationIndex i) const { return names_[i]; }
    /// The station that answers to `address` (0..126), or kNobody; the lowest index when there are several.
    StationIndex find(std::uint8_t address) const;
    /// How many stations answer to `address` now; more than one is a wiring error that the line carries out faithfully.
    std::size_t count(std::uint8_t address) const;

    /// Adds an observer; it must outlive the segment or be removed.
    template <Observer O>
    void observe(O& observer) { observers_.emplace_back(observer); }
    void unobserve(const void* observer);
    /// What goes wrong from now on; FaultRef{} for nothing.
    void set_faults(FaultRef faults) { faults_ = faults; }

    // ---- time ---------------------------------------------------------------------------------------------------
    Ticks now() const { return now_; }
    /// The next tick at which something happens; kNever on a dead line.
    Ticks next();
    /// Does everything due up to and including `to`, and stands there.
    void advance(Ticks to);
    /// advance() by a duration.
    void run(Ticks duration) { advance(now_ + duration); }
    /// Runs until `done()` is true after some tick, at most for `limit`. Returns done().
    template <class Done>
    bool run_until(Done&& done, Ticks limit) {
        const Ticks end = now_ + limit;
        while (!done()) {
            const Ticks at = next();
            if (at > end) {
                advance(end);
                return done();
            }
            advance(at);
        }
        return true;
    }

    // ---- the line itself ----------------------------------------------------------------------------------------
    /// Characters nobody sent, from `at` (not before now()) on; faults may be empty. False when too much is going on.
    bool disturb(Ticks at, Ticks bit, std::span<const std::uint8_t> octets, std::span<const std::uint8_t> faults = {});
    /// Something station `sender` is known to have sent before now(): heard at once. For lines whose wire is elsewhere.
    /// A `t` that is not exactly one good telegram must be damaged, with its faults filled. Ends what announce() began.
    void inject(StationIndex sender, const fdl::Transmission& t);
    /// Station `sender` begins to send now what is known only when it ends, for lines whose wire is elsewhere; inject() must
    /// follow. Those who hear everything and those who may be about to answer are told. Whatever else is on the line until
    /// then collides with it: that is spoilt from then on, since nobody knows how long this goes on, and this as long as
    /// that lasted.
    void announce(StationIndex sender);
    /// What `sender` is sending has left the line now, before its bit times are over: heard at once, and `sender` is told
    /// by sent(). For lines whose wire is elsewhere and faster. Nothing happens when it sends nothing.
    void finish(StationIndex sender);
    /// True while something is on the line.
    bool busy() const;
    const SegmentCounters& counters() const { return counters_; }

private:
    struct Tap {
        StationRef station;
        bool on = false;
        bool plain = true;  ///< no crystal error
        std::uint8_t address = kNoAddress;
        Ticks position{};
        Ticks sends_from = core::kNever, sends_to{};  ///< its last transmission, as it was on the line
        Ticks heard_to{};                             ///< end of the last single character it heard
        bool announced = false;                       ///< it sends what is not known yet
        Ticks hit_from = core::kNever, hit_to{};      ///< while it did, others sent
        core::Clock clock{};
    };
    /// A transmission under way.
    struct Flight {
        fdl::Transmission sent;
        StationIndex sender = kNobody;
        bool used = false;
        bool begun = false;
        bool seen = false;   ///< by the observers
        Ticks event{};       ///< when it needs attention next
        StationSet carrier;  ///< who is told that it begins
        std::array<std::uint16_t, kMaxStations> told;  ///< per station: 0 carrier due, n+1: n characters heard
    };
    static constexpr std::size_t kMaxFlights = 8;
    static constexpr std::uint8_t kNoFlight = kMaxFlights;
    static constexpr StationIndex kSeveral = 0xFFFE;

    // stations
    Ticks line_time(const Tap& tap, Ticks local) const { return tap.plain ? local : tap.clock.line(local); }
    Ticks local_time(const Tap& tap, Ticks line) const { return tap.plain ? line : tap.clock.local(line); }
    Ticks station_next(StationIndex i) const { return line_time(taps_[i], taps_[i].station.next()); }
    void readdress(StationIndex i, std::uint8_t address);
    void recount(std::uint8_t address);
    void refresh(StationIndex i);
    void wake(StationIndex i);
    void catch_up(StationIndex i);
    void stations_due(StationIndex first);
    bool concerns(StationIndex i, const fdl::Transmission& t) const;
    void add_audience(StationSet& all, const fdl::Transmission& t) const;

    // transmissions
    std::uint8_t allocate();
    void release(std::uint8_t f);
    void launch(std::uint8_t f, StationIndex sender);
    void spoil(std::uint8_t f);
    void split(std::uint8_t f, std::size_t octet, Ticks gap);
    void begin_launched();
    void begin(std::uint8_t f);
    void collide(Flight& a, Flight& b);
    void collide_announced(Tap& tap, Flight& f);
    void hear_injected(StationIndex sender, const fdl::Transmission& t);
    Ticks delay(StationIndex from, StationIndex to) const;
    bool direct(const Flight& f) const { return !f.sent.damaged && !delayed_; }

    // delivery
    void wire_due();
    void replan();
    void plan(Flight& f);
    void show(Flight& f);
    void hear_carrier(StationIndex i);
    void hear_whole(StationIndex i, const fdl::Transmission& t, Ticks late);
    void hear_one(StationIndex i, const fdl::Character& c);
    Ticks due(const Flight& f, StationIndex i) const;
    void deliver_directly(std::uint8_t f);
    void deliver_stepwise(std::uint8_t f);
    void deliver_step(Flight& f, StationIndex i);

    Ticks now_{};
    Ticks wire_next_ = core::kNever;
    Schedule schedule_;
    StationSet on_, ears_, heard_last_;
    std::array<StationIndex, 128> at_;  ///< station by address; kNobody, or kSeveral
    std::vector<Tap> taps_;
    bool delayed_ = false;              ///< some tap has a position
    std::size_t announced_ = 0;         ///< taps that send what is not known yet

    std::array<std::uint8_t, kMaxFlights> order_{};  ///< flights under way, in the order they were launched
    std::size_t flying_ = 0;
    std::array<std::uint8_t, kMaxFlights> launched_{};
    std::size_t launched_count_ = 0;
    std::vector<Flight> flights_;

    std::vector<ObserverRef> observers_;
    FaultRef faults_;
    SegmentCounters counters_;
    std::vector<std::string> names_;
};

}  // namespace dpchip::segment
