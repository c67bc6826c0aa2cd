// SPDX-License-Identifier: Apache-2.0
// Package: what each pin does when it moves, and the order of things in a tick.
#include <dpchip/pins/package.hpp>

#include <algorithm>
#include <bit>

#include <dpchip/core/bits.hpp>
#include <dpchip/pins/clock_out.hpp>
#include <dpchip/regmap/address.hpp>
#include <dpchip/regmap/fact.hpp>

namespace dpchip::pins {

namespace {

using core::kNever;
using regmap::PinRule;

constexpr std::uint64_t bit_of(PinId pin) { return std::uint64_t{1} << core::to_underlying(pin); }
constexpr std::size_t slot(PinId pin) { return core::to_underlying(pin); }

/// What an idle board holds at 1.
constexpr InputLevels idle_board() {
    InputLevels in;
    for (const PinId pin : {PinId::xcs_ab11, PinId::xwr_e_clock_ab11, PinId::xrd_r_w, PinId::rxd, PinId::xtest0, PinId::xtest1}) in.set(pin, true);
    return in;
}

constexpr std::uint64_t pins_that(bool (*property)(PinId)) {
    std::uint64_t mask = 0;
    for (const PinInfo& p : kPinTable)
        if (property(p.id)) mask |= bit_of(p.id);
    return mask;
}
constexpr bool is_data(PinId pin) { return info(pin).direction == PinDirection::bidirectional; }
constexpr std::uint64_t kOutputs = pins_that(is_output), kData = pins_that(is_data), kInputs = pins_that(is_input);

PinLevel from_chip(chip::Level level) { return to_level(level == chip::Level::high); }

PinId pin_of(chip::Pin pin) {
    switch (pin) {
    case chip::Pin::x_int: return PinId::x_int;
    case chip::Pin::rts: return PinId::rts;
    case chip::Pin::xdataexch_sync: return PinId::xdataexch_sync;
    }
    return PinId::x_int;
}

constexpr std::uint8_t kAllChipPins = 0x07;
constexpr std::array<chip::Pin, 3> kChipPins{chip::Pin::x_int, chip::Pin::rts, chip::Pin::xdataexch_sync};

}  // namespace

template <class Trace>
Package<Trace>::Package(Variant variant, Supply supply, const regmap::Options& chip_options, const PackageOptions& options)
    : chip_{variant, chip_options}, options_{options}, supply_{supply}, in_{idle_board()}, driven_{kInputs & ~kData},
      watched_{kOutputs & ~bit_of(PinId::clkout)} {
    DPCHIP_ASSERT(works_at(variant, supply));
    chip_.watch(kAllChipPins);
    chip_.watch_ram(true);
    biu_.configure(ProcessorMode::async_intel, supply_, in_);
    timing_.configure(ProcessorMode::async_intel, supply_);
    out_.fill(PinLevel::z);
    shown_.fill(PinLevel::z);
    out_[slot(PinId::xready_xdtack)] = PinLevel::high;
    for (const chip::Pin p : kChipPins) out_[slot(pin_of(p))] = from_chip(chip_.level(p));
    update_clkout();
    refresh_all();
    edges_ = {};
}

// ---- time -------------------------------------------------------------------------------------------------------

template <class Trace>
Ticks Package<Trace>::next() const {
    const Ticks chip = options_.line == LineSide::pins ? uart_.next(chip_) : chip_.next();
    const bool clock = (watched_ & bit_of(PinId::clkout)) != 0 && in_.is_high(PinId::xtest0);
    const Ticks clkout = clock ? clock_out::next(clk_, in_.is_high(PinId::divider), now_) : kNever;
    return std::max(now_, std::min({chip, biu_.next(), clkout}));
}

template <class Trace>
void Package<Trace>::advance(Ticks to) {
    run(to);
    sample();
}

template <class Trace>
void Package<Trace>::run(Ticks to) {
    DPCHIP_ASSERT(to >= now_);
    for (Ticks at = next(); at < to; at = next()) run_to(at, true);
    run_to(to, false);
}

template <class Trace>
void Package<Trace>::sample() {
    if (options_.line != LineSide::pins) return;
    uart_.sample(chip_);
    drain_chip();
    drain_uart();
}

template <class Trace>
void Package<Trace>::set_rxd(Ticks at, PinLevel level) {
    if (at > now_) run(at);
    set_pin(PinId::rxd, level);
}

template <class Trace>
void Package<Trace>::run_to(Ticks at, bool samples) {
    now_ = at;
    move_chip(at, samples);
    serve_bus();
    update_clkout();
}

template <class Trace>
void Package<Trace>::move_chip(Ticks at, bool samples) {
    if (options_.line != LineSide::pins) chip_.advance(at);
    else if (samples) uart_.advance(chip_, at);
    else uart_.run(chip_, at);
    drain_chip();
    drain_uart();
}

template <class Trace>
void Package<Trace>::serve_bus() {
    Access access;
    while (biu_.take(now_, in_, has_ab11(), access)) {
        if (dpc_.bus(access.at)) chip_.trace().emit([&] {
            return core::TraceRecord{now_, static_cast<std::uint16_t>(regmap::Fact::ram_wait), 0, static_cast<std::uint32_t>(dpc_.counters().collisions)};
        });
        if (access.write) chip_.write(access.address, access.value);
        else biu_.read_value(chip_.read(access.address));
        drain_chip();
    }
    biu_.outputs_until(now_);
    update_bus_outputs();
}

template <class Trace>
void Package<Trace>::drain_chip() {
    for (auto& uses = chip_.ram_uses(); !uses.empty();) {
        const chip::RamUse use = uses.pop();
        dpc_.sequencer(use.at, use.octets, clk_);
    }
    for (auto& edges = chip_.edges(); !edges.empty();) {
        const chip::Edge e = edges.pop();
        drive(pin_of(e.pin), from_chip(e.level), e.at);
        if (e.pin == chip::Pin::rts && !options_.txd_pull_up && options_.line == LineSide::pins && !floats_noted_) {
            floats_noted_ = true;
            find(PinRule::txd_floats, core::to_underlying(PinId::txd));
        }
    }
}

template <class Trace>
void Package<Trace>::drain_uart() {
    for (auto& edges = uart_.edges(); !edges.empty();) {
        const PinEdge e = edges.pop();
        drive(e.pin, e.level, e.at);
    }
}

// ---- outputs ----------------------------------------------------------------------------------------------------

template <class Trace>
PinLevel Package<Trace>::visible(PinId pin) const {
    const PinLevel level = in_.is_high(PinId::xtest0) ? out_[slot(pin)] : PinLevel::z;
    return pin == PinId::txd && level == PinLevel::z && options_.txd_pull_up ? PinLevel::high : level;
}

template <class Trace>
void Package<Trace>::drive(PinId pin, PinLevel level, Ticks at) {
    out_[slot(pin)] = level;
    const PinLevel shows = visible(pin);
    if (shows == shown_[slot(pin)]) return;
    shown_[slot(pin)] = shows;
    if ((watched_ & bit_of(pin)) != 0) edges_.push({at, pin, shows});
}

/// XTEST0 has changed: every output shows something else.
template <class Trace>
void Package<Trace>::refresh_all() {
    for (const PinInfo& p : kPinTable)
        if (is_output(p.id)) drive(p.id, out_[slot(p.id)], now_);
}

template <class Trace>
void Package<Trace>::update_bus_outputs() {
    drive(PinId::xready_xdtack, biu_.ready(), now_);
    const bool began = biu_.drives_data() && out_[slot(PinId::db0)] == PinLevel::z;
    for (std::size_t i = 0; i < kDataBus.size(); ++i)
        drive(kDataBus[i], biu_.drives_data() ? to_level(core::bit(biu_.data(), static_cast<unsigned>(i))) : PinLevel::z, now_);
    if (!biu_.drives_data()) contention_noted_ = false;
    if (began) check_contention();
}

template <class Trace>
void Package<Trace>::update_clkout() {
    drive(PinId::clkout, clock_out::level(clk_, in_.is_high(PinId::divider), now_), now_);
}

template <class Trace>
PinLevel Package<Trace>::pin(PinId pin) const {
    if (pin == PinId::clkout && in_.is_high(PinId::xtest0)) return clock_out::level(clk_, in_.is_high(PinId::divider), now_);
    if (is_output(pin) && shown_[slot(pin)] != PinLevel::z) return shown_[slot(pin)];
    if (info(pin).direction == PinDirection::supply) return to_level(info(pin).name == "VDD");
    if (pin == PinId::txd) return visible(pin);
    if (is_input(pin) && ((driven_ & bit_of(pin)) != 0 || info(pin).input == InputType::cmos_pulldown)) return to_level(in_.is_high(pin));
    return PinLevel::z;
}

template <class Trace>
void Package<Trace>::watch(PinId pin, bool on) {
    watched_ = on ? watched_ | (bit_of(pin) & kOutputs) : watched_ & ~bit_of(pin);
    if (pin == PinId::clkout) shown_[slot(pin)] = this->pin(pin);
}

template <class Trace>
void Package<Trace>::set_options(const PackageOptions& options) {
    options_ = options;
    refresh_all();
}

// ---- inputs -----------------------------------------------------------------------------------------------------

template <class Trace>
void Package<Trace>::set_pin(PinId pin, PinLevel level) {
    if (!is_input(pin)) {
        if (is_output(pin) && level != PinLevel::z) find(PinRule::output_driven, core::to_underlying(pin));
        return;
    }
    if (pin == PinId::clk) return level == PinLevel::z ? void() : clock_edge(level);
    const bool was_high = in_.is_high(pin), was_driven = (driven_ & bit_of(pin)) != 0;
    if (level == PinLevel::z) {
        driven_ &= ~bit_of(pin);
        if (info(pin).input == InputType::cmos_pulldown) in_.set(pin, false);
        else if (!is_data(pin) && was_driven) find(PinRule::floating_input, core::to_underlying(pin));
    } else {
        driven_ |= bit_of(pin);
        in_.set(pin, level == PinLevel::high);
    }
    const bool lets_go = is_data(pin) && was_driven != ((driven_ & bit_of(pin)) != 0);
    if (in_.is_high(pin) != was_high || lets_go) input_changed(pin);
}

template <class Trace>
void Package<Trace>::input_changed(PinId pin) {
    if (pin == PinId::reset) return reset_changed();
    if (pin == PinId::xint_mot || pin == PinId::mode) return strap_changed(pin);
    if (pin == PinId::xtest0) return refresh_all();
    if (pin == PinId::divider) return update_clkout();
    if (pin == PinId::rxd || pin == PinId::xcts) return line_changed(pin);
    if (pin != PinId::xtest1) return bus_pin_changed(pin);
    if (!in_.is_high(pin)) find(PinRule::test_mode, core::to_underlying(pin));
}

template <class Trace>
void Package<Trace>::line_changed(PinId pin) {
    const bool high = in_.is_high(pin);
    if (options_.line == LineSide::pins) {
        if (pin == PinId::rxd) uart_.set_rxd(chip_, now_, to_level(high));
        else uart_.set_xcts(chip_, now_, to_level(high));
    } else if (pin == PinId::xcts) {
        chip_.set_xcts(high ? chip::Level::high : chip::Level::low);
    }
    drain_chip();
    drain_uart();
}

template <class Trace>
void Package<Trace>::reset_changed() {
    if (!in_reset()) {
        const Ticks width = now_ - reset_since_;
        if (!regmap::timing(regmap::SystemTiming::reset_width).limits.meets(width))
            violated(PinRule::system_timing, core::to_underlying(regmap::SystemTiming::reset_width), width, now_);
        biu_.configure(biu_.mode(), supply_, in_);
        timing_.configure(biu_.mode(), supply_);
        return;
    }
    reset_since_ = now_;
    was_reset_ = true;
    floats_noted_ = contention_noted_ = false;
    chip_.reset();
    uart_.reset(chip_);
    biu_.configure(biu_.mode(), supply_, in_);
    drain_chip();
    drain_uart();
    drive(PinId::txd, uart_.txd(), now_);
    update_bus_outputs();
}

template <class Trace>
void Package<Trace>::strap_changed(PinId pin) {
    if (!in_reset() && was_reset_) find(PinRule::strap_changed, core::to_underlying(pin));
    const ProcessorMode mode = regmap::processor_mode(in_.is_high(PinId::xint_mot), in_.is_high(PinId::mode));
    biu_.configure(mode, supply_, in_);
    timing_.configure(mode, supply_);
    chip_.set_bus_mode(regmap::motorola(mode) ? chip::BusMode::motorola : chip::BusMode::intel);
    update_bus_outputs();
}

/// Which event of the timing table a pin's change is; strobes are the Biu's business.
template <class Trace>
void Package<Trace>::note_bus_event(PinId pin) {
    using regmap::BusEvent;
    const bool high = in_.is_high(pin);
    const ProcessorMode mode = biu_.mode();
    if (is_data(pin)) return bus_event(BusEvent::data_changes);
    if (pin == ab11_pin(mode)) return uses_ab11() ? bus_event(BusEvent::address_changes) : void();
    if (pin == PinId::xcs_ab11) return bus_event(high ? BusEvent::xcs_rises : BusEvent::xcs_falls);
    if (pin == PinId::xrd_r_w) return regmap::motorola(mode) ? bus_event(BusEvent::r_w_changes) : void();
    if (pin == PinId::xwr_e_clock_ab11) return;
    if (pin != PinId::ale_as_ab11) return bus_event(BusEvent::address_changes);
    if (mode != ProcessorMode::sync_intel) return;
    bus_event(high ? BusEvent::ale_rises : BusEvent::ale_falls);
    if (!high) biu_.latch(in_);
}

template <class Trace>
void Package<Trace>::bus_event(regmap::BusEvent e) {
    if (!in_reset()) timing_.event(e, now_);
}

template <class Trace>
void Package<Trace>::bus_pin_changed(PinId pin) {
    note_bus_event(pin);
    const bool early = (chip_.state().mode0 & regmap::mode0::early_rdy) != 0;
    const bool was_busy = biu_.busy();
    biu_.pins_changed(in_, clk_, {in_reset(), early, has_ab11()}, now_, timing_);
    if (!was_busy && biu_.busy() && !was_reset_ && !no_reset_noted_) {
        no_reset_noted_ = true;
        find(PinRule::no_reset, 0);
    }
    while (!biu_.complaints().empty()) find(biu_.complaints().pop(), 0);
    drain_timing();
    if (is_data(pin) && biu_.drives_data()) check_contention();
}

/// The board drives DB against the chip in the strobe. After it the chip holds its data on for some nanoseconds, and the next
/// address of a multiplexed bus may come before it lets go.
template <class Trace>
void Package<Trace>::check_contention() {
    if (contention_noted_ || !biu_.answers_strobe() || !in_.is_high(PinId::xtest0)) return;
    for (const PinId pin : kDataBus) {
        const bool against = (driven_ & bit_of(pin)) != 0 && to_level(in_.is_high(pin)) != out_[slot(pin)];
        if (!against) continue;
        contention_noted_ = true;
        return find(PinRule::bus_contention, core::to_underlying(pin));
    }
}

// ---- clock ------------------------------------------------------------------------------------------------------

template <class Trace>
void Package<Trace>::set_clock_phase(Ticks phase) {
    DPCHIP_ASSERT(phase >= Ticks{} && phase < core::kClk);
    clk_ = Clk{phase};
    uart_ = BasicUart<Chip>{phase};
    uart_.reset(chip_);
    uart_.set_rxd(chip_, now_, to_level(in_.is_high(PinId::rxd)));
    drain_uart();
    update_clkout();
}

template <class Trace>
void Package<Trace>::clock_edge(PinLevel level, Ticks slope) {
    clk_.drive(level, now_, slope, [&](regmap::SystemTiming what, Ticks found) {
        violated(PinRule::system_timing, core::to_underlying(what), found, now_);
    });
    update_clkout();
}

// ---- findings ---------------------------------------------------------------------------------------------------

template <class Trace>
void Package<Trace>::drain_timing() {
    while (!timing_.violations().empty()) {
        const Violation v = timing_.violations().pop();
        violated(PinRule::timing, v.number, v.found, v.at);
    }
}

template <class Trace>
void Package<Trace>::violated(regmap::PinRule rule, std::uint8_t number, Ticks found, Ticks at) {
    if (!options_.check_timing) return;
    const std::uint32_t detail = regmap::pack({number, supply_, found});
    ++violations_[0];
    if (rule == PinRule::timing) ++violations_[number];
    failed_ = failed_ || options_.fatal;
    findings_.push({at, core::FindingKind::timing_violation, core::to_underlying(rule), detail});
    chip_.trace().emit([&] {
        return core::TraceRecord{at, static_cast<std::uint16_t>(regmap::Fact::pin_finding), core::to_underlying(rule), detail};
    });
}

template <class Trace>
void Package<Trace>::find(regmap::PinRule rule, std::uint32_t detail) {
    findings_.push({now_, regmap::info(rule).kind, core::to_underlying(rule), detail});
    chip_.trace().emit([&] {
        return core::TraceRecord{now_, static_cast<std::uint16_t>(regmap::Fact::pin_finding), core::to_underlying(rule), detail};
    });
}

// ---- telegrams --------------------------------------------------------------------------------------------------

template <class Trace>
void Package<Trace>::hear(const fdl::Transmission& t) {
    chip_.hear(t);
    drain_chip();
}

template <class Trace>
void Package<Trace>::hear_character(const fdl::Character& c) {
    chip_.hear_character(c);
    drain_chip();
}

template <class Trace>
void Package<Trace>::carrier(Ticks at) {
    chip_.carrier(at);
    drain_chip();
}

template <class Trace>
bool Package<Trace>::take(fdl::Transmission& t) { return options_.line == LineSide::telegrams && chip_.take(t); }

template <class Trace>
void Package<Trace>::sent(Ticks at) { chip_.sent(at); }

template class Package<core::NoTrace>;
template class Package<core::RingTrace>;

}  // namespace dpchip::pins
