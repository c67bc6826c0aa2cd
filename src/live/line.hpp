// SPDX-License-Identifier: Apache-2.0
// A live line: a segment driven by the monotonic clock, with one more station on it, the port.
//
// A telegram ends when its last octet was read. Whole good telegrams take the telegram path with that time; only damaged
// input goes character by character, without gaps. An answer leaves in one write, never before its time, and not at all
// when the slot time is over. On media without bit timing (pty, tcp) sending is over when the write returned; the
// segment's bit times then count only up to the first start bit. Silence cannot be measured there either: the line vouches
// for the 33 bit times before every good telegram, so that damage never costs the next one, nor a telegram that follows
// another faster than a wire would carry it.
//
// Line time is 0 when the line is made and follows the wall. It may run ahead by what processor accesses took (spend());
// run() waits until the wall has caught up. No threads: everything happens inside the calls. One thread at a time.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <dpchip/fdl/baud.hpp>
#include <dpchip/live/port.hpp>
#include <dpchip/live/stream_decoder.hpp>
#include <dpchip/live/time_source.hpp>
#include <dpchip/segment/segment.hpp>

namespace dpchip::live {

/// When a pty's or a socket's write happens: as soon as the answer is due, or after the time it would take on a wire.
enum class Pace : std::uint8_t { prompt, wire };

struct LineOptions {
    fdl::BaudCode baud = fdl::BaudCode::kbit_19_2;
    std::optional<Ticks> slot_time{};  ///< default: the profile's T_SL on serial, 200 ms on pty and tcp
    Pace pace = Pace::prompt;          ///< serial lines have a pace of their own
};

struct LineCounters {
    std::uint64_t heard = 0;           ///< good telegrams
    std::uint64_t damaged = 0;         ///< pieces that were none
    std::uint64_t damaged_octets = 0;
    std::uint64_t sent = 0;            ///< telegrams written
    std::uint64_t late = 0;            ///< answers not sent because the slot time was over
    std::uint64_t unsent = 0;          ///< the port did not take them: nobody there, or nobody reads
};

class LiveLine {
public:
    /// `port` and `time` are used through their interfaces only; both must outlive the line.
    LiveLine(Port& port, const TimeSource& time, const LineOptions& options = {});
    ~LiveLine();
    LiveLine(const LiveLine&) = delete;
    LiveLine& operator=(const LiveLine&) = delete;

    /// The line's segment: attach stations and observers here. Move it only through the line.
    segment::Segment& segment() { return segment_; }
    /// The sender that an observer sees for what came through the port.
    segment::StationIndex port_station() const { return port_station_; }

    /// Line time: the wall's, or ahead of it.
    Ticks now() const;
    /// Lives for `duration` of wall time and returns what has passed: less after stop(), or when `enough` (asked after
    /// every step, and first of all) says so. Throws LineError when the port is gone.
    Ticks run(Ticks duration, const std::function<bool()>& enough = {});
    /// Moves the line ahead by the time a processor access takes, and sends what falls due meanwhile.
    void spend(Ticks duration);
    /// Makes the present or next run() return at once, and every further one until resume(). Async-signal-safe.
    void stop() noexcept;
    void resume() { stop_ = false; }
    bool stopped() const { return stop_; }

    /// `--baud auto`: asked after every step for the rate the UART should have, normally the rate that the chip's search
    /// tries. Empty: the rate stays.
    void follow_baud(std::function<fdl::BaudCode()> rate) { follow_ = std::move(rate); }
    fdl::BaudCode baud() const { return baud_; }
    Ticks slot_time() const { return slot_time_; }
    const LineCounters& counters() const { return counters_; }

private:
    /// The port as a station: it brings what others sent and wants nothing.
    struct Tap {
        Ticks next() const { return core::kNever; }
        void advance(Ticks) {}
        void hear(const segment::Transmission&) {}
        void hear_character(const segment::Character&) {}
        void carrier(Ticks) {}
        bool take(segment::Transmission&) { return false; }
        bool hears_all() const { return false; }
        std::uint8_t address() const { return segment::kNoAddress; }
    };
    /// What stations begin to send.
    struct Outbox {
        LiveLine& line;
        void see(const segment::Sighting&) {}
        void see_begin(const segment::Sighting& s) { line.begun(s); }
    };
    struct Outgoing {
        fdl::Transmission sent;
        segment::StationIndex sender;
        Ticks due;  ///< not to be written before
    };

    bool timed() const { return port_.medium() == Medium::serial; }
    Ticks wall() const { return time_.now() - origin_; }
    void apply_baud(fdl::BaudCode baud);
    void begun(const segment::Sighting& s);
    void advance(Ticks to);
    void write_due();
    void write(const Outgoing& out);
    void listen();
    void drain(std::size_t source, Ticks now);
    void hear(const Piece& piece, std::size_t source);
    void hear_damage(const Piece& piece);
    void inject(std::span<const std::uint8_t> octets, std::span<const std::uint8_t> faults, Ticks end);
    void step();
    Ticks next_event();

    Port& port_;
    const TimeSource& time_;
    Ticks origin_;
    Pace pace_;
    fdl::BaudCode baud_;
    Ticks bit_{};
    std::optional<Ticks> wanted_slot_time_;
    Ticks slot_time_{};
    bool deaf_ = false;  ///< the UART does not do the rate that is wanted now
    segment::Segment segment_;
    Tap tap_;
    Outbox outbox_{*this};
    segment::StationIndex port_station_ = segment::kNobody;
    std::vector<StreamDecoder> decoders_;  ///< per source
    std::unique_ptr<Reception> reception_;
    std::vector<Outgoing> outgoing_;
    Ticks busy_until_{};                   ///< end of the last telegram on the line, either way
    std::optional<Ticks> request_end_;     ///< of the last telegram heard; answers count their slot time from here
    std::function<fdl::BaudCode()> follow_;
    std::atomic<bool> stop_{false};
    static_assert(std::atomic<bool>::is_always_lock_free);
    LineCounters counters_;
};

}  // namespace dpchip::live
