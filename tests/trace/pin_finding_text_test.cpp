// SPDX-License-Identifier: Apache-2.0
// Findings of the package in words, whatever numbers a record holds.
#include <gtest/gtest.h>

#include <dpchip/core/bits.hpp>
#include <dpchip/regmap/pin_rules.hpp>
#include <dpchip/trace/pin_finding_text.hpp>

namespace dpchip::trace {
namespace {

using namespace core::literals;
using regmap::PinRule;
using regmap::Supply;

std::string text(PinRule rule, std::uint32_t detail) { return pin_finding_text(core::to_underlying(rule), detail); }

TEST(PinFindingText, Names_number_time_limit_supply_and_figure) {
    EXPECT_EQ(text(PinRule::timing, regmap::pack({31, Supply::v3_3, 136.7_ns - core::Ticks{1}})),
              "timing 31, E_CLOCK pulse width: 136.683 ns, at least 136.7 ns (3.3 V, figure 10-17)");
    EXPECT_EQ(text(PinRule::timing, regmap::pack({43, Supply::v5, core::Ticks{-61}})),
              "timing 43, address set-up before AS: -1.016 ns, at least 0 ns (5 V, figure 10-20)");
    EXPECT_EQ(text(PinRule::system_timing, regmap::pack({1, Supply::v5, 15_ns})),
              "clock high time TCH: 15 ns, at most 14.6 ns (section 10.7.1)");
    EXPECT_EQ(text(PinRule::system_timing, regmap::pack({7, Supply::v5, 99_ns})), "RESET: 99 ns, at least 100 ns (section 10.7.1)");
}

TEST(PinFindingText, Names_the_pin_where_there_is_one) {
    EXPECT_EQ(text(PinRule::test_mode, 35), "test_mode at pin 35: XTEST1 belongs on VDD (8.4)");
    EXPECT_EQ(text(PinRule::both_strobes, 0), "both_strobes: XRD and XWR are both low: no access (10.7.2, 10.7.3)");
}

TEST(PinFindingText, Takes_any_record) {
    EXPECT_EQ(pin_finding_text(999, 1), "rule 999");
    EXPECT_EQ(text(PinRule::timing, regmap::pack({34, Supply::v5, {}})), "timing 34");
    EXPECT_EQ(text(PinRule::timing, 0xFFFF'FFFFu), "timing 63");
    EXPECT_EQ(text(PinRule::system_timing, 0xFFFF'FFFFu), "system_timing 63");
}

TEST(NanosecondsText, Is_exact_to_a_picosecond_and_rounded_towards_zero) {
    EXPECT_EQ(nanoseconds_text(core::Ticks{}), "0");
    EXPECT_EQ(nanoseconds_text(6.25_ns), "6.25");
    EXPECT_EQ(nanoseconds_text(core::Ticks{1}), "0.016");
    EXPECT_EQ(nanoseconds_text(core::Ticks{-1}), "-0.016");
    EXPECT_EQ(nanoseconds_text(core::kClk), "20.833");
    EXPECT_EQ(nanoseconds_text(2_s), "2000000000");
}

// A violation that is out of all measure does not become another one.
TEST(TimingViolation, Saturates_and_keeps_number_and_supply) {
    const auto far = regmap::unpack_violation(regmap::pack({60, Supply::v5, core::kNever}));
    EXPECT_EQ(far, (regmap::TimingViolation{60, Supply::v5, core::Ticks{regmap::kLargestFound}}));
    const auto before = regmap::unpack_violation(regmap::pack({1, Supply::v3_3, core::Ticks{-(std::int64_t{1} << 50)}}));
    EXPECT_EQ(before, (regmap::TimingViolation{1, Supply::v3_3, core::Ticks{-regmap::kLargestFound}}));
}

}  // namespace
}  // namespace dpchip::trace
