// SPDX-License-Identifier: Apache-2.0
// Which signals there are, and when they change.
#include <dpchip/cli/wave_file.hpp>

#include <algorithm>

#include <fnmatch.h>

#include <dpchip/cli/failure.hpp>
#include <dpchip/cli/stations.hpp>
#include <dpchip/regmap/interrupts.hpp>

namespace dpchip::cli {
namespace {

std::ofstream open(const std::string& path) {
    std::ofstream file{path, std::ios::binary | std::ios::trunc};
    if (!file) throw Failure{ExitCode::failed, path + ": cannot be written"};
    return file;
}

trace::VcdOptions vcd_options(const WaveOptions& o) { return {o.timescale, o.from, o.to, "simulated line"}; }

std::string_view baud_text(fdl::BaudCode code) { return code == fdl::BaudCode::not_found ? std::string_view{"searching"} : fdl::baud(code).gsd; }

}  // namespace

WaveFile::WaveFile(const WaveOptions& options, segment::Segment& segment, const std::vector<std::string>& slaves)
    : options_{options}, file_{open(options.path)}, writer_{file_, vcd_options(options)}, order_{writer_}, segment_{segment},
      used_(options.signals.size()) {
    wire_of_.fill(kNoWire);
    declare(slaves);
    segment_.observe(*this);
}

WaveFile::~WaveFile() {
    segment_.unobserve(this);
    settle_line(core::kNever);
    order_.release(core::kNever);
    writer_.finish(segment_.now());
}

bool WaveFile::wanted(const std::string& scope, const std::string& name) {
    const std::string full = scope + '.' + name;
    all_.push_back(full);
    bool fits = options_.signals.empty();
    for (std::size_t i = 0; i < options_.signals.size(); ++i)
        if (::fnmatch(options_.signals[i].c_str(), full.c_str(), 0) == 0) fits = used_[i] = true;
    return fits;
}
WaveFile::Signal WaveFile::bit(const std::string& scope, std::string_view name, char initial) {
    return wanted(scope, std::string{name}) ? writer_.bit(scope, name, initial) : trace::VcdWriter::kOff;
}
WaveFile::Signal WaveFile::vector(const std::string& scope, std::string_view name, unsigned width) {
    return wanted(scope, std::string{name}) ? writer_.vector(scope, name, width) : trace::VcdWriter::kOff;
}
WaveFile::Signal WaveFile::text(const std::string& scope, std::string_view name) {
    return wanted(scope, std::string{name}) ? writer_.text(scope, name) : trace::VcdWriter::kOff;
}

void WaveFile::declare(const std::vector<std::string>& slaves) {
    line_ = bit("line", "level", '1');
    master_txd_ = bit("master", "TXD", '1');
    for (const std::string& scope : slaves) {
        Signals s{};
        s.txd = bit(scope, "TXD", '1');
        s.rxd = bit(scope, "RXD", '1');
        s.rts = bit(scope, "RTS", 'x');
        s.x_int = bit(scope, "X_INT", 'x');
        s.sync = bit(scope, "XDATAEXCH_SYNC", 'x');
        s.diag_flag = bit(scope, "Diag_Flag", 'x');
        s.wd = text(scope, "WD_State");
        s.dp = text(scope, "DP_State");
        s.baud = text(scope, "Baud_Rate");
        s.owner = vector(scope, "Diag_Master_Add", 8);
        s.din = vector(scope, "Din_Buffer_SM", 8);
        s.dout = vector(scope, "Dout_Buffer_SM", 8);
        s.dxb = vector(scope, "DXBout_Buffer_SM", 8);
        s.diag = vector(scope, "Diag_Buffer_SM", 8);
        for (std::size_t i = 0; i < s.irr.size(); ++i) s.irr[i] = bit(scope + ".IRR", regmap::kInterruptBits[i].name, 'x');
        slaves_.push_back(s);
    }
    for (std::size_t i = 0; i < used_.size(); ++i) {
        if (used_[i]) continue;
        std::string known;
        for (const std::string& name : all_) known += "\n  " + name;
        throw Failure{ExitCode::usage, "--signals " + options_.signals[i] + ": no signal is called so. There are:" + known};
    }
}

// ---- slaves ------------------------------------------------------------------------------------------------------

WaveFile::Shown WaveFile::shown_of(const slave::VirtualSlave* slave) {
    Shown now;
    if (slave == nullptr) return now;
    const chip::State& s = slave->chip().state();
    const auto level = [&](chip::Pin pin) { return slave->chip().level(pin) == chip::Level::high ? std::uint8_t{1} : std::uint8_t{0}; };
    now.on = true;
    now.irr = s.irr;
    now.rts = level(chip::Pin::rts);
    now.x_int = level(chip::Pin::x_int);
    now.sync = level(chip::Pin::xdataexch_sync);
    now.diag_flag = s.diag_flag;
    now.din = s.din_sm;
    now.dout = s.dout_sm;
    now.dxb = s.dxbout_sm;
    now.diag = s.diag_sm;
    now.owner = s.owner;
    now.dp = s.dp_state;
    now.wd = s.wd_state;
    now.baud = s.baud;
    return now;
}

void WaveFile::look(std::size_t n, const slave::VirtualSlave* slave, segment::StationIndex index) {
    Signals& s = slaves_[n];
    if (index != segment::kNobody) wire_of_[index] = n + 1;
    const Shown now = shown_of(slave);
    if (s.shown_once && now == s.shown) return;
    show(s, now);
    s.shown = now;
    s.shown_once = true;
}

/// Writes all of a slave; what has not changed is left out by the writer.
void WaveFile::show(Signals& s, const Shown& now) {
    const core::Ticks at = segment_.now();
    if (!now.on) {
        for (const Signal signal : {s.rts, s.x_int, s.sync, s.diag_flag, s.dp, s.wd, s.baud, s.din, s.dout, s.dxb, s.diag, s.owner}) order_.unknown(at, signal);
        for (const Signal signal : s.irr) order_.unknown(at, signal);
        return;
    }
    const auto put = [&](Signal signal, bool high) { order_.set(at, signal, high ? '1' : '0'); };
    put(s.rts, now.rts != 0);
    put(s.x_int, now.x_int != 0);
    put(s.sync, now.sync != 0);
    put(s.diag_flag, now.diag_flag != 0);
    order_.set_text(at, s.dp, name(now.dp));
    order_.set_text(at, s.wd, name(now.wd));
    order_.set_text(at, s.baud, baud_text(now.baud));
    order_.set_value(at, s.din, now.din);
    order_.set_value(at, s.dout, now.dout);
    order_.set_value(at, s.dxb, now.dxb);
    order_.set_value(at, s.diag, now.diag);
    order_.set_value(at, s.owner, now.owner);
    for (unsigned i = 0; i < 16; ++i) put(s.irr[i], ((now.irr >> i) & 1u) != 0);
}

// ---- line --------------------------------------------------------------------------------------------------------

void WaveFile::see_begin(const segment::Sighting& s) { open_.push_back({s.sent.start, s.sender}); }

/// A station that was unplugged while it sent is nobody at the end; it is still its pin that moved.
void WaveFile::see(const segment::Sighting& s) {
    segment::StationIndex sender = s.sender;
    const auto same = [&](const Open& o) { return o.start == s.sent.start && (o.sender == s.sender || s.sender == segment::kNobody); };
    if (const auto at = std::find_if(open_.begin(), open_.end(), same); at != open_.end()) {
        sender = at->sender;
        open_.erase(at);
    }
    const std::size_t wire = sender < wire_of_.size() ? wire_of_[sender] : kNoWire;
    trace::render(s.sent, [&](core::Ticks when, bool high) { drive(when, wire, high); });
}

void WaveFile::drive(core::Ticks at, std::size_t wire, bool high) {
    if (wire == kMaster) order_.set(at, master_txd_, high ? '1' : '0');
    else if (wire != kNoWire && wire <= slaves_.size()) order_.set(at, slaves_[wire - 1].txd, high ? '1' : '0');
    line_edges_.push_back({at, high});
}

/// The line's level from all senders' edges before `until`.
void WaveFile::settle_line(core::Ticks until) {
    if (line_edges_.empty()) return;
    std::stable_sort(line_edges_.begin(), line_edges_.end(), [](const LineEdge& a, const LineEdge& b) { return a.at < b.at; });
    std::size_t n = 0;
    for (; n < line_edges_.size() && line_edges_[n].at < until; ++n) {
        lows_ = line_edges_[n].high ? lows_ - 1 : lows_ + 1;
        const bool same_tick = n + 1 < line_edges_.size() && line_edges_[n + 1].at == line_edges_[n].at;
        if (same_tick) continue;
        const char level = lows_ == 0 ? '1' : '0';
        order_.set(line_edges_[n].at, line_, level);
        for (const Signals& s : slaves_) order_.set(line_edges_[n].at, s.rxd, level);
    }
    line_edges_.erase(line_edges_.begin(), line_edges_.begin() + static_cast<std::ptrdiff_t>(n));
}

void WaveFile::settle() {
    core::Ticks until = segment_.now();
    for (const Open& o : open_) until = std::min(until, o.start);
    settle_line(until);
    order_.release(until);
    if (!writer_.good()) throw Failure{ExitCode::failed, options_.path + ": cannot be written any more"};
}

}  // namespace dpchip::cli
