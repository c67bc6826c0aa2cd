// SPDX-License-Identifier: Apache-2.0
// BusCycles: a cycle is a handful of actions at times; sorted, they are the edges of the timing diagrams.
#include <dpchip/pins/bus_cycles.hpp>

#include <algorithm>

#include <dpchip/core/bits.hpp>

namespace dpchip::pins {

namespace {
using namespace core::literals;
constexpr Ticks kLongAgo{-(std::int64_t{1} << 60)};
constexpr Ticks kReadyTimeout = 1_us;
}  // namespace

template <class Trace>
BusCycles<Trace>::BusCycles(Package<Trace>& package, ProcessorMode mode, bool with_ab11)
    : package_{&package}, mode_{mode}, with_ab11_{with_ab11}, times_{BusTimes::comfortable(mode, package.supply())}, fell_{kLongAgo}, rose_{kLongAgo},
      select_until_{kLongAgo}, lines_until_{kLongAgo}, r_w_until_{kLongAgo} {}

template <class Trace>
void BusCycles<Trace>::power_up(Ticks reset) {
    Package<Trace>& p = *package_;
    const bool motorola = regmap::motorola(mode_), synchronous = regmap::synchronous(mode_);
    p.set_pin(PinId::reset, PinLevel::high);
    p.set_pin(PinId::xint_mot, to_level(motorola));
    p.set_pin(PinId::mode, to_level(synchronous));
    p.set_pin(PinId::xcs_ab11, PinLevel::high);
    p.set_pin(PinId::xrd_r_w, PinLevel::high);
    p.set_pin(PinId::xwr_e_clock_ab11, to_level(!motorola));
    p.set_pin(PinId::ale_as_ab11, to_level(mode_ == ProcessorMode::async_motorola));
    move_address(0);
    if (with_ab11_) p.set_pin(ab11_pin(mode_), PinLevel::low);
    for (const PinId db : kDataBus) p.set_pin(db, PinLevel::z);
    move_to(p.now() + reset);
    p.set_pin(PinId::reset, PinLevel::low);
    planned_count_ = 0;
    address_lines_ = 0;
    r_w_high_ = true;
    fell_ = rose_ = select_until_ = lines_until_ = r_w_until_ = kLongAgo;
}

// ---- actions ----------------------------------------------------------------------------------------------------

template <class Trace>
void BusCycles<Trace>::plan(Action action) {
    DPCHIP_ASSERT(planned_count_ < planned_.size());
    std::size_t at = planned_count_++;
    for (; at > 0 && planned_[at - 1].at > action.at; --at) planned_[at] = planned_[at - 1];
    planned_[at] = action;
}

template <class Trace>
void BusCycles<Trace>::move_to(Ticks to) {
    if (to < package_->now()) return;
    if (mover_ != nullptr) mover_(mover_context_, to);
    else package_->advance(to);
}

template <class Trace>
void BusCycles<Trace>::run(Ticks to) {
    std::size_t done = 0;
    for (; done < planned_count_ && planned_[done].at <= to; ++done) {
        move_to(planned_[done].at);
        apply(planned_[done]);
    }
    std::copy(planned_.begin() + static_cast<std::ptrdiff_t>(done), planned_.begin() + static_cast<std::ptrdiff_t>(planned_count_), planned_.begin());
    planned_count_ -= done;
    move_to(to);
}

template <class Trace>
void BusCycles<Trace>::move_address(std::uint16_t lines) {
    for (std::size_t i = 0; i < kAddressBus.size(); ++i) package_->set_pin(kAddressBus[i], to_level(core::bit(lines, static_cast<unsigned>(i))));
    if (with_ab11_) package_->set_pin(ab11_pin(mode_), to_level(core::bit(lines, 11)));
}

template <class Trace>
void BusCycles<Trace>::apply(const Action& action) {
    switch (action.line) {
    case Line::address: return move_address(action.value);
    case Line::data:
        for (std::size_t i = 0; i < kDataBus.size(); ++i) package_->set_pin(kDataBus[i], to_level(core::bit(action.value, static_cast<unsigned>(i))));
        return;
    case Line::release_data:
        for (const PinId db : kDataBus) package_->set_pin(db, PinLevel::z);
        return;
    case Line::pin: return package_->set_pin(action.pin, action.level);
    }
}

template <class Trace>
void BusCycles<Trace>::advance(Ticks to) { run(to); }

template <class Trace>
void BusCycles<Trace>::settle() { run(std::max(package_->now(), rose_) + 100_ns); }

// ---- cycles -----------------------------------------------------------------------------------------------------

template <class Trace>
PinId BusCycles<Trace>::strobe_pin(Cycle cycle) const {
    switch (mode_) {
    case ProcessorMode::sync_intel:
    case ProcessorMode::async_intel: return cycle == Cycle::read ? PinId::xrd_r_w : PinId::xwr_e_clock_ab11;
    case ProcessorMode::async_motorola: return PinId::ale_as_ab11;
    case ProcessorMode::sync_motorola: return PinId::xwr_e_clock_ab11;
    }
    return PinId::xrd_r_w;
}

/// What AB shows for an address of the chip.
template <class Trace>
std::uint16_t BusCycles<Trace>::lines_of(std::uint16_t address) const {
    const unsigned a = address & (with_ab11_ ? 0xFFFu : 0x7FFu);
    if (mode_ != ProcessorMode::sync_intel) return static_cast<std::uint16_t>(a);
    return static_cast<std::uint16_t>((a >> 8 & 7u) | (a & 0x800u));
}

/// Early enough for the last cycle's holds and this one's set-ups.
template <class Trace>
Ticks BusCycles<Trace>::earliest_strobe(const CycleNumbers& n, Cycle cycle, std::uint16_t lines) const {
    const Ticks now = package_->now();
    Ticks at = std::max({now, fell_ + time(n.cycle), rose_ + time(n.inactive)});
    if (mode_ == ProcessorMode::sync_intel) {
        const Ticks ale_falls = std::max({now, rose_ + time(n.strobe_to_ale)}) + std::max(time(n.ale_width), time(n.address_to_ale));
        return std::max({at, ale_falls + time(n.ale_to_strobe), lines_until_ + time(n.address_to_ale) + time(n.ale_to_strobe)});
    }
    at = std::max({at, std::max({now, select_until_, fell_ + time(n.last_strobe_to_select)}) + time(n.select_setup)});
    if (lines != address_lines_) at = std::max(at, std::max(now, lines_until_) + time(n.address_setup));
    if (regmap::motorola(mode_) && r_w_high_ != (cycle == Cycle::read)) at = std::max(at, std::max(now, r_w_until_) + time(n.r_w_setup));
    return at;
}

template <class Trace>
void BusCycles<Trace>::begin(Cycle cycle, std::uint16_t address) {
    const CycleNumbers n = cycle_numbers(mode_, cycle);
    const std::uint16_t lines = lines_of(address);
    const Ticks strobe = earliest_strobe(n, cycle, lines);
    if (mode_ == ProcessorMode::sync_intel) {
        const Ticks ale_falls = strobe - time(n.ale_to_strobe), valid = ale_falls - time(n.address_to_ale);
        plan({valid, Line::address, {}, {}, lines});
        plan({valid, Line::data, {}, {}, static_cast<std::uint16_t>(address & 0xFFu)});
        plan_pin(ale_falls - time(n.ale_width), PinId::ale_as_ab11, true);
        plan_pin(ale_falls, PinId::ale_as_ab11, false);
        plan({ale_falls + time(n.address_after_ale), Line::release_data, {}, {}, 0});
    } else {
        if (lines != address_lines_) plan({strobe - time(n.address_setup), Line::address, {}, {}, lines});
        plan_pin(strobe - time(n.select_setup), PinId::xcs_ab11, false);
    }
    address_lines_ = lines;
    const bool read = cycle == Cycle::read;
    if (regmap::motorola(mode_) && r_w_high_ != read) plan_pin(strobe - time(n.r_w_setup), PinId::xrd_r_w, read);
    if (regmap::motorola(mode_)) r_w_high_ = read;
    plan_pin(strobe, strobe_pin(cycle), mode_ == ProcessorMode::sync_motorola);
    fell_ = strobe;
}

/// When the strobe ends: after its width, or with ready.
template <class Trace>
Ticks BusCycles<Trace>::wait_for_end(const CycleNumbers& n) {
    const Ticks shortest = fell_ + time(n.width);
    if (!times_.wait_for_ready) return shortest;
    run(fell_);
    const Ticks give_up = fell_ + kReadyTimeout;
    while (package_->pin(PinId::xready_xdtack) != PinLevel::low && package_->now() < give_up) run(std::min(give_up, std::max(package_->next(), package_->now() + Ticks{1})));
    ready_ = package_->now();
    return std::max(shortest, ready_);
}

/// What may move when the strobe is over.
template <class Trace>
void BusCycles<Trace>::after_strobe(const CycleNumbers& n) {
    if (mode_ != ProcessorMode::sync_intel) {
        select_until_ = rose_ + time(n.select_hold);
        plan_pin(select_until_, PinId::xcs_ab11, true);
    }
    lines_until_ = rose_ + time(n.address_hold);
    r_w_until_ = rose_ + time(n.r_w_hold);
    if (!times_.busy_bus) return;
    address_lines_ = static_cast<std::uint16_t>(address_lines_ ^ 0xFFFu);
    plan({lines_until_, Line::address, {}, {}, address_lines_});
    if (!regmap::motorola(mode_)) return;
    r_w_high_ = !r_w_high_;
    plan_pin(r_w_until_, PinId::xrd_r_w, r_w_high_);
}

template <class Trace>
void BusCycles<Trace>::finish(Cycle cycle, std::uint8_t value) {
    const CycleNumbers n = cycle_numbers(mode_, cycle);
    const bool write = cycle == Cycle::write;
    if (write && times_.wait_for_ready) plan({std::max(fell_, package_->now()), Line::data, {}, {}, value});
    rose_ = wait_for_end(n);
    if (write && !times_.wait_for_ready) plan({rose_ - time(n.data_setup), Line::data, {}, {}, value});
    if (write) plan({rose_ + time(n.data_hold), Line::release_data, {}, {}, 0});
    after_strobe(n);
    plan_pin(rose_, strobe_pin(cycle), mode_ != ProcessorMode::sync_motorola);
}

template <class Trace>
std::uint8_t BusCycles<Trace>::read(std::uint16_t address) {
    begin(Cycle::read, address);
    finish(Cycle::read, 0);
    run(rose_ - Ticks{1});
    move_to(rose_);
    unsigned value = 0;
    for (std::size_t i = 0; i < kDataBus.size(); ++i) value |= (package_->pin(kDataBus[i]) != PinLevel::low ? 1u : 0u) << i;
    run(rose_);
    return static_cast<std::uint8_t>(value);
}

template <class Trace>
void BusCycles<Trace>::write(std::uint16_t address, std::uint8_t value) {
    begin(Cycle::write, address);
    finish(Cycle::write, value);
    run(rose_);
}

template <class Trace>
void BusCycles<Trace>::read_block(std::uint16_t address, std::span<std::uint8_t> out) {
    for (std::uint8_t& octet : out) octet = read(address++);
}

template <class Trace>
void BusCycles<Trace>::write_block(std::uint16_t address, std::span<const std::uint8_t> in) {
    for (const std::uint8_t octet : in) write(address++, octet);
}

template class BusCycles<core::NoTrace>;
template class BusCycles<core::RingTrace>;

}  // namespace dpchip::pins
