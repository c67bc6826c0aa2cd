// SPDX-License-Identifier: Apache-2.0
// The timing table against what stands in the figures, and against itself.
#include <gtest/gtest.h>

#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <dpchip/regmap/bus_timing.hpp>

namespace {

using namespace dpchip;
using regmap::Supply;
using regmap::TimingKind;

struct Row {
    unsigned number{};
    std::string mode, owed_by;
    std::array<std::string, 4> figures;  ///< 3.3 V min, max, 5 V min, max
};

std::vector<Row> rows_of_the_manual() {
    std::ifstream file{DPCHIP_SOURCE_DIR "/tests/pins/bus_timing.txt"};
    std::vector<Row> rows;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::istringstream words{line};
        Row row;
        char bar{};
        words >> row.number >> bar >> row.mode >> bar;
        for (std::string& f : row.figures) words >> f >> bar;
        words >> row.owed_by;
        EXPECT_TRUE(words) << line;
        rows.push_back(row);
    }
    return rows;
}

/// "136.7" in ticks; nothing for "-".
std::optional<core::Ticks> ticks(const std::string& text) {
    if (text == "-") return std::nullopt;
    const auto point = text.find('.');
    std::int64_t n = std::stoll(text.substr(0, point)) * 60;
    if (point != std::string::npos) n += std::stoll(text.substr(point + 1)) * 6;  // one decimal
    return core::Ticks{n};
}

// proves: VPC3C 10.7.2-03..18, VPC3C 10.7.3-03..18, VPC3C 10.7.4-03..14, VPC3C 10.7.5-03..21, E038
TEST(TimingTable, Every_figure_is_the_one_that_the_manual_prints) {
    const std::vector<Row> rows = rows_of_the_manual();
    ASSERT_EQ(rows.size(), regmap::kTimingParameters);
    std::set<unsigned> seen;
    for (const Row& row : rows) {
        SCOPED_TRACE(row.number);
        ASSERT_TRUE(regmap::is_timing_number(row.number) && seen.insert(row.number).second);
        const regmap::TimingParameter& p = regmap::timing(row.number);
        EXPECT_EQ(p.number, row.number);
        EXPECT_EQ(regmap::name(p.mode), row.mode);
        EXPECT_EQ(p.kind == TimingKind::check ? "processor" : "chip", row.owed_by);
        const std::array<core::Ticks, 4> have{p.at(Supply::v3_3).min, p.at(Supply::v3_3).max, p.at(Supply::v5).min, p.at(Supply::v5).max};
        for (std::size_t i = 0; i < have.size(); ++i)
            EXPECT_EQ(have[i], ticks(row.figures[i]).value_or(i % 2 == 0 ? regmap::kNoMin : regmap::kNoMax)) << "column " << i;
    }
}

// The edges that the manual leaves unsaid follow from sums of its figures (reference 4.5).
TEST(TimingTable, The_sums_that_fix_the_unprinted_edges_hold) {
    const auto min = [](unsigned n) { return regmap::timing(n).at(Supply::v5).min; };
    EXPECT_EQ(min(10), min(6) + min(7) + min(1) + min(2));
    EXPECT_EQ(min(22), min(18) + min(25));
    EXPECT_EQ(min(51), min(45) + min(54));
    EXPECT_EQ(min(50), min(59) + min(54));
    for (const Supply s : {Supply::v3_3, Supply::v5}) {
        EXPECT_EQ(core::to_ns(regmap::timing(20).at(s).max - regmap::timing(21).at(s).max), 21) << "one CLK, rounded";
        EXPECT_EQ(regmap::timing(48).at(s), regmap::timing(20).at(s));
        EXPECT_EQ(regmap::timing(49).at(s), regmap::timing(21).at(s));
    }
    EXPECT_EQ(core::to_ns(core::kClk * 4), core::to_ns(min(12))) << "a write strobe spans four CLK";
}

TEST(TimingTable, There_are_45_checks_and_14_promises_and_no_34) {
    int checks = 0, promises = 0;
    for (const regmap::TimingParameter& p : regmap::kBusTiming) ++(p.kind == TimingKind::check ? checks : promises);
    EXPECT_EQ(checks, 45);
    EXPECT_EQ(promises, 14);
    EXPECT_FALSE(regmap::is_timing_number(34));
    for (const regmap::TimingParameter& p : regmap::kBusTiming) {
        EXPECT_NE(p.from.bits, 0u);
        EXPECT_NE(p.to.bits, 0u);
        EXPECT_FALSE(p.name.empty());
    }
}

// proves: VPC3C 10.7.1-01, VPC3C 10.7.1-03, VPC3C 10.7.1-04..08, E039
TEST(TimingTable, The_unnumbered_times_are_those_of_the_manual) {
    using regmap::SystemTiming;
    const auto limits = [](SystemTiming t) { return regmap::timing(t).limits; };
    EXPECT_EQ(limits(SystemTiming::clk_high), (regmap::TimingLimits{core::Ticks{375}, core::Ticks{876}})) << "6.25 to 14.6 ns";
    EXPECT_EQ(limits(SystemTiming::clk_low), limits(SystemTiming::clk_high));
    EXPECT_EQ(limits(SystemTiming::clk_rise).max, core::nanoseconds(4));
    EXPECT_EQ(limits(SystemTiming::clk_fall).max, core::nanoseconds(4));
    EXPECT_TRUE(limits(SystemTiming::clk_period).meets(core::kClk)) << "20.83 ns";
    EXPECT_EQ(limits(SystemTiming::eoi_inactive_us).min, core::microseconds(1));
    EXPECT_EQ(limits(SystemTiming::eoi_inactive_ms).min, core::milliseconds(1));
    EXPECT_EQ(limits(SystemTiming::reset_width).min, core::nanoseconds(100));
    EXPECT_GE(limits(SystemTiming::reset_width).min, core::kClk * 4) << "100 ns are more than the 4 clocks of section 8.1.2";
}

}  // namespace
