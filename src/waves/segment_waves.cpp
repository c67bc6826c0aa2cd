// SPDX-License-Identifier: Apache-2.0
// Which signals there are, and when they change.
#include <dpchip/waves/segment_waves.hpp>

#include <algorithm>

#include <dpchip/chip/outputs.hpp>
#include <dpchip/chip/state_names.hpp>
#include <dpchip/regmap/interrupts.hpp>
#include <dpchip/waves/pattern.hpp>

namespace dpchip::waves {
namespace {

trace::VcdOptions vcd_options(const Options& o) { return {o.timescale, o.from, o.to, o.comment}; }

std::string_view baud_text(fdl::BaudCode code) { return code == fdl::BaudCode::not_found ? std::string_view{"searching"} : fdl::baud(code).gsd; }

}  // namespace

SegmentWaves::SegmentWaves(std::ostream& out, segment::Segment& segment, const std::vector<std::string>& chips, const Options& options)
    : options_{options}, writer_{out, vcd_options(options_)}, order_{writer_}, segment_{segment}, begun_{segment.now()},
      used_(options.signals.size()), station_of_(chips.size() + 1, segment::kNobody) {
    wire_of_.fill(kNoWire);
    declare(chips);
    segment_.observe(*this);
}

SegmentWaves::~SegmentWaves() { finish(); }

void SegmentWaves::finish() {
    if (finished_) return;
    finished_ = true;
    segment_.unobserve(this);
    const core::Ticks now = segment_.now();
    for (const Open& o : open_)
        trace::render(o.sent, [&](core::Ticks at, bool high) {
            if (at <= now) drive(at, o.wire, high);
        });
    settle_line(core::kNever);
    order_.release(core::kNever);
    writer_.finish(now);
}

const std::string* SegmentWaves::unmatched() const {
    const auto at = std::find(used_.begin(), used_.end(), false);
    return at == used_.end() ? nullptr : &options_.signals[static_cast<std::size_t>(at - used_.begin())];
}

// ---- declarations ------------------------------------------------------------------------------------------------

bool SegmentWaves::wanted(const std::string& scope, std::string_view name) {
    const std::string& full = all_.emplace_back(scope + '.' + std::string{name});
    bool fit = options_.signals.empty();
    for (std::size_t i = 0; i < options_.signals.size(); ++i)
        if (fits(options_.signals[i], full)) fit = used_[i] = true;
    return fit;
}
SegmentWaves::Signal SegmentWaves::bit(const std::string& scope, std::string_view name, char initial) {
    return wanted(scope, name) ? writer_.bit(scope, name, initial) : trace::VcdWriter::kOff;
}
SegmentWaves::Signal SegmentWaves::vector(const std::string& scope, std::string_view name, unsigned width) {
    return wanted(scope, name) ? writer_.vector(scope, name, width) : trace::VcdWriter::kOff;
}
SegmentWaves::Signal SegmentWaves::text(const std::string& scope, std::string_view name) {
    return wanted(scope, name) ? writer_.text(scope, name) : trace::VcdWriter::kOff;
}

void SegmentWaves::declare(const std::vector<std::string>& chips) {
    line_ = bit("line", "level", '1');
    master_txd_ = bit("master", "TXD", '1');
    for (const std::string& scope : chips) declare_chip(scope);
}

void SegmentWaves::declare_chip(const std::string& scope) {
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
    chips_.push_back(s);
}

// ---- chips -------------------------------------------------------------------------------------------------------

SegmentWaves::Shown SegmentWaves::shown_of(const chip::State* state) {
    Shown now;
    if (state == nullptr) return now;
    const chip::State& s = *state;
    const auto level = [&](chip::Pin pin) { return core::to_underlying(chip::outputs::level(s, pin)); };
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

void SegmentWaves::look(std::size_t n, const chip::State* state, segment::StationIndex index) {
    Signals& s = chips_[n];
    put_on_wire(n + 1, index);
    const Shown now = shown_of(state);
    if (s.shown_once && now == s.shown) return;
    show(s, now);
    s.shown = now;
    s.shown_once = true;
}

/// Writes all of a chip; what has not changed is left out by the writer.
void SegmentWaves::show(const Signals& s, const Shown& now) {
    if (!now.on) return show_dark(s);
    const core::Ticks at = segment_.now();
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
    for (unsigned i = 0; i < s.irr.size(); ++i) put(s.irr[i], ((now.irr >> i) & 1u) != 0);
}

void SegmentWaves::show_dark(const Signals& s) {
    const core::Ticks at = segment_.now();
    for (const Signal signal : {s.rts, s.x_int, s.sync, s.diag_flag, s.dp, s.wd, s.baud, s.din, s.dout, s.dxb, s.diag, s.owner}) order_.unknown(at, signal);
    for (const Signal signal : s.irr) order_.unknown(at, signal);
}

// ---- line --------------------------------------------------------------------------------------------------------

/// A station's number is given to the next one when it leaves.
void SegmentWaves::put_on_wire(std::size_t wire, segment::StationIndex index) {
    const segment::StationIndex before = station_of_[wire];
    if (before == index) return;
    if (before < wire_of_.size() && wire_of_[before] == wire) wire_of_[before] = kNoWire;
    if (index < wire_of_.size()) wire_of_[index] = wire;
    station_of_[wire] = index;
}

void SegmentWaves::see_begin(const segment::Sighting& s) { open_.push_back({s.sent, s.sender, wire_of(s.sender)}); }

/// A station that was unplugged while it sent is nobody at the end; it is still its pin that moved.
void SegmentWaves::see(const segment::Sighting& s) {
    std::size_t wire = wire_of(s.sender);
    const auto same = [&](const Open& o) { return o.sent.start == s.sent.start && (o.sender == s.sender || s.sender == segment::kNobody); };
    if (const auto at = std::find_if(open_.begin(), open_.end(), same); at != open_.end()) {
        wire = at->wire;
        open_.erase(at);
    } else if (s.sent.start < begun_) {
        return;
    }
    trace::render(s.sent, [&](core::Ticks when, bool high) { drive(when, wire, high); });
}

void SegmentWaves::drive(core::Ticks at, std::size_t wire, bool high) {
    if (wire == kMaster) order_.set(at, master_txd_, high ? '1' : '0');
    else if (wire != kNoWire && wire <= chips_.size()) order_.set(at, chips_[wire - 1].txd, high ? '1' : '0');
    line_edges_.push_back({at, high});
}

/// The line's level from all senders' edges before `until`.
void SegmentWaves::settle_line(core::Ticks until) {
    if (line_edges_.empty()) return;
    std::stable_sort(line_edges_.begin(), line_edges_.end(), [](const LineEdge& a, const LineEdge& b) { return a.at < b.at; });
    std::size_t n = 0;
    for (; n < line_edges_.size() && line_edges_[n].at < until; ++n) {
        lows_ = line_edges_[n].high ? lows_ - 1 : lows_ + 1;
        const bool same_tick = n + 1 < line_edges_.size() && line_edges_[n + 1].at == line_edges_[n].at;
        if (same_tick) continue;
        const char level = lows_ == 0 ? '1' : '0';
        order_.set(line_edges_[n].at, line_, level);
        for (const Signals& s : chips_) order_.set(line_edges_[n].at, s.rxd, level);
    }
    line_edges_.erase(line_edges_.begin(), line_edges_.begin() + static_cast<std::ptrdiff_t>(n));
}

void SegmentWaves::settle(core::Ticks hold) {
    core::Ticks until = std::min(segment_.now(), hold);
    for (const Open& o : open_) until = std::min(until, o.sent.start);
    settle_line(until);
    order_.release(until);
}

}  // namespace dpchip::waves
