// SPDX-License-Identifier: Apache-2.0
// Ticks: literals are exact or do not compile, arithmetic is that of integers (docs/time.md).

#include <cstdint>
#include <limits>
#include <type_traits>

#include <dpchip/core/ticks.hpp>
#include <gtest/gtest.h>

namespace {

using namespace dpchip::core;
using namespace dpchip::core::literals;

// A time that is no whole number of ticks is no constant expression: ask whether it can be a template argument.
template <std::int64_t>
struct Constant {};
template <std::int64_t Num, std::int64_t Den>
concept Exact = requires { typename Constant<exact(Num, Den).n>; };

template <std::size_t N>
struct Text {
    char text[N]{};
    consteval Text(const char (&t)[N]) {
        for (std::size_t i = 0; i < N; ++i) text[i] = t[i];
    }
};
template <Text T, std::int64_t Unit>
concept Parses = requires { typename Constant<detail::parse(T.text, Unit).n>; };

TEST(Ticks, literals_are_exact) {
    EXPECT_EQ((1_ns).n, 60);
    EXPECT_EQ((6.25_ns).n, 375);
    EXPECT_EQ((14.6_ns).n, 876);
    EXPECT_EQ((136.7_ns).n, 8'202);
    EXPECT_EQ((0.05_ns).n, 3);
    EXPECT_EQ((1_us).n, 60'000);
    EXPECT_EQ((1'000.5_us).n, 60'030'000);
    EXPECT_EQ((10_ms).n, 600'000'000);
    EXPECT_EQ((2_s).n, 120'000'000'000);
    EXPECT_EQ((4_clk).n, 5'000);
    EXPECT_EQ((0.5_clk).n, 625);
    EXPECT_EQ(1.50_us, 1'500_ns);
}

TEST(Ticks, what_is_no_whole_number_of_ticks_does_not_compile) {
    static_assert(Exact<1, 48'000'000> && Exact<11, 500'000> && Exact<-1, 60>);
    static_assert(!Exact<1, 7> && !Exact<1, 0> && !Exact<1, -60>);
    static_assert(!Exact<std::numeric_limits<std::int64_t>::max(), 1>, "overflow is an error, too");
    static_assert(Parses<"6.25", 60> && !Parses<"0.01", 60> && !Parses<"20.83", 60>);
    static_assert(!Parses<"1e3", 60> && !Parses<"0x10", 60>);
    SUCCEED();
}

TEST(Ticks, clk_of_48_MHz_and_the_bit_time_of_every_baud_rate_are_whole) {
    EXPECT_EQ(kClk.n, 1'250);
    EXPECT_EQ(exact(1, 12'000'000), 4 * kClk);
    EXPECT_EQ(exact(11, 500'000), 1'056 * kClk);
    EXPECT_EQ(exact(1, 9'600), 5'000 * kClk);
    EXPECT_EQ(48'000'000 * kClk, 1_s);
}

TEST(Ticks, functions_agree_with_literals) {
    EXPECT_EQ(nanoseconds(7), 7_ns);
    EXPECT_EQ(microseconds(7), 7_us);
    EXPECT_EQ(milliseconds(7), 7_ms);
    EXPECT_EQ(seconds(7), 7_s);
    EXPECT_EQ(seconds(-7).n, -7 * kTicksPerSecond);
}

TEST(Ticks, arithmetic_is_that_of_integers) {
    Ticks t = 10_ns;
    t += 5_ns;
    EXPECT_EQ(t, 15_ns);
    t -= 20_ns;
    EXPECT_EQ(t.n, -300);
    EXPECT_EQ(3 * 2_ns, 2_ns * 3);
    EXPECT_EQ(10_ns / 3_ns, 3);
    EXPECT_EQ(10_ns % 3_ns, 1_ns);
    EXPECT_LT(1_ns, 2_ns);
    EXPECT_GT(kNever, seconds(150'000'000));
}

TEST(Ticks, nanoseconds_round_down_on_both_sides_of_zero) {
    for (const auto& [ticks, ns] : {std::pair<std::int64_t, std::int64_t>{0, 0}, {59, 0}, {60, 1}, {-1, -1}, {-60, -1}, {-61, -2}})
        EXPECT_EQ(to_ns({ticks}), ns) << ticks;
    EXPECT_EQ(to_ns({std::numeric_limits<std::int64_t>::min()}), -153'722'867'280'912'931);
}

TEST(Ticks, an_int64_spans_more_than_four_years) {
    constexpr std::int64_t years = std::numeric_limits<std::int64_t>::max() / kTicksPerSecond / 86'400 * 100 / 365;
    EXPECT_EQ(years, 487);  // hundredths of a year
}

TEST(Ticks, integers_neither_become_times_nor_times_integers_by_themselves) {
    static_assert(!std::is_convertible_v<std::int64_t, Ticks> && !std::is_convertible_v<Ticks, std::int64_t>);
    SUCCEED();
}

}  // namespace
