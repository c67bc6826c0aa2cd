// SPDX-License-Identifier: Apache-2.0
// Waveforms from the C API: bits, RTS and X/INT of known telegrams at their exact times, whole files whatever happens.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <dpchip/dpchip.h>

#include "capi/vcd_reader.hpp"

namespace {

using dpchip::test::Vcd;
using Octets = std::vector<std::uint8_t>;

constexpr std::int64_t kUs = 60'000, kMs = 1000 * kUs, kBit = 40'000;  // 1.5 Mbit/s
constexpr std::int64_t kFound = 3 * kMs + kMs / 2;  // the search listens at 1.5 Mbit/s; what proves the rate is not answered
const Octets kRequest{0x10, 0x08, 0x02, 0x49, 0x53, 0x16}, kAnswer{0x10, 0x02, 0x08, 0x00, 0x0A, 0x16};

/// Ticks as picoseconds, rounded to the nearest.
constexpr std::int64_t ps(std::int64_t ticks) { return (ticks * 100 + 3) / 6; }

std::string path_of(const std::string& name) {
    const std::filesystem::path folder = std::filesystem::path{DPCHIP_BINARY_DIR} / "tests";
    std::filesystem::create_directories(folder);
    return (folder / name).string();
}

/// The levels of a telegram that starts at `start` and ends with the line high.
Vcd::Wave bits(std::int64_t start, const Octets& octets) {
    Vcd::Wave wave;
    std::string level = "1";
    const auto put = [&](std::size_t bit, bool high) {
        const std::string now = high ? "1" : "0";
        if (now != level) wave.push_back({ps(start + static_cast<std::int64_t>(bit) * kBit), now});
        level = now;
    };
    for (std::size_t n = 0; n < octets.size(); ++n) {
        bool parity = false;
        put(n * 11, false);
        for (unsigned b = 0; b < 8; ++b) {
            const bool one = (octets[n] >> b & 1) != 0;
            parity = parity != one;
            put(n * 11 + 1 + b, one);
        }
        put(n * 11 + 9, parity);
        put(n * 11 + 10, true);
    }
    return wave;
}

Vcd::Wave between(const Vcd::Wave& wave, std::int64_t from, std::int64_t to) {
    Vcd::Wave part;
    for (const Vcd::Change& c : wave)
        if (c.at >= ps(from) && c.at <= ps(to)) part.push_back(c);
    return part;
}

struct ChipDeleter { void operator()(dpchip_chip* c) const { dpchip_chip_destroy(c); } };
struct LineDeleter { void operator()(dpchip_line* l) const { dpchip_line_close(l); } };
using ChipPtr = std::unique_ptr<dpchip_chip, ChipDeleter>;
using LinePtr = std::unique_ptr<dpchip_line, LineDeleter>;

class Waves : public testing::Test {
protected:
    Waves() : line{dpchip_line_open("sim:", 1'500'000)}, chip{new_chip()} {}

    static ChipPtr new_chip() {
        ChipPtr chip{dpchip_chip_create("vpc3+c")};
        EXPECT_EQ(dpchip_chip_set_option(chip.get(), "baud_probe_ms", "1"), DPCHIP_OK);
        EXPECT_EQ(dpchip_chip_set_access_time(chip.get(), 0), DPCHIP_OK);
        EXPECT_EQ(dpchip_chip_watch(chip.get(), 1), DPCHIP_OK);
        return chip;
    }
    void attach(dpchip_chip* c) { ASSERT_EQ(dpchip_line_attach(line.get(), c), DPCHIP_OK) << dpchip_last_error(); }

    /// 6 octets of diagnosis, no I/O; the User_Timer_Clock alone may raise X/INT.
    static void set_up(dpchip_chip* c, std::uint8_t address = 8) {
        const std::array<std::pair<std::uint16_t, std::uint8_t>, 19> cells{{{0x24, 6}, {0x25, 6}, {0x26, 0x16}, {0x27, 0x17},
            {0x28, 24}, {0x2B, 0x18}, {0x30, 0x1C}, {0x32, 0x20}, {0x33, 2}, {0x34, 0x24}, {0x17, 0x08}, {0x40, 0xFF},
            {0x06, 0xC0}, {0x07, 0x01}, {0x16, address}, {0x3A, 0x11}, {0x3B, 0x47}, {0x04, 0xEF}, {0x08, 0x01}}};
        for (const auto& [cell, value] : cells) dpchip_chip_write(c, cell, value);
    }
    void line_to(std::int64_t ticks) {
        while (dpchip_line_now_ticks(line.get()) < ticks)
            ASSERT_GE(dpchip_line_run_ticks(line.get(), ticks - dpchip_line_now_ticks(line.get())), 0);
    }
    void post(const Octets& octets, std::int64_t at) { ASSERT_EQ(dpchip_line_post(line.get(), octets.data(), octets.size(), at), DPCHIP_OK) << dpchip_last_error(); }
    int draw(const std::string& path, const char* signals = nullptr) { return dpchip_line_waves(line.get(), path.c_str(), signals); }
    int end() { return dpchip_line_waves(line.get(), nullptr, nullptr); }
    std::vector<dpchip_telegram> telegrams() {
        std::vector<dpchip_telegram> all;
        dpchip_telegram t{};
        t.size = sizeof t;
        while (dpchip_line_telegram(line.get(), &t) == 1) all.push_back(t);
        return all;
    }
    /// What dpchip_chip_edge says of one output, as a wave.
    static std::vector<Vcd::Wave> edges(dpchip_chip* c) {
        std::vector<Vcd::Wave> waves(3);
        dpchip_edge e{};
        while (dpchip_chip_edge(c, &e) == 1) waves[static_cast<std::size_t>(e.output)].push_back({ps(e.ticks), e.level != 0 ? "1" : "0"});
        return waves;
    }
    static Vcd::Wave changes(const Vcd::Wave& wave) { return {wave.begin() + (wave.empty() ? 0 : 1), wave.end()}; }

