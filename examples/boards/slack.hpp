// SPDX-License-Identifier: Apache-2.0
// How much a board has to spare: of every timing parameter of section 10.7 that the processor owes the chip, the shortest time
// that the pins have shown.
//
// It looks at levels and knows the parameter table, nothing else: a second opinion beside the package's own check.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include <dpchip/pins/package.hpp>

namespace boards {

using namespace dpchip;
using core::Ticks;
using pins::PinId;

struct Slack {
    unsigned number = 0;   ///< of the parameter
    Ticks found{}, spare{};
};

class SlackMeter {
public:
    explicit SlackMeter(pins::Supply supply) : supply_{supply} { last_.fill(kNotYet); }

    /// The inputs have changed, or not.
    void look(const pins::Package<>& package, Ticks now) {
        const Levels levels = look_at(package);
        const std::uint64_t changed = (levels.high ^ levels_.high) | (levels.driven ^ levels_.driven);
        levels_ = levels;
        const bool settled = was_settled_ && !package.in_reset();
        was_settled_ = !package.in_reset();
        if (changed == 0 || !settled) return;
        mode_ = package.mode();
        for (unsigned pin = 1; pin <= pins::kPins; ++pin)
            if (((changed >> pin) & 1u) != 0) note(static_cast<PinId>(pin), levels.is_high(static_cast<PinId>(pin)), now);
    }
    /// The tightest so far.
    std::optional<Slack> tightest() const {
        std::optional<Slack> tightest;
        for (const Slack& s : least_)
            if (s.number != 0 && (!tightest || s.spare < tightest->spare)) tightest = s;
        return tightest;
    }
    Ticks shortest_cycle() const { return shortest_cycle_; }
    const std::array<Slack, regmap::kTimingParameters>& all() const { return least_; }

private:
    using Event = regmap::BusEvent;
    static constexpr Ticks kNotYet{-(std::int64_t{1} << 60)};

    struct Levels {
        std::uint64_t high = 0, driven = 0;  ///< one bit each at the pin's number
        bool is_high(PinId pin) const { return ((high >> static_cast<unsigned>(pin)) & 1u) != 0; }
    };

    /// While the chip drives DB, the processor does not.
    Levels look_at(const pins::Package<>& package) const {
        Levels levels;
        const auto take = [&](PinId pin) {
            const std::uint64_t bit = std::uint64_t{1} << static_cast<unsigned>(pin);
            const pins::PinLevel level = package.pin(pin);
            if (level == pins::PinLevel::high) levels.high |= bit;
            if (level != pins::PinLevel::z) levels.driven |= bit;
            return bit;
        };
        std::uint64_t data = 0;
        for (const PinId pin : pins::kDataBus) data |= take(pin);
        if (package.biu().drives_data()) {
            levels.high = levels_.high & data;
            levels.driven = levels_.driven & data;
        }
        for (const PinId pin : pins::kAddressBus) take(pin);
        for (const PinId pin : {PinId::xcs_ab11, PinId::xwr_e_clock_ab11, PinId::xrd_r_w, PinId::ale_as_ab11}) take(pin);
        return levels;
    }
    static bool is_data(PinId pin) { return pins::info(pin).direction == pins::PinDirection::bidirectional; }

    void note(PinId pin, bool high, Ticks now) {
        const bool motorola = regmap::motorola(mode_), synchronous = regmap::synchronous(mode_);
        const auto strobe = [&](Event falls, Event rises, bool opens, regmap::Cycle cycle) {
            if (opens) open(cycle, now);
            if (selected_) event(high ? rises : falls, now);
        };
        if (is_data(pin)) return event(Event::data_changes, now);
        if (pin == PinId::xrd_r_w && !motorola) return strobe(Event::xrd_falls, Event::xrd_rises, !high, regmap::Cycle::read);
        if (pin == PinId::xwr_e_clock_ab11 && !motorola) return strobe(Event::xwr_falls, Event::xwr_rises, !high, regmap::Cycle::write);
        const regmap::Cycle by_r_w = levels_.is_high(PinId::xrd_r_w) ? regmap::Cycle::read : regmap::Cycle::write;
        if (pin == PinId::xwr_e_clock_ab11 && synchronous) return strobe(Event::e_falls, Event::e_rises, high, by_r_w);
        if (pin == PinId::ale_as_ab11 && motorola && !synchronous) return strobe(Event::as_falls, Event::as_rises, !high, by_r_w);
        if (pin == PinId::ale_as_ab11 && !motorola && synchronous) return event(high ? Event::ale_rises : Event::ale_falls, now);
        if (pin == PinId::xrd_r_w) return event(Event::r_w_changes, now);
        if (pin == PinId::xcs_ab11 && mode_ != regmap::ProcessorMode::sync_intel) return event(high ? Event::xcs_rises : Event::xcs_falls, now);
        const bool address = std::ranges::find(pins::kAddressBus, pin) != pins::kAddressBus.end() || pin == pins::ab11_pin(mode_);
        if (address) event(Event::address_changes, now);
    }
    void open(regmap::Cycle cycle, Ticks now) {
        cycle_ = cycle;
        selected_ = mode_ == regmap::ProcessorMode::sync_intel
                        ? std::none_of(pins::kAddressBus.begin() + 3, pins::kAddressBus.end(), [this](PinId ab) { return levels_.is_high(ab); })
                        : !levels_.is_high(PinId::xcs_ab11);
        if (!selected_) return;
        if (opened_ != kNotYet) shortest_cycle_ = std::min(shortest_cycle_, now - opened_);
        opened_ = now;
    }
    void event(Event e, Ticks now) {
        for (const regmap::TimingParameter& p : regmap::kBusTiming) {
            if (p.mode != mode_ || p.kind != regmap::TimingKind::check || !p.to.has(e) || !regmap::covers(p.cycle, cycle_)) continue;
            Ticks from = kNotYet;
            for (std::size_t i = 0; i < regmap::kBusEvents; ++i)
                if (p.from.has(static_cast<Event>(i))) from = std::max(from, last_[i]);
            if (from == kNotYet) continue;
            Slack& least = least_[regmap::timing_index(p.number)];
            const Slack s{p.number, now - from, now - from - p.at(supply_).min};
            if (least.number == 0 || s.spare < least.spare) least = s;
        }
        last_[static_cast<std::size_t>(e)] = now;
    }

    pins::Supply supply_;
    pins::ProcessorMode mode_{};
    Levels levels_;
    bool was_settled_ = false;
    bool selected_ = false;  ///< the last strobe was for the chip; those of others do not count
    regmap::Cycle cycle_ = regmap::Cycle::read;
    Ticks opened_ = kNotYet, shortest_cycle_ = core::kNever;
    std::array<Ticks, regmap::kBusEvents> last_{};
    std::array<Slack, regmap::kTimingParameters> least_{};
};

}  // namespace boards
