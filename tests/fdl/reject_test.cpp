// SPDX-License-Identifier: Apache-2.0
// Every reason to reject a telegram has a test of its name (reference 2.1, 2.4).
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/fdl/assembler.hpp>
#include <dpchip/fdl/baud.hpp>
#include <dpchip/fdl/telegram.hpp>

namespace {

using namespace dpchip::fdl;
using Octets = std::vector<std::uint8_t>;

const Octets kStatus{0x10, 0x08, 0x02, 0x49, 0x53, 0x16};
const Octets kDiagnosis{0x68, 0x05, 0x05, 0x68, 0x82, 0xE3, 0x6D, 0x3C, 0x3E, 0x4C, 0x16};
const Octets kSd3Telegram{0xA2, 0x08, 0x02, 0x5D, 1, 2, 3, 4, 5, 6, 7, 8, 0x8B, 0x16};

Octets with(Octets octets, std::size_t at, std::uint8_t value) {
    octets.at(at) = value;
    return octets;
}

struct Case {
    const char* test;
    Reject reason;
    std::vector<Octets> octets;
};

class WholeTelegram : public ::testing::TestWithParam<Case> {};

TEST_P(WholeTelegram, is_rejected_by_name) {
    for (const Octets& octets : GetParam().octets) {
        const auto telegram = decode(octets);
        ASSERT_FALSE(telegram);
        EXPECT_EQ(telegram.error(), GetParam().reason) << name(telegram.error());
    }
}

INSTANTIATE_TEST_SUITE_P(
    Reject, WholeTelegram,
    ::testing::Values(
        Case{"need_more", Reject::need_more,
             {{}, {0x10}, {0x68}, {0x68, 5}, {0x68, 5, 5}, {0x68, 5, 5, 0x68}, {0xDC, 2}, {0xA2, 8, 2}}},
        Case{"start_delimiter", Reject::start_delimiter, {{0x00}, {0x16}, {0xFF, 1, 2, 3}, {0xE4}, {0x11, 8, 2, 0x49, 0x53, 0x16}}},
        Case{"length_mismatch", Reject::length_mismatch, {with(kDiagnosis, 2, 6), {0x68, 4, 5}, {0x68, 249, 248}}},
        Case{"length_range", Reject::length_range, {with(kDiagnosis, 1, 3), {0x68, 0}, {0x68, 250}, {0x68, 255}}},
        Case{"second_start_delimiter", Reject::second_start_delimiter, {with(kDiagnosis, 3, 0x69), {0x68, 4, 4, 0x10}}},
        Case{"checksum", Reject::checksum,
             {with(kStatus, 4, 0x54), with(kStatus, 1, 9), with(kDiagnosis, 9, 0), with(kDiagnosis, 7, 0x3D),
              with(kSd3Telegram, 12, 0), with(kSd3Telegram, 11, 9)}},
        Case{"end_delimiter", Reject::end_delimiter,
             {with(kStatus, 5, 0x17), with(kDiagnosis, 10, 0), with(kSd3Telegram, 13, 0xE5)}}),
    [](const auto& tested) { return std::string{tested.param.test}; });

TEST(WholeTelegram, is_taken_when_nothing_is_wrong_with_it) {
    EXPECT_TRUE(decode(kStatus));
    EXPECT_TRUE(decode(kDiagnosis));
    EXPECT_TRUE(decode(kSd3Telegram));
}

TEST(RejectNames, are_all_different_and_known) {
    std::vector<std::string> names;
    for (int i = 0; i <= static_cast<int>(Reject::collision); ++i) names.emplace_back(name(static_cast<Reject>(i)));
    std::sort(names.begin(), names.end());
    EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
    EXPECT_EQ(std::find(names.begin(), names.end(), "unknown"), names.end());
    EXPECT_STREQ(name(static_cast<Reject>(200)), "unknown");
}

// ---- the reasons that only characters can show -------------------------------------------------------------------

constexpr Ticks kBit = baud(BaudCode::mbit_1_5).bit;

/// Sends octets character by character; one of them may come late or be damaged.
struct Line {
    Assembler assembler;
    Ticks at{};

