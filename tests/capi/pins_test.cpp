// SPDX-License-Identifier: Apache-2.0
// The package through dpchip_pins.h: pins by number, time in ticks, edges, findings in words, the chip inside.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <dpchip/dpchip_pins.h>

namespace {

struct Deleter {
    void operator()(dpchip_pins* p) const { dpchip_pins_destroy(p); }
    void operator()(dpchip_chip* c) const { dpchip_chip_destroy(c); }
};
using Part = std::unique_ptr<dpchip_pins, Deleter>;

constexpr std::int64_t kNs = 60;
constexpr std::array<int, 8> kDb{DPCHIP_PIN_DB0, DPCHIP_PIN_DB1, DPCHIP_PIN_DB2, DPCHIP_PIN_DB3, DPCHIP_PIN_DB4, DPCHIP_PIN_DB5, DPCHIP_PIN_DB6, DPCHIP_PIN_DB7};
constexpr std::array<int, 11> kAb{DPCHIP_PIN_AB0, DPCHIP_PIN_AB1, DPCHIP_PIN_AB2, DPCHIP_PIN_AB3, DPCHIP_PIN_AB4, DPCHIP_PIN_AB5,
                                  DPCHIP_PIN_AB6, DPCHIP_PIN_AB7, DPCHIP_PIN_AB8, DPCHIP_PIN_AB9, DPCHIP_PIN_AB10};

/// A part with asynchronous Intel bus on a board of few words.
class Pins : public testing::Test {
protected:
    Part part{dpchip_pins_create("vpc3+c", 5000)};

