// SPDX-License-Identifier: Apache-2.0
// Stations of the C API whose bits are the caller's, and telegrams that are told as they begin.
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <dpchip/dpchip.h>

namespace {

using Octets = std::vector<std::uint8_t>;

constexpr std::int64_t kBit = 40'000;  // 1.5 Mbit/s
const Octets kStatus{0x10, 0x08, 0x02, 0x49, 0x53, 0x16}, kAnswer{0x10, 0x02, 0x08, 0x00, 0x0A, 0x16};

struct LineDeleter { void operator()(dpchip_line* l) const { dpchip_line_close(l); } };

class Joined : public testing::Test {
protected:
    Joined() : line{dpchip_line_open("sim:", 1'500'000)}, station{dpchip_line_join(line.get(), 1'500'000)} {
        EXPECT_GE(station, 0);
        EXPECT_EQ(dpchip_line_watch(line.get(), 3), DPCHIP_OK);
    }
    void run(std::int64_t ticks) { EXPECT_EQ(dpchip_line_run_ticks(line.get(), ticks), ticks); }
    std::int64_t now() const { return dpchip_line_now_ticks(line.get()); }
    int sent(const Octets& octets, const std::uint8_t* faults = nullptr) {
        return dpchip_line_joined_sent(line.get(), station, octets.data(), faults, octets.size(), now() - 11 * kBit * static_cast<std::int64_t>(octets.size()));
    }
    using Take = int (*)(dpchip_line*, dpchip_telegram*);
    std::vector<dpchip_telegram> all(Take take) {
        std::vector<dpchip_telegram> taken;
        dpchip_telegram t{};
        t.size = sizeof t;
        while (take(line.get(), &t) == 1) taken.push_back(t);
        return taken;
    }
    static Octets octets(const dpchip_telegram& t) { return {t.octets, t.octets + t.length}; }

    std::unique_ptr<dpchip_line, LineDeleter> line;
    int station;
};

TEST_F(Joined, what_it_sends_is_on_the_line_with_its_own_time) {
    run(100 * kBit);
    ASSERT_EQ(dpchip_line_joined_begins(line.get(), station), DPCHIP_OK);
    EXPECT_EQ(dpchip_line_joined_begins(line.get(), station), DPCHIP_E_STATE) << "it is sending already";
    run(66 * kBit);
    ASSERT_EQ(sent(kAnswer), DPCHIP_OK);
    EXPECT_EQ(sent(kAnswer), DPCHIP_E_STATE) << "it has not begun";
    const auto seen = all(dpchip_line_telegram);
    ASSERT_EQ(seen.size(), 1u);
    EXPECT_EQ(seen[0].start_ticks, 100 * kBit);
    EXPECT_EQ(octets(seen[0]), kAnswer);
    EXPECT_EQ(seen[0].own, 0);
    EXPECT_EQ(seen[0].damaged, 0);
    EXPECT_TRUE(all(dpchip_line_begun).empty()) << "its own telegrams are not told";
    Octets answer(255);
    ASSERT_EQ(dpchip_line_receive(line.get(), answer.data(), answer.size(), 0), 6) << "the test has heard it";
}

TEST_F(Joined, telegrams_of_others_are_told_when_they_begin) {
    ASSERT_EQ(dpchip_line_post(line.get(), kStatus.data(), kStatus.size(), 100 * kBit), DPCHIP_OK);
    run(100 * kBit);
    const auto begun = all(dpchip_line_begun);
    ASSERT_EQ(begun.size(), 1u);
    EXPECT_EQ(octets(begun[0]), kStatus);
    EXPECT_EQ(begun[0].start_ticks, now());
    EXPECT_EQ(begun[0].end_ticks, now() + 66 * kBit);
    EXPECT_TRUE(all(dpchip_line_telegram).empty());
    run(66 * kBit);
    EXPECT_EQ(all(dpchip_line_telegram).size(), 1u);
    EXPECT_EQ(dpchip_line_watch(line.get(), 1), DPCHIP_OK);
    ASSERT_EQ(dpchip_line_send(line.get(), kStatus.data(), kStatus.size()), DPCHIP_OK);
    EXPECT_TRUE(all(dpchip_line_begun).empty());
    EXPECT_EQ(all(dpchip_line_telegram).size(), 1u);
}

TEST_F(Joined, faults_and_what_is_no_telegram_are_damage) {
    const Octets parity{0, 0, DPCHIP_FAULT_PARITY, 0, 0, 0};
    run(100 * kBit);
    for (const auto& [telegram, faults] : {std::pair{kAnswer, parity.data()}, std::pair{Octets{0x10, 0x02}, static_cast<const std::uint8_t*>(nullptr)}}) {
        ASSERT_EQ(dpchip_line_joined_begins(line.get(), station), DPCHIP_OK);
        run(66 * kBit);
        ASSERT_EQ(sent(telegram, faults), DPCHIP_OK);
        const auto seen = all(dpchip_line_telegram);
        ASSERT_EQ(seen.size(), 1u);
        EXPECT_EQ(seen[0].damaged, 1);
    }
}

TEST_F(Joined, what_cannot_be_is_refused) {
    EXPECT_EQ(dpchip_line_join(nullptr, 1'500'000), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_line_join(line.get(), 1234), DPCHIP_E_ARGUMENT);
    EXPECT_NE(std::string{dpchip_last_error()}.find("1234"), std::string::npos);
    EXPECT_EQ(dpchip_line_joined_begins(line.get(), station + 1), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_line_joined_begins(nullptr, station), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_line_begun(line.get(), nullptr), DPCHIP_E_ARGUMENT);
    run(10 * kBit);
    ASSERT_EQ(dpchip_line_joined_begins(line.get(), station), DPCHIP_OK);
    EXPECT_EQ(dpchip_line_joined_sent(line.get(), station, kAnswer.data(), nullptr, 6, now()), DPCHIP_E_ARGUMENT) << "it ends in the future";
    EXPECT_EQ(dpchip_line_joined_sent(line.get(), station, kAnswer.data(), nullptr, 6, INT64_MAX), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_line_joined_sent(line.get(), station, kAnswer.data(), nullptr, 256, 0), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_line_joined_sent(line.get(), station, kAnswer.data(), nullptr, 0, 0), DPCHIP_E_ARGUMENT);
    run(56 * kBit);
    EXPECT_EQ(sent(kAnswer), DPCHIP_OK);
    for (int i = 0; i < 300; ++i) static_cast<void>(dpchip_line_join(line.get(), 9600));
    EXPECT_EQ(dpchip_line_join(line.get(), 9600), DPCHIP_E_STATE) << "no room";
}

}  // namespace
