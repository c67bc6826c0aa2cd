// SPDX-License-Identifier: Apache-2.0
// The line: who hears what and when, in which order, on which terms stations come and go.
#include <algorithm>
#include <memory>

#include <gtest/gtest.h>

#include "segment/talker.hpp"

#include <dpchip/segment/judge.hpp>
#include <dpchip/segment/port.hpp>

namespace {

using namespace dpchip;
using namespace dpchip::core::literals;
using core::Ticks;
using segment::AttachError;
using segment::kNobody;
using segment::Segment;
using test::request;
using test::Talker;

constexpr Ticks kBit = fdl::baud(fdl::BaudCode::mbit_12).bit;
using test::kNever;

TEST(Attach, gives_indices_in_order_and_names_by_default) {
    Segment line;
    Talker a{.own = 3}, b{.own = 4};
    ASSERT_EQ(*line.attach(a, "slave 3"), 0);
    ASSERT_EQ(*line.attach(b), 1);
    EXPECT_EQ(line.name(0), "slave 3");
    EXPECT_EQ(line.name(1), "station 1");
    EXPECT_EQ(line.find(4), 1);
    EXPECT_EQ(line.find(5), kNobody);
    EXPECT_EQ(line.find(127), kNobody);
    EXPECT_EQ(line.find(255), kNobody);
}

TEST(Attach, refuses_an_address_twice_the_same_object_twice_and_more_than_fit) {
    Segment line;
    Talker a{.own = 3}, b{.own = 3};
    ASSERT_TRUE(line.attach(a));
    EXPECT_EQ(line.attach(b).error(), AttachError::address_taken);
    EXPECT_EQ(line.attach(a).error(), AttachError::already_attached);
    std::vector<Talker> many(segment::kMaxStations);
    for (std::size_t i = 1; i < segment::kMaxStations; ++i) ASSERT_TRUE(line.attach(many[i]));
    EXPECT_EQ(line.attach(many[0]).error(), AttachError::full);
    for (const auto e : {AttachError::full, AttachError::already_attached, AttachError::address_taken})
        EXPECT_STRNE(segment::name(e), "unknown");
}

TEST(Attach, makes_a_detached_address_and_place_free_again) {
    Segment line;
    Talker a{.own = 3}, b{.own = 3}, c{.own = 9};
    ASSERT_TRUE(line.attach(a));
    ASSERT_TRUE(line.attach(c));
    line.detach(0);
    EXPECT_EQ(line.find(3), kNobody);
    EXPECT_FALSE(line.attached(0));
    EXPECT_EQ(*line.attach(b), 0);
    EXPECT_EQ(line.find(3), 0);
}

TEST(Attach, brings_the_station_up_to_the_time_of_the_line) {
    Segment line;
    line.advance(5_us);
    Talker a{.own = 3};
    ASSERT_TRUE(line.attach(a));
    EXPECT_EQ(a.now, 5_us);
}

TEST(Dispatch, is_to_the_addressed_station_and_to_those_who_hear_everything) {
    Segment line;
    Talker master{.plan = {{10_us, request(3)}}}, addressed{.own = 3, .tsdr_bits = 100}, other{.own = 4}, spy{.ears = true};
    for (Talker* t : {&master, &addressed, &other, &spy}) ASSERT_TRUE(line.attach(*t));
    line.run(15_us + kBit * 66);
    const std::vector<test::Told> expected{{"carrier", 10_us}, {"telegram", 10_us + kBit * 66}};
    EXPECT_EQ(addressed.told, expected);
    EXPECT_EQ(spy.told, expected);
    EXPECT_TRUE(other.told.empty());
    EXPECT_TRUE(master.told.empty());
}

TEST(Dispatch, of_127_is_to_everybody_but_the_sender) {
    Segment line;
    Talker master{.plan = {{10_us, request(127, 2, {1, 2})}}}, a{.own = 3}, b{.own = 4}, nobody{};
    for (Talker* t : {&master, &a, &b, &nobody}) ASSERT_TRUE(line.attach(*t));
    line.run(1_ms);
    for (const Talker* t : {&a, &b, &nobody}) EXPECT_EQ(t->count("telegram"), 1u);
    EXPECT_TRUE(master.told.empty());
}

TEST(Dispatch, of_tokens_and_short_acknowledgements_is_only_to_those_who_hear_everything) {
    Segment line;
    Talker master{.plan = {{10_us, {0xDC, 3, 2}}, {50_us, {0xE5}}}}, a{.own = 3}, spy{.ears = true};
    for (Talker* t : {&master, &a, &spy}) ASSERT_TRUE(line.attach(*t));
    line.run(1_ms);
    EXPECT_TRUE(a.told.empty());
    EXPECT_EQ(spy.count("telegram"), 2u);
}

TEST(Dispatch, follows_a_station_that_changes_its_address_or_pricks_up_its_ears) {
    Segment line;
    Talker master{.plan = {{10_us, request(3)}, {50_us, request(9)}, {90_us, request(77)}}}, a{.own = 3};
    ASSERT_TRUE(line.attach(master));
    ASSERT_TRUE(line.attach(a));
    line.advance(40_us);
    EXPECT_EQ(a.count("telegram"), 1u);
    a.own = 9;
    line.touch(1);
    EXPECT_EQ(line.find(3), kNobody);
    EXPECT_EQ(line.find(9), 1);
    line.advance(80_us);
    EXPECT_EQ(a.count("telegram"), 2u);
    a.ears = true;
    line.touch(1);
    line.advance(120_us);
    EXPECT_EQ(a.count("telegram"), 3u);
}

TEST(Dispatch, to_an_address_two_stations_have_moved_to_reaches_both_and_their_answers_collide) {
    Segment line;
    Talker master{.ears = true, .plan = {{10_us, request(3)}}}, a{.own = 3}, b{.own = 4};
    for (Talker* t : {&master, &a, &b}) ASSERT_TRUE(line.attach(*t));
    b.own = 3;
    line.touch(2);
    EXPECT_EQ(line.count(3), 2u);
    EXPECT_EQ(line.find(3), 1);
    line.run(1_ms);
    EXPECT_EQ(a.count("telegram"), 1u);
    EXPECT_EQ(b.count("telegram"), 1u);
    EXPECT_EQ(line.counters().collisions, 1u);
    ASSERT_EQ(master.told.size(), 3u);  // two carriers, one garbled character
    EXPECT_NE(master.told[2].what.find("faults 4"), std::string::npos);
}

TEST(Answer, begins_exactly_tsdr_after_the_request_and_is_heard_at_its_end) {
    Segment line;
    test::Recorder record;
    Talker master{.ears = true, .plan = {{10_us, request(3, 2, {1, 2, 3})}}};
    Talker slave{.own = 3, .tsdr_bits = 36, .reply = test::answer(2, 3, {7})};
    ASSERT_TRUE(line.attach(master));
    ASSERT_TRUE(line.attach(slave));
    line.observe(record);
    line.run(1_ms);
    ASSERT_EQ(record.entries.size(), 2u);
    EXPECT_EQ(record.entries[0].end, 10_us + kBit * (12 * 11));
    EXPECT_EQ(record.entries[1].start, record.entries[0].end + kBit * 36);
    EXPECT_EQ(record.entries[1].sender, 1);
    EXPECT_EQ(master.told, (std::vector<test::Told>{{"carrier", record.entries[1].start},
                                                    {"telegram", record.entries[1].start + kBit * (10 * 11)}}));
    EXPECT_EQ(record.begun, 2u);
}

TEST(Answer, that_has_not_begun_is_given_up_when_somebody_else_sends) {
    Segment line;
    Talker master{.plan = {{10_us, request(3)}, {10_us + kBit * 80, request(4)}}}, slave{.own = 3, .tsdr_bits = 50};
    ASSERT_TRUE(line.attach(master));
    ASSERT_TRUE(line.attach(slave));
    line.run(1_ms);
    EXPECT_EQ(slave.count("carrier"), 2u);
    EXPECT_EQ(slave.count("telegram"), 1u);
    EXPECT_EQ(line.counters().transmissions, 2u);
    EXPECT_EQ(line.counters().collisions, 0u);
}

TEST(Order, at_one_tick_is_line_first_then_stations_by_index) {
    Segment line;
    const Ticks end = 10_us + kBit * 66;
    Talker b{.alarm = end}, master{.plan = {{10_us, request(3)}}}, c{.own = 3, .alarm = end}, d{.alarm = end};
    std::vector<std::string> order;
    struct Watch {
        Talker& t;
        std::vector<std::string>& order;
        std::string name;
        Ticks next() const { return t.next(); }
        void advance(Ticks at) { const auto n = t.told.size(); t.advance(at); if (t.told.size() != n) order.push_back(name + " alarm"); }
        void hear(const fdl::Transmission& s) { order.push_back(name + " hears"); t.hear(s); }
        void hear_character(const fdl::Character& ch) { t.hear_character(ch); }
        void carrier(Ticks at) { t.carrier(at); }
        bool take(fdl::Transmission& s) { return t.take(s); }
        bool hears_all() const { return false; }
        std::uint8_t address() const { return t.address(); }
    };
    Watch wb{b, order, "b"}, wm{master, order, "m"}, wc{c, order, "c"}, wd{d, order, "d"};
    ASSERT_TRUE(line.attach(wd));
    ASSERT_TRUE(line.attach(wm));
    ASSERT_TRUE(line.attach(wc));
    ASSERT_TRUE(line.attach(wb));
    line.advance(end);
    // c is told at the line's turn, moved to the tick first; then the others by index
    EXPECT_EQ(order, (std::vector<std::string>{"c alarm", "c hears", "d alarm", "b alarm"}));
}

TEST(Order, of_stations_that_begin_at_the_same_tick_makes_them_collide_whatever_their_index) {
    Segment line;
    Talker a{.plan = {{10_us, request(3)}}}, b{.plan = {{10_us, request(4)}}}, spy{.ears = true};
    for (Talker* t : {&a, &b, &spy}) ASSERT_TRUE(line.attach(*t));
    line.run(1_ms);
    EXPECT_EQ(line.counters().collisions, 1u);
    EXPECT_EQ(spy.count("telegram"), 0u);
    EXPECT_EQ(std::ranges::count_if(spy.told, [](const auto& t) { return t.what.starts_with("character"); }), 6);
}

TEST(Collision, in_the_middle_spoils_only_the_characters_it_covers) {
    Segment line;
    Talker a{.plan = {{10_us, request(3)}}}, b{.plan = {{10_us + kBit * 40, {0xE5}}}}, spy{.ears = true}, deaf{.own = 9};
    for (Talker* t : {&a, &b, &spy, &deaf}) ASSERT_TRUE(line.attach(*t));
    test::Recorder record;
    segment::Judge judge;
    line.observe(record);
    line.observe(judge);
    line.run(1_ms);
    ASSERT_EQ(record.entries.size(), 2u);
    EXPECT_TRUE(record.entries[0].damaged && record.entries[1].damaged);
    EXPECT_GE(judge.count(segment::Violation::collision), 1u);
    const std::vector<std::uint8_t> sent = request(3);
    ASSERT_EQ(deaf.told.size(), 7u);  // everybody hears what is damaged, from the collision on
    EXPECT_EQ(deaf.told[0], (test::Told{"carrier", 10_us + kBit * 40}));
    deaf.told.erase(deaf.told.begin());
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(deaf.told[i].at, 10_us + kBit * (11 * static_cast<std::int64_t>(i + 1)));
        const bool covered = i == 3 || i == 4;  // 40..51 overlaps characters 33..44 and 44..55
        EXPECT_EQ(deaf.told[i].what.ends_with("faults 4"), covered) << i;
        EXPECT_EQ(deaf.told[i].what == "character " + std::to_string(sent[i]) + " faults 0", !covered) << i;
    }
    EXPECT_EQ(std::ranges::count_if(a.told, [](const auto& t) { return t.what.starts_with("character"); }), 0);
}

