// SPDX-License-Identifier: Apache-2.0
// A station that sends what nobody knows before it has ended: who is told, what collides, what is heard.
#include <gtest/gtest.h>

#include <algorithm>

#include "segment/talker.hpp"

namespace {

using namespace dpchip::core::literals;
using namespace dpchip;
using core::Ticks;
using segment::Segment;
using test::answer;
using test::Recorder;
using test::request;
using test::Talker;

constexpr Ticks kBit = fdl::baud(fdl::BaudCode::mbit_12).bit;

class Announcement : public testing::Test {
protected:
    Announcement() {
        EXPECT_TRUE(line.attach(wire));    // 0
        EXPECT_TRUE(line.attach(master));  // 1
        EXPECT_TRUE(line.attach(slave));   // 2
        line.observe(recorder);
    }
    /// The master asks the slave at `at`.
    void ask(Ticks at) {
        master.plan = {{at, request(3)}};
        line.touch(1);
    }
    /// What station `i` has sent has ended now.
    void end(segment::StationIndex i, const std::vector<std::uint8_t>& octets) {
        fdl::Transmission t{};
        t.assign(line.now() - kBit * (11 * static_cast<std::int64_t>(octets.size())), kBit, octets);
        line.inject(i, t);
    }
    static std::ptrdiff_t garbled(const Talker& who) {
        return std::ranges::count_if(who.told, [](const auto& n) { return n.what.ends_with("faults 4"); });
    }

    Segment line;
    Talker wire{}, master{.ears = true}, slave{.own = 3};
    Recorder recorder;
};

TEST_F(Announcement, is_a_carrier_for_who_hears_all_and_a_telegram_with_its_true_start_at_the_end) {
    line.advance(1_ms);
    line.announce(0);
    EXPECT_TRUE(line.busy());
    EXPECT_EQ(master.told, (std::vector<test::Told>{{"carrier", 1_ms}}));
    EXPECT_TRUE(slave.told.empty()) << "nobody knows yet that it is for this station";
    line.run(kBit * 66);
    end(0, request(3));
    EXPECT_FALSE(line.busy());
    EXPECT_EQ(slave.count("telegram"), 1u);
    EXPECT_EQ(slave.count("wrong end"), 0u);
    ASSERT_EQ(recorder.entries.size(), 1u);
    EXPECT_EQ(recorder.entries[0].start, 1_ms);
    EXPECT_EQ(recorder.entries[0].sender, 0);
    EXPECT_EQ(line.counters().collisions, 0u);
    line.run(kBit * 22);
    EXPECT_EQ(recorder.entries.size(), 2u) << "and it is answered";
}

TEST_F(Announcement, makes_a_station_give_up_the_answer_that_it_plans) {
    ask(1_ms);
    line.advance(1_ms + kBit * (66 + 5));
    EXPECT_EQ(slave.count("telegram"), 1u);
    line.announce(0);
    EXPECT_EQ(slave.count("carrier"), 2u);
    line.run(kBit * 11);
    end(0, {fdl::kSc});
    line.run(1_ms);
    EXPECT_EQ(recorder.entries.size(), 2u) << "no answer";
}

TEST_F(Announcement, into_a_telegram_spoils_the_rest_of_that_and_its_own_overlap) {
    ask(1_ms);
    line.advance(1_ms + kBit * (4 * 11 + 5));
    line.announce(0);
    line.run(kBit * 66);
    end(0, answer(2, 9, {}));
    EXPECT_EQ(slave.count("telegram"), 0u);
    EXPECT_EQ(line.counters().collisions, 1u);
    ASSERT_EQ(recorder.entries.size(), 2u);
    const auto first = request(3), second = answer(2, 9, {});
    EXPECT_TRUE(recorder.entries[0].damaged);
    EXPECT_TRUE(std::equal(first.begin(), first.begin() + 4, recorder.entries[0].octets.begin())) << "what was over stays";
    EXPECT_TRUE(recorder.entries[1].damaged);
    EXPECT_TRUE(std::equal(second.begin() + 2, second.end(), recorder.entries[1].octets.begin() + 2)) << "what was alone stays";
    EXPECT_GE(garbled(slave), 2);
}

TEST_F(Announcement, is_hit_by_what_begins_before_its_end) {
    ask(1_ms + kBit * 50);
    line.advance(1_ms);
    line.announce(0);
    line.run(kBit * 66);
    end(0, answer(2, 9, {}));
    line.run(1_ms);
    EXPECT_EQ(slave.count("telegram"), 0u);
    ASSERT_EQ(recorder.entries.size(), 2u);
    EXPECT_TRUE(recorder.entries[0].damaged);
    EXPECT_TRUE(recorder.entries[1].damaged);
    EXPECT_EQ(line.counters().collisions, 1u);
    line.announce(0);
    line.run(kBit * 66);
    end(0, request(3));
    EXPECT_EQ(slave.count("telegram"), 1u) << "the next one is whole again";
}

TEST_F(Announcement, of_two_stations_at_a_time_spoils_both) {
    Talker other{};
    ASSERT_TRUE(line.attach(other));
    line.advance(1_ms);
    line.announce(0);
    line.run(kBit * 11);
    line.announce(3);
    line.run(kBit * 55);
    end(0, request(3));
    line.run(kBit * 11);
    end(3, request(3));
    ASSERT_EQ(recorder.entries.size(), 2u);
    for (const auto& e : recorder.entries) EXPECT_TRUE(e.damaged);
    EXPECT_EQ(slave.count("telegram"), 0u);
}

TEST_F(Announcement, ends_with_the_station) {
    line.advance(1_ms);
    line.announce(0);
    line.detach(0);
    EXPECT_FALSE(line.busy());
    ask(2_ms);
    line.advance(3_ms);
    EXPECT_EQ(slave.count("telegram"), 1u);
}

}  // namespace
