// SPDX-License-Identifier: Apache-2.0
// Every rule of the judge is broken once, by name, and kept once at its limit.
#include <gtest/gtest.h>

#include "segment/talker.hpp"

#include <dpchip/segment/judge.hpp>

namespace {

using namespace dpchip;
using namespace dpchip::core::literals;
using core::Ticks;
using segment::Judge;
using segment::Violation;
using test::request;

constexpr fdl::BaudCode kRate = fdl::BaudCode::mbit_3;
constexpr Ticks kBit = fdl::baud(kRate).bit;
constexpr fdl::BusTimes kTimes = fdl::bus_times(kRate);

/// Puts transmissions before a judge without a line.
struct Court {
    Judge judge;
    Ticks at = 1_ms;
    void hear(const std::vector<std::uint8_t>& octets, std::int64_t idle_bits = 100'000, segment::StationIndex sender = 1,
              int faults = -1, Ticks bit = kBit) {
        fdl::Transmission t{};
        t.assign(at + bit * idle_bits, bit, octets);
        if (faults >= 0) {
            t.damaged = true;
            t.faults.fill(0);
            t.faults[0] = static_cast<std::uint8_t>(faults);
        }
        judge.see({t, sender});
        at = t.end();
    }
    /// True when exactly this rule was broken, exactly once.
    bool only(Violation v) const { return judge.total() == 1 && judge.count(v) == 1 && judge.violations()[0].rule == v; }
};

TEST(Judge, has_a_name_for_every_rule) {
    for (std::size_t i = 0; i < segment::kViolations; ++i) EXPECT_STRNE(name(static_cast<Violation>(i)), "unknown");
    EXPECT_STREQ(name(static_cast<Violation>(99)), "unknown");
}

TEST(Judge, finds_an_early_answer) {
    Court good, bad;
    good.hear(request(3));
    good.hear({0xE5}, 11);
    EXPECT_TRUE(good.judge.clean());
    bad.hear(request(3));
    bad.hear({0xE5}, 10);
    EXPECT_TRUE(bad.only(Violation::early_answer));
    EXPECT_EQ(bad.judge.violations()[0].bits, 10);
    EXPECT_EQ(bad.judge.violations()[0].sender, 1);
    EXPECT_EQ(bad.judge.violations()[0].at, bad.at - kBit * 11);
}

TEST(Judge, finds_a_late_answer) {
    Court good, bad;
    good.hear(request(3));
    good.hear(test::answer(2, 3, {1}), kTimes.max_tsdr);
    EXPECT_TRUE(good.judge.clean());
    bad.hear(request(3));
    bad.hear(test::answer(2, 3, {1}), kTimes.max_tsdr + 1);
    EXPECT_TRUE(bad.only(Violation::late_answer));
}

TEST(Judge, finds_a_request_before_TID1) {
    for (const bool token : {false, true}) {
        Court good, bad;
        for (Court* c : {&good, &bad}) {
            if (token) c->hear({0xDC, 2, 2});
            else { c->hear(request(3)); c->hear({0xE5}, 11); }
        }
        good.hear(request(4), kTimes.tid1());
        EXPECT_TRUE(good.judge.clean());
        bad.hear(request(4), kTimes.tid1() - 1);
        EXPECT_TRUE(bad.only(Violation::short_idle));
    }
}

TEST(Judge, finds_a_request_before_TID2) {
    Court good, bad;
    for (Court* c : {&good, &bad}) c->hear(request(127, 2, {0, 0}));
    good.hear(request(4), kTimes.tid2());
    EXPECT_TRUE(good.judge.clean());
    bad.hear(request(4), kTimes.tid2() - 1);
    EXPECT_TRUE(bad.only(Violation::short_idle_sdn));
}

TEST(Judge, finds_an_impatient_master) {
    Court good, bad;
    for (Court* c : {&good, &bad}) c->hear(request(3));
    good.hear(request(3), kTimes.tsl);
    EXPECT_TRUE(good.judge.clean());
    EXPECT_EQ(good.judge.unanswered(), 1u);
    bad.hear(request(3), kTimes.tsl - 1);
    EXPECT_TRUE(bad.only(Violation::impatient));
}

TEST(Judge, finds_answers_out_of_turn) {
    Court unasked, stranger, to_stranger, twice;
    unasked.hear({0xE5});
    EXPECT_TRUE(unasked.only(Violation::out_of_turn));
    stranger.hear(request(3));
    stranger.hear(test::answer(2, 4, {1}), 11);
    EXPECT_TRUE(stranger.only(Violation::out_of_turn));
    to_stranger.hear(request(3));
    to_stranger.hear(test::answer(1, 3, {1}), 11);
    EXPECT_TRUE(to_stranger.only(Violation::out_of_turn));
    twice.hear(request(3));
    twice.hear({0xE5}, 11);
    twice.hear({0xE5}, 50);
    EXPECT_TRUE(twice.only(Violation::out_of_turn));
}

TEST(Judge, lets_a_publisher_answer_everybody_but_nobody_else) {
    std::vector<std::uint8_t> msrd = request(3), everybody = test::answer(127, 3, {1});
    msrd.resize(fdl::encode(msrd, 3, 2, 0x77, {}));
    Court good, bad;
    good.hear(msrd);
    good.hear(everybody, 11);
    EXPECT_TRUE(good.judge.clean());
    bad.hear(request(3));
    bad.hear(everybody, 11);
    EXPECT_TRUE(bad.only(Violation::out_of_turn));
}

TEST(Judge, finds_octets_that_are_no_telegram) {
    Court c;
    c.hear({1, 2, 3});
    EXPECT_TRUE(c.only(Violation::malformed));
    Court two;
    two.hear({0xE5, 0xE5});
    EXPECT_TRUE(two.only(Violation::malformed));
}

TEST(Judge, finds_parity_stop_and_collision_faults) {
    Court parity, stop, collision;
    parity.hear(request(3), 1000, 1, fdl::fault_parity);
    EXPECT_TRUE(parity.only(Violation::parity));
    stop.hear(request(3), 1000, 1, fdl::fault_stop);
    EXPECT_TRUE(stop.only(Violation::stop_bit));
    collision.hear(request(3), 1000, 1, fdl::fault_collision);
    EXPECT_TRUE(collision.only(Violation::collision));
}

TEST(Judge, finds_impossible_source_addresses) {
    Court c;
    c.hear(request(3, 127));
    EXPECT_TRUE(c.only(Violation::address));
}

TEST(Judge, finds_rates_that_do_not_exist_unless_told_the_bus_times) {
    Court c;
    c.hear(request(3), 100, 1, -1, kBit + Ticks{1});
    EXPECT_TRUE(c.only(Violation::rate));
    Court told{Judge{kTimes}};
    told.hear(request(3), 100, 1, -1, kBit + Ticks{1});
    told.hear({0xE5}, 11, 1, -1, kBit + Ticks{1});
    EXPECT_TRUE(told.judge.clean());
}

TEST(Judge, finds_gaps_that_a_fault_puts_into_a_telegram) {
    segment::Segment line;
    test::Talker master{.bit = kBit, .plan = {{1_ms, request(3)}, {5_ms, request(4)}}};
    ASSERT_TRUE(line.attach(master));
    const segment::ScriptedFaults::Line script[]{{0, {.kind = segment::FaultKind::gap, .octet = 2, .bits = 3}}};
    segment::ScriptedFaults faults{script};
    line.set_faults(segment::FaultRef{faults});
    Judge judge;
    line.observe(judge);
    line.advance(10_ms);
    EXPECT_EQ(judge.count(Violation::gap), 1u);
    EXPECT_EQ(judge.count(Violation::malformed), 2u);
    EXPECT_EQ(judge.total(), 3u);
}

TEST(Judge, keeps_the_first_64_and_counts_all) {
    Court c;
    for (int i = 0; i < 100; ++i) c.hear({1});
    EXPECT_EQ(c.judge.violations().size(), 64u);
    EXPECT_EQ(c.judge.count(Violation::malformed), 100u);
    c.judge.clear();
    EXPECT_TRUE(c.judge.clean());
    EXPECT_TRUE(c.judge.violations().empty());
}

}  // namespace