TEST(Echo, is_not_delivered) {
    Segment line;
    Talker a{.own = 3, .ears = true, .plan = {{10_us, request(3)}, {90_us, request(127)}, {200_us, {1, 2, 3}}}};
    ASSERT_TRUE(line.attach(a));
    line.run(1_ms);
    EXPECT_TRUE(a.told.empty());
}

TEST(Propagation, delays_carrier_and_telegram_by_the_distance) {
    Segment line;
    Talker master{.ears = true, .plan = {{10_us, request(3)}}}, slave{.own = 3, .tsdr_bits = 50}, spy{.ears = true};
    ASSERT_TRUE(line.attach(master, "m", {.position = 100_ns}));
    ASSERT_TRUE(line.attach(slave, "s", {.position = 600_ns}));
    ASSERT_TRUE(line.attach(spy, "y", {.position = 0_ns}));
    line.run(1_ms);
    const Ticks end = 10_us + kBit * 66;
    EXPECT_EQ(slave.told, (std::vector<test::Told>{{"carrier", 10_us + 500_ns}, {"telegram", end + 500_ns}}));
    const Ticks reply = end + 500_ns + kBit * 50;
    EXPECT_EQ(master.told,
              (std::vector<test::Told>{{"carrier", reply + 500_ns}, {"telegram", reply + kBit * 11 + 500_ns}}));
    EXPECT_EQ(spy.told[0], (test::Told{"carrier", 10_us + 100_ns}));
    EXPECT_EQ(spy.told[1], (test::Told{"telegram", end + 100_ns}));
    EXPECT_EQ(spy.told[3], (test::Told{"telegram", reply + kBit * 11 + 600_ns}));
}

