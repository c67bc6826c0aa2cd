// SPDX-License-Identifier: Apache-2.0
// Findings of the package in words.
#include <dpchip/trace/pin_finding_text.hpp>

#include <array>

#include <dpchip/regmap/pin_rules.hpp>

namespace dpchip::trace {
namespace {

using regmap::PinRule;

std::string limits_text(const regmap::TimingLimits& limits, core::Ticks found) {
    const bool short_of = found < limits.min;
    return (short_of ? "at least " : "at most ") + nanoseconds_text(short_of ? limits.min : limits.max) + " ns";
}

std::string numbered(const regmap::TimingViolation& v) {
    if (!regmap::is_timing_number(v.number)) return "timing " + std::to_string(v.number);
    const regmap::TimingParameter& p = regmap::timing(v.number);
    return "timing " + std::to_string(v.number) + ", " + std::string{p.name} + ": " + nanoseconds_text(v.found) + " ns, " +
           limits_text(p.at(v.supply), v.found) + " (" + std::string{regmap::name(v.supply)} + ", figure " + std::string{p.figure} + ")";
}

std::string unnumbered(const regmap::TimingViolation& v) {
    if (v.number >= regmap::kSystemTiming.size()) return "system_timing " + std::to_string(v.number);
    const regmap::SystemTimingParameter& p = regmap::kSystemTiming[v.number];
    const std::string symbol = p.symbol.empty() ? std::string{} : ' ' + std::string{p.symbol};
    return std::string{p.name} + symbol + ": " + nanoseconds_text(v.found) + " ns, " + limits_text(p.limits, v.found) + " (section 10.7.1)";
}

}  // namespace

std::string nanoseconds_text(core::Ticks t) {
    const std::uint64_t ticks = t.n < 0 ? ~static_cast<std::uint64_t>(t.n) + 1 : static_cast<std::uint64_t>(t.n);
    std::string text = (t.n < 0 ? "-" : "") + std::to_string(ticks / core::kTicksPerNs);
    std::uint64_t thousandths = ticks % core::kTicksPerNs * 1000 / core::kTicksPerNs;
    if (thousandths == 0) return text;
    std::string decimals = std::to_string(1000 + thousandths).substr(1);
    while (decimals.back() == '0') decimals.pop_back();
    return text + '.' + decimals;
}

std::string pin_finding_text(std::uint16_t rule, std::uint32_t detail) {
    if (rule >= regmap::kPinRules.size()) return "rule " + std::to_string(rule);
    if (static_cast<PinRule>(rule) == PinRule::timing) return numbered(regmap::unpack_violation(detail));
    if (static_cast<PinRule>(rule) == PinRule::system_timing) return unnumbered(regmap::unpack_violation(detail));
    const regmap::PinRuleInfo& info = regmap::kPinRules[rule];
    const std::string pin = detail == 0 ? std::string{} : " at pin " + std::to_string(detail);
    return std::string{info.name} + pin + ": " + std::string{info.text};
}

}  // namespace dpchip::trace
