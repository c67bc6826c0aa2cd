// SPDX-License-Identifier: Apache-2.0
// Circuit: planned edges in the order of time.
#include "circuit.hpp"

#include <algorithm>

namespace boards {

Circuit::Circuit(pins::Package<>& package, const pins::Wiring& wiring)
    : package_{&package}, wiring_{&wiring}, transceiver_{package, wiring}, slack_{package.supply()} {
    for (const pins::PinInfo& p : pins::kPinTable) package.watch(p.id, false);  // levels are enough
    line_.attach(transceiver_);
}

void Circuit::insert(const Action& action) {
    const auto place = std::ranges::upper_bound(planned_, action.at, {}, &Action::at);
    planned_.insert(place, action);
}

Ticks Circuit::next() const { return planned_.empty() ? line_.next() : std::min(line_.next(), planned_.front().at); }

void Circuit::run(Ticks to) {
    while (!planned_.empty() && planned_.front().at <= to) {
        const Action action = planned_.front();
        planned_.erase(planned_.begin());
        line_.advance(std::max(action.at, line_.now()));
        apply(action);
    }
    line_.advance(std::max(to, line_.now()));
}

void Circuit::apply(const Action& action) {
    const auto& lines = action.signal->lines();
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const PinLevel level = action.release ? PinLevel::z : pins::to_level(((action.value >> i) & 1u) != 0);
        lines[i].drive(*package_, level);
    }
    slack_.look(*package_, now());
}

std::uint32_t Circuit::value(const Signal& signal) const {
    std::uint32_t value = 0;
    const auto& lines = signal.lines();
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (lines[i].level(*package_) != PinLevel::low) value |= 1u << i;
    return value;
}

bool Circuit::floats(const Signal& signal) const {
    return std::ranges::any_of(signal.lines(), [this](const pins::WiredLine& l) { return l.level(*package_) == PinLevel::z; });
}

}  // namespace boards