TEST(Propagation, lets_two_collide_that_do_not_overlap_at_one_place) {
    Segment line;
    const Ticks end = 10_us + kBit * 66;
    Talker a{.plan = {{10_us, request(3)}}}, b{.plan = {{end + 100_ns, {0xE5}}}}, spy{.ears = true};
    ASSERT_TRUE(line.attach(a, "a"));
    ASSERT_TRUE(line.attach(b, "b", {.position = 500_ns}));
    ASSERT_TRUE(line.attach(spy, "y"));
    line.run(1_ms);
    EXPECT_EQ(line.counters().collisions, 1u);
}

TEST(Crystal, converts_between_the_stations_ticks_and_the_lines) {
    Segment line;
    const std::int32_t ppb = 100'000;  // 100 ppm fast
    Talker master{.plan = {{10_ms, request(3)}}}, slave{.own = 3, .tsdr_bits = 4000, .alarm = 20_ms};
    ASSERT_TRUE(line.attach(master));
    ASSERT_TRUE(line.attach(slave, "s", {.crystal_ppb = ppb}));
    test::Recorder record;
    line.observe(record);
    line.run(30_ms);
    const core::Clock clock{ppb};
    const Ticks end = 10_ms + kBit * 66;
    ASSERT_EQ(slave.told.size(), 3u);
    EXPECT_EQ(slave.told[0], (test::Told{"carrier", clock.local(10_ms)}));
    EXPECT_EQ(slave.told[1], (test::Told{"telegram", clock.local(end)}));
    ASSERT_EQ(record.entries.size(), 2u);
    EXPECT_EQ(record.entries[1].start, clock.line(clock.local(end) + kBit * 4000));
    EXPECT_LT(record.entries[1].start, end + kBit * 4000);
    EXPECT_EQ(slave.told[2], (test::Told{"alarm", 20_ms}));
    EXPECT_EQ(slave.count("time ran backwards"), 0u);
}

