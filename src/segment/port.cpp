// SPDX-License-Identifier: Apache-2.0
// When a port may send, and what it keeps.
#include <dpchip/segment/port.hpp>

#include <algorithm>

namespace dpchip::segment {

namespace {

/// A request by its own station answers later than everything else: the bus stays reserved for the slot time.
std::int64_t idle_bits(std::span<const std::uint8_t> octets, const fdl::BusTimes& times) {
    const auto t = fdl::decode(octets);
    if (!t || t->size != octets.size()) return std::max(fdl::kTsynBits, times.tid1());
    if (!t->has_fc() || !t->fc.is_request()) return times.tid1();
    const fdl::Request r = t->fc.request();
    const bool answered = t->destination() != fdl::kBroadcast && !fdl::is_sdn(r) && r != fdl::Request::time_event;
    return answered ? times.tsl : times.tid2();
}

}  // namespace

bool Port::send(std::span<const std::uint8_t> octets) {
    if (waiting_ || octets.empty() || octets.size() > fdl::kMaxTelegram) return false;
    out_.assign({}, bit_, octets);
    const auto telegram = fdl::decode(octets);
    out_.damaged = !telegram || telegram->size != octets.size();
    out_.faults.fill(fdl::fault_none);
    waiting_ = true;
    exact_ = false;
    return true;
}

bool Port::send_at(Ticks at, std::span<const std::uint8_t> octets, std::span<const std::uint8_t> faults) {
    if (at < now_ || faults.size() > fdl::kMaxTelegram || !send(octets)) return false;
    std::ranges::copy(faults, out_.faults.begin());
    if (std::ranges::any_of(faults, [](std::uint8_t f) { return f != fdl::fault_none; })) out_.damaged = true;
    out_.start = at;
    exact_ = true;
    return true;
}

Ticks Port::start() const {
    if (exact_) return std::max(out_.start, own_end_);
    if (carrier_) return core::kNever;
    return std::max({now_, free_, own_end_, bit_ * times_.tid1()});  // a line never used has been idle since 0
}

Ticks Port::next() const {
    const Ticks send = begins();
    if (partial_.length == 0) return send;
    return std::min(send, partial_.end() + partial_.bit * fdl::kTsynBits);
}

void Port::advance(Ticks t) {
    now_ = t;
    if (partial_.length != 0 && t >= partial_.end() + partial_.bit * fdl::kTsynBits) flush();
}

bool Port::take(Transmission& t) {
    if (!waiting_ || start() > now_) return false;
    t = out_;
    t.start = now_;
    waiting_ = carrier_ = false;
    own_end_ = t.end();
    free_ = own_end_ + bit_ * idle_bits(t.bytes(), times_);
    return true;
}

void Port::carrier(Ticks at) {
    if (partial_.length != 0 && at > partial_.end()) flush();
    if (at >= own_end_) carrier_ = true;
}

void Port::hear(const Transmission& t) {
    flush();
    carrier_ = false;
    inbox_.push(t);
    free_ = t.end() + bit_ * idle_bits(t.bytes(), times_);
}

void Port::hear_character(const Character& c) {
    carrier_ = false;
    const bool follows = partial_.length != 0 && c.start == partial_.end();
    if (!follows || partial_.length == fdl::kMaxTelegram) flush();
    if (partial_.length == 0) {
        partial_.start = c.start;
        partial_.bit = c.bit;
        partial_.damaged = true;
    }
    partial_.octets[partial_.length] = c.octet;
    partial_.faults[partial_.length] = c.faults;
    ++partial_.length;
    free_ = c.end() + bit_ * std::max(fdl::kTsynBits, times_.tid1());
}

void Port::flush() {
    if (partial_.length != 0) inbox_.push(partial_);
    partial_.length = 0;
}

}  // namespace dpchip::segment