    void set(int pin, int level) { EXPECT_GE(dpchip_pins_set_pin(part.get(), pin, level), DPCHIP_E_VIOLATION); }
    void wait(std::int64_t ns) { EXPECT_EQ(dpchip_pins_advance(part.get(), dpchip_pins_now(part.get()) + ns * kNs), DPCHIP_OK); }
    void reset() {
        set(DPCHIP_PIN_RESET, 1);
        wait(300);
        set(DPCHIP_PIN_RESET, 0);
        wait(100);
    }
    void address(unsigned a) {
        for (std::size_t i = 0; i < kAb.size(); ++i) set(kAb[i], (a >> i & 1u) != 0 ? DPCHIP_HIGH : DPCHIP_LOW);
    }
    void write(unsigned a, unsigned value, std::int64_t width = 150) {
        address(a);
        for (std::size_t i = 0; i < kDb.size(); ++i) set(kDb[i], (value >> i & 1u) != 0 ? DPCHIP_HIGH : DPCHIP_LOW);
        set(DPCHIP_PIN_XCS_AB11, 0);
        set(DPCHIP_PIN_XWR_E_CLOCK_AB11, 0);
        wait(width);
        set(DPCHIP_PIN_XWR_E_CLOCK_AB11, 1);
        set(DPCHIP_PIN_XCS_AB11, 1);
        wait(60);
        for (const int db : kDb) set(db, DPCHIP_Z);
    }
    unsigned read(unsigned a) {
        address(a);
        set(DPCHIP_PIN_XCS_AB11, 0);
        set(DPCHIP_PIN_XRD_R_W, 0);
        wait(150);
        unsigned value = 0;
        for (std::size_t i = 0; i < kDb.size(); ++i) value |= (dpchip_pins_get_pin(part.get(), kDb[i]) != DPCHIP_LOW ? 1u : 0u) << i;
        set(DPCHIP_PIN_XRD_R_W, 1);
        set(DPCHIP_PIN_XCS_AB11, 1);
        wait(60);
        return value;
    }
    std::vector<std::string> findings() {
        std::vector<std::string> all;
        std::array<char, 256> text{};
        while (dpchip_pins_finding(part.get(), text.data(), text.size()) == 1) all.emplace_back(text.data());
        return all;
    }
};

TEST_F(Pins, A_cycle_on_the_pins_reaches_the_chip_inside) {
    reset();
    write(0x123, 0xA5);
    EXPECT_EQ(dpchip_pins_peek(part.get(), 0x123), 0xA5);
    EXPECT_EQ(read(0x123), 0xA5u);
    EXPECT_EQ(findings(), std::vector<std::string>{});
    dpchip_chip_info info{};
    info.size = sizeof info;
    EXPECT_EQ(dpchip_pins_chip_info(part.get(), &info), DPCHIP_OK);
    EXPECT_EQ(info.online, 0);
    EXPECT_EQ(info.baud_code, DPCHIP_NO_BAUD);
}

TEST_F(Pins, Edges_of_the_outputs_come_with_their_times) {
    reset();
    std::int64_t ticks = 0;
    int pin = 0, level = 0;
    while (dpchip_pins_next_edge(part.get(), &ticks, &pin, &level) == 1) {}
    const std::int64_t before = dpchip_pins_now(part.get());
    read(0x04);
    std::vector<std::pair<int, int>> ready;
    while (dpchip_pins_next_edge(part.get(), &ticks, &pin, &level) == 1)
        if (pin == DPCHIP_PIN_XREADY_XDTACK) ready.emplace_back(level, static_cast<int>((ticks - before) / kNs));
    ASSERT_EQ(ready.size(), 2u);
    EXPECT_EQ(ready[0].first, DPCHIP_LOW);
    EXPECT_LE(ready[0].second, 126);
    EXPECT_EQ(ready[1], std::make_pair(int{DPCHIP_HIGH}, 150 + 16));
}

TEST_F(Pins, CLKOUT_leaves_edges_only_while_it_is_watched) {
    std::int64_t ticks = 0;
    int pin = 0, level = 0;
    wait(10'000);
    EXPECT_EQ(dpchip_pins_next_edge(part.get(), &ticks, &pin, &level), 0);
    EXPECT_EQ(dpchip_pins_watch(part.get(), DPCHIP_PIN_CLKOUT, 1), DPCHIP_OK);
    wait(1'000'000);
    int edges = 0;
    while (dpchip_pins_next_edge(part.get(), &ticks, &pin, &level) == 1) ++edges;
    EXPECT_EQ(edges, 24'000) << "12 MHz for 1 ms";
}

TEST_F(Pins, A_violation_is_a_line_of_text_that_names_number_limit_and_time) {
    reset();
    write(0x40, 1, 70);
    EXPECT_EQ(findings(), std::vector<std::string>{"470 ns: timing violation: timing 29, XWR pulse width: 70 ns, at least 83 ns (5 V, figure 10-14)"});
    EXPECT_EQ(dpchip_pins_violations(part.get(), 29), 1);
    EXPECT_EQ(dpchip_pins_violations(part.get(), 0), 1);
    EXPECT_EQ(dpchip_pins_violations(part.get(), 34), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_pins_peek(part.get(), 0x40), 1) << "it is carried out all the same";
    EXPECT_EQ(dpchip_pins_failed(part.get()), 0);
}

TEST_F(Pins, With_fatal_a_violation_stops_the_part) {
    EXPECT_EQ(dpchip_pins_set_option(part.get(), "fatal", "true"), DPCHIP_OK);
    reset();
    address(0x40);
    set(DPCHIP_PIN_XCS_AB11, 0);
    set(DPCHIP_PIN_XWR_E_CLOCK_AB11, 0);
    wait(70);
    EXPECT_EQ(dpchip_pins_set_pin(part.get(), DPCHIP_PIN_XWR_E_CLOCK_AB11, 1), DPCHIP_E_VIOLATION);
    EXPECT_EQ(dpchip_pins_failed(part.get()), 1);
    EXPECT_EQ(dpchip_pins_advance(part.get(), dpchip_pins_now(part.get()) + 60), DPCHIP_E_VIOLATION);
    EXPECT_NE(std::string{dpchip_last_error()}.find("fatal"), std::string::npos);
}

TEST_F(Pins, The_chip_inside_can_be_saved_and_loaded_into_a_chip) {
    reset();
    write(0x20, 0x77);
    std::vector<std::uint8_t> bytes(dpchip_pins_snapshot_size(part.get()));
    EXPECT_EQ(dpchip_pins_save(part.get(), bytes.data(), bytes.size()), static_cast<std::int64_t>(bytes.size()));
    EXPECT_EQ(dpchip_pins_save(part.get(), bytes.data(), 10), DPCHIP_E_SPACE);
    const std::unique_ptr<dpchip_chip, Deleter> chip{dpchip_chip_create("vpc3+c")};
    EXPECT_EQ(dpchip_chip_load(chip.get(), bytes.data(), bytes.size()), DPCHIP_OK);
    EXPECT_EQ(dpchip_chip_peek(chip.get(), 0x20), 0x77);
}

TEST_F(Pins, CLK_edges_can_be_driven_and_are_checked) {
    EXPECT_EQ(dpchip_pins_set_clock_phase(part.get(), 1250), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_pins_set_clock_phase(part.get(), 600), DPCHIP_OK);
    for (int i = 0; i < 10; ++i) {
        EXPECT_EQ(dpchip_pins_clock_edge(part.get(), DPCHIP_HIGH, 4 * kNs), DPCHIP_OK);
        EXPECT_EQ(dpchip_pins_advance(part.get(), dpchip_pins_now(part.get()) + 625), DPCHIP_OK);
        EXPECT_EQ(dpchip_pins_clock_edge(part.get(), DPCHIP_LOW, 4 * kNs), DPCHIP_OK);
        EXPECT_EQ(dpchip_pins_advance(part.get(), dpchip_pins_now(part.get()) + 625), DPCHIP_OK);
    }
    EXPECT_EQ(dpchip_pins_violations(part.get(), 0), 0);
    EXPECT_EQ(dpchip_pins_clock_edge(part.get(), DPCHIP_HIGH, 4 * kNs + 1), DPCHIP_OK);
    EXPECT_EQ(findings().at(0), "208 ns: timing violation: clock rise time TCR: 4.016 ns, at most 4 ns (section 10.7.1)");
}

TEST_F(Pins, Options_of_package_and_chip_go_by_name) {
    EXPECT_EQ(dpchip_pins_set_option(part.get(), "txd_pull_up", "false"), DPCHIP_OK);
    EXPECT_EQ(dpchip_pins_get_pin(part.get(), DPCHIP_PIN_TXD), DPCHIP_Z);
    EXPECT_EQ(dpchip_pins_set_option(part.get(), "txd_pull_up", "maybe"), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_pins_set_option(part.get(), "line", "none"), DPCHIP_OK);
    EXPECT_EQ(dpchip_pins_set_option(part.get(), "check_timing", "false"), DPCHIP_OK);
    EXPECT_EQ(dpchip_pins_set_option(part.get(), "rts_lead_clk", "8"), DPCHIP_OK);
    EXPECT_EQ(dpchip_pins_set_option(part.get(), "no_such", "1"), DPCHIP_E_NAME);
}

TEST(PinsErrors, Nothing_crashes_and_every_refusal_has_words) {
    EXPECT_EQ(dpchip_pins_create("apc3", 5000), nullptr);
    EXPECT_EQ(std::string{dpchip_last_error()}, "apc3 does not work at 5000 mV");
    EXPECT_EQ(dpchip_pins_create("vpc3+c", 4000), nullptr);
    EXPECT_EQ(dpchip_pins_create("z80", 5000), nullptr);
    EXPECT_EQ(dpchip_pins_create(nullptr, 5000), nullptr);
    EXPECT_EQ(dpchip_pins_set_pin(nullptr, 1, 0), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_pins_get_pin(nullptr, 1), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_pins_advance(nullptr, 1), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_pins_peek(nullptr, 1), 0xFF);
    EXPECT_EQ(dpchip_pins_next(nullptr), std::numeric_limits<std::int64_t>::max());
    const Part part{dpchip_pins_create("apc3", 3300)};
    for (const int pin : {-1, 0, 45, 1000}) {
        EXPECT_EQ(dpchip_pins_set_pin(part.get(), pin, 0), DPCHIP_E_ARGUMENT);
        EXPECT_EQ(dpchip_pins_get_pin(part.get(), pin), DPCHIP_E_ARGUMENT);
        EXPECT_EQ(dpchip_pins_name(pin), nullptr);
        EXPECT_EQ(dpchip_pins_direction(pin), DPCHIP_E_ARGUMENT);
    }
    EXPECT_EQ(dpchip_pins_set_pin(part.get(), 1, 3), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_pins_advance(part.get(), -1), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_pins_watch(part.get(), DPCHIP_PIN_RESET, 1), DPCHIP_E_ARGUMENT);
    EXPECT_STREQ(dpchip_pins_name(DPCHIP_PIN_XCS_AB11), "XCS/AB11");
    EXPECT_EQ(dpchip_pins_direction(DPCHIP_PIN_DB0), DPCHIP_PIN_BIDIRECTIONAL);
    EXPECT_EQ(dpchip_pins_direction(DPCHIP_PIN_VDD_18), DPCHIP_PIN_SUPPLY);
    dpchip_pins_destroy(nullptr);
}

}  // namespace