TEST(Time, next_is_exact_and_never_in_the_past) {
    Segment line;
    Talker a{.alarm = 50_us};
    ASSERT_TRUE(line.attach(a));
    EXPECT_EQ(line.next(), 50_us);
    a.alarm = 80_us;  // later without touch: found out when it matters
    EXPECT_EQ(line.next(), 80_us);
    line.advance(100_us);
    EXPECT_EQ(a.told, (std::vector<test::Told>{{"alarm", 80_us}}));
    EXPECT_EQ(line.next(), kNever);
    a.alarm = 20_us;
    line.touch(0);
    EXPECT_EQ(a.told.back(), (test::Told{"alarm", 100_us}));
}

TEST(Time, run_until_stops_at_the_tick_that_makes_it_true_or_at_the_limit) {
    Segment line;
    Talker a{.alarm = 50_us};
    ASSERT_TRUE(line.attach(a));
    EXPECT_TRUE(line.run_until([&] { return a.count("alarm") == 1; }, 1_ms));
    EXPECT_EQ(line.now(), 50_us);
    EXPECT_FALSE(line.run_until([&] { return a.count("alarm") == 2; }, 1_ms));
    EXPECT_EQ(line.now(), 1_ms + 50_us);
}

TEST(Time, settle_brings_every_station_to_now) {
    Segment line;
    Talker a, b;
    ASSERT_TRUE(line.attach(a));
    ASSERT_TRUE(line.attach(b));
    line.advance(7_us);
    EXPECT_NE(a.now, 7_us);
    line.settle();
    EXPECT_EQ(a.now, 7_us);
    EXPECT_EQ(b.now, 7_us);
}

