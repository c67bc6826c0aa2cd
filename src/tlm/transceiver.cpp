// SPDX-License-Identifier: Apache-2.0
// A UART's two halves, in events: levels into telegrams, telegrams into levels.
#include <dpchip/tlm/transceiver.hpp>

#include <algorithm>
#include <string>

#include <dpchip/tlm/report.hpp>

namespace dpchip::tlm {

using sc_dt::sc_logic;

namespace {

constexpr int kBits = 11;
constexpr std::size_t kMaxTelegram = 255;

/// Every bit time of PROFIBUS is a whole number of those at 12 Mbit/s, also that of 45.45 kbit/s.
constexpr Ticks bit_time(std::uint32_t baud) {
    constexpr Ticks per_second = 60'000'000'000, fastest = 5'000;
    const Ticks rate = baud == 0 ? 1 : Ticks{baud};
    return (per_second + rate * fastest / 2) / (rate * fastest) * fastest;
}

bool odd(unsigned bits) {
    bool is = false;
    for (; bits != 0; bits &= bits - 1) is = !is;
    return is;
}

/// The eleven bits of a character, first bit lowest.
unsigned frame_of(std::uint8_t octet) {
    return static_cast<unsigned>(octet) << 1 | (odd(octet) ? 1u << 9 : 0u) | 1u << 10;
}

std::uint8_t faults_of(unsigned frame) {
    const bool parity = odd(frame >> 1 & 0x1FF), framing = (frame & 0x401) != 0x400;
    return static_cast<std::uint8_t>((parity ? DPCHIP_FAULT_PARITY : 0) | (framing ? DPCHIP_FAULT_STOP : 0));
}

/// How long a telegram is that begins like this, whether the rest is good or not; 0: it cannot be said.
std::size_t telegram_length(const Octets& octets) {
    if (octets.empty()) return 0;
    switch (octets[0]) {
    case 0xE5: return 1;   // SC
    case 0xDC: return 3;   // SD4
    case 0x10: return 6;   // SD1
    case 0xA2: return 14;  // SD3
    case 0x68: return octets.size() < 2 ? 0 : octets[1] + std::size_t{6};  // SD2
    default: return 0;
    }
}

}  // namespace

// ---- to RXD ------------------------------------------------------------------------------------------------------

Ticks Transceiver::Incoming::end() const { return start + bit * kBits * static_cast<Ticks>(octets.size()); }

bool Transceiver::Incoming::level(Ticks at) const {
    if (at < start || at >= end()) return true;
    const Ticks slot = (at - start) / bit;
    return (frame_of(octets[static_cast<std::size_t>(slot / kBits)]) >> slot % kBits & 1) != 0;
}

/// The next bit boundary at which the level changes, or the end.
Ticks Transceiver::Incoming::next_edge(Ticks after) const {
    const bool now = level(after);
    Ticks at = after < start ? start : start + ((after - start) / bit + 1) * bit;
    while (at < end() && level(at) == now) at += bit;
    return at;
}

void Transceiver::telegram_begins(const Octets& octets, Ticks start, Ticks bit) {
    incoming_.push_back({octets, start, bit});
    wake_.notify(sc_core::SC_ZERO_TIME);
}

void Transceiver::others_drive(bool level) {
    others_ = level;
    wake_.notify(sc_core::SC_ZERO_TIME);
}

void Transceiver::show(Ticks now) {
    incoming_.erase(std::remove_if(incoming_.begin(), incoming_.end(), [&](const Incoming& in) { return in.end() <= now; }), incoming_.end());
    const bool quiet = others_ && std::all_of(incoming_.begin(), incoming_.end(), [&](const Incoming& in) { return in.level(now); });
    rxd.write(sends_ || quiet ? sc_dt::SC_LOGIC_1 : sc_dt::SC_LOGIC_0);
}

// ---- the module --------------------------------------------------------------------------------------------------

Transceiver::Transceiver(const sc_core::sc_module_name& name, std::uint32_t baud) : sc_core::sc_module{name}, baud_{baud}, bit_{bit_time(baud)} {
    using SC_CURRENT_USER_MODULE = Transceiver;
    rxd.initialize(sc_dt::SC_LOGIC_1);
    SC_METHOD(step);
    sensitive << txd << rts << wake_;
}

Transceiver::~Transceiver() = default;

void Transceiver::end_of_elaboration() { station_ = line->join(*this, baud_); }

/// Everything is done here, by one process: RXD has one writer. What is due comes before what has just changed.
void Transceiver::step() {
    const Ticks now = to_ticks(sc_core::sc_time_stamp());
    read_txd(now);
    show(now);
    plan(now);
}

void Transceiver::plan(Ticks now) {
    Ticks next = std::min(next_sample(), telegram_over());
    for (const Incoming& in : incoming_) next = std::min(next, in.next_edge(now));
    wake_.cancel();
    if (next == kNever) return;
    const sc_core::sc_time at = to_sc_time(next);
    const sc_core::sc_time& present = sc_core::sc_time_stamp();
    wake_.notify(at > present ? at - present : sc_core::SC_ZERO_TIME);
}

// ---- from TXD ----------------------------------------------------------------------------------------------------

void Transceiver::read_txd(Ticks now) {
    if (next_sample() <= now) sample();
    if (telegram_over() <= now) hand_over();
    sends_ = rts.read() == sc_dt::SC_LOGIC_1;
    const bool level = !sends_ || txd.read() != sc_dt::SC_LOGIC_0;
    if (level == level_) return;
    level_ = level;
    line->drive(station_, level);
    if (!level && samples_ < 0) start_bit(now);
}

void Transceiver::start_bit(Ticks now) {
    character_ = now;
    samples_ = 0;
    frame_ = 0;
    if (!octets_.empty()) return;
    start_ = now;
    line->begins(station_);
}

Ticks Transceiver::next_sample() const { return samples_ < 0 ? kNever : character_ + samples_ * bit_ + bit_ / 2; }

void Transceiver::sample() {
    if (level_) frame_ |= 1u << samples_;
    if (++samples_ < kBits) return;
    samples_ = -1;
    octets_.push_back(static_cast<std::uint8_t>(frame_ >> 1));
    faults_.push_back(faults_of(frame_));
}

/// When the octets are handed over unless another character begins.
Ticks Transceiver::telegram_over() const {
    if (octets_.empty() || samples_ >= 0) return kNever;
    const bool whole = octets_.size() == telegram_length(octets_) || octets_.size() == kMaxTelegram;
    return character_ + kBits * bit_ + (whole ? 0 : bit_ / 2);
}

void Transceiver::hand_over() {
    // Characters of another rate may follow each other faster than theirs allows.
    const Ticks over = character_ + kBits * bit_, length = kBits * bit_ * static_cast<Ticks>(octets_.size());
    const Ticks start = std::min(start_, over - length);
    const Octets octets = std::move(octets_), faults = std::move(faults_);
    octets_.clear();
    faults_.clear();
    line->sent(station_, octets, faults, start);
    const auto good = static_cast<std::size_t>(std::count(faults.begin(), faults.end(), 0));
    if (good == faults.size()) return;
    report::warning(report::kTransceiver, *this, std::to_string(faults.size() - good) + " of " + std::to_string(faults.size()) +
                    " characters on TXD have wrong parity, start or stop bits at " + std::to_string(baud_) + " bit/s");
}

}  // namespace dpchip::tlm
