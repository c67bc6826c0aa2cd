// SPDX-License-Identifier: Apache-2.0
// Biu: strobes in, accesses and output levels out.
#include <dpchip/pins/biu.hpp>

#include <algorithm>

namespace dpchip::pins {

using core::kNever;
using regmap::PinRule;

namespace {
Cycle cycle(bool write) { return write ? Cycle::write : Cycle::read; }
}  // namespace

void Biu::configure(ProcessorMode mode, Supply supply, const InputLevels& in) {
    mode_ = mode;
    supply_ = supply;
    phase_ = strobe(in) == Strobe::none ? Phase::idle : Phase::dead;
    drives_data_ = false;
    ready_ = PinLevel::high;
    access_at_ = data_at_ = ready_at_ = release_at_ = unready_at_ = kNever;
    latched_ = {};
}

Biu::Strobe Biu::strobe(const InputLevels& in) const {
    const auto motorola = [&](bool active) { return !active ? Strobe::none : in.is_high(PinId::xrd_r_w) ? Strobe::read : Strobe::write; };
    switch (mode_) {
    case ProcessorMode::sync_intel:
    case ProcessorMode::async_intel: {
        const bool read = !in.is_high(PinId::xrd_r_w), write = !in.is_high(PinId::xwr_e_clock_ab11);
        return read && write ? Strobe::both : read ? Strobe::read : write ? Strobe::write : Strobe::none;
    }
    case ProcessorMode::async_motorola: return motorola(!in.is_high(PinId::ale_as_ab11));
    case ProcessorMode::sync_motorola: return motorola(in.is_high(PinId::xwr_e_clock_ab11));
    }
    return Strobe::none;
}

/// XCS, or AB10..AB3 = 0 in synchronous Intel mode (8.1.4).
bool Biu::selected(const InputLevels& in) const {
    if (mode_ == ProcessorMode::sync_intel) return (in.number(kAddressBus) & 0x7F8u) == 0;
    return !in.is_high(PinId::xcs_ab11);
}

std::uint16_t Biu::address(const InputLevels& in, bool has_ab11) const {
    const unsigned ab11 = has_ab11 && in.is_high(ab11_pin(mode_)) ? 0x800u : 0u;
    const unsigned ab = in.number(kAddressBus);
    const unsigned low = mode_ == ProcessorMode::sync_intel ? (ab & 7u) << 8 | ale_latch_ : ab;
    return static_cast<std::uint16_t>(ab11 | low);
}

void Biu::pins_changed(const InputLevels& in, const Clk& clk, const BiuContext& context, Ticks now, TimingCheck& timing) {
    const Strobe s = strobe(in);
    const bool active = s != Strobe::none;
    if (phase_ == Phase::idle && active) {
        phase_ = Phase::waiting;
        strobe_began_ = now;
    }
    switch (phase_) {
    case Phase::idle: return;
    case Phase::waiting:
        if (!active) phase_ = Phase::idle;
        else if (selected(in)) open(clk, context, s, now, timing);
        return;
    case Phase::open:
        if (s == Strobe::both) return drop(timing, now);
        if (active && selected(in)) return;
        end(in, clk, context, now);
        phase_ = active ? Phase::ended : Phase::idle;
        if (!active) timing.close(now);
        return;
    case Phase::ended:
        if (active) return;
        phase_ = Phase::idle;
        timing.close(now);
        return;
    case Phase::dead:
        if (!active) phase_ = Phase::idle;
        return;
    }
}

void Biu::open(const Clk& clk, const BiuContext& context, Strobe s, Ticks now, TimingCheck& timing) {
    if (context.in_reset || s == Strobe::both) {
        complaints_.push(context.in_reset ? PinRule::access_in_reset : PinRule::both_strobes);
        phase_ = Phase::dead;
        return;
    }
    phase_ = Phase::open;
    write_ = s == Strobe::write;
    address_held_ = false;
    timing.open(cycle(write_), strobe_began_);
    clk_edge_ = clk.edge_from(now);
    access_at_ = clk_edge_ + regmap::kReadAccess;
    const regmap::InternalTiming& t = regmap::internal_timing(supply_);
    data_at_ = write_ ? kNever : clk_edge_ + t.data_valid;
    ready_at_ = regmap::synchronous(mode_) ? kNever : clk_edge_ + (context.early_ready ? t.early_ready : t.normal_ready);
}

/// Strobe or select has gone.
void Biu::end(const InputLevels& in, const Clk& clk, const BiuContext& context, Ticks now) {
    const bool seen = clk_edge_ < now;
    if (!seen) {
        complaints_.push(PinRule::strobe_unseen);
    } else if (write_) {
        if (!address_held_) address_ = address(in, context.has_ab11);
        latched_.push({clk.edge_from(now) + regmap::kWriteAccess, true, address_, static_cast<std::uint8_t>(in.number(kDataBus))});
    } else if (access_at_ != kNever) {
        latched_.push({access_at_, false, address(in, context.has_ab11), 0});
    }
    release(now);
}

/// DB and ready go back, as late as the chip may take.
void Biu::release(Ticks now) {
    const auto longest = [&](unsigned number) { return regmap::timing(number).at(supply_).max; };
    access_at_ = data_at_ = ready_at_ = kNever;
    if (drives_data_) release_at_ = now + longest(regmap::data_hold_number(mode_));
    if (ready_ == PinLevel::low) unready_at_ = now + longest(regmap::ready_hold_number(mode_));
}

/// Both strobes at once: what has not happened does not happen.
void Biu::drop(TimingCheck& timing, Ticks now) {
    complaints_.push(PinRule::both_strobes);
    timing.abandon();
    release(now);
    phase_ = Phase::dead;
}

Ticks Biu::next() const {
    const Ticks latched = latched_.empty() ? kNever : latched_.front().at;
    return std::min({latched, access_at_, data_at_, ready_at_, release_at_, unready_at_});
}

bool Biu::take(Ticks now, const InputLevels& in, bool has_ab11, Access& access) {
    if (!latched_.empty() && latched_.front().at <= now) {
        access = latched_.pop();
        return true;
    }
    if (access_at_ > now) return false;
    const Ticks at = access_at_;
    access_at_ = kNever;
    address_ = address(in, has_ab11);
    address_held_ = true;
    access = {at, false, address_, 0};
    return !write_;
}

void Biu::outputs_until(Ticks now) {
    const auto due = [now](Ticks& at) {
        if (at > now) return false;
        at = kNever;
        return true;
    };
    if (due(release_at_)) drives_data_ = false;
    if (due(unready_at_)) ready_ = PinLevel::high;
    if (due(data_at_)) drives_data_ = true;
    if (due(ready_at_)) ready_ = PinLevel::low;
}

}  // namespace dpchip::pins