/// A busy line: one asker, slaves, collisions, faults. The same seed gives the same line.
struct Busy {
    Segment line;
    std::vector<std::unique_ptr<Talker>> talkers;
    test::Recorder record;
    segment::RandomFaults faults{7, {0, 30'000, 20'000, 20'000, 20'000, 20'000, 20'000, 20'000, 20'000}};

    explicit Busy(bool positions) {
        segment::Random random{42};
        auto master = std::make_unique<Talker>();
        master->ears = true;
        Ticks at = 10_us;
        for (int n = 0; n < 600; ++n) {
            at += kBit * static_cast<std::int64_t>(60 + random.below(300));
            master->plan.emplace_back(at, random.below(9) == 0 ? request(127, 2, {1, 2})
                                                               : request(static_cast<std::uint8_t>(3 + random.below(20)), 2, {1, 2, 3}));
        }
        talkers.push_back(std::move(master));
        for (std::uint8_t i = 0; i < 20; ++i) {
            auto slave = std::make_unique<Talker>();
            slave->own = static_cast<std::uint8_t>(3 + i);
            slave->ears = i % 7 == 0;
            slave->tsdr_bits = 11 + i;
            slave->reply = test::answer(2, slave->own, {i, 1, 2});
            slave->alarm = microseconds_of(i);
            talkers.push_back(std::move(slave));
        }
        for (std::size_t i = 0; i < talkers.size(); ++i)
            EXPECT_TRUE(line.attach(*talkers[i], {}, {.crystal_ppb = positions ? static_cast<std::int32_t>(i * 1000) : 0,
                                                      .position = positions ? Ticks{static_cast<std::int64_t>(i * 77)} : Ticks{}}));
        line.observe(record);
        line.set_faults(segment::FaultRef{faults});
    }
    static Ticks microseconds_of(int i) { return core::microseconds(100 + 13 * i); }
};

class Chunks : public ::testing::TestWithParam<bool> {};