    LinePtr line;
    ChipPtr chip;
};

TEST_F(Waves, a_telegram_and_its_answer_are_there_bit_by_bit_at_their_exact_times) {
    const std::string file = path_of("capi_bits.vcd");
    attach(chip.get());
    set_up(chip.get());
    ASSERT_EQ(draw(file), DPCHIP_OK) << dpchip_last_error();
    ASSERT_EQ(dpchip_line_watch(line.get(), 1), DPCHIP_OK);
    post(kRequest, kFound);
    line_to(5 * kMs);
    post(kRequest, 5 * kMs + 1);
    line_to(6 * kMs);
    ASSERT_EQ(end(), DPCHIP_OK) << dpchip_last_error();
    const auto seen = telegrams();
    ASSERT_EQ(seen.size(), 3u);
    const Vcd vcd{file};
    EXPECT_EQ(vcd.timescale, "1ps");
    EXPECT_EQ(vcd.first, 0);
    EXPECT_EQ(vcd.last, ps(6 * kMs));
    const Vcd::Wave request = bits(5 * kMs + 1, kRequest), answer = bits(seen[2].start_ticks, kAnswer);
    for (const char* name : {"line.level", "station_8.RXD"}) {
        EXPECT_EQ(between(vcd.wave(name), 5 * kMs, seen[1].end_ticks), request) << name;
        EXPECT_EQ(between(vcd.wave(name), seen[2].start_ticks, 6 * kMs), answer) << name;
    }
    EXPECT_EQ(between(vcd.wave("master.TXD"), 5 * kMs, 6 * kMs), request);
    EXPECT_EQ(changes(vcd.wave("station_8.TXD")), answer);
    const auto said = edges(chip.get());
    EXPECT_EQ(said[DPCHIP_OUT_RTS].size(), 2u);
    EXPECT_EQ(changes(vcd.wave("station_8.RTS")), said[DPCHIP_OUT_RTS]);
    EXPECT_EQ(vcd.wave("station_8.RTS").front(), (Vcd::Change{0, "0"}));
    EXPECT_EQ(said[DPCHIP_OUT_X_INT].size(), 1u);
    EXPECT_EQ(changes(vcd.wave("station_8.X_INT")), said[DPCHIP_OUT_X_INT]);
    EXPECT_EQ(vcd.at("station_8.Baud_Rate", ps(6 * kMs)), "1.5M");
    EXPECT_EQ(vcd.at("station_8.DP_State", ps(6 * kMs)), "WAIT-PRM");
    EXPECT_EQ(vcd.at("station_8.WD_State", ps(kMs)), "BAUD_SEARCH");
    EXPECT_EQ(vcd.at("station_8.IRR.Baud_Rate_Detect", ps(6 * kMs)), "1");
}

TEST_F(Waves, firmware_that_polls_in_virtual_time_sees_X_INT_where_the_picture_has_it) {
    const std::string file = path_of("capi_firmware.vcd");
    ASSERT_EQ(dpchip_chip_set_access_time(chip.get(), 130), DPCHIP_OK);  // X/INT moves within an access
    attach(chip.get());
    ASSERT_EQ(dpchip_chip_set_name(chip.get(), "Press"), DPCHIP_OK);
    set_up(chip.get());
    ASSERT_EQ(draw(file, "Press.X_INT, Press.IRR.*"), DPCHIP_OK) << dpchip_last_error();
    std::vector<std::int64_t> served;
    int accesses = 0;
    while (served.size() < 3) {  // nobody runs the line but the accesses
        ASSERT_LT(++accesses, 100'000);
        static_cast<void>(dpchip_chip_read(chip.get(), 0x05));
        if (dpchip_chip_interrupt(chip.get()) == 0) continue;
        dpchip_chip_write(chip.get(), 0x02, 0xFF);  // acknowledge
        dpchip_chip_write(chip.get(), 0x03, 0xFF);
        dpchip_chip_write(chip.get(), 0x08, 0x02);  // EOI
        served.push_back(dpchip_line_now_ticks(line.get()));
    }
    ASSERT_EQ(end(), DPCHIP_OK);
    const Vcd vcd{file};
    const auto said = edges(chip.get());
    EXPECT_GE(said[DPCHIP_OUT_X_INT].size(), 6u);
    EXPECT_EQ(changes(vcd.wave("Press.X_INT")), said[DPCHIP_OUT_X_INT]);
    for (const std::int64_t at : served) EXPECT_EQ(vcd.at("Press.X_INT", ps(at) - 1), "0");
    EXPECT_EQ(vcd.waves.size(), 17u) << "X_INT and sixteen requests";
}

TEST_F(Waves, a_line_that_is_closed_leaves_a_whole_file_with_the_bits_so_far) {
    const std::string file = path_of("capi_closed.vcd");
    attach(chip.get());
    ASSERT_EQ(dpchip_line_set_option(line.get(), "waves_timescale", "10ns"), DPCHIP_OK) << dpchip_last_error();
    line_to(kMs);
    ASSERT_EQ(draw(file), DPCHIP_OK);
    post(kRequest, 2 * kMs);
    line_to(2 * kMs + 20 * kBit);
    line.reset();
    const Vcd vcd{file};
    EXPECT_EQ(vcd.timescale, "10ns");
    EXPECT_EQ(vcd.first, 100'000);
    EXPECT_EQ(vcd.last, 201'333) << "20 bits of 1.5 Mbit/s behind 2 ms, rounded";
    EXPECT_EQ(vcd.wave("chip_1.RXD")[1], (Vcd::Change{200'000, "0"}));
    std::size_t so_far = 0;
    for (const Vcd::Change& c : bits(2 * kMs, kRequest)) so_far += c.at <= ps(2 * kMs + 20 * kBit) ? 1u : 0u;
    EXPECT_EQ(changes(vcd.wave("master.TXD")).size(), so_far);
}

TEST_F(Waves, what_is_on_the_line_already_is_not_drawn) {
    const std::string file = path_of("capi_middle.vcd");
    attach(chip.get());
    post(kRequest, kMs);
    line_to(kMs + 5 * kBit);
    ASSERT_EQ(draw(file, "line.level"), DPCHIP_OK);
    line_to(2 * kMs);
    post(kRequest, 2 * kMs);
    line_to(3 * kMs);
    ASSERT_EQ(end(), DPCHIP_OK);
    EXPECT_EQ(changes(Vcd{file}.wave("line.level")), bits(2 * kMs, kRequest));
}

TEST_F(Waves, a_chip_that_leaves_is_unknown_until_it_is_back_and_no_other_takes_its_place) {
    const std::string file = path_of("capi_leaving.vcd");
    const ChipPtr other = new_chip(), late = new_chip();
    attach(chip.get());
    attach(other.get());
    ASSERT_EQ(dpchip_chip_set_name(other.get(), "chip_1"), DPCHIP_OK);
    set_up(other.get(), 9);
    ASSERT_EQ(draw(file), DPCHIP_OK) << dpchip_last_error();
    line_to(kMs / 2);
    ASSERT_EQ(dpchip_line_detach(line.get(), chip.get()), DPCHIP_OK);
    attach(late.get());  // gets the number of the one that left
    set_up(late.get());
    line_to(kFound + kMs / 2);
    post(kRequest, -1);
    line_to(5 * kMs);
    post(kRequest, -1);
    line_to(6 * kMs);
    attach(chip.get());
    line_to(7 * kMs);
    ASSERT_EQ(end(), DPCHIP_OK);
    const Vcd vcd{file};
    EXPECT_EQ(vcd.at("chip_1.RTS", 0), "0");
    EXPECT_EQ(vcd.at("chip_1.RTS", ps(kMs / 2)), "x");
    EXPECT_EQ(vcd.at("chip_1.DP_State", ps(kMs / 2)), "?");
    EXPECT_EQ(vcd.at("chip_1.RTS", ps(6 * kMs)), "0");
    EXPECT_EQ(changes(vcd.wave("chip_1.TXD")), Vcd::Wave{});
    EXPECT_GT(changes(vcd.wave("chip_1_2.RXD")).size(), 60u) << "the answer of the one that came later is on the line";
    EXPECT_EQ(changes(vcd.wave("chip_1_2.TXD")), Vcd::Wave{});
}

TEST_F(Waves, a_chip_may_be_destroyed_while_it_is_drawn) {
    const std::string file = path_of("capi_destroyed.vcd");
    attach(chip.get());
    ASSERT_EQ(draw(file), DPCHIP_OK);
    line_to(kMs);
    chip.reset();
    const ChipPtr next = new_chip();
    attach(next.get());
    line_to(2 * kMs);
    ASSERT_EQ(end(), DPCHIP_OK);
    const Vcd vcd{file};
    EXPECT_EQ(vcd.at("chip_1.X_INT", ps(kMs) - 1), "1");
    EXPECT_EQ(vcd.at("chip_1.X_INT", ps(2 * kMs)), "x");
}

TEST_F(Waves, bits_that_are_told_afterwards_stand_at_their_times_among_the_others) {
    const std::string file = path_of("capi_joined.vcd");
    attach(chip.get());
    set_up(chip.get());
    const int station = dpchip_line_join(line.get(), 1'500'000);
    ASSERT_GE(station, 0);
    ASSERT_EQ(draw(file, "line.level,station_8.X_INT"), DPCHIP_OK);
    line_to(kMs - 30 * kBit);
    ASSERT_EQ(dpchip_line_joined_begins(line.get(), station), DPCHIP_OK);
    line_to(kMs + 36 * kBit);  // X/INT falls meanwhile
    ASSERT_EQ(dpchip_line_joined_sent(line.get(), station, kRequest.data(), nullptr, kRequest.size(), kMs - 30 * kBit), DPCHIP_OK) << dpchip_last_error();
    line_to(2 * kMs);
    ASSERT_EQ(end(), DPCHIP_OK);
    const Vcd vcd{file};
    EXPECT_EQ(changes(vcd.wave("line.level")), bits(kMs - 30 * kBit, kRequest));
    EXPECT_EQ(changes(vcd.wave("station_8.X_INT")), edges(chip.get())[DPCHIP_OUT_X_INT]);
}

TEST_F(Waves, what_cannot_be_is_refused_in_words) {
    const std::string never = path_of("capi_never.vcd"), file = path_of("capi_once.vcd");
    std::remove(never.c_str());
    attach(chip.get());
    EXPECT_EQ(draw(never, "line.*,Presse.TXD"), DPCHIP_E_NAME);
    EXPECT_NE(std::string{dpchip_last_error()}.find("Presse.TXD: no signal is called so. There are: line.level master.TXD chip_1.TXD"), std::string::npos) << dpchip_last_error();
    EXPECT_EQ(draw(never, "line.*,,master.TXD"), DPCHIP_E_NAME);
    EXPECT_FALSE(std::filesystem::exists(never));
    EXPECT_EQ(draw("/no/such/folder/x.vcd"), DPCHIP_E_FILE);
    EXPECT_EQ(end(), DPCHIP_OK) << "nothing is being drawn";
    ASSERT_EQ(draw(file), DPCHIP_OK);
    EXPECT_EQ(draw(never), DPCHIP_E_STATE);
    EXPECT_NE(std::string{dpchip_last_error()}.find("capi_once.vcd"), std::string::npos);
    EXPECT_EQ(end(), DPCHIP_OK);
    EXPECT_EQ(dpchip_line_waves(nullptr, file.c_str(), nullptr), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_line_set_option(line.get(), "waves_timescale", "3ns"), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_line_set_option(line.get(), "colour", "red"), DPCHIP_E_NAME);
    EXPECT_EQ(dpchip_line_set_option(line.get(), nullptr, "1ns"), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_line_set_option(nullptr, "waves_timescale", "1ns"), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_chip_set_name(chip.get(), "a b"), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_chip_set_name(chip.get(), std::string(101, 'a').c_str()), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_chip_set_name(nullptr, "a"), DPCHIP_E_ARGUMENT);
    const LinePtr live{dpchip_line_open("pty", 0)};
    ASSERT_NE(live, nullptr) << dpchip_last_error();
    EXPECT_EQ(dpchip_line_waves(live.get(), never.c_str(), nullptr), DPCHIP_E_STATE);
    EXPECT_FALSE(std::filesystem::exists(never));
}

TEST_F(Waves, a_full_disk_is_told_at_the_end) {
    if (!std::filesystem::exists("/dev/full")) {
        std::puts("left out: waveforms on a full disk, because there is no /dev/full");
        return;
    }
    attach(chip.get());
    ASSERT_EQ(draw("/dev/full"), DPCHIP_OK);
    line_to(5 * kMs);
    EXPECT_EQ(end(), DPCHIP_E_FILE);
    EXPECT_NE(std::string{dpchip_last_error()}.find("/dev/full"), std::string::npos);
    EXPECT_EQ(end(), DPCHIP_OK) << "it has ended";
}

}  // namespace
