// SPDX-License-Identifier: Apache-2.0
// What stands behind a dpchip_line: a segment, and a way to let time pass on it. Virtual or live.
#pragma once

#include <deque>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <dpchip/core/ticks.hpp>
#include <dpchip/dpchip.h>
#include <dpchip/fdl/baud.hpp>
#include <dpchip/live/recorder.hpp>
#include <dpchip/segment/segment.hpp>
#include <dpchip/trace/vcd_writer.hpp>

namespace dpchip::capi {

using core::Ticks;
class LineWaves;

class Line {
public:
    Line();
    virtual ~Line();
    Line(const Line&) = delete;
    Line& operator=(const Line&) = delete;

    virtual segment::Segment& segment() = 0;
    virtual Ticks now() const = 0;
    /// Lets time pass, at most `duration`, until an attached chip's X/INT has risen; returns what has passed.
    virtual Ticks run(Ticks duration) = 0;
    /// A processor access takes this long.
    virtual void spend(Ticks duration) = 0;
    virtual void stop() noexcept {}
    virtual std::string path() const { return {}; }
    /// The test as a master. Codes as in the C API.
    virtual int send(std::span<const std::uint8_t> octets) = 0;
    virtual int receive(std::span<std::uint8_t> into, Ticks timeout) = 0;
    /// Plans octets for `at`, or for the earliest moment of the bus rules when that is negative.
    virtual int post(std::span<const std::uint8_t> octets, Ticks at) = 0;
    virtual std::int64_t epoch_ns() const { return 0; }
    /// The station through which the outside is on the line, when it is someone else's.
    virtual segment::StationIndex port() const { return segment::kNobody; }
    /// The station whose telegrams are the caller's own, or come from the port.
    virtual segment::StationIndex outside() const = 0;
    virtual bool is_virtual() const = 0;

    void record(const std::string& file);
    void end_recording();

    /// Waveforms of the line and the chips that are on it now. Codes as in the C API.
    int draw(const std::string& file, std::string_view signals);
    int end_drawing();
    int set_option(std::string_view name, const std::string& text);
    /// After anything that may have changed something; nothing is drawn: nothing is done.
    void look() {
        if (waves_ != nullptr) look_at_waves();
    }

    /// Keeps every telegram for dpchip_line_telegram, and for dpchip_line_begun as it begins.
    void watch(bool ends, bool beginnings);
    /// The oldest one kept, or nothing.
    std::optional<dpchip_telegram> seen();
    std::optional<dpchip_telegram> begun();

    /// Stations whose bits are elsewhere. Codes as in the C API.
    int join(fdl::BaudCode rate);
    int joined_begins(int station);
    int joined_sent(int station, std::span<const std::uint8_t> octets, const std::uint8_t* faults, Ticks start);

    std::vector<dpchip_chip*> chips;

protected:
    /// Whether every event is to be looked at.
    bool drawn() const { return waves_ != nullptr; }
    /// True when the X/INT of a chip has gone active since the last time this was asked.
    bool x_int_rose();

private:
    struct Recording {
        std::ofstream file;
        std::optional<trace::PcapngWriter> writer;
        std::optional<live::Recorder> recorder;
    };
    /// What was on the line, for dpchip_line_telegram.
    struct Watch {
        const Line& line;
        bool beginnings = false;
        std::deque<dpchip_telegram> telegrams{}, begun{};
        void see(const segment::Sighting& s);
        void see_begin(const segment::Sighting& s);
        void keep(std::deque<dpchip_telegram>& in, const segment::Sighting& s) const;
    };
    /// A station without ears or a mind of its own.
    struct Joined {
        segment::StationIndex index{};
        Ticks bit{};
        bool sending = false;
        Ticks since{};  ///< sending: no earlier

        Ticks next() const { return core::kNever; }
        void advance(Ticks) {}
        void hear(const fdl::Transmission&) {}
        void hear_character(const fdl::Character&) {}
        void carrier(Ticks) {}
        bool take(fdl::Transmission&) { return false; }
        bool hears_all() const { return false; }
        std::uint8_t address() const { return segment::kNoAddress; }
    };
    void look_at_waves();
    Joined* joined(int station);
    static std::optional<dpchip_telegram> oldest(std::deque<dpchip_telegram>& of);

    std::deque<Joined> joined_;  ///< the segment points at them
    std::unique_ptr<Recording> recording_;
    std::unique_ptr<Watch> watch_;
    trace::VcdTimescale timescale_{};
    std::unique_ptr<LineWaves> waves_;
};

/// Throws std::invalid_argument or live::LineError in words. baud 0: the default.
std::unique_ptr<Line> open(std::string_view uri, std::uint32_t baud);

}  // namespace dpchip::capi

struct dpchip_line {
    std::unique_ptr<dpchip::capi::Line> line;
    std::string path;
};
