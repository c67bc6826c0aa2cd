// SPDX-License-Identifier: Apache-2.0
// A port: a station without a mind of its own. It sends what it is given, at the earliest moment the bus rules allow or
// at a given tick, and keeps what the others say. For tests that play the master, the C API and live lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/core/fixed_queue.hpp>
#include <dpchip/fdl/baud.hpp>
#include <dpchip/fdl/bus_times.hpp>
#include <dpchip/fdl/telegram.hpp>
#include <dpchip/segment/station.hpp>

namespace dpchip::segment {

class Port {
public:
    /// Sends at this rate and keeps to these bus times (all in bit times).
    explicit Port(fdl::BaudCode rate) : Port{rate, fdl::bus_times(rate)} {}
    Port(fdl::BaudCode rate, const fdl::BusTimes& times) : bit_{fdl::baud(rate).bit}, times_{times} {}

    // ---- outbox: call Segment::touch() afterwards ---------------------------------------------------------------
    /// Sends octets, good telegram or not, as soon as the rules allow: TID1 after an answer or a token, TID2 after a
    /// telegram without answer, the slot time after an unanswered request, TSYN after anything else.
    /// False when it is still busy with the octets before, or there are none or more than 255.
    bool send(std::span<const std::uint8_t> octets);
    /// The same at tick `at` exactly, whatever the rules say. `faults` (per octet, mask of CharacterFault) may be empty.
    bool send_at(Ticks at, std::span<const std::uint8_t> octets, std::span<const std::uint8_t> faults = {});
    /// True until the last stop bit of what it was given has passed. Known at `now`.
    bool sending(Ticks now) const { return waiting_ || now < own_end_; }
    /// When the waiting octets begin, as things stand; kNever when nothing waits.
    Ticks begins() const { return waiting_ ? start() : core::kNever; }
    /// End of the last stop bit of what it last sent.
    Ticks sent_end() const { return own_end_; }
    /// Gives up what has not begun.
    void cancel() { waiting_ = false; }
    void set_rate(fdl::BaudCode rate) { bit_ = fdl::baud(rate).bit; times_ = fdl::bus_times(rate); }
    void set_times(const fdl::BusTimes& times) { times_ = times; }
    Ticks bit() const { return bit_; }

    // ---- inbox --------------------------------------------------------------------------------------------------
    /// Something others sent that has not been received yet.
    bool pending() const { return !inbox_.empty(); }
    /// The oldest of it; call only when pending(). Damaged ones come as they arrived, once the line was idle for TSYN.
    Transmission receive() { return inbox_.pop(); }
    void clear() { while (!inbox_.empty()) static_cast<void>(inbox_.pop()); }
    /// Transmissions that found the inbox (16) full.
    std::uint64_t overflows() const { return inbox_.overflows(); }

    // ---- Station ------------------------------------------------------------------------------------------------
    Ticks next() const;
    void advance(Ticks t);
    void hear(const Transmission& t);
    void hear_character(const Character& c);
    void carrier(Ticks at);
    bool take(Transmission& t);
    bool hears_all() const { return true; }
    std::uint8_t address() const { return kNoAddress; }

private:
    void flush();
    Ticks start() const;

    Ticks bit_;
    fdl::BusTimes times_;
    Ticks now_{};
    Transmission out_{};
    bool waiting_ = false;
    bool exact_ = false;       ///< at out_.start, not when the rules allow
    Ticks free_{};             ///< from here on the rules allow a request
    Ticks own_end_{};
    bool carrier_ = false;     ///< somebody is sending
    Transmission partial_{};   ///< damaged characters so far
    core::FixedQueue<Transmission, 16> inbox_;
};

static_assert(Station<Port>);

}  // namespace dpchip::segment
