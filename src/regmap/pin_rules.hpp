// SPDX-License-Identifier: Apache-2.0
// What the package around the chip finds fault with (hardware reference 1, 2, 4, 7), and how a violated limit is packed into
// a finding. Numbers with words, like fact.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <dpchip/core/finding.hpp>
#include <dpchip/regmap/bus_timing.hpp>

namespace dpchip::regmap {

/// `rule` of a finding that layer pins made. detail: a pin number, or what is said.
enum class PinRule : std::uint16_t {
    timing,            ///< a numbered parameter of 10.7. detail: TimingViolation
    system_timing,     ///< an unnumbered one of 10.7.1. detail: TimingViolation, number: SystemTiming
    strap_changed,     ///< XINT/MOT or MODE changed outside RESET
    test_mode,         ///< XTEST1 = 0
    floating_input,    ///< an input without pull-down was let go
    no_reset,          ///< the processor accesses before the first RESET. detail: 0
    access_in_reset,   ///< strobe while RESET = 1; ignored. detail: 0
    both_strobes,      ///< XRD = 0 and XWR = 0; no access. detail: 0
    strobe_unseen,     ///< a strobe that no rising edge of CLK saw; no access. detail: 0
    bus_contention,    ///< processor and chip drive a DB pin against each other
    output_driven,     ///< the board drives a pin that is an output only; ignored
    txd_floats,        ///< sending without a pull-up on TXD
    count
};

struct PinRuleInfo {
    PinRule rule;
    core::FindingKind kind;
    std::string_view name, text;
};

// clang-format off
inline constexpr std::array<PinRuleInfo, static_cast<std::size_t>(PinRule::count)> kPinRules{{
    {PinRule::timing,          core::FindingKind::timing_violation, "timing",          "a limit of section 10.7 was violated"},
    {PinRule::system_timing,   core::FindingKind::timing_violation, "system_timing",   "a limit of section 10.7.1 was violated"},
    {PinRule::strap_changed,   core::FindingKind::misuse,           "strap_changed",   "XINT/MOT and MODE are straps: changed outside RESET (8.1.2)"},
    {PinRule::test_mode,       core::FindingKind::misuse,           "test_mode",       "XTEST1 belongs on VDD (8.4)"},
    {PinRule::floating_input,  core::FindingKind::misuse,           "floating_input",  "an input without pull-down is not driven: its last level is kept (3.1)"},
    {PinRule::no_reset,        core::FindingKind::misuse,           "no_reset",        "accessed before RESET was ever active (10.7.1)"},
    {PinRule::access_in_reset, core::FindingKind::misuse,           "access_in_reset", "accessed during RESET: ignored (8.1.2)"},
    {PinRule::both_strobes,    core::FindingKind::misuse,           "both_strobes",    "XRD and XWR are both low: no access (10.7.2, 10.7.3)"},
    {PinRule::strobe_unseen,   core::FindingKind::unusual,          "strobe_unseen",   "a strobe fell between two edges of CLK: no access (10.7.3)"},
    {PinRule::bus_contention,  core::FindingKind::misuse,           "bus_contention",  "processor and chip drive the data bus against each other"},
    {PinRule::output_driven,   core::FindingKind::misuse,           "output_driven",   "the board drives an output: ignored (3.1)"},
    {PinRule::txd_floats,      core::FindingKind::misuse,           "txd_floats",      "TXD has no pull-up: the line driver sees no level between transmissions (10.4)"},
}};
// clang-format on
static_assert([] {
    for (std::size_t i = 0; i < kPinRules.size(); ++i)
        if (kPinRules[i].rule != static_cast<PinRule>(i)) return false;
    return true;
}());
constexpr const PinRuleInfo& info(PinRule r) { return kPinRules[static_cast<std::size_t>(r)]; }

/// A violated limit as a finding carries it: 6 bits number, 1 bit supply, 25 bits of ticks with sign (+-279 us, saturated).
struct TimingViolation {
    std::uint8_t number{};
    Supply supply{};
    Ticks found{};

    bool operator==(const TimingViolation&) const = default;
};
inline constexpr std::int64_t kLargestFound = (1 << 24) - 1;

constexpr std::uint32_t pack(const TimingViolation& v) {
    const std::int64_t ticks = std::clamp(v.found.n, -kLargestFound, kLargestFound);
    return static_cast<std::uint32_t>(v.number) << 26 | static_cast<std::uint32_t>(v.supply) << 25 |
           (static_cast<std::uint32_t>(ticks) & 0x1FF'FFFFu);
}
constexpr TimingViolation unpack_violation(std::uint32_t detail) {
    const std::int64_t raw = detail & 0x1FF'FFFFu;
    return {static_cast<std::uint8_t>(detail >> 26), static_cast<Supply>((detail >> 25) & 1u),
            Ticks{raw > kLargestFound ? raw - 0x200'0000 : raw}};
}
static_assert(unpack_violation(pack({60, Supply::v5, Ticks{-1}})) == TimingViolation{60, Supply::v5, Ticks{-1}});

}  // namespace dpchip::regmap
