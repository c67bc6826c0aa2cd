// SPDX-License-Identifier: Apache-2.0
// Waveforms of the package: every edge that the queue tells, and what the board drives.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <dpchip/dpchip_pins.h>

#include "capi/vcd_reader.hpp"

namespace {

using dpchip::test::Vcd;

constexpr std::int64_t kNs = 60, kUs = 1000 * kNs;

std::string path_of(const std::string& name) {
    const std::filesystem::path folder = std::filesystem::path{DPCHIP_BINARY_DIR} / "tests";
    std::filesystem::create_directories(folder);
    return (folder / name).string();
}
std::string letter(int level) { return level == DPCHIP_Z ? "z" : level == DPCHIP_HIGH ? "1" : "0"; }

struct PartDeleter { void operator()(dpchip_pins* p) const { dpchip_pins_destroy(p); } };

class PinsWaves : public testing::Test {
protected:
    PinsWaves() : part{dpchip_pins_create("vpc3+c", 5000)} {
        EXPECT_EQ(dpchip_pins_set_option(part.get(), "waves_timescale", "1ns"), DPCHIP_OK) << dpchip_last_error();
    }
    void to(std::int64_t ticks) { ASSERT_EQ(dpchip_pins_advance(part.get(), ticks), DPCHIP_OK) << dpchip_last_error(); }
    void pin(int number, int level) { ASSERT_EQ(dpchip_pins_set_pin(part.get(), number, level), DPCHIP_OK); }
    int draw(const std::string& path) { return dpchip_pins_waves(part.get(), path.c_str()); }

    /// Asynchronous Intel: reads the Status Register, slowly.
    void read_status(std::int64_t at) {
        to(at);
        pin(DPCHIP_PIN_AB2, 1);
        pin(DPCHIP_PIN_XCS_AB11, 0);
        to(at + 100 * kNs);
        pin(DPCHIP_PIN_XRD_R_W, 0);
        to(at + 400 * kNs);
        pin(DPCHIP_PIN_XRD_R_W, 1);
        to(at + 500 * kNs);
        pin(DPCHIP_PIN_XCS_AB11, 1);
        pin(DPCHIP_PIN_AB2, 0);
        to(at + 600 * kNs);
    }
    void reset(std::int64_t at) {
        to(at);
        pin(DPCHIP_PIN_RESET, 1);
        to(at + kUs);
        pin(DPCHIP_PIN_RESET, 0);
    }

