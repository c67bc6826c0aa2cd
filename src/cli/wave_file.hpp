// SPDX-License-Identifier: Apache-2.0
// A simulated segment as waveforms: TXD, RXD and RTS bit by bit, the other pins and the state machines of every slave.
//
// The line's levels are those of the telegrams that were on it, rendered with their own bit times; TXD is shown with its
// pull-up, so 1 when nothing is sent. RXD is the line as it is, the slave's own answers included. Where two send at once
// the low level wins. Propagation delay is not shown: all see the line where it is sent.
#pragma once

#include <array>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <dpchip/segment/segment.hpp>
#include <dpchip/slave/virtual_slave.hpp>
#include <dpchip/trace/vcd_order.hpp>

namespace dpchip::cli {

struct WaveOptions {
    std::string path;                  ///< empty: no waveforms
    std::vector<std::string> signals;  ///< patterns with * and ? against SCOPE.NAME; none: everything
    core::Ticks from{}, to = core::kNever;
    trace::VcdTimescale timescale{};
};

class WaveFile {
public:
    /// Records `segment` from now on. Throws Failure when the file cannot be written or a pattern fits no signal.
    WaveFile(const WaveOptions& options, segment::Segment& segment, const std::vector<std::string>& slaves);
    ~WaveFile();
    WaveFile(const WaveFile&) = delete;
    WaveFile& operator=(const WaveFile&) = delete;

    /// To be called after everything that may have changed something, for each slave; null: it has no power.
    void look(std::size_t n, const slave::VirtualSlave* slave, segment::StationIndex index);
    /// After all slaves: writes what is settled. Throws Failure when the disk is full.
    void settle();
    void set_master(segment::StationIndex index) { wire_of_[index] = kMaster; }
    std::uint64_t changes() const { return writer_.changes(); }
    const std::string& path() const { return options_.path; }

    // ---- segment::EarlyObserver ---------------------------------------------------------------------------------
    void see_begin(const segment::Sighting& s);
    void see(const segment::Sighting& s);

private:
    using Signal = trace::VcdWriter::Signal;
    static constexpr std::size_t kMaster = 0, kNoWire = 0xFFFF;
    /// What is shown of a slave, to tell changes.
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
        core::Ticks start;
        segment::StationIndex sender;
    };

    void declare(const std::vector<std::string>& slaves);
    bool wanted(const std::string& scope, const std::string& name);
    Signal bit(const std::string& scope, std::string_view name, char initial);
    Signal vector(const std::string& scope, std::string_view name, unsigned width);
    Signal text(const std::string& scope, std::string_view name);
    static Shown shown_of(const slave::VirtualSlave* slave);
    void show(Signals& s, const Shown& now);
    void drive(core::Ticks at, std::size_t wire, bool high);

    WaveOptions options_;
    std::ofstream file_;
    trace::VcdWriter writer_;
    trace::VcdOrder order_;
    segment::Segment& segment_;
    std::vector<bool> used_;                ///< patterns that fitted something
    std::vector<std::string> all_;          ///< every signal there is, for messages
    Signal line_ = trace::VcdWriter::kOff, master_txd_ = trace::VcdWriter::kOff;
    std::vector<Signals> slaves_;
    std::array<std::size_t, segment::kMaxStations> wire_of_{};
    std::vector<Open> open_;
    /// Edges of all wires that are not in the line's level yet, by time.
    struct LineEdge {
        core::Ticks at;
        bool high;
    };
    std::vector<LineEdge> line_edges_;
    std::size_t lows_ = 0;                  ///< transmissions that are low
    void settle_line(core::Ticks until);
};

}  // namespace dpchip::cli
