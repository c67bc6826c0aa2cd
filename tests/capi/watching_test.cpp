// SPDX-License-Identifier: Apache-2.0
// What callers with a clock of their own need from the C API: edges of the outputs, a chip's next event, telegrams that
// are planned and telegrams that were on the line.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <dpchip/dpchip.h>

namespace {

using Octets = std::vector<std::uint8_t>;

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kUs = 60'000, kMs = 1000 * kUs, kBit = 40'000;  // 1.5 Mbit/s
constexpr std::int64_t kFound = 3 * kMs + kMs / 2;  // the search listens at 1.5 Mbit/s; what proves the rate is not answered

struct ChipDeleter { void operator()(dpchip_chip* c) const { dpchip_chip_destroy(c); } };
struct LineDeleter { void operator()(dpchip_line* l) const { dpchip_line_close(l); } };

class Watching : public testing::Test {
protected:
    Watching() : line{dpchip_line_open("sim:", 1'500'000)}, chip{dpchip_chip_create("vpc3+c")} {
        EXPECT_EQ(dpchip_chip_set_option(chip.get(), "baud_probe_ms", "1"), DPCHIP_OK);
        EXPECT_EQ(dpchip_chip_set_access_time(chip.get(), 0), DPCHIP_OK);
        EXPECT_EQ(dpchip_chip_watch(chip.get(), 1), DPCHIP_OK);
    }

    void attach() { ASSERT_EQ(dpchip_line_attach(line.get(), chip.get()), DPCHIP_OK); }
    void write(std::uint16_t address, std::uint8_t value) { dpchip_chip_write(chip.get(), address, value); }

    /// Station 8, 6 octets of diagnosis, no I/O; the User_Timer_Clock alone may raise X/INT.
    void set_up() {
        const std::array<std::pair<std::uint16_t, std::uint8_t>, 18> cells{{{0x24, 6}, {0x25, 6}, {0x26, 0x16}, {0x27, 0x17},
            {0x28, 24}, {0x2B, 0x18}, {0x30, 0x1C}, {0x32, 0x20}, {0x33, 2}, {0x34, 0x24}, {0x17, 0x08}, {0x40, 0xFF},
            {0x06, 0xC0}, {0x07, 0x01}, {0x16, 8}, {0x3A, 0x11}, {0x3B, 0x47}, {0x04, 0xEF}}};
        for (const auto& [cell, value] : cells) write(cell, value);
        write(0x08, 0x01);  // Start_VPC3
    }
    void line_to(std::int64_t ticks) {
        while (dpchip_line_now_ticks(line.get()) < ticks)
            ASSERT_GE(dpchip_line_run_ticks(line.get(), ticks - dpchip_line_now_ticks(line.get())), 0);
    }
    std::vector<dpchip_edge> edges() {
        std::vector<dpchip_edge> all;
        dpchip_edge e{};
        while (dpchip_chip_edge(chip.get(), &e) == 1) all.push_back(e);
        return all;
    }
    std::vector<dpchip_telegram> telegrams() {
        std::vector<dpchip_telegram> all;
        dpchip_telegram t{};
        t.size = sizeof t;
        while (dpchip_line_telegram(line.get(), &t) == 1) all.push_back(t);
        return all;
    }

