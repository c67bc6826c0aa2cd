// SPDX-License-Identifier: Apache-2.0
// The bus interface: one strobe is one access, select, address, direction, and what is no access (8.1.2, 10.7.2 to 10.7.5).
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <random>

#include "pins/part.hpp"

namespace {

using namespace dpchip;
using namespace dpchip::core::literals;
using core::Ticks;
using regmap::Fact;
using test::kModes;
using test::Part;
using test::PinId;
using test::PinLevel;
using test::ProcessorMode;
using test::Supply;

PinId strobe_pin(ProcessorMode mode, bool read) {
    if (mode == ProcessorMode::async_motorola) return PinId::ale_as_ab11;
    if (mode == ProcessorMode::sync_motorola || !read) return PinId::xwr_e_clock_ab11;
    return PinId::xrd_r_w;
}

/// The strobe of a read or write begins or ends. R_W and XCS are as they stand.
void strobe(Part& part, bool read, bool active) {
    const bool high = part.bus.mode() == ProcessorMode::sync_motorola ? active : !active;
    part.set(strobe_pin(part.bus.mode(), read), high ? 1 : 0);
}

/// Selects `address`; in synchronous Intel mode with its ALE.
void point_at(Part& part, std::uint16_t address, bool read = true) {
    const ProcessorMode mode = part.bus.mode();
    const unsigned lines = mode == ProcessorMode::sync_intel ? address >> 8u : address;
    for (std::size_t i = 0; i < pins::kAddressBus.size(); ++i) part.set(pins::kAddressBus[i], (lines >> i & 1u) != 0 ? 1 : 0);
    if (regmap::motorola(mode)) part.set(PinId::xrd_r_w, read ? 1 : 0);
    if (mode != ProcessorMode::sync_intel) part.set(PinId::xcs_ab11, 0);
    part.wait(20_ns);
    if (mode != ProcessorMode::sync_intel) return;
    for (std::size_t i = 0; i < 8; ++i) part.set(pins::kDataBus[i], core::bit(address, static_cast<unsigned>(i)) ? 1 : 0);
    part.set(PinId::ale_as_ab11, 1);
    part.wait(20_ns);
    part.set(PinId::ale_as_ab11, 0);
    part.wait(20_ns);
    for (const PinId db : pins::kDataBus) part.package.set_pin(db, PinLevel::z);
    part.wait(20_ns);
}

class EveryMode : public testing::TestWithParam<ProcessorMode> {
protected:
    Part part{GetParam()};
};

// proves: VPC3C 10.7.2-19, VPC3C 10.7.3-19, VPC3C 10.7.4-15, VPC3C 10.7.5-22
TEST_P(EveryMode, A_read_strobe_is_one_access_however_long_it_is) {
    for (const Ticks width : {150_ns, 1_us, 1_ms}) {
        point_at(part, 0x0A);
        part.accesses();
        strobe(part, true, true);
        const Ticks k = part.package.clk().edge_from(part.package.now());
        part.wait(width);
        strobe(part, true, false);
        part.wait(200_ns);
        const auto accesses = part.accesses();
        ASSERT_EQ(accesses.size(), 1u);
        EXPECT_EQ(accesses[0].what, static_cast<std::uint16_t>(Fact::cpu_read));
        EXPECT_EQ(accesses[0].at, k + 2_clk) << "at the internal access, not at the end of the strobe";
    }
    EXPECT_EQ(part.findings(), "");
}

TEST_P(EveryMode, A_command_acts_once_and_its_result_stays_on_the_bus_to_the_end_of_the_strobe) {
    constexpr std::uint16_t kNewDinBufferCmd = 0x09;
    const std::uint8_t before = part.package.chip().state().din_sm;
    chip::Chip<> reference = part.package.chip();
    const std::uint8_t expected = reference.read(kNewDinBufferCmd);
    EXPECT_NE(reference.state().din_sm, before);
    point_at(part, kNewDinBufferCmd);
    strobe(part, true, true);
    part.wait(5_us);
    unsigned value = 0;
    for (std::size_t i = 0; i < 8; ++i) value |= (part.pin(pins::kDataBus[i]) == PinLevel::high ? 1u : 0u) << i;
    strobe(part, true, false);
    part.wait(100_ns);
    EXPECT_EQ(value, expected);
    EXPECT_EQ(part.package.chip().state().din_sm, reference.state().din_sm) << "one exchange, not more";
}

// proves: VPC3C 10.7.2-02, VPC3C 10.7.3-02, VPC3C 10.7.4-02, VPC3C 10.7.5-02
TEST_P(EveryMode, A_write_acts_once_with_the_data_of_the_end_of_the_strobe) {
    point_at(part, 0x123, false);
    part.accesses();
    strobe(part, false, true);
    part.wait(50_ns);
    for (const PinId db : pins::kDataBus) part.set(db, 0);
    part.wait(300_ns);
    EXPECT_TRUE(part.accesses().empty());
    part.set(PinId::db5, 1);
    part.wait(20_ns);
    const Ticks captured = part.package.now();
    strobe(part, false, false);
    part.wait(20_ns);
    for (const PinId db : pins::kDataBus) part.package.set_pin(db, PinLevel::z);
    part.wait(1_us);
    const auto accesses = part.accesses();
    ASSERT_EQ(accesses.size(), 1u);
    EXPECT_EQ(accesses[0].what, static_cast<std::uint16_t>(Fact::cpu_write));
    EXPECT_EQ(accesses[0].a, 0x123);
    EXPECT_EQ(accesses[0].b, 0x20u);
    EXPECT_EQ(accesses[0].at, part.package.clk().edge_from(captured) + 1_clk);
    EXPECT_EQ(part.findings(), "");
}

TEST_P(EveryMode, The_chip_drives_DB_in_reads_of_its_own_only) {
    const auto drives = [&] { return part.pin(PinId::db0) != PinLevel::z; };
    point_at(part, 0x155, false);
    strobe(part, false, true);
    part.wait(200_ns);
    EXPECT_FALSE(drives()) << "a write";
    strobe(part, false, false);
    part.wait(200_ns);
    point_at(part, 0x155);
    strobe(part, true, true);
    part.wait(200_ns);
    EXPECT_TRUE(drives());
    strobe(part, true, false);
    part.wait(3_ns);
    EXPECT_TRUE(drives()) << "data hold";
    part.wait(11_ns);
    EXPECT_FALSE(drives());
}

TEST_P(EveryMode, A_strobe_without_select_is_none) {
    point_at(part, 0x155);
    if (GetParam() == ProcessorMode::sync_intel) part.set(PinId::ab7, 1);
    else part.set(PinId::xcs_ab11, 1);
    part.wait(50_ns);
    part.accesses();
    for (const bool read : {true, false}) {
        strobe(part, read, true);
        part.wait(300_ns);
        EXPECT_EQ(part.pin(PinId::db0), PinLevel::z);
        EXPECT_EQ(part.pin(PinId::xready_xdtack), PinLevel::high);
        strobe(part, read, false);
        part.wait(300_ns);
    }
    EXPECT_TRUE(part.accesses().empty());
    EXPECT_EQ(part.findings(), "");
}

TEST_P(EveryMode, A_strobe_that_no_clock_edge_sees_is_none_and_reported) {
    point_at(part, 0x155);
    part.accesses();
    part.wait(part.package.clk().edge_after(part.package.now()) - part.package.now() + 2_ns);
    strobe(part, true, true);
    part.wait(10_ns);
    strobe(part, true, false);
    part.wait(300_ns);
    EXPECT_TRUE(part.accesses().empty());
    EXPECT_NE(part.findings().find("strobe_unseen"), std::string::npos);
}

TEST_P(EveryMode, A_read_given_up_after_a_clock_edge_is_carried_out_once_and_drives_nothing) {
    point_at(part, 0x155);
    part.accesses();
    strobe(part, true, true);
    part.wait(25_ns);
    strobe(part, true, false);
    part.edges(PinId::db0);
    part.wait(500_ns);
    const auto accesses = part.accesses();
    ASSERT_EQ(accesses.size(), 1u);
    EXPECT_EQ(accesses[0].a, 0x155);
    EXPECT_TRUE(part.edges(PinId::db0).empty());
    const std::string found = part.findings();
    EXPECT_NE(found.find("timing"), std::string::npos) << "it is too short";
}

TEST_P(EveryMode, Random_cycles_read_back_what_random_cycles_wrote_and_match_a_chip_without_pins) {
    std::mt19937 random{4711u + static_cast<unsigned>(GetParam())};
    const int steps = std::getenv("DPCHIP_LONG") != nullptr ? 100'000 : 4'000;
    chip::Chip<> bare{regmap::Variant::vpc3c, {}, regmap::motorola(GetParam()) ? chip::BusMode::motorola : chip::BusMode::intel};
    bare.reset();
    part.accesses();
    for (int i = 0; i < steps; ++i) {
        // Registers and RAM alike, but Start, which would begin to wait for telegrams, and 4KB_Mode, which this board lacks.
        const std::uint16_t address = static_cast<std::uint16_t>(random() % 3 == 0 ? random() % 0x16 : random() % 0x800);
        const auto value = static_cast<std::uint8_t>(random() & (address == 0x08 ? 0xFEu : address == 0x0C ? 0x7Fu : 0xFFu));
        part.bus.times().wait_for_ready = random() % 2 == 0;
        part.wait(Ticks{static_cast<std::int64_t>(random() % 2000)});
        std::uint8_t got = 0;
        const bool read = random() % 2 == 0;
        if (read) got = part.bus.read(address);
        else part.bus.write(address, value);
        if (!read) part.bus.settle();
        const auto accesses = part.accesses();
        ASSERT_EQ(accesses.size(), 1u);
        bare.advance(accesses[0].at);
        if (read) {
            ASSERT_EQ(bare.read(address), got) << "address " << address << " step " << i;
        } else {
            bare.write(address, value);
        }
    }
    part.bus.settle();
    bare.advance(part.package.now());
    chip::State a = part.package.chip().state(), b = bare.state();
    a.watched_pins = b.watched_pins = 0;
    a.line_idle_since = b.line_idle_since = Ticks{};
    chip::describe(a, [&](std::string_view name, auto& member) {
        chip::describe(b, [&](std::string_view other, auto& its) {
            if constexpr (sizeof member == sizeof its) {
                if (name == other) {
                    EXPECT_EQ(std::memcmp(&member, &its, sizeof member), 0) << name;
                }
            }
        });
    });
    EXPECT_EQ(part.package.violations(0), 0u);
}

INSTANTIATE_TEST_SUITE_P(Modes, EveryMode, testing::ValuesIn(kModes), [](const auto& i) {
    std::string name{regmap::name(i.param)};
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

// ---- select and address -----------------------------------------------------------------------------------------

// proves: VPC3C 8.1.4-02, VPC3C 8.1.5-02, APC3 6.3-02
TEST(InternalSelect, Needs_AB10_to_AB3_all_at_0) {
    Part part{ProcessorMode::sync_intel};
    part.bus.write(0x342, 0x99);
    part.bus.settle();
    for (std::size_t line = 0; line < pins::kAddressBus.size(); ++line) {
        point_at(part, 0x342);
        if (line >= 3) part.set(pins::kAddressBus[line], 1);
        part.wait(20_ns);
        strobe(part, true, true);
        part.wait(150_ns);
        EXPECT_EQ(part.pin(PinId::db0) != PinLevel::z, line < 3) << "AB" << line;
        strobe(part, true, false);
        part.wait(50_ns);
        part.set(pins::kAddressBus[line], 0);
    }
}

// proves: VPC3C 3.1-51
TEST(InternalSelect, Does_not_look_at_XCS_with_2_KB) {
    Part part{ProcessorMode::sync_intel};
    for (const int level : {0, 1}) {
        part.set(PinId::xcs_ab11, level);
        part.bus.write(0x155, static_cast<std::uint8_t>(level + 1));
        EXPECT_EQ(part.bus.read(0x155), level + 1);
    }
}

TEST(AddressLatch, Keeps_what_DB_was_when_ALE_fell) {
    Part part{ProcessorMode::sync_intel};
    part.bus.write(0x2C3, 0x5C);
    part.bus.settle();
    point_at(part, 0x2C3);
    for (const PinId db : pins::kDataBus) part.set(db, 0);
    part.wait(20_ns);
    for (const PinId db : pins::kDataBus) part.package.set_pin(db, PinLevel::z);
    part.accesses();
    strobe(part, true, true);
    part.wait(150_ns);
    strobe(part, true, false);
    EXPECT_EQ(part.accesses().at(0).a, 0x2C3);
}

TEST(Ab11, Tied_to_VDD_on_a_2_KB_board_hides_the_registers_once_4KB_Mode_is_set) {
    Part part{ProcessorMode::sync_intel};
    part.bus.write(0x155, 0x11);
    EXPECT_EQ(part.bus.read(0x155), 0x11);
    part.bus.write(0x0C, 0x81);
    part.accesses();
    EXPECT_EQ(part.bus.read(0x155), 0x00);
    EXPECT_EQ(part.accesses().at(1).a, 0x955);
}

// proves: VPC3C 3.1-09, VPC3C 3.1-10, E037
TEST(Ab11, Selects_the_upper_2_KB_in_every_mode_with_4KB_Mode_and_only_then) {
    for (const ProcessorMode mode : kModes) {
        Part part{mode, true};
        part.bus.write(0x955, 0x22);
        part.bus.settle();
        EXPECT_EQ(part.package.chip().peek(0x155), 0x22) << "2 KB: the pin has no effect";
        part.bus.write(0x0C, 0x81);  // 4KB_Mode
        part.bus.write(0x955, 0x33);
        part.bus.write(0x155, 0x44);
        EXPECT_EQ(part.bus.read(0x955), 0x33) << regmap::name(mode);
        EXPECT_EQ(part.bus.read(0x155), 0x44);
        EXPECT_EQ(part.findings(), "");
    }
}

TEST(Ab11, Obeys_the_address_times_once_it_is_an_address_line) {
    for (const bool with_4k : {false, true}) {
        Part part{ProcessorMode::async_intel, false};
        if (with_4k) part.bus.write(0x0C, 0x81);
        part.bus.settle();
        point_at(part, 0x155);
        strobe(part, true, true);
        part.wait(60_ns);
        part.set(PinId::ale_as_ab11, 1);
        part.wait(90_ns);
        strobe(part, true, false);
        part.wait(50_ns);
        EXPECT_EQ(part.findings(), with_4k ? "timing 16" : "");
    }
}

// proves: APC3 2.1-03
TEST(Ab11, Is_not_there_on_APC3) {
    Part part{ProcessorMode::async_intel, true, Supply::v3_3, regmap::Variant::apc3};
    part.bus.write(0x955, 0x22);
    part.bus.settle();
    EXPECT_EQ(part.package.chip().peek(0x155), 0x22);
}

// ---- strobes of the Intel modes ---------------------------------------------------------------------------------

TEST(Strobes, XRD_and_XWR_together_do_nothing_and_drive_nothing) {
    for (const ProcessorMode mode : {ProcessorMode::async_intel, ProcessorMode::sync_intel}) {
        Part part{mode};
        point_at(part, 0x155);
        part.accesses();
        strobe(part, true, true);
        strobe(part, false, true);
        part.wait(300_ns);
        EXPECT_EQ(part.pin(PinId::db0), PinLevel::z);
        strobe(part, true, false);
        part.wait(300_ns);
        strobe(part, false, false);
        part.wait(300_ns);
        EXPECT_TRUE(part.accesses().empty());
        EXPECT_EQ(part.findings(), "both_strobes");
        part.bus.write(0x155, 0x31);
        EXPECT_EQ(part.bus.read(0x155), 0x31);
    }
}

TEST(Strobes, The_second_strobe_takes_the_bus_away_from_a_read) {
    Part part{ProcessorMode::async_intel};
    point_at(part, 0x155);
    strobe(part, true, true);
    part.wait(200_ns);
    EXPECT_EQ(part.pin(PinId::xready_xdtack), PinLevel::low);
    strobe(part, false, true);
    part.wait(20_ns);
    EXPECT_EQ(part.pin(PinId::db0), PinLevel::z);
    EXPECT_EQ(part.pin(PinId::xready_xdtack), PinLevel::high);
}

// proves: VPC3C 3.1-02
TEST(Strobes, A_late_select_begins_and_an_early_end_of_it_ends_the_access) {
    Part part{ProcessorMode::async_intel};
    point_at(part, 0x155, false);
    part.set(PinId::xcs_ab11, 1);
    part.wait(50_ns);
    part.accesses();
    for (const PinId db : pins::kDataBus) part.set(db, 1);
    strobe(part, false, true);
    part.wait(5_ns);
    part.set(PinId::xcs_ab11, 0);
    part.wait(100_ns);
    part.set(PinId::xcs_ab11, 1);
    part.set(PinId::db0, 0);
    part.wait(2_ns);
    part.set(PinId::xcs_ab11, 0);
    part.wait(100_ns);
    strobe(part, false, false);
    part.wait(100_ns);
    const auto accesses = part.accesses();
    ASSERT_EQ(accesses.size(), 1u) << "one strobe, one access";
    EXPECT_EQ(accesses[0].b, 0xFFu);
    EXPECT_EQ(part.findings(), "timing 19, timing 26");
}

TEST(Contention, The_processor_drives_against_a_read) {
    Part part{ProcessorMode::async_intel};
    part.bus.write(0x155, 0xFF);
    part.bus.settle();
    point_at(part, 0x155);
    part.set(PinId::db2, 0);
    strobe(part, true, true);
    part.wait(150_ns);
    EXPECT_EQ(part.findings(), "bus_contention 15");
    strobe(part, true, false);
    part.wait(50_ns);
    part.package.set_pin(PinId::db2, PinLevel::z);
    strobe(part, true, true);
    part.wait(150_ns);
    EXPECT_EQ(part.findings(), "");
    part.set(PinId::db4, 0);
    EXPECT_EQ(part.findings(), "bus_contention 19") << "also in the middle";
}

// ---- Dual-Port RAM controller (8.2) -----------------------------------------------------------------------------

// proves: VPC3C 8.2-01, VPC3C 8.2-02, E075
TEST(DualPort, The_bus_never_waits_and_the_sequencer_waits_one_clock_for_each_access_it_meets) {
    pins::DualPortController dpc;
    const pins::Clk clk;
    dpc.sequencer(Ticks{1}, 10, clk);
    EXPECT_EQ(dpc.busy_until(), 11_clk) << "ten octets from the next edge on";
    EXPECT_TRUE(dpc.bus(1_clk));
    EXPECT_TRUE(dpc.bus(11_clk)) << "the wait made it longer";
    EXPECT_FALSE(dpc.bus(13_clk));
    EXPECT_EQ(dpc.busy_until(), 13_clk);
    EXPECT_EQ(dpc.counters().bus_accesses, 3u);
    EXPECT_EQ(dpc.counters().sequencer_accesses, 10u);
    EXPECT_EQ(dpc.counters().collisions, 2u);
    EXPECT_EQ(dpc.counters().longest_wait, 2u);
    dpc.sequencer(20_clk, 1, clk);
    EXPECT_TRUE(dpc.bus(20_clk));
    EXPECT_EQ(dpc.counters().longest_wait, 2u) << "per run";
}

}  // namespace