TEST_P(Chunks, of_advance_do_not_change_anything) {
    constexpr Ticks kEnd = 20_ms;
    Busy whole{GetParam()}, steps{GetParam()}, odd{GetParam()}, exact{GetParam()};
    whole.line.advance(kEnd);
    for (Ticks at{}; at < kEnd; at += Ticks{50'021}) steps.line.advance(at);
    steps.line.advance(kEnd);
    segment::Random random{1};
    while (odd.line.now() < kEnd) odd.line.advance(std::min(kEnd, odd.line.now() + Ticks{static_cast<std::int64_t>(random.below(3'000'000))}));
    while (exact.line.next() <= kEnd) exact.line.advance(exact.line.next());
    ASSERT_GT(whole.record.entries.size(), 700u);
    ASSERT_GT(whole.line.counters().collisions, 5u);
    for (const Busy* other : {&steps, &odd, &exact}) {
        ASSERT_EQ(other->record.entries, whole.record.entries);
        for (std::size_t i = 0; i < whole.talkers.size(); ++i) EXPECT_EQ(other->talkers[i]->told, whole.talkers[i]->told) << i;
    }
    for (const auto& t : whole.talkers) EXPECT_EQ(t->count("time ran backwards"), 0u);
    for (std::size_t kind = 1; kind < segment::kFaultKinds; ++kind)
        EXPECT_GT(whole.faults.counts()[kind], 0u) << segment::name(static_cast<segment::FaultKind>(kind));
}
INSTANTIATE_TEST_SUITE_P(PlainAndLongCable, Chunks, ::testing::Bool());

TEST(Many, stations_125_answer_in_turn_and_only_the_addressed_one_is_disturbed) {
    Segment line;
    std::vector<Talker> slaves(125);
    Talker master;
    master.ears = true;
    Ticks at = 10_us;
    for (int round = 0; round < 3; ++round)
        for (std::uint8_t i = 0; i < 125; ++i, at += kBit * 400) master.plan.emplace_back(at, request(static_cast<std::uint8_t>(1 + i)));
    ASSERT_TRUE(line.attach(master));
    for (std::size_t i = 0; i < slaves.size(); ++i) {
        slaves[i].own = static_cast<std::uint8_t>(1 + i);
        slaves[i].alarm = 1_s;  // a watchdog that never comes up
        ASSERT_TRUE(line.attach(slaves[i]));
    }
    segment::Judge judge;
    line.observe(judge);
    line.advance(at);
    EXPECT_EQ(master.count("telegram"), 375u);
    for (const Talker& s : slaves) EXPECT_EQ(s.told.size(), 6u);  // carrier and telegram, its own three times
    EXPECT_TRUE(judge.clean()) << judge.total();
    EXPECT_EQ(judge.answers(), 375u);
}

TEST(Disturbance, is_heard_by_everybody_and_refused_when_it_makes_no_sense) {
    Segment line;
    Talker a{.own = 3}, b{.own = 4};
    ASSERT_TRUE(line.attach(a));
    ASSERT_TRUE(line.attach(b));
    line.advance(1_us);
    const std::vector<std::uint8_t> octets{0x55, 0xAA}, faults{0, fdl::fault_parity};
    EXPECT_FALSE(line.disturb(500_ns, kBit, octets));
    EXPECT_FALSE(line.disturb(2_us, kBit, {}));
    EXPECT_TRUE(line.disturb(2_us, kBit, octets, faults));
    line.advance(10_us);
    const std::vector<test::Told> expected{{"carrier", 2_us}, {"character 85 faults 0", 2_us + kBit * 11}, {"character 170 faults 1", 2_us + kBit * 22}};
    EXPECT_EQ(a.told, expected);
    EXPECT_EQ(b.told, expected);
}

TEST(Finish, ends_a_transmission_before_its_bit_times_are_over_and_tells_its_sender) {
    struct Hasty : Talker {
        Ticks over = kNever;
        void sent(Ticks at) { over = at; }
    };
    Segment line;
    Hasty slave;
    slave.plan.emplace_back(10_us, test::answer(2, 3, {1, 2, 3}));
    Talker wire{.ears = true};
    ASSERT_TRUE(line.attach(wire));
    ASSERT_TRUE(line.attach(slave));
    line.advance(12_us);
    EXPECT_TRUE(line.busy());
    line.finish(0);  // sends nothing
    EXPECT_TRUE(line.busy());
    line.finish(1);
    EXPECT_FALSE(line.busy());
    EXPECT_EQ(slave.over, 12_us);
    EXPECT_EQ(wire.told, (std::vector<test::Told>{{"carrier", 10_us}, {"telegram", 12_us}}));
}

TEST(Injection, is_heard_at_once_and_answered_on_the_line) {
    Segment line;
    Talker wire{.ears = true}, slave{.own = 3};
    ASSERT_TRUE(line.attach(wire));
    ASSERT_TRUE(line.attach(slave));
    line.advance(1_ms);
    fdl::Transmission t{};
    const auto octets = request(3);
    t.assign(line.now() - kBit * 66, kBit, octets);
    line.inject(0, t);
    EXPECT_EQ(slave.count("telegram"), 1u);
    EXPECT_EQ(slave.count("wrong end"), 0u);
    EXPECT_EQ(line.next(), 1_ms + kBit * 11);
    line.run(1_ms);
    EXPECT_EQ(wire.count("telegram"), 1u);
    t.assign(line.now() - kBit * 66, kBit, octets);
    t.damaged = true;
    t.faults.fill(0);
    line.inject(0, t);
    EXPECT_EQ(std::ranges::count_if(slave.told, [](const auto& n) { return n.what.starts_with("character"); }), 6);
}

}  // namespace
