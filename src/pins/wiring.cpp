// SPDX-License-Identifier: Apache-2.0
// Wiring: a rule of the package after the other, pin by pin.
#include <dpchip/pins/wiring.hpp>

#include <algorithm>

#include <dpchip/core/assert.hpp>

namespace dpchip::pins {

namespace {

/// It forces a level on the pin, whoever else is there.
constexpr bool forces(const Connection& c) { return c.end == FarEnd::drives || c.end == FarEnd::both || c.end == FarEnd::vdd || c.end == FarEnd::gnd; }
constexpr bool is_strap(PinId pin) { return pin == PinId::xint_mot || pin == PinId::mode || pin == PinId::divider; }
constexpr bool is_test_pin(PinId pin) { return pin == PinId::xtest0 || pin == PinId::xtest1; }

std::string_view sentence(WiringRule rule) {
    switch (rule) {
    case WiringRule::open_input: return "an input that nothing drives (3.1)";
    case WiringRule::two_drivers: return "driven from two sides";
    case WiringRule::output_driven: return "an output, and the board drives it too (3.1)";
    case WiringRule::outputs_tied: return "tied to another output; it is never high-resistance (8.1.2)";
    case WiringRule::no_pull_up: return "without its pull-up the line driver sees no level between transmissions (3.1)";
    case WiringRule::data_bus: return "the data bus goes both ways (8.1.2)";
    case WiringRule::supply: return "a supply pin that is not on its rail (3.1)";
    case WiringRule::test_pin: return "a test pin belongs on VDD (8.4)";
    case WiringRule::strap: return "a strap is static, this one hangs on a line (8.1.2)";
    case WiringRule::unused_pin: return "unused in this mode, and on the wrong rail (8.1.2)";
    }
    return "";
}

}  // namespace

WiringText& WiringText::operator+=(std::string_view words) {
    const std::size_t n = std::min(words.size(), text_.size() - length_);
    std::copy_n(words.begin(), n, text_.begin() + static_cast<std::ptrdiff_t>(length_));
    length_ += n;
    return *this;
}

WiringText& WiringText::operator+=(unsigned number) {
    if (number >= 10) *this += number / 10;
    const char digit = static_cast<char>('0' + number % 10);
    return *this += std::string_view{&digit, 1};
}

WiringText text(const WiringFault& fault, Variant variant) {
    WiringText words;
    const auto name_pin = [&](PinId pin) {
        const PinInfo& p = info(pin);
        words += "pin ";
        words += p.number();
        words += " (";
        words += variant == Variant::apc3 ? p.apc3_name : p.name;
        words += ")";
    };
    name_pin(fault.pin);
    if (!fault.line.empty()) (words += ", line ") += fault.line;
    if (!fault.other_line.empty()) (words += " and ") += fault.other_line;
    if (fault.rule == WiringRule::outputs_tied) {
        words += ", together with ";
        name_pin(fault.other);
    }
    return (words += ": ") += sentence(fault.rule);
}

Wiring& Wiring::add(std::span<const Connection> connections) {
    DPCHIP_ASSERT(connections.size() <= kConnections - count_);
    const std::size_t n = std::min(connections.size(), kConnections - count_);
    std::copy_n(connections.begin(), n, connections_.begin() + static_cast<std::ptrdiff_t>(count_));
    count_ += n;
    return *this;
}

Wiring& Wiring::cut(PinId pin) {
    const auto end = connections_.begin() + static_cast<std::ptrdiff_t>(count_);
    count_ -= static_cast<std::size_t>(end - std::remove_if(connections_.begin(), end, [pin](const Connection& c) { return c.pin == pin; }));
    return *this;
}

bool Wiring::has(PinId pin, FarEnd end) const {
    return std::ranges::any_of(connections(), [&](const Connection& c) { return c.pin == pin && c.end == end; });
}

WiredLine Wiring::line(std::string_view name) const {
    WiredLine line;
    for (const Connection& c : connections()) {
        const bool wire = c.end == FarEnd::drives || c.end == FarEnd::listens || c.end == FarEnd::both;
        if (wire && c.line == name && line.count_ < kPins) line.ends_[line.count_++] = {c.pin, c.inverted};
    }
    return line;
}

std::optional<PinLevel> Wiring::tied(PinId pin) const {
    if (has_driver(pin)) return std::nullopt;
    if (has(pin, FarEnd::vdd)) return PinLevel::high;
    if (has(pin, FarEnd::gnd)) return PinLevel::low;
    if (has(pin, FarEnd::pull_up)) return PinLevel::high;
    if (has(pin, FarEnd::pull_down) || info(pin).input == InputType::cmos_pulldown) return PinLevel::low;
    return std::nullopt;
}

std::optional<ProcessorMode> Wiring::mode() const {
    const auto motorola = tied(PinId::xint_mot), synchronous = tied(PinId::mode);
    if (!motorola || !synchronous) return std::nullopt;
    return regmap::processor_mode(*motorola == PinLevel::high, *synchronous == PinLevel::high);
}

// ---- what is wrong ------------------------------------------------------------------------------------------------

/// By insertion, so that faults of one pin stay in order.
void WiringFaults::sort() {
    for (std::size_t i = 1; i < count_; ++i)
        for (std::size_t k = i; k > 0 && faults_[k].pin < faults_[k - 1].pin; --k) std::swap(faults_[k], faults_[k - 1]);
}

WiringFaults Wiring::check(bool with_4k) const {
    WiringFaults faults;
    for (const PinInfo& p : kPinTable) {
        switch (p.direction) {
        case PinDirection::supply: check_supply(p, faults); break;
        case PinDirection::input: check_input(p, faults); break;
        case PinDirection::output: check_output(p, faults); break;
        case PinDirection::bidirectional: check_data(p, faults); break;
        }
    }
    check_unused(with_4k, faults);
    faults.sort();
    return faults;
}

void Wiring::check_supply(const PinInfo& pin, WiringFaults& faults) const {
    const FarEnd right = pin.name == "VDD" ? FarEnd::vdd : FarEnd::gnd;
    const bool elsewhere = std::ranges::any_of(connections(), [&](const Connection& c) { return c.pin == pin.id && forces(c) && c.end != right; });
    if (!has(pin.id, right) || elsewhere) faults.push({WiringRule::supply, pin.id, {}, {}, {}});
}

void Wiring::check_input(const PinInfo& pin, WiringFaults& faults) const {
    const Connection* driver = nullptr;
    for (const Connection& c : connections()) {
        if (c.pin != pin.id || !forces(c)) continue;
        if (driver != nullptr) faults.push({WiringRule::two_drivers, pin.id, {}, driver->line, c.line});
        driver = &c;
    }
    const bool line = driver != nullptr && (driver->end == FarEnd::drives || driver->end == FarEnd::both);
    const auto level = tied(pin.id);
    if (driver == nullptr && !level) faults.push({WiringRule::open_input, pin.id, {}, {}, {}});
    if (line && is_strap(pin.id)) faults.push({WiringRule::strap, pin.id, {}, driver->line, {}});
    if (level == PinLevel::low && is_test_pin(pin.id)) faults.push({WiringRule::test_pin, pin.id, {}, {}, {}});
}

void Wiring::check_output(const PinInfo& pin, WiringFaults& faults) const {
    for (const Connection& c : connections()) {
        if (c.pin != pin.id) continue;
        if (forces(c)) faults.push({WiringRule::output_driven, pin.id, {}, c.line, {}});
        if (c.end != FarEnd::listens || c.inverted) continue;  // behind an inverter it is another net
        for (const Connection& d : connections()) {
            const bool later_output = d.pin > pin.id && info(d.pin).direction == PinDirection::output;
            if (later_output && d.end == FarEnd::listens && !d.inverted && d.line == c.line)
                faults.push({WiringRule::outputs_tied, pin.id, d.pin, c.line, {}});
        }
    }
    if (pin.id == PinId::txd && !has(pin.id, FarEnd::pull_up)) faults.push({WiringRule::no_pull_up, pin.id, {}, {}, {}});
}

void Wiring::check_data(const PinInfo& pin, WiringFaults& faults) const {
    const auto lines = std::ranges::count_if(connections(), [&](const Connection& c) { return c.pin == pin.id && c.end == FarEnd::both && !c.inverted; });
    const auto others = std::ranges::count_if(connections(), [&](const Connection& c) {
        return c.pin == pin.id && (c.end == FarEnd::drives || c.end == FarEnd::vdd || c.end == FarEnd::gnd || c.inverted);
    });
    if (lines != 1 || others != 0) faults.push({WiringRule::data_bus, pin.id, {}, {}, {}});
}

/// Pins 1, 2 and 24 where the mode does not use them (8.1.2).
void Wiring::check_unused(bool with_4k, WiringFaults& faults) const {
    const auto selected = mode();
    if (!selected) return;
    for (const BusPinFunctions& f : kBusPinFunctions) {
        const std::string_view function = (with_4k ? f.with_4k : f.with_2k)[static_cast<std::size_t>(*selected)];
        const auto level = tied(f.pin);
        if (!level || !function.starts_with("unused")) continue;
        if (to_level(function.ends_with("VDD")) != *level) faults.push({WiringRule::unused_pin, f.pin, {}, {}, {}});
    }
}

}  // namespace dpchip::pins