    dpchip::core::Result<Telegram, Reject> send(std::uint8_t octet, std::uint8_t faults = fault_none, Ticks late = {}) {
        const Character c{at + late, kBit, octet, faults};
        at = c.end();
        return assembler.push(c);
    }
    dpchip::core::Result<Telegram, Reject> send(const Octets& octets) {
        dpchip::core::Result<Telegram, Reject> last{Reject::need_more};
        for (const std::uint8_t octet : octets) last = send(octet);
        return last;
    }
    void idle(std::int64_t bits) { at += kBit * bits; }
};

class DamagedCharacter : public ::testing::TestWithParam<std::size_t> {};

TEST_P(DamagedCharacter, with_wrong_parity_rejects_the_telegram_as_parity) {
    Line line;
    for (std::size_t i = 0; i < GetParam(); ++i) EXPECT_EQ(line.send(kStatus[i]).error(), Reject::need_more);
    EXPECT_EQ(line.send(kStatus[GetParam()], fault_parity).error(), Reject::parity);
}
TEST_P(DamagedCharacter, without_stop_bit_rejects_the_telegram_as_stop_bit) {
    Line line;
    for (std::size_t i = 0; i < GetParam(); ++i) EXPECT_EQ(line.send(kStatus[i]).error(), Reject::need_more);
    EXPECT_EQ(line.send(kStatus[GetParam()], fault_stop).error(), Reject::stop_bit);
}
TEST_P(DamagedCharacter, from_two_senders_rejects_the_telegram_as_collision) {
    Line line;
    for (std::size_t i = 0; i < GetParam(); ++i) EXPECT_EQ(line.send(kStatus[i]).error(), Reject::need_more);
    EXPECT_EQ(line.send(kStatus[GetParam()], fault_collision | fault_parity).error(), Reject::collision);
}
TEST_P(DamagedCharacter, behind_a_gap_rejects_the_telegram_as_gap_unless_it_is_the_first) {
    Line line;
    for (std::size_t i = 0; i < GetParam(); ++i) EXPECT_EQ(line.send(kStatus[i]).error(), Reject::need_more);
    const auto verdict = line.send(kStatus[GetParam()], fault_none, kBit);
    EXPECT_EQ(verdict.error(), GetParam() == 0 ? Reject::need_more : Reject::gap);
}
INSTANTIATE_TEST_SUITE_P(Octet, DamagedCharacter, ::testing::Range(std::size_t{0}, std::size_t{6}));

TEST(Receiver, tolerates_a_quarter_of_a_bit_between_characters_and_no_more) {
    for (const std::int64_t sign : {1, -1}) {
        Line good, bad;
        EXPECT_EQ(good.send(0x10).error(), Reject::need_more);
        EXPECT_EQ(bad.send(0x10).error(), Reject::need_more);
        const Ticks quarter{kBit.n / 4 * sign};
        EXPECT_EQ(good.send(0x08, fault_none, quarter).error(), Reject::need_more);
        EXPECT_EQ(bad.send(0x08, fault_none, quarter + Ticks{sign}).error(), Reject::gap);
    }
}

TEST(Receiver, is_deaf_after_an_error_until_33_bit_times_of_idle_and_hears_the_next_telegram) {
    Line line;
    EXPECT_EQ(line.send(0x00).error(), Reject::start_delimiter);
    EXPECT_FALSE(line.assembler.synchronous());
    line.idle(30);  // 00h ends with its parity bit low: the stop bit counts as idle, so 31 of 33
    EXPECT_EQ(line.send(kStatus).error(), Reject::need_more);
    EXPECT_FALSE(line.assembler.synchronous());
    line.idle(33);
    ASSERT_TRUE(line.send(kStatus));
    EXPECT_TRUE(std::ranges::equal(line.assembler.bytes(), kStatus));
}

TEST(Receiver, counts_idle_time_from_the_last_low_bit) {
    Line line;
    EXPECT_EQ(line.send(0x00).error(), Reject::start_delimiter);
    line.idle(32);  // and the stop bit makes 33
    EXPECT_TRUE(line.send(kStatus));
}

TEST(Receiver, needs_no_idle_time_between_good_telegrams) {
    Line line;
    EXPECT_TRUE(line.send(kStatus));
    EXPECT_TRUE(line.send(kDiagnosis));
    line.idle(11);
    EXPECT_TRUE(line.send(std::uint8_t{0xE5}));
    EXPECT_TRUE(line.send({0xDC, 2, 2}));
}

TEST(Receiver, gives_up_a_telegram_that_stopped_and_takes_the_one_behind_the_pause) {
    Line line;
    EXPECT_EQ(line.send({0x68, 5, 5}).error(), Reject::need_more);
    line.idle(40);
    EXPECT_TRUE(line.send(kStatus));
    EXPECT_EQ(line.assembler.abandoned(), 1u);
}

TEST(Receiver, is_synchronous_behind_an_undamaged_telegram_it_was_told_of) {
    Line line;
    EXPECT_EQ(line.send(0x00).error(), Reject::start_delimiter);
    line.at += kBit * 100;
    line.assembler.synchronise(line.at);
    EXPECT_TRUE(line.send(kStatus));
}

}  // namespace
