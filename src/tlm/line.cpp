// SPDX-License-Identifier: Apache-2.0
// The line: who moves it, when the kernel has to come back, and what is handed over then.
#include <dpchip/tlm/line.hpp>

#include <algorithm>
#include <cstdio>
#include <string>

#include <dpchip/tlm/report.hpp>

namespace dpchip::tlm {

namespace {

constexpr std::size_t kInbox = 64;
constexpr Ticks kBitsOfCharacter = 11;
constexpr int kWatchEnds = 1, kWatchAll = 3;

Telegram telegram_from(const dpchip_telegram& t) {
    return {Octets(t.octets, t.octets + t.length), to_sc_time(t.start_ticks), to_sc_time(t.end_ticks), t.own != 0, t.damaged != 0};
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const Telegram& telegram) {
    const char* gap = "";
    for (const std::uint8_t octet : telegram.octets) {
        char digits[4];
        std::snprintf(digits, sizeof digits, "%02X", octet);
        out << gap << digits;
        gap = " ";
    }
    return out;
}

Line::Line(const sc_core::sc_module_name& name, std::uint32_t baud)
    : sc_core::sc_module{name}, line_{dpchip_line_open("sim:", baud)} {
    using SC_CURRENT_USER_MODULE = Line;
    if (line_ == nullptr) report::error(report::kLine, *this, dpchip_last_error());
    if (sc_core::sc_get_time_resolution() > sc_core::sc_time{1, sc_core::SC_PS})
        report::warning(report::kLine, *this, "the time resolution is coarser than 1 ps: what is shown at a time may be up to one unit late");
    dpchip_line_watch(line_.get(), kWatchEnds);
    SC_METHOD(step);
    dont_initialize();
    sensitive << wake_;
}

Line::~Line() = default;

void Line::end_of_elaboration() { plan(); }

// ---- time --------------------------------------------------------------------------------------------------------

void Line::step() {
    planned_ = sc_core::sc_max_time();
    advance(to_ticks(sc_core::sc_time_stamp()));
    collect();
    deliver();
    plan();
}

void Line::advance(Ticks to) {
    dpchip_line* line = line_.get();
    for (Ticks now = dpchip_line_now_ticks(line); now < to; now = dpchip_line_now_ticks(line))
        if (dpchip_line_run_ticks(line, to - now) < 0) {
            report::error(report::kLine, *this, dpchip_last_error());
            break;
        }
}

void Line::touched() {
    collect();
    plan();
}

void Line::collect() {
    dpchip_telegram telegram{};
    telegram.size = sizeof telegram;
    while (dpchip_line_telegram(line_.get(), &telegram) == 1) seen_.push_back(telegram_from(telegram));
    while (dpchip_line_begun(line_.get(), &telegram) == 1) {
        const Ticks bit = (telegram.end_ticks - telegram.start_ticks) / (kBitsOfCharacter * telegram.length);
        begun_.push_back({to_sc_time(telegram.start_ticks), Octets(telegram.octets, telegram.octets + telegram.length), telegram.start_ticks, bit});
    }
    for (LineStation* station : stations_) station->line_moved();
}

void Line::deliver() {
    for (; !begun_.empty() && begun_.front().at <= sc_core::sc_time_stamp(); begun_.pop_front())
        for (const Wire& w : wires_) w.wire->telegram_begins(begun_.front().octets, begun_.front().start, begun_.front().bit);
    while (!seen_.empty() && seen_.front().end <= sc_core::sc_time_stamp()) {
        const Telegram telegram = std::move(seen_.front());
        seen_.pop_front();
        if (telegram.own) {
            sent_.notify(sc_core::SC_ZERO_TIME);
        } else {
            if (inbox_.size() == kInbox) inbox_.pop_front();
            inbox_.push_back(telegram);
            received_.notify(sc_core::SC_ZERO_TIME);
        }
        telegrams.write(telegram);
    }
}

/// Has step() called when something is due next, and no earlier.
void Line::plan() {
    sc_core::sc_time at = to_sc_time(dpchip_line_next_ticks(line_.get()));
    if (!seen_.empty()) at = std::min(at, seen_.front().end);
    if (!begun_.empty()) at = std::min(at, begun_.front().at);
    if (at == planned_) return;
    planned_ = at;
    wake_.cancel();
    if (at == sc_core::sc_max_time()) return;
    const sc_core::sc_time& now = sc_core::sc_time_stamp();
    wake_.notify(at > now ? at - now : sc_core::SC_ZERO_TIME);
}

// ---- stations ----------------------------------------------------------------------------------------------------

void Line::attach(dpchip_chip& chip, LineStation& station) {
    if (dpchip_line_attach(line_.get(), &chip) != DPCHIP_OK) report::error(report::kLine, *this, dpchip_last_error());
    stations_.push_back(&station);
}

int Line::join(LineWire& wire, std::uint32_t baud) {
    const int station = dpchip_line_join(line_.get(), baud);
    check(station);
    dpchip_line_watch(line_.get(), kWatchAll);
    wires_.push_back({station, &wire});
    return station;
}

void Line::drive(int station, bool level) {
    for (Wire& w : wires_)
        if (w.station == station) w.level = level;
    for (const Wire& hearer : wires_) {
        if (hearer.station == station) continue;
        hearer.wire->others_drive(std::all_of(wires_.begin(), wires_.end(), [&](const Wire& w) { return w.station == hearer.station || w.level; }));
    }
}

void Line::begins(int station) {
    advance(to_ticks(sc_core::sc_time_stamp()));
    check(dpchip_line_joined_begins(line_.get(), station));
    touched();
}

void Line::sent(int station, const Octets& octets, const Octets& faults, Ticks start) {
    advance(to_ticks(sc_core::sc_time_stamp()));
    check(dpchip_line_joined_sent(line_.get(), station, octets.data(), faults.data(), octets.size(), start));
    touched();
}

void Line::check(int code) {
    if (code < 0) report::error(report::kLine, *this, dpchip_last_error());
}

bool Line::post(const Octets& octets, Ticks at) {
    advance(to_ticks(sc_core::sc_time_stamp()));
    const int code = dpchip_line_post(line_.get(), octets.data(), octets.size(), at);
    if (code == DPCHIP_E_ARGUMENT) report::error(report::kLine, *this, "a telegram has 1 to 255 octets");
    touched();
    return code == DPCHIP_OK;
}

bool Line::send(const Octets& octets) { return post(octets, -1); }

bool Line::send_now(const Octets& octets) { return post(octets, 0); }

bool Line::receive(Telegram& telegram) {
    if (inbox_.empty()) return false;
    telegram = std::move(inbox_.front());
    inbox_.pop_front();
    return true;
}

bool Line::exchange(const Octets& request, Telegram& answer, const sc_core::sc_time& timeout) {
    if (!send(request)) {
        report::error(report::kLine, *this, "exchange() while another telegram waits to be sent");
        return false;
    }
    sc_core::wait(sent_);
    inbox_.clear();
    sc_core::wait(timeout, received_);
    return receive(answer);
}

}  // namespace dpchip::tlm
