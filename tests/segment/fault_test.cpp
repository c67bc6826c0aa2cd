// SPDX-License-Identifier: Apache-2.0
// Each kind of fault does to a transmission what its name says, and nothing else.
#include <gtest/gtest.h>

#include "segment/talker.hpp"

#include <dpchip/segment/fault.hpp>

namespace {

using namespace dpchip;
using namespace dpchip::core::literals;
using core::Ticks;
using segment::Fault;
using segment::FaultKind;
using test::request;
using test::Told;

constexpr Ticks kBit = fdl::baud(fdl::BaudCode::mbit_12).bit;
constexpr Ticks kAt = 10_us;

/// What a bystander hears of a request (10 03 02 7D 82 16) at kAt with this fault, and of a good one later.
std::vector<Told> heard(const Fault& fault) {
    segment::Segment line;
    test::Talker master{.plan = {{kAt, request(3)}, {1_ms, request(3)}}}, spy{.ears = true};
    EXPECT_TRUE(line.attach(master));
    EXPECT_TRUE(line.attach(spy));
    const segment::ScriptedFaults::Line script[]{{0, fault}};
    segment::ScriptedFaults faults{script};
    line.set_faults(segment::FaultRef{faults});
    line.advance(2_ms);
    EXPECT_GE(spy.told.size(), 2u);
    EXPECT_EQ(spy.told.back(), (Told{"telegram", 1_ms + kBit * 66}));
    spy.told.resize(spy.told.size() - 2);  // the good one and its carrier
    return spy.told;
}

std::vector<Told> characters(std::size_t from, std::size_t to, Ticks start, std::size_t bad = 99, int octet = -1, int fault = 0) {
    const auto sent = request(3);
    std::vector<Told> all;
    for (std::size_t i = from; i < to; ++i) {
        const int value = i == bad && octet >= 0 ? octet : sent[i];
        all.push_back({"character " + std::to_string(value) + " faults " + std::to_string(i == bad ? fault : 0),
                       start + kBit * (11 * static_cast<std::int64_t>(i - from + 1))});
    }
    return all;
}
std::vector<Told> with_carrier(const std::vector<Told>& rest, Ticks at = kAt) {
    std::vector<Told> all{{"carrier", at}};
    for (const Told& t : rest) all.push_back(t);
    return all;
}

TEST(Fault, none_leaves_the_telegram_alone) {
    EXPECT_EQ(heard({}), (std::vector<Told>{{"carrier", kAt}, {"telegram", kAt + kBit * 66}}));
}
TEST(Fault, flip_of_one_bit_changes_the_octet_and_its_parity) {
    EXPECT_EQ(heard({.kind = FaultKind::flip, .octet = 2, .mask = 0x01}), with_carrier(characters(0, 6, kAt, 2, 3, 1)));
}
TEST(Fault, flip_of_two_bits_keeps_the_parity_good) {
    EXPECT_EQ(heard({.kind = FaultKind::flip, .octet = 2, .mask = 0x03}), with_carrier(characters(0, 6, kAt, 2, 1, 0)));
}
TEST(Fault, parity_and_stop_hit_one_character) {
    EXPECT_EQ(heard({.kind = FaultKind::parity, .octet = 4}), with_carrier(characters(0, 6, kAt, 4, -1, 1)));
    EXPECT_EQ(heard({.kind = FaultKind::stop, .octet = 11}), with_carrier(characters(0, 6, kAt, 5, -1, 2)));
}
TEST(Fault, truncate_ends_the_telegram_early) {
    EXPECT_EQ(heard({.kind = FaultKind::truncate, .octet = 4}), with_carrier(characters(0, 4, kAt)));
    EXPECT_TRUE(heard({.kind = FaultKind::truncate, .octet = 0}).empty());
}
TEST(Fault, gap_moves_the_rest_and_says_so_by_time_alone) {
    std::vector<Told> expected = with_carrier(characters(0, 2, kAt));
    const Ticks second = kAt + kBit * 29;
    for (const Told& t : with_carrier(characters(2, 6, second), second)) expected.push_back(t);
    EXPECT_EQ(heard({.kind = FaultKind::gap, .octet = 2, .bits = 7}), expected);
}
TEST(Fault, gap_before_the_first_octet_is_late) {
    EXPECT_EQ(heard({.kind = FaultKind::gap, .octet = 0, .bits = 7}), heard({.kind = FaultKind::late, .bits = 7}));
}
TEST(Fault, late_moves_the_whole_telegram_undamaged) {
    EXPECT_EQ(heard({.kind = FaultKind::late, .bits = 70}),
              (std::vector<Told>{{"carrier", kAt + kBit * 70}, {"telegram", kAt + kBit * 136}}));
}
TEST(Fault, drop_leaves_nothing) { EXPECT_TRUE(heard({.kind = FaultKind::drop}).empty()); }

TEST(Fault, noise_follows_a_good_telegram) {
    const auto all = heard({.kind = FaultKind::noise, .octet = 1, .mask = 0x80, .bits = 5});
    const Ticks noise = kAt + kBit * 71;
    EXPECT_EQ(all, (std::vector<Told>{{"carrier", kAt}, {"telegram", kAt + kBit * 66}, {"carrier", noise},
                                      {"character 128 faults 0", noise + kBit * 11}, {"character 165 faults 0", noise + kBit * 22}}));
}

TEST(RandomFaults, are_as_frequent_as_asked_and_the_same_for_the_same_seed) {
    const segment::RandomFaults::Rates rates{0, 100'000, 0, 0, 0, 0, 0, 50'000, 0};
    segment::RandomFaults one{99, rates}, two{99, rates}, other{100, rates};
    fdl::Transmission t{};
    t.length = 20;
    bool differs = false;
    for (std::uint64_t n = 0; n < 20'000; ++n) {
        const Fault a = one(t, 0, n), b = two(t, 0, n), c = other(t, 0, n);
        ASSERT_EQ(a.kind, b.kind);
        ASSERT_EQ(a.octet, b.octet);
        ASSERT_LT(a.octet, 20);
        differs = differs || a.kind != c.kind;
    }
    EXPECT_TRUE(differs);
    EXPECT_NEAR(static_cast<double>(one.counts()[1]), 2000.0, 300.0);
    EXPECT_NEAR(static_cast<double>(one.counts()[7]), 1000.0, 200.0);
    EXPECT_EQ(one.counts()[4], 0u);
}

TEST(FaultNames, are_known) {
    for (std::size_t i = 0; i < segment::kFaultKinds; ++i) EXPECT_STRNE(name(static_cast<FaultKind>(i)), "unknown");
}

}  // namespace
