// SPDX-License-Identifier: Apache-2.0
// A chip on a line that the caller models: it does what it would do on a line of the library, at the same ticks.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <dpchip/dpchip.h>

namespace {

using Octets = std::vector<std::uint8_t>;

constexpr std::int64_t kMs = 60'000'000, kBit = 40'000, kCharacter = 11 * kBit;  // 1.5 Mbit/s
constexpr std::uint32_t kBaud = 1'500'000;
const Octets kFdlStatus{0x10, 0x08, 0x02, 0x49, 0x53, 0x16}, kFdlAnswer{0x10, 0x02, 0x08, 0x00, 0x0A, 0x16};

struct Sent {
    std::int64_t start;
    Octets octets;
    bool operator==(const Sent&) const = default;
};

class OwnLine : public testing::Test {
protected:
    OwnLine() { set_up(chip.get()); }

    static void set_up(dpchip_chip* c) {
        EXPECT_EQ(dpchip_chip_set_option(c, "baud_probe_ms", "1"), DPCHIP_OK);
        EXPECT_EQ(dpchip_chip_set_access_time(c, 0), DPCHIP_OK);
        const std::array<std::pair<std::uint16_t, std::uint8_t>, 17> cells{{{0x24, 6}, {0x25, 6}, {0x26, 0x16}, {0x27, 0x17},
            {0x28, 24}, {0x2B, 0x18}, {0x30, 0x1C}, {0x32, 0x20}, {0x33, 2}, {0x34, 0x24}, {0x17, 0x08}, {0x40, 0xFF},
            {0x06, 0xC0}, {0x07, 0x01}, {0x16, 8}, {0x3A, 0x11}, {0x3B, 0x47}}};
        for (const auto& [cell, value] : cells) dpchip_chip_write(c, cell, value);
        dpchip_chip_write(c, 0x08, 0x01);
    }
    /// From event to event, keeping what the chip sends.
    void run_to(std::int64_t end) {
        for (;;) {
            const std::int64_t at = std::min(end, dpchip_chip_next_ticks(chip.get()));
            ASSERT_EQ(dpchip_chip_run_ticks(chip.get(), at - dpchip_chip_now_ticks(chip.get())), DPCHIP_OK);
            dpchip_telegram t{};
            t.size = sizeof t;
            if (dpchip_chip_take(chip.get(), &t) == 1) {
                EXPECT_EQ(t.end_ticks - t.start_ticks, t.length * kCharacter);
                sent.push_back({t.start_ticks, Octets(t.octets, t.octets + t.length)});
            }
            if (at == end) return;
        }
    }
    void hear(const Octets& telegram, std::int64_t start) {
        run_to(start);
        EXPECT_EQ(dpchip_chip_carrier(chip.get()), DPCHIP_OK);
        run_to(start + static_cast<std::int64_t>(telegram.size()) * kCharacter);
        EXPECT_EQ(dpchip_chip_hear(chip.get(), telegram.data(), telegram.size(), kBaud), DPCHIP_OK) << dpchip_last_error();
    }

