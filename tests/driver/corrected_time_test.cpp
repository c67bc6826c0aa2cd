// SPDX-License-Identifier: Apache-2.0
// The time between two settings, and what the settings teach about the rate of the local clock.
#include <dpchip/driver/corrected_time.hpp>

#include <cstdlib>

#include <gtest/gtest.h>

namespace dpchip::driver {
namespace {

using dp::NetworkTime;

constexpr NetworkTime kNoon = NetworkTime::from_wire(0xC3123456, 0x80000000);
constexpr std::uint64_t kSecond = 1'000'000'000;

/// What a local clock that is `ppb` too fast shows `ns` after noon, beginning at any number.
std::uint64_t local(std::uint64_t ns, std::int64_t ppb) {
    const auto s = static_cast<std::int64_t>(ns / kSecond), rest = static_cast<std::int64_t>(ns % kSecond);
    return 77 + ns + static_cast<std::uint64_t>(s * ppb + rest * ppb / 1'000'000'000);
}

/// How far the time is off `ns` after noon.
std::int64_t error(const CorrectedTime& t, std::uint64_t ns, std::int64_t ppb) {
    return t.at(local(ns, ppb)).minus_ns(kNoon.plus_ns(static_cast<std::int64_t>(ns)));
}

CorrectedTime set_every(std::uint64_t interval, int times, std::int64_t ppb, bool correct = true) {
    CorrectedTime t;
    t.correct_rate(correct);
    for (int i = 0; i < times; ++i) {
        const std::uint64_t ns = static_cast<std::uint64_t>(i) * interval;
        t.set(kNoon.plus_ns(static_cast<std::int64_t>(ns)), local(ns, ppb));
    }
    return t;
}

TEST(CorrectedTime, goes_on_with_the_local_clock) {
    CorrectedTime t;
    EXPECT_FALSE(t.valid());
    t.set(kNoon, 77);
    EXPECT_TRUE(t.valid());
    EXPECT_EQ(t.at(77), kNoon);
    EXPECT_EQ(t.at(77 + 500'000'000), NetworkTime::from_wire(0xC3123457, 0));
    EXPECT_EQ(t.at(77 + 3'600 * kSecond).seconds, kNoon.seconds + 3'600);
    EXPECT_EQ(t.correction_ns(), 0);
}

TEST(CorrectedTime, the_second_setting_tells_the_rate) {
    for (const std::int64_t ppb : {100'000, -100'000, 25'000, -1'000, 0}) {
        const CorrectedTime one = set_every(10 * kSecond, 1, ppb), two = set_every(10 * kSecond, 2, ppb);
        EXPECT_FALSE(one.rate_known());
        EXPECT_NEAR(static_cast<double>(error(one, 10 * kSecond, ppb)), static_cast<double>(10 * ppb), 2.0);
        EXPECT_TRUE(two.rate_known());
        EXPECT_NEAR(two.rate_ppb(), static_cast<double>(-ppb), 12.0) << "a hundred millionths of ppb are a tenth of it";
        EXPECT_LE(std::abs(error(two, 20 * kSecond, ppb)), 200) << "200 ns after ten seconds with " << ppb;
    }
}

TEST(CorrectedTime, without_correction_of_the_rate_the_drift_stays) {
    const CorrectedTime t = set_every(10 * kSecond, 5, 100'000, false);
    EXPECT_FALSE(t.rate_known());
    EXPECT_EQ(t.rate_ppb(), 0);
    EXPECT_NEAR(static_cast<double>(error(t, 50 * kSecond, 100'000)), 1'000'000.0, 10.0);
    EXPECT_NEAR(static_cast<double>(t.correction_ns()), -1'000'000.0, 10.0);
}

TEST(CorrectedTime, short_intervals_are_gathered_until_they_are_a_second) {
    // Each setting is up to a microsecond late, which over 10 ms would be 100 ppm.
    CorrectedTime t;
    for (std::uint64_t i = 0; i <= 300; ++i)
        t.set(kNoon.plus_ns(static_cast<std::int64_t>(i * 10'000'000)), local(i * 10'000'000 + i * 317 % 1'000, 50'000));
    EXPECT_TRUE(t.rate_known());
    EXPECT_NEAR(t.rate_ppb(), -50'000.0, 1'000.0);
}

TEST(CorrectedTime, a_crystal_that_warms_up_is_followed) {
    CorrectedTime t;
    std::uint64_t at = 77;
    for (std::int64_t i = 0; i < 40; ++i) {
        t.set(kNoon.plus_ns(i * 10'000'000'000), at);
        at += 10 * kSecond + static_cast<std::uint64_t>((i < 20 ? 0 : 20'000) * 10);
    }
    EXPECT_NEAR(t.rate_ppb(), -20'000.0, 100.0);
}

TEST(CorrectedTime, another_time_is_taken_over_and_teaches_nothing) {
    for (const std::int64_t jump : {3'600'000'000'000, -3'600'000'000'000, std::int64_t{20'000'000}}) {
        CorrectedTime t = set_every(10 * kSecond, 3, 30'000);
        const std::int32_t rate = t.rate_ppb();
        const NetworkTime other = kNoon.plus_ns(36'000'000'000'000 + jump);
        t.set(other, local(30 * kSecond, 30'000));
        EXPECT_EQ(t.rate_ppb(), rate);
        EXPECT_EQ(t.at(local(30 * kSecond, 30'000)), other);
        t.set(other.plus_ns(10'000'000'000), local(40 * kSecond, 30'000));
        EXPECT_NEAR(t.rate_ppb(), -30'000.0, 12.0) << "and the next one does again";
    }
}

TEST(CorrectedTime, goes_on_over_the_end_of_the_era_of_1900) {
    CorrectedTime t;
    t.set(NetworkTime::from_wire(0xFFFFFFFF, 0), 0);
    t.set(NetworkTime::from_wire(0x00000009, 0), 10 * kSecond + 1'000'000);
    EXPECT_NEAR(t.rate_ppb(), -100'000.0, 12.0);
    EXPECT_EQ(t.correction_ns(), -1'000'000);
    EXPECT_EQ(t.at(10 * kSecond + 1'000'000).wire_seconds(), 9u);
}

TEST(CorrectedTime, reset_forgets_the_time_and_keeps_what_was_asked_for) {
    CorrectedTime t = set_every(10 * kSecond, 3, 30'000, false);
    t.reset();
    EXPECT_FALSE(t.valid());
    t.set(kNoon, 0);
    t.set(kNoon.plus_ns(10'000'000'000), 10 * kSecond + 5'000);
    EXPECT_FALSE(t.rate_known());
}

}  // namespace
}  // namespace dpchip::driver
