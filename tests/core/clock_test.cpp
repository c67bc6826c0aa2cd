// SPDX-License-Identifier: Apache-2.0
// Clock: local time of a crystal against line time, rounded one way only and without drift.

#include <cstdint>
#include <random>

#include <dpchip/core/clock.hpp>
#include <gtest/gtest.h>

namespace {

using namespace dpchip::core;

constexpr std::int64_t kBillion = 1'000'000'000;

TEST(Clock, a_perfect_crystal_only_shifts_by_its_origin) {
    const Clock clock{0, {500}};
    EXPECT_EQ(clock.local({500}).n, 0);
    EXPECT_EQ(clock.local({499}).n, -1);
    EXPECT_EQ(clock.line({7}).n, 507);
}

TEST(Clock, line_to_local_rounds_down_and_local_to_line_rounds_up) {
    struct { std::int32_t ppb; std::int64_t line, local; } const down[]{
        {1, 1, 1}, {1, -1, -2}, {-1, 1, 0}, {-1, -1, -1}, {1, kBillion, kBillion + 1}, {-1, kBillion, kBillion - 1},
        {1'000'000, 999, 999}, {1'000'000, 1'000, 1'001}, {-1'000'000, 1'000, 999}, {-1'000'000, 1'001, 999},
    };
    for (const auto& row : down) EXPECT_EQ(Clock{row.ppb}.local({row.line}).n, row.local) << row.ppb << ' ' << row.line;
    struct { std::int32_t ppb; std::int64_t local, line; } const up[]{
        {1, 1, 1}, {1, -1, 0}, {-1, 1, 2}, {-1, -1, -1}, {1, kBillion + 1, kBillion}, {-1, kBillion - 1, kBillion},
        {1'000'000, 1'001, 1'000}, {1'000'000, 1'002, 1'001}, {-1'000'000, 999, 1'000}, {-1'000'000, 998, 999},
    };
    for (const auto& row : up) EXPECT_EQ(Clock{row.ppb}.line({row.local}).n, row.line) << row.ppb << ' ' << row.local;
}

TEST(Clock, years_later_the_error_is_the_crystals_and_not_one_tick_more) {
    // Whole billions of line ticks have an exact answer in local ticks.
    constexpr std::int64_t four_years = 4LL * 365 * 86'400 * 60;  // in billions of ticks
    for (const std::int32_t ppb : {-1'000'000, -100'000, -1, 1, 50'000, 100'000, 1'000'000}) {
        const std::int64_t local = four_years * (kBillion + ppb);
        EXPECT_EQ(Clock{ppb}.local({four_years * kBillion}).n, local) << ppb;
        EXPECT_EQ(Clock{ppb}.line({local}).n, four_years * kBillion) << ppb;
    }
}

TEST(Clock, a_local_event_is_seen_at_the_first_line_tick_at_which_it_is_due) {
    std::mt19937_64 random{20260101};
    for (int i = 0; i < 20'000; ++i) {
        const auto ppb = static_cast<std::int32_t>(random() % 2'000'001) - 1'000'000;
        const Ticks origin{static_cast<std::int64_t>(random() >> 4)};
        const Ticks due{static_cast<std::int64_t>(random() >> (4 + i % 50)) * (i % 2 == 0 ? 1 : -1)};
        const Clock clock{ppb, origin};
        const Ticks line = clock.line(due);
        ASSERT_GE(clock.local(line), due) << ppb << ' ' << origin.n << ' ' << due.n;
        ASSERT_LT(clock.local({line.n - 1}), due) << ppb << ' ' << origin.n << ' ' << due.n;
    }
}

TEST(Clock, never_stays_never) {
    for (const std::int32_t ppb : {-1'000, 0, 1'000}) {
        EXPECT_EQ((Clock{ppb, {77}}.local(kNever)), kNever);
        EXPECT_EQ((Clock{ppb, {77}}.line(kNever)), kNever);
    }
}

}  // namespace