    std::unique_ptr<dpchip_pins, PartDeleter> part;
};

TEST_F(PinsWaves, every_edge_of_the_outputs_and_every_input_is_there_at_its_time) {
    const std::string file = path_of("capi_pins.vcd");
    to(10 * kUs);
    std::int64_t at = 0;
    int number = 0, level = 0;
    while (dpchip_pins_next_edge(part.get(), &at, &number, &level) == 1) {}
    ASSERT_EQ(draw(file), DPCHIP_OK) << dpchip_last_error();
    reset(20 * kUs);
    read_status(30 * kUs);
    ASSERT_EQ(dpchip_pins_waves(part.get(), nullptr), DPCHIP_OK);
    const Vcd vcd{file};
    EXPECT_EQ(vcd.timescale, "1ns");
    EXPECT_EQ(vcd.first, 10'000);
    EXPECT_EQ(vcd.last, 30'600);
    EXPECT_EQ(vcd.waves.size(), 38u) << "44 pins without six supplies";
    EXPECT_EQ(vcd.wave("part.RESET"), (Vcd::Wave{{10'000, "0"}, {20'000, "1"}, {21'000, "0"}}));
    EXPECT_EQ(vcd.wave("part.XRD_R_W"), (Vcd::Wave{{10'000, "1"}, {30'100, "0"}, {30'400, "1"}}));
    EXPECT_EQ(vcd.wave("part.TXD"), (Vcd::Wave{{10'000, "1"}})) << "with its pull-up";
    std::size_t told = 0;
    while (dpchip_pins_next_edge(part.get(), &at, &number, &level) == 1) {
        ++told;
        std::string name = std::string{"part."} + dpchip_pins_name(number);
        for (char& c : name) c = c == '/' ? '_' : c;
        EXPECT_EQ(vcd.at(name, (at + kNs / 2) / kNs), letter(level)) << name << " at " << at;
    }
    EXPECT_GT(told, 8u) << "XREADY, and DB there and back";
    EXPECT_GE(vcd.wave("part.DB0").size(), 3u);
    EXPECT_EQ(vcd.at("part.DB0", 30'590), "z");
}

TEST_F(PinsWaves, drawing_and_watching_do_not_disturb_each_other) {
    const std::string file = path_of("capi_pins_watched.vcd");
    ASSERT_EQ(dpchip_pins_watch(part.get(), DPCHIP_PIN_XREADY_XDTACK, 0), DPCHIP_OK);
    ASSERT_EQ(draw(file), DPCHIP_OK);
    reset(20 * kUs);
    read_status(30 * kUs);
    ASSERT_EQ(dpchip_pins_watch(part.get(), DPCHIP_PIN_CLKOUT, 1), DPCHIP_OK);
    to(32 * kUs);
    ASSERT_EQ(dpchip_pins_watch(part.get(), DPCHIP_PIN_CLKOUT, 0), DPCHIP_OK);
    part.reset();  // ends the file
    const Vcd vcd{file};
    EXPECT_GE(vcd.wave("part.XREADY_XDTACK").size(), 3u);
    EXPECT_GE(vcd.wave("part.CLKOUT2_4").size(), 20u);
    EXPECT_GE(vcd.wave("part.CLKOUT2_4")[1].at, 30'600);
    EXPECT_EQ(vcd.last, 32'000);
}

TEST_F(PinsWaves, edges_that_nobody_asked_for_are_not_queued_because_of_a_drawing) {
    ASSERT_EQ(dpchip_pins_watch(part.get(), DPCHIP_PIN_XREADY_XDTACK, 0), DPCHIP_OK);
    ASSERT_EQ(draw(path_of("capi_pins_quiet.vcd")), DPCHIP_OK);
    reset(20 * kUs);
    read_status(30 * kUs);
    std::int64_t at = 0;
    int number = 0, level = 0, count = 0;
    while (dpchip_pins_next_edge(part.get(), &at, &number, &level) == 1) {
        EXPECT_NE(number, int{DPCHIP_PIN_XREADY_XDTACK});
        ++count;
    }
    EXPECT_GT(count, 0);
}

TEST_F(PinsWaves, what_cannot_be_is_refused) {
    EXPECT_EQ(draw("/no/such/folder/x.vcd"), DPCHIP_E_FILE);
    EXPECT_EQ(dpchip_pins_waves(part.get(), nullptr), DPCHIP_OK) << "nothing is being drawn";
    ASSERT_EQ(draw(path_of("capi_pins_once.vcd")), DPCHIP_OK);
    EXPECT_EQ(draw(path_of("capi_pins_twice.vcd")), DPCHIP_E_STATE);
    EXPECT_EQ(dpchip_pins_waves(nullptr, "x.vcd"), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_pins_set_option(part.get(), "waves_timescale", "2ns"), DPCHIP_E_ARGUMENT);
    ASSERT_EQ(dpchip_pins_waves(part.get(), nullptr), DPCHIP_OK);
    if (!std::filesystem::exists("/dev/full")) {
        std::puts("left out: waveforms of a package on a full disk, because there is no /dev/full");
        return;
    }
    ASSERT_EQ(draw("/dev/full"), DPCHIP_OK);
    EXPECT_EQ(dpchip_pins_waves(part.get(), nullptr), DPCHIP_E_FILE);
}

}  // namespace
