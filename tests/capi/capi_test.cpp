// SPDX-License-Identifier: Apache-2.0
// The C API: what dpchip.h promises, held against a small firmware on a sim: line.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <dpchip/dpchip.h>

namespace {

using Octets = std::vector<std::uint8_t>;

struct ChipDeleter { void operator()(dpchip_chip* c) const { dpchip_chip_destroy(c); } };
struct LineDeleter { void operator()(dpchip_line* l) const { dpchip_line_close(l); } };
using ChipPtr = std::unique_ptr<dpchip_chip, ChipDeleter>;
using LinePtr = std::unique_ptr<dpchip_line, LineDeleter>;

constexpr std::int64_t kMs = 1'000'000;

/// A chip on a sim: line with the smallest set-up that reaches DATA-EXCH; the test plays firmware and master.
class Sim : public testing::Test {
protected:
    Sim() : line{dpchip_line_open("sim:", 1'500'000)}, chip{dpchip_chip_create("vpc3+c")} {
        EXPECT_EQ(dpchip_chip_set_option(chip.get(), "baud_probe_ms", "1"), DPCHIP_OK);
        EXPECT_EQ(dpchip_line_attach(line.get(), chip.get()), DPCHIP_OK);
    }

    void write(std::uint16_t address, std::uint8_t value) { dpchip_chip_write(chip.get(), address, value); }
    std::uint8_t read(std::uint16_t address) { return dpchip_chip_read(chip.get(), address); }

    void set_up(std::uint8_t address, std::uint16_t ident, bool start = true) {
        const std::array<std::pair<std::uint16_t, std::uint8_t>, 22> cells{{{0x1A, 2}, {0x1B, 0x10}, {0x1C, 0x11}, {0x1D, 0x12},
            {0x1E, 2}, {0x1F, 0x13}, {0x20, 0x14}, {0x21, 0x15}, {0x24, 6}, {0x25, 6}, {0x26, 0x16}, {0x27, 0x17}, {0x28, 24},
            {0x2B, 0x18}, {0x30, 0x1C}, {0x32, 0x20}, {0x33, 2}, {0x34, 0x24}, {0x17, 0x08}, {0x40, 0xFF}, {0x06, 0xC0}, {0x07, 0x01}}};
        for (const auto& [cell, value] : cells) write(cell, value);
        write(0x16, address);
        write(0x3A, static_cast<std::uint8_t>(ident));
        write(0x3B, static_cast<std::uint8_t>(ident >> 8));
        if (start) write(0x08, 0x01);
    }

    void live(std::int64_t ns) {
        while (ns > 0) {
            const auto spent = dpchip_line_run(line.get(), ns);
            ASSERT_GE(spent, 0);
            ns -= spent;
        }
    }

    void find_baud() {
        live(3 * kMs + kMs / 2);
        EXPECT_EQ(tell({0x10, 0x7E, 0x02, 0x49, 0xC9, 0x16}), Octets{}) << "the telegram that proves the rate is not answered";
    }

    Octets tell(const Octets& request) {
        EXPECT_EQ(dpchip_line_send(line.get(), request.data(), request.size()), DPCHIP_OK) << dpchip_last_error();
        Octets answer(255);
        const int n = dpchip_line_receive(line.get(), answer.data(), answer.size(), kMs);
        answer.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
        return answer;
    }

    dpchip_chip_info info() {
        dpchip_chip_info i{};
        i.size = sizeof i;
        EXPECT_EQ(dpchip_chip_get_info(chip.get(), &i), DPCHIP_OK);
        return i;
    }