    std::unique_ptr<dpchip_line, LineDeleter> line;
    std::unique_ptr<dpchip_chip, ChipDeleter> chip;
};

TEST_F(Watching, a_chip_on_no_line_knows_its_next_event_and_can_be_moved_there) {
    EXPECT_EQ(dpchip_chip_next_ticks(chip.get()), kNever) << "an Offline chip plans nothing";
    ASSERT_EQ(dpchip_chip_run_ticks(chip.get(), 12'345), DPCHIP_OK);
    EXPECT_EQ(dpchip_chip_now_ticks(chip.get()), 12'345);
    set_up();
    const auto next = dpchip_chip_next_ticks(chip.get());
    ASSERT_LT(next, kNever);
    ASSERT_EQ(dpchip_chip_run_ticks(chip.get(), next - dpchip_chip_now_ticks(chip.get())), DPCHIP_OK);
    EXPECT_EQ(dpchip_chip_now_ticks(chip.get()), next);
    EXPECT_GT(dpchip_chip_next_ticks(chip.get()), next);
    EXPECT_EQ(dpchip_chip_run_ticks(chip.get(), -1), DPCHIP_E_ARGUMENT);
    attach();
    EXPECT_EQ(dpchip_chip_run_ticks(chip.get(), 1), DPCHIP_E_STATE);
    EXPECT_EQ(dpchip_chip_now_ticks(chip.get()), dpchip_line_now_ticks(line.get()));
}

TEST_F(Watching, the_edges_of_X_INT_come_with_their_ticks) {
    set_up();
    EXPECT_EQ(dpchip_chip_level(chip.get(), DPCHIP_OUT_X_INT), 1) << "active low, idle";
    ASSERT_EQ(dpchip_chip_run_ticks(chip.get(), kMs), DPCHIP_OK);
    EXPECT_EQ(dpchip_chip_level(chip.get(), DPCHIP_OUT_X_INT), 0);
    auto seen = edges();
    ASSERT_EQ(seen.size(), 1u);
    EXPECT_EQ(seen[0].ticks, kMs) << "the User_Timer_Clock ticks every millisecond";
    EXPECT_EQ(seen[0].output, DPCHIP_OUT_X_INT);
    EXPECT_EQ(seen[0].level, 0);
    write(0x08, 0x02);  // EOI; the event is still there
    ASSERT_EQ(dpchip_chip_run_ticks(chip.get(), kMs / 2), DPCHIP_OK);
    seen = edges();
    ASSERT_EQ(seen.size(), 2u);
    EXPECT_EQ(seen[0].ticks, kMs);
    EXPECT_EQ(seen[0].level, 1);
    EXPECT_EQ(seen[1].ticks, kMs + kUs) << "the EOI inactive time";
    EXPECT_EQ(seen[1].level, 0);
}

TEST_F(Watching, an_edge_has_the_time_of_the_line_even_when_the_chip_came_later) {
    line_to(3 * kMs + 7);
    attach();
    set_up();
    line_to(5 * kMs);
    const auto seen = edges();
    ASSERT_EQ(seen.size(), 1u);
    EXPECT_EQ(seen[0].ticks, 4 * kMs + 7);
}

TEST_F(Watching, nothing_is_kept_for_who_does_not_watch) {
    ASSERT_EQ(dpchip_chip_watch(chip.get(), 0), DPCHIP_OK);
    set_up();
    ASSERT_EQ(dpchip_chip_run_ticks(chip.get(), 2 * kMs), DPCHIP_OK);
    EXPECT_TRUE(edges().empty());
    EXPECT_TRUE(telegrams().empty());
}

TEST_F(Watching, watching_goes_on_after_a_snapshot_is_loaded) {
    Octets snapshot(dpchip_chip_snapshot_size(chip.get()));
    ASSERT_EQ(dpchip_chip_watch(chip.get(), 0), DPCHIP_OK);
    set_up();
    ASSERT_GT(dpchip_chip_save(chip.get(), snapshot.data(), snapshot.size()), 0);
    ASSERT_EQ(dpchip_chip_watch(chip.get(), 1), DPCHIP_OK);
    ASSERT_EQ(dpchip_chip_load(chip.get(), snapshot.data(), snapshot.size()), DPCHIP_OK);
    attach();
    const Octets request{0x10, 0x08, 0x02, 0x49, 0x53, 0x16};
    line_to(kFound);
    for (int i = 0; i < 2; ++i) {
        ASSERT_EQ(dpchip_line_post(line.get(), request.data(), request.size(), -1), DPCHIP_OK);
        line_to((5 + i) * kMs);
    }
    int rts = 0;
    for (const dpchip_edge& e : edges()) rts += e.output == DPCHIP_OUT_RTS ? 1 : 0;
    EXPECT_EQ(rts, 2) << "RTS goes up and down around the answer";
}

TEST_F(Watching, a_posted_telegram_starts_at_its_tick_and_everything_on_the_line_is_seen_in_order) {
    attach();
    set_up();
    ASSERT_EQ(dpchip_line_watch(line.get(), 1), DPCHIP_OK);
    const Octets request{0x10, 0x08, 0x02, 0x49, 0x53, 0x16}, answer{0x10, 0x02, 0x08, 0x00, 0x0A, 0x16};
    ASSERT_EQ(dpchip_line_post(line.get(), request.data(), request.size(), kFound + 1), DPCHIP_OK);
    EXPECT_EQ(dpchip_line_now_ticks(line.get()), 0) << "it does not wait";
    EXPECT_EQ(dpchip_line_post(line.get(), request.data(), request.size(), 5 * kMs), DPCHIP_E_STATE) << "one at a time";
    line_to(5 * kMs);
    ASSERT_EQ(dpchip_line_post(line.get(), request.data(), request.size(), 4 * kMs), DPCHIP_OK);
    line_to(6 * kMs);
    const auto seen = telegrams();
    ASSERT_EQ(seen.size(), 3u);
    EXPECT_EQ(seen[0].start_ticks, kFound + 1);
    EXPECT_EQ(seen[0].end_ticks, kFound + 1 + 66 * kBit);
    EXPECT_EQ(seen[1].start_ticks, 5 * kMs) << "a time that has passed means now";
    EXPECT_GE(seen[2].start_ticks, seen[1].end_ticks + 11 * kBit) << "minTSDR";
    EXPECT_EQ(seen[0].own, 1);
    EXPECT_EQ(seen[1].own, 1);
    EXPECT_EQ(seen[2].own, 0);
    EXPECT_EQ(seen[2].damaged, 0);
    EXPECT_EQ(Octets(seen[2].octets, seen[2].octets + seen[2].length), answer);
    EXPECT_TRUE(telegrams().empty()) << "each is taken once";
}

TEST_F(Watching, a_collision_is_seen_as_damage) {
    attach();
    set_up();
    ASSERT_EQ(dpchip_line_watch(line.get(), 1), DPCHIP_OK);
    const Octets request{0x10, 0x08, 0x02, 0x49, 0x53, 0x16};
    ASSERT_EQ(dpchip_line_post(line.get(), request.data(), request.size(), kFound), DPCHIP_OK);
    line_to(5 * kMs);
    ASSERT_EQ(dpchip_line_post(line.get(), request.data(), request.size(), 5 * kMs), DPCHIP_OK);
    line_to(5 * kMs + 78 * kBit + 1);  // the answer began a moment ago
    ASSERT_EQ(dpchip_line_post(line.get(), request.data(), request.size(), 0), DPCHIP_OK);
    line_to(6 * kMs);
    const auto seen = telegrams();
    ASSERT_EQ(seen.size(), 4u);
    EXPECT_EQ(seen[1].damaged, 0);
    EXPECT_EQ(seen[2].damaged, 1);
    EXPECT_EQ(seen[3].damaged, 1);
}

TEST_F(Watching, bad_arguments_are_refused_in_words) {
    dpchip_telegram no_size{};
    const std::uint8_t octet = 0xE5;
    EXPECT_EQ(dpchip_chip_level(chip.get(), 3), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_chip_level(nullptr, DPCHIP_OUT_RTS), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_chip_edge(chip.get(), nullptr), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_chip_watch(nullptr, 1), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_chip_now_ticks(nullptr), 0);
    EXPECT_EQ(dpchip_chip_next_ticks(nullptr), kNever);
    EXPECT_EQ(dpchip_chip_run_ticks(nullptr, 1), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_line_telegram(line.get(), &no_size), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_line_watch(nullptr, 1), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_line_post(line.get(), &octet, 0, 0), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_line_post(line.get(), &octet, 256, 0), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_line_post(nullptr, &octet, 1, 0), DPCHIP_E_ARGUMENT);
}

}  // namespace