    std::unique_ptr<dpchip_chip, decltype(&dpchip_chip_destroy)> chip{dpchip_chip_create("vpc3+c"), &dpchip_chip_destroy};
    std::vector<Sent> sent;
};

TEST_F(OwnLine, a_chip_answers_as_on_a_line_of_the_library_at_the_same_ticks) {
    const std::unique_ptr<dpchip_line, decltype(&dpchip_line_close)> line{dpchip_line_open("sim:", kBaud), &dpchip_line_close};
    const std::unique_ptr<dpchip_chip, decltype(&dpchip_chip_destroy)> other{dpchip_chip_create("vpc3+c"), &dpchip_chip_destroy};
    ASSERT_EQ(dpchip_line_attach(line.get(), other.get()), DPCHIP_OK);
    ASSERT_EQ(dpchip_line_watch(line.get(), 1), DPCHIP_OK);
    set_up(other.get());
    std::vector<Sent> expected;
    for (const std::int64_t start : {3 * kMs + kMs / 2, 5 * kMs + 1, 6 * kMs + 77'777}) {
        ASSERT_EQ(dpchip_line_post(line.get(), kFdlStatus.data(), kFdlStatus.size(), start), DPCHIP_OK);
        dpchip_line_run_ticks(line.get(), start + kMs / 2 - dpchip_line_now_ticks(line.get()));
        hear(kFdlStatus, start);
        run_to(start + kMs / 2);
    }
    dpchip_telegram t{};
    t.size = sizeof t;
    while (dpchip_line_telegram(line.get(), &t) == 1)
        if (t.own == 0) expected.push_back({t.start_ticks, Octets(t.octets, t.octets + t.length)});
    ASSERT_EQ(expected.size(), 2u);
    EXPECT_EQ(expected[0].octets, kFdlAnswer);
    EXPECT_EQ(sent, expected);
}

TEST_F(OwnLine, an_answer_is_given_up_when_somebody_else_begins) {
    hear(kFdlStatus, 3 * kMs + kMs / 2);
    hear(kFdlStatus, 5 * kMs);
    EXPECT_EQ(dpchip_chip_carrier(chip.get()), DPCHIP_OK);
    run_to(6 * kMs);
    EXPECT_TRUE(sent.empty());
}

TEST_F(OwnLine, a_character_with_a_parity_error_spoils_its_telegram) {
    hear(kFdlStatus, 3 * kMs + kMs / 2);
    for (const int faults : {0, int{DPCHIP_FAULT_PARITY}, int{DPCHIP_FAULT_STOP}}) {
        sent.clear();
        run_to(dpchip_chip_now_ticks(chip.get()) + kMs);
        for (std::size_t i = 0; i < kFdlStatus.size(); ++i) {
            run_to(dpchip_chip_now_ticks(chip.get()) + kCharacter);
            EXPECT_EQ(dpchip_chip_hear_character(chip.get(), kFdlStatus[i], i == 4 ? faults : 0, kBaud), DPCHIP_OK);
        }
        run_to(dpchip_chip_now_ticks(chip.get()) + kMs);
        EXPECT_EQ(sent.size(), faults == 0 ? 1u : 0u) << faults;
    }
}

TEST_F(OwnLine, what_makes_no_sense_is_refused) {
    dpchip_telegram t{};
    EXPECT_EQ(dpchip_chip_take(chip.get(), &t), DPCHIP_E_ARGUMENT) << "no size";
    t.size = sizeof t;
    EXPECT_EQ(dpchip_chip_take(chip.get(), &t), 0);
    EXPECT_EQ(dpchip_chip_hear(chip.get(), kFdlStatus.data(), 5, kBaud), DPCHIP_E_ARGUMENT) << "not a whole telegram";
    EXPECT_EQ(dpchip_chip_hear(chip.get(), kFdlStatus.data(), kFdlStatus.size(), 1234), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_chip_hear(chip.get(), nullptr, 1, kBaud), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_chip_hear_character(chip.get(), 0, 8, kBaud), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_chip_carrier(nullptr), DPCHIP_E_ARGUMENT);
    const std::unique_ptr<dpchip_line, decltype(&dpchip_line_close)> line{dpchip_line_open("sim:", kBaud), &dpchip_line_close};
    ASSERT_EQ(dpchip_line_attach(line.get(), chip.get()), DPCHIP_OK);
    EXPECT_EQ(dpchip_chip_take(chip.get(), &t), DPCHIP_E_STATE);
    EXPECT_EQ(dpchip_chip_hear(chip.get(), kFdlStatus.data(), kFdlStatus.size(), kBaud), DPCHIP_E_STATE);
    EXPECT_EQ(dpchip_chip_hear_character(chip.get(), 0, 0, kBaud), DPCHIP_E_STATE);
    EXPECT_EQ(dpchip_chip_carrier(chip.get()), DPCHIP_E_STATE);
}

}  // namespace
