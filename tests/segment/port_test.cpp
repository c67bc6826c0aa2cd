// SPDX-License-Identifier: Apache-2.0
// A port sends at the earliest moment the bus rules allow, not a bit earlier or later, and keeps what the others say.
#include <algorithm>

#include <gtest/gtest.h>

#include "segment/talker.hpp"

#include <dpchip/segment/judge.hpp>
#include <dpchip/segment/port.hpp>

namespace {

using namespace dpchip;
using namespace dpchip::core::literals;
using core::Ticks;
using segment::Port;
using test::request;

constexpr fdl::BaudCode kRate = fdl::BaudCode::mbit_12;
constexpr Ticks kBit = fdl::baud(kRate).bit;

struct PortTest : ::testing::Test {
    segment::Segment line;
    Port port{kRate};
    test::Talker slave{.own = 3, .tsdr_bits = 36, .reply = test::answer(2, 3, {0xAB})};
    test::Recorder record;
    segment::Judge judge;

    void SetUp() override {
        ASSERT_TRUE(line.attach(port, "port"));
        ASSERT_TRUE(line.attach(slave, "slave 3"));
        line.observe(record);
        line.observe(judge);
    }
    /// Sends and runs until the last stop bit has passed.
    void send(const std::vector<std::uint8_t>& octets) {
        ASSERT_TRUE(port.send(octets));
        line.touch(0);
        ASSERT_TRUE(line.run_until([&] { return !port.sending(line.now()); }, 1_s));
    }
    Ticks last_start() const { return record.entries.back().start; }
};

TEST_F(PortTest, keeps_TID1_at_the_very_start) {
    ASSERT_TRUE(port.send(request(3)));
    line.touch(0);
    EXPECT_EQ(port.begins(), kBit * 76);
    line.run(1_ms);
    EXPECT_EQ(record.entries[0].start, kBit * 76);
}

TEST_F(PortTest, sends_at_once_on_a_line_idle_for_long) {
    line.advance(1_ms);
    ASSERT_TRUE(port.send(request(3)));
    line.touch(0);
    EXPECT_TRUE(port.sending(line.now()));
    line.run(1_ms);
    EXPECT_EQ(record.entries[0].start, 1_ms);
}

TEST_F(PortTest, receives_the_answer_and_waits_TID1_after_it) {
    line.advance(1_ms);
    ASSERT_TRUE(port.send(request(3)));
    line.touch(0);
    ASSERT_TRUE(line.run_until([&] { return port.pending(); }, 1_ms));
    const auto answer = port.receive();
    EXPECT_TRUE(std::ranges::equal(answer.bytes(), slave.reply));
    EXPECT_EQ(line.now(), answer.end());
    ASSERT_TRUE(port.send(request(3)));
    line.touch(0);
    line.run(1_ms);
    EXPECT_EQ(record.entries[2].start, answer.end() + kBit * 76);
    EXPECT_TRUE(judge.clean());
}

TEST_F(PortTest, waits_for_an_answer_it_does_not_fetch_before_it_sends_again) {
    line.advance(1_ms);
    ASSERT_TRUE(port.send(request(3)));
    line.touch(0);
    line.run_until([&] { return !port.sending(line.now()); }, 1_ms);
    ASSERT_TRUE(port.send(request(3)));
    line.touch(0);
    line.run(1_ms);
    ASSERT_EQ(record.entries.size(), 4u);
    EXPECT_EQ(record.entries[2].start, record.entries[1].end + kBit * 76);
    EXPECT_EQ(line.counters().collisions, 0u);
    EXPECT_TRUE(judge.clean());
}

TEST_F(PortTest, waits_the_slot_time_when_nobody_answers_and_TID2_after_a_broadcast) {
    line.advance(1_ms);
    const std::vector<std::vector<std::uint8_t>> sends{request(9), request(127, 2, {0, 0}), {0xDC, 2, 2}, request(3)};
    const std::int64_t idle[]{0, 1000, 800, 76};
    Ticks before{};
    for (std::size_t i = 0; i < sends.size(); ++i) {
        ASSERT_TRUE(port.send(sends[i]));
        line.touch(0);
        ASSERT_TRUE(line.run_until([&] { return !port.sending(line.now()); }, 1_s));
        const Ticks begin = port.sent_end() - kBit * (11 * static_cast<std::int64_t>(sends[i].size()));
        EXPECT_EQ(begin, i == 0 ? Ticks{1_ms} : before + kBit * idle[i]) << i;
        before = port.sent_end();
    }
    EXPECT_TRUE(judge.clean());
}

TEST_F(PortTest, sends_garbage_as_damaged_characters_and_the_next_telegram_after_TID1) {
    line.advance(1_ms);
    const std::vector<std::uint8_t> bad{0x10, 3, 2, 0x7D, 0, 0x16};
    send(bad);
    EXPECT_EQ(slave.told.size(), 7u);
    EXPECT_EQ(slave.told[4].what, "character 125 faults 0");
    const Ticks end = port.sent_end();
    send(request(3));
    EXPECT_EQ(last_start(), end + kBit * 76);
}

TEST_F(PortTest, sends_faults_at_a_tick_of_its_own_choice) {
    const std::vector<std::uint8_t> faults{0, fdl::fault_parity};
    line.advance(100_us);
    line.settle();
    EXPECT_FALSE(port.send_at(99_us, request(3)));
    ASSERT_TRUE(port.send_at(200_us, request(3), faults));
    line.touch(0);
    line.run(1_ms);
    EXPECT_EQ(record.entries[0].start, 200_us);
    EXPECT_EQ(slave.told[2].what, "character 3 faults 1");
}

TEST_F(PortTest, refuses_a_second_telegram_while_one_waits_and_sizes_that_do_not_exist) {
    EXPECT_FALSE(port.send({}));
    EXPECT_FALSE(port.send(std::vector<std::uint8_t>(256)));
    EXPECT_TRUE(port.send(request(3)));
    EXPECT_FALSE(port.send(request(3)));
    port.cancel();
    EXPECT_TRUE(port.send(request(3)));
}

TEST_F(PortTest, gives_damaged_answers_as_they_arrived_once_the_line_is_idle) {
    const segment::ScriptedFaults::Line script[]{{1, {.kind = segment::FaultKind::parity, .octet = 2}}};
    segment::ScriptedFaults faults{script};
    line.set_faults(segment::FaultRef{faults});
    line.advance(1_ms);
    ASSERT_TRUE(port.send(request(3)));
    line.touch(0);
    ASSERT_TRUE(line.run_until([&] { return port.pending(); }, 1_ms));
    const auto got = port.receive();
    EXPECT_TRUE(got.damaged);
    EXPECT_EQ(got.length, slave.reply.size());
    EXPECT_EQ(got.faults[2], fdl::fault_parity);
    EXPECT_EQ(line.now(), got.end() + kBit * 33);
    EXPECT_FALSE(port.pending());
}

TEST_F(PortTest, counts_what_its_inbox_could_not_take) {
    test::Talker chatty{};
    for (int i = 0; i < 20; ++i) chatty.plan.emplace_back(core::microseconds(10 + 20 * i), std::vector<std::uint8_t>{0xE5});
    ASSERT_TRUE(line.attach(chatty));
    line.run(1_ms);
    EXPECT_EQ(port.overflows(), 4u);
    port.clear();
    EXPECT_FALSE(port.pending());
}

TEST_F(PortTest, hears_the_rest_of_a_transmission_it_collided_with_and_sends_again) {
    test::Talker rude{.plan = {{1_ms + kBit * 10, request(99, 2, std::vector<std::uint8_t>(20))}}};
    ASSERT_TRUE(line.attach(rude));
    line.advance(1_ms);
    send(request(9));
    EXPECT_EQ(line.counters().collisions, 1u);
    send(request(3));
    ASSERT_TRUE(line.run_until([&] { return port.pending(); }, 1_ms));
    EXPECT_TRUE(port.receive().damaged);
    ASSERT_TRUE(line.run_until([&] { return port.pending(); }, 1_ms));
    EXPECT_FALSE(port.receive().damaged);
}

}  // namespace
