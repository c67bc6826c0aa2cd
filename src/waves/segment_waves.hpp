// SPDX-License-Identifier: Apache-2.0
// A segment in virtual time as waveforms: TXD, RXD and RTS bit by bit, the other pins and the state machines of chips on it.
//
// The line's levels are those of the telegrams that were on it, rendered with their own bit times; TXD is shown with its
// pull-up, so 1 when nothing is sent. RXD is the line as it is, the chip's own answers included. Where two send at once
// the low level wins. Pins and states are looked at: whoever moves the segment does so event by event and calls look() and
// settle() after each. Propagation delay is not shown: all see the line where it is sent.
//
// Not drawn: what was on the line already when drawing began, the other pins of the package (trace::VcdPins has them), stations without a name here but for their bits on
// the line.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include <dpchip/chip/state.hpp>
#include <dpchip/segment/segment.hpp>
#include <dpchip/trace/vcd_order.hpp>

namespace dpchip::waves {

struct Options {
    std::vector<std::string> signals;         ///< patterns with * and ? against SCOPE.NAME; none: everything
    core::Ticks from{}, to = core::kNever;    ///< line time
    trace::VcdTimescale timescale{};
    std::string comment = "simulated line";   ///< for the header
};

class SegmentWaves {
public:
    /// Draws `segment` into `out` from now on; both must outlive it. `chips` are the scopes of the chips, which look() calls
    /// by number. Nothing is written before the first settle(), so `out` may be opened in between.
    SegmentWaves(std::ostream& out, segment::Segment& segment, const std::vector<std::string>& chips, const Options& options);
    ~SegmentWaves();
    SegmentWaves(const SegmentWaves&) = delete;
    SegmentWaves& operator=(const SegmentWaves&) = delete;

    /// Every signal that could be chosen, as SCOPE.NAME.
    const std::vector<std::string>& signals() const { return all_; }
    /// The first pattern that fits none of them; null: all fit.
    const std::string* unmatched() const;

    /// The station whose telegrams are master.TXD.
    void set_master(segment::StationIndex index) { put_on_wire(kMaster, index); }
    /// After anything that may have changed chip `n`; null: it has no power, or is away. kNobody: it is not on the line.
    void look(std::size_t n, const chip::State* state, segment::StationIndex index);
    /// After all chips: writes what is settled. Nothing will be known later that happened before `hold` or, if that is
    /// earlier, before what is on the line now began.
    void settle(core::Ticks hold = core::kNever);
    /// Writes what is left, the bits so far of what is on the line included. Nothing may follow.
    void finish();
    /// False when the stream has failed.
    bool good() const { return writer_.good(); }
    std::uint64_t changes() const { return writer_.changes(); }

    // ---- segment::EarlyObserver ---------------------------------------------------------------------------------
    void see_begin(const segment::Sighting& s);
    void see(const segment::Sighting& s);

private:
    using Signal = trace::VcdWriter::Signal;
    /// Wires: the master's TXD, then those of the chips.
    static constexpr std::size_t kMaster = 0, kNoWire = 0xFFFF;
    /// What is shown of a chip, to tell changes.
    struct Shown {
        bool on = false;
        std::uint16_t irr = 0;
        std::uint8_t rts = 0, x_int = 0, sync = 0, diag_flag = 0, din = 0, dout = 0, dxb = 0, diag = 0, owner = 0;
        chip::DpState dp{};
        chip::WdState wd{};
        fdl::BaudCode baud{};
        bool operator==(const Shown&) const = default;
    };
    struct Signals {
        Signal txd, rxd, rts, x_int, sync, dp, wd, baud, diag_flag, din, dout, dxb, diag, owner;
        std::array<Signal, 16> irr;
        bool shown_once = false;
        Shown shown;
    };
    /// A transmission that has begun and not ended.
    struct Open {
        fdl::Transmission sent;
        segment::StationIndex sender;
        std::size_t wire;
    };
    struct LineEdge {
        core::Ticks at;
        bool high;
    };

    void declare(const std::vector<std::string>& chips);
    void declare_chip(const std::string& scope);
    bool wanted(const std::string& scope, std::string_view name);
    Signal bit(const std::string& scope, std::string_view name, char initial);
    Signal vector(const std::string& scope, std::string_view name, unsigned width);
    Signal text(const std::string& scope, std::string_view name);
    static Shown shown_of(const chip::State* state);
    void show(const Signals& s, const Shown& now);
    void show_dark(const Signals& s);
    void put_on_wire(std::size_t wire, segment::StationIndex index);
    std::size_t wire_of(segment::StationIndex sender) const { return sender < wire_of_.size() ? wire_of_[sender] : kNoWire; }
    void drive(core::Ticks at, std::size_t wire, bool high);
    void settle_line(core::Ticks until);

    Options options_;
    trace::VcdWriter writer_;
    trace::VcdOrder order_;
    segment::Segment& segment_;
    core::Ticks begun_;               ///< what began earlier is not drawn
    std::vector<bool> used_;          ///< patterns that fitted something
    std::vector<std::string> all_;
    Signal line_ = trace::VcdWriter::kOff, master_txd_ = trace::VcdWriter::kOff;
    std::vector<Signals> chips_;
    std::array<std::size_t, segment::kMaxStations> wire_of_{};  ///< by station
    std::vector<segment::StationIndex> station_of_;             ///< by wire
    std::vector<Open> open_;
    std::vector<LineEdge> line_edges_;  ///< edges of all wires that are not in the line's level yet
    std::size_t lows_ = 0;              ///< transmissions that are low
    bool finished_ = false;
};

}  // namespace dpchip::waves
