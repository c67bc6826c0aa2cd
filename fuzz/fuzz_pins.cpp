// SPDX-License-Identifier: Apache-2.0
// Any edges at any pins at any time, in every mode, at both supplies and on every chip: the package never hangs, its outputs
// stay levels, their edges come in order of time, next() is never in the past and a copy goes on like the original.
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <dpchip/pins/package.hpp>

namespace {

using namespace dpchip;
using core::Ticks;
using pins::PinId;
using pins::PinLevel;

using Package = pins::Package<core::NoTrace>;

void require(bool condition) {
    if (!condition) __builtin_trap();
}

void drain(Package& package, Ticks& last) {
    while (!package.edges().empty()) {
        const pins::PinEdge e = package.edges().pop();
        require(e.at >= last && e.at <= package.now() && pins::is_output(e.pin));
        last = e.at;
    }
    while (!package.findings().empty()) require(package.findings().pop().rule < static_cast<unsigned>(regmap::PinRule::count));
    require(package.next() >= package.now());
}

/// An octet of time: steps of a quarter CLK, then of CLK, microseconds and milliseconds.
Ticks step(std::uint8_t octet) {
    constexpr std::array<Ticks, 4> kUnits{Ticks{313}, core::kClk, core::microseconds(1), core::milliseconds(1)};
    return kUnits[octet >> 6] * (octet & 0x3F);
}

/// As a test bench would: by events, so that no edge is lost. CLKOUT is watched for short times only.
void advance(Package& package, Ticks to, Ticks& last) {
    for (int steps = 0; package.next() < to; ++steps) {
        require(steps < 4'000'000);
        package.advance(package.next());
        drain(package, last);
    }
    package.advance(to);
    drain(package, last);
}

std::unique_ptr<Package> create(std::uint8_t head) {
    const auto variant = static_cast<regmap::Variant>(head % regmap::kVariants);
    const auto wanted = (head & 0x40u) != 0 ? regmap::Supply::v5 : regmap::Supply::v3_3;
    const auto supply = pins::works_at(variant, wanted) ? wanted : variant == regmap::Variant::apc3 ? regmap::Supply::v3_3 : regmap::Supply::v5;
    const pins::PackageOptions options{.txd_pull_up = (head & 0x20u) != 0, .line = (head & 0x80u) != 0 ? pins::LineSide::telegrams : pins::LineSide::pins};
    return std::make_unique<Package>(variant, supply, regmap::Options{}, options);
}

}  // namespace

/// Commands of two octets: what (pin and level, or an action), and how long to wait before.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::span<const std::uint8_t> rest{data, size};
    if (rest.size() < 2) return 0;
    const auto package = create(rest[0]);
    package->set_clock_phase(Ticks{rest[1] * 4});
    rest = rest.subspan(2);
    Ticks last{};
    for (std::size_t commands = 0; rest.size() >= 2 && commands < 2'000; ++commands, rest = rest.subspan(2)) {
        advance(*package, package->now() + step(rest[1]), last);
        const unsigned what = rest[0];
        const unsigned pin = what % 64 + 1;
        if (pins::is_pin(pin)) package->set_pin(static_cast<PinId>(pin), static_cast<PinLevel>(what / 64 % 3));
        else if (pin < 50) package->clock_edge(what >= 128 ? PinLevel::high : PinLevel::low, Ticks{rest[1]});
        else if (pin < 54) package->watch(PinId::clkout, what >= 128 && step(rest[1]) < core::microseconds(10));
        else if (pin < 56) *package = Package{*package};
        drain(*package, last);
        package->watch(PinId::clkout, false);
        for (unsigned n = 1; n <= pins::kPins; ++n) require(static_cast<unsigned>(package->pin(static_cast<PinId>(n))) <= 2);
    }
    Package copy = *package;
    Ticks copy_last = last;
    advance(*package, package->now() + core::microseconds(2), last);
    advance(copy, copy.now() + core::microseconds(2), copy_last);
    for (unsigned n = 1; n <= pins::kPins; ++n) require(package->pin(static_cast<PinId>(n)) == copy.pin(static_cast<PinId>(n)));
    require(package->edges().overflows() == 0);
    return 0;
}