    LinePtr line;
    ChipPtr chip;
};

TEST_F(Sim, the_exchange_recorded_from_a_real_slave_comes_out_byte_for_byte) {
    set_up(2, 0x0CDA);
    find_baud();
    EXPECT_EQ(tell({0x10, 0x02, 0x63, 0x49, 0xAE, 0x16}), (Octets{0x10, 0x63, 0x02, 0x00, 0x65, 0x16}));
    EXPECT_EQ(tell({0x68, 0x05, 0x05, 0x68, 0x82, 0xE3, 0x6D, 0x3C, 0x3E, 0x4C, 0x16}),
              (Octets{0x68, 0x0B, 0x0B, 0x68, 0xE3, 0x82, 0x08, 0x3E, 0x3C, 0x02, 0x05, 0x00, 0xFF, 0x0C, 0xDA, 0xD3, 0x16}));
    EXPECT_EQ(tell({0x68, 0x0C, 0x0C, 0x68, 0x82, 0xE3, 0x5D, 0x3D, 0x3E, 0x88, 0x02, 0x05, 0x0B, 0x0C, 0xDA, 0x00, 0xBD, 0x16}), Octets{0xE5});
    EXPECT_EQ(tell({0x68, 0x07, 0x07, 0x68, 0x82, 0xE3, 0x7D, 0x3E, 0x3E, 0x11, 0x21, 0x90, 0x16}), Octets{0xE5});
    EXPECT_EQ(read(0x10), 0x00) << "the configuration is accepted";
    const Octets diag = tell({0x68, 0x05, 0x05, 0x68, 0x82, 0xE3, 0x5D, 0x3C, 0x3E, 0x3C, 0x16});
    ASSERT_EQ(diag.size(), 17u);
    EXPECT_EQ(Octets(diag.begin() + 9, diag.begin() + 15), (Octets{0x00, 0x0C, 0x00, 0x63, 0x0C, 0xDA}));
    EXPECT_EQ(info().dp_state, DPCHIP_DATA_EXCH_STATE);
    EXPECT_EQ(info().owner, 0x63);
    EXPECT_EQ(info().baud_code, 3);
}

TEST_F(Sim, an_access_takes_the_bus_cycle_time) {
    const auto before = dpchip_line_now_ticks(line.get());
    read(0x04);
    EXPECT_EQ(dpchip_line_now_ticks(line.get()) - before, 125 * 60);
    ASSERT_EQ(dpchip_chip_set_access_time(chip.get(), 500), DPCHIP_OK);
    write(0x100, 1);
    EXPECT_EQ(dpchip_line_now_ticks(line.get()) - before, 625 * 60);
}

TEST_F(Sim, firmware_may_wait_in_a_loop_for_the_chip_to_move) {
    set_up(8, 0x4711);
    write(0x08, 0x04);  // Go_Offline
    int reads = 0;
    while ((read(0x04) & 1) != 0 && reads < 1000) ++reads;
    EXPECT_LE(reads, 10);
}

TEST_F(Sim, peek_takes_no_time_and_does_nothing) {
    set_up(8, 0x4711);
    const auto now = dpchip_line_now_ticks(line.get());
    const auto first = dpchip_chip_peek(chip.get(), 0x0B);
    EXPECT_EQ(dpchip_chip_peek(chip.get(), 0x0B), first);
    EXPECT_EQ(dpchip_line_now_ticks(line.get()), now);
    EXPECT_EQ(first & 4, 4) << "the cleared outputs of Start wait in N";
}

TEST_F(Sim, run_returns_at_once_when_X_INT_rose_during_an_access_and_not_again_while_it_stays) {
    write(0x04, 0x00);
    write(0x05, 0x00);
    set_up(8, 0x4711);  // Start raises DX_Out
    EXPECT_EQ(dpchip_chip_interrupt(chip.get()), 1);
    EXPECT_EQ(dpchip_line_run(line.get(), kMs / 2), 0);
    EXPECT_EQ(dpchip_line_run(line.get(), kMs / 2), kMs / 2) << "an interrupt that stays active does not end it";
}

TEST_F(Sim, run_ends_when_X_INT_rises) {
    write(0x04, 0xEF);  // User_Timer_Clock alone is unmasked
    set_up(8, 0x4711);
    const auto start = dpchip_line_now_ticks(line.get());
    const auto spent = dpchip_line_run(line.get(), 5 * kMs);
    EXPECT_EQ(spent, kMs);
    EXPECT_EQ(dpchip_line_now_ticks(line.get()) - start, spent * 60);
    write(0x02, 0x10);
    write(0x08, 0x02);
    EXPECT_EQ(dpchip_chip_interrupt(chip.get()), 0);
    EXPECT_EQ(dpchip_line_run(line.get(), 5 * kMs), kMs - 250) << "the two accesses took 250 ns of the next millisecond";
}

TEST_F(Sim, run_notices_an_interrupt_that_rose_during_receive) {
    set_up(8, 0x4711);
    find_baud();
    write(0x04, 0x00);
    write(0x05, 0xF7);  // New_Prm_Data
    write(0x02, 0xFF);
    write(0x03, 0xFF);
    write(0x08, 0x02);
    live(10'000);
    EXPECT_EQ(tell({0x68, 0x0D, 0x0D, 0x68, 0x88, 0x82, 0x6D, 0x3D, 0x3E, 0x80, 0x01, 0x01, 0x0B, 0x47, 0x11, 0x00, 0x00, 0xD7, 0x16}), Octets{0xE5});
    EXPECT_EQ(dpchip_line_run(line.get(), kMs), 0);
}

TEST_F(Sim, the_next_event_is_known) {
    EXPECT_EQ(dpchip_line_next_ticks(line.get()), std::numeric_limits<std::int64_t>::max()) << "an Offline chip plans nothing";
    set_up(8, 0x4711);
    EXPECT_LT(dpchip_line_next_ticks(line.get()), std::numeric_limits<std::int64_t>::max());
    EXPECT_EQ(dpchip_line_run_ticks(line.get(), 12'345), 12'345);
}

TEST_F(Sim, a_snapshot_brings_a_chip_back_to_where_it_was) {
    set_up(8, 0x4711);
    find_baud();
    Octets snapshot(dpchip_chip_snapshot_size(chip.get()));
    ASSERT_EQ(dpchip_chip_save(chip.get(), snapshot.data(), snapshot.size()), static_cast<std::int64_t>(snapshot.size()));
    EXPECT_EQ(dpchip_chip_reset(chip.get()), DPCHIP_OK);
    EXPECT_EQ(tell({0x10, 0x08, 0x02, 0x49, 0x53, 0x16}), Octets{});
    ASSERT_EQ(dpchip_chip_load(chip.get(), snapshot.data(), snapshot.size()), DPCHIP_OK) << dpchip_last_error();
    EXPECT_EQ(tell({0x10, 0x08, 0x02, 0x49, 0x53, 0x16}), (Octets{0x10, 0x02, 0x08, 0x00, 0x0A, 0x16}));
    snapshot[100] ^= 1;
    EXPECT_EQ(dpchip_chip_load(chip.get(), snapshot.data(), snapshot.size()), DPCHIP_E_SNAPSHOT);
    EXPECT_EQ(dpchip_chip_save(chip.get(), snapshot.data(), 10), DPCHIP_E_SPACE);
}

TEST_F(Sim, findings_come_as_text) {
    set_up(8, 0x4711);
    write(0x06, 0x00);  // Mode Register 0 while online
    std::array<char, 200> text{};
    std::string all;
    while (dpchip_chip_finding(chip.get(), text.data(), text.size()) == 1) all += std::string{text.data()} + "\n";
    EXPECT_NE(all.find("mode_reg_online"), std::string::npos) << all;
    EXPECT_EQ(dpchip_chip_finding(chip.get(), text.data(), text.size()), 0);
}

TEST_F(Sim, a_recording_is_a_pcapng_file) {
    const std::string file = std::string{DPCHIP_BINARY_DIR} + "/capi_test.pcapng";
    ASSERT_EQ(dpchip_line_record(line.get(), file.c_str()), DPCHIP_OK) << dpchip_last_error();
    set_up(8, 0x4711);
    find_baud();
    tell({0x10, 0x08, 0x02, 0x49, 0x53, 0x16});
    ASSERT_EQ(dpchip_line_record(line.get(), nullptr), DPCHIP_OK);
    std::ifstream in{file, std::ios::binary};
    std::array<char, 4> magic{};
    in.read(magic.data(), magic.size());
    EXPECT_EQ(std::string(magic.data(), 4), "\x0A\x0D\x0D\x0A");
    EXPECT_EQ(dpchip_line_record(line.get(), "/nonexistent/folder/x.pcapng"), DPCHIP_E_FILE);
}

TEST_F(Sim, a_chip_moves_from_line_to_line_and_keeps_its_state) {
    set_up(8, 0x4711);
    find_baud();
    EXPECT_EQ(dpchip_line_attach(line.get(), chip.get()), DPCHIP_E_STATE);
    ASSERT_EQ(dpchip_line_detach(line.get(), chip.get()), DPCHIP_OK);
    EXPECT_EQ(dpchip_line_detach(line.get(), chip.get()), DPCHIP_E_STATE);
    read(0x04);  // alone, it has a clock of its own
    line.reset(dpchip_line_open("sim:", 1'500'000));
    ASSERT_EQ(dpchip_line_attach(line.get(), chip.get()), DPCHIP_OK) << dpchip_last_error();
    live(kMs);
    EXPECT_EQ(tell({0x10, 0x08, 0x02, 0x49, 0x53, 0x16}), (Octets{0x10, 0x02, 0x08, 0x00, 0x0A, 0x16}));
}

TEST_F(Sim, two_chips_share_a_line_and_an_address_given_twice_is_refused) {
    set_up(8, 0x4711);
    ChipPtr other{dpchip_chip_create("apc3")};
    ASSERT_EQ(dpchip_line_attach(line.get(), other.get()), DPCHIP_OK);
    std::swap(chip, other);
    set_up(9, 0x4712);
    find_baud();
    EXPECT_EQ(info().address, 9);
    std::swap(chip, other);
    ASSERT_EQ(dpchip_line_detach(line.get(), chip.get()), DPCHIP_OK);
    ChipPtr third{dpchip_chip_create("vpc3+b")};
    std::swap(chip, third);
    set_up(9, 0x4713);  // online at 9 before it comes to the line
    EXPECT_EQ(dpchip_line_attach(line.get(), chip.get()), DPCHIP_E_STATE);
    EXPECT_NE(std::string{dpchip_last_error()}, "");
}

TEST(Capi, every_variant_can_be_created_and_no_other) {
    for (const char* name : {"vpc3+c", "vpc3+b", "vpc3+", "apc3", "spc3"}) EXPECT_NE(ChipPtr{dpchip_chip_create(name)}, nullptr) << name;
    EXPECT_EQ(dpchip_chip_create("vpc4"), nullptr);
    EXPECT_NE(std::string{dpchip_last_error()}.find("vpc3+c"), std::string::npos) << "the error names the chips there are";
    EXPECT_EQ(dpchip_chip_create(nullptr), nullptr);
}

TEST(Capi, bad_lines_are_refused_in_words) {
    for (const char* uri : {"", "simm:", "tcp:", "serial:/dev/does_not_exist", "pty:/nonexistent/folder/link"}) {
        EXPECT_EQ(dpchip_line_open(uri, 0), nullptr) << uri;
        EXPECT_NE(std::string{dpchip_last_error()}, "") << uri;
    }
    EXPECT_EQ(dpchip_line_open("sim:", 1234), nullptr);
    EXPECT_NE(std::string{dpchip_last_error()}.find("1234"), std::string::npos);
    EXPECT_EQ(dpchip_line_open(nullptr, 0), nullptr);
}

TEST(Capi, options_are_checked) {
    const ChipPtr chip{dpchip_chip_create("vpc3+c")};
    EXPECT_EQ(dpchip_chip_set_option(chip.get(), "t_proc_clk", "96"), DPCHIP_OK);
    EXPECT_EQ(dpchip_chip_set_option(chip.get(), "no_such_option", "1"), DPCHIP_E_NAME);
    EXPECT_EQ(dpchip_chip_set_option(chip.get(), "t_proc_clk", "fast"), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_chip_set_bus_mode(chip.get(), 7), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_chip_set_bus_mode(chip.get(), DPCHIP_MOTOROLA), DPCHIP_OK);
    EXPECT_EQ(dpchip_chip_set_access_time(chip.get(), -1), DPCHIP_E_ARGUMENT);
}

TEST(Capi, null_handles_are_errors_not_crashes) {
    EXPECT_EQ(dpchip_chip_read(nullptr, 0), 0xFF);
    dpchip_chip_write(nullptr, 0, 0);
    EXPECT_EQ(dpchip_chip_peek(nullptr, 0), 0xFF);
    EXPECT_EQ(dpchip_chip_interrupt(nullptr), 0);
    EXPECT_EQ(dpchip_chip_reset(nullptr), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_line_run(nullptr, 1), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_line_attach(nullptr, nullptr), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(dpchip_line_send(nullptr, "x", 1), DPCHIP_E_ARGUMENT);
    EXPECT_EQ(std::string{dpchip_line_path(nullptr)}, "");
    dpchip_chip_destroy(nullptr);
    dpchip_line_close(nullptr);
    dpchip_line_stop(nullptr);
}

TEST(Capi, a_live_line_has_a_path_and_no_test_master) {
    const LinePtr line{dpchip_line_open("pty", 0)};
    ASSERT_NE(line, nullptr) << dpchip_last_error();
    EXPECT_NE(std::string{dpchip_line_path(line.get())}, "");
    EXPECT_EQ(dpchip_line_send(line.get(), "x", 1), DPCHIP_E_STATE);
    dpchip_line_stop(line.get());
    EXPECT_LT(dpchip_line_run(line.get(), 60'000'000'000), 60'000'000'000) << "stop() ends the next run";
}

/// The clock of a live line is ahead of what the line has done; a chip goes with the line. Builds with assertions stop when
/// a chip's time turns back.
TEST(Capi, time_never_turns_back_for_a_chip_on_a_live_line) {
    const LinePtr line{dpchip_line_open("pty", 0)};
    ASSERT_NE(line, nullptr) << dpchip_last_error();
    const ChipPtr chip{dpchip_chip_create("vpc3+c")};
    ASSERT_EQ(dpchip_line_attach(line.get(), chip.get()), DPCHIP_OK) << dpchip_last_error();
    for (int round = 0; round < 3; ++round) {
        for (std::uint16_t address = 0x16; address < 0x40; ++address) dpchip_chip_write(chip.get(), address, 0x55);
        EXPECT_EQ(dpchip_chip_read(chip.get(), 0x20), 0x55);
        EXPECT_GE(dpchip_line_run(line.get(), 1'000'000), 0);
    }
    EXPECT_EQ(dpchip_line_detach(line.get(), chip.get()), DPCHIP_OK);
}

}  // namespace
