// SPDX-License-Identifier: Apache-2.0
// The boards of examples/boards work, and each mistake in them shows: in the wiring, in the clock, in the firmware's settings.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <boards/board.hpp>
#include <boards/hc16.hpp>
#include <boards/mcs51.hpp>

#include "support/golden.hpp"

namespace boards {

void PrintTo(const Range& r, std::ostream* out) { *out << std::hex << r.first << ".." << r.last << std::dec; }

namespace {

std::string words(const Plan& plan, const Report& report) {
    std::ostringstream out;
    print(out, plan, report);
    return out.str();
}

/// The plan with another connection on a pin.
Plan with(Plan plan, const pins::Connection& connection) {
    std::erase_if(plan.wiring, [&](const pins::Connection& c) { return c.pin == connection.pin; });
    plan.wiring.push_back(connection);
    return plan;
}
Plan without(Plan plan, PinId pin) {
    std::erase_if(plan.wiring, [&](const pins::Connection& c) { return c.pin == pin; });
    return plan;
}
Plan for_apc3(Plan plan) {
    plan.variant = pins::Variant::apc3;
    plan.supply = pins::Supply::v3_3;
    plan.ram = driver::RamSize::bytes_1536;
    return plan;
}
/// The firmware sees no chip behind its addresses: no status can be FFH, or the RAM test fails.
bool not_found(const Report& r) { return r.config == driver::ConfigError::no_chip || r.config == driver::ConfigError::ram_fault; }
bool says(const std::vector<std::string>& all, std::string_view part) {
    return std::ranges::any_of(all, [&](const std::string& s) { return s.find(part) != std::string::npos; });
}

void expect_good(const Plan& plan) {
    const Report r = run(plan);
    EXPECT_TRUE(r.good(plan)) << words(plan, r);
    EXPECT_EQ(r.selected, std::vector{plan.selected}) << plan.name;
    EXPECT_TRUE(r.tightest && r.tightest->spare >= Ticks{}) << words(plan, r);
}

// ---- the boards ---------------------------------------------------------------------------------------------------

// proves: VPC3C 8.1.2-25, VPC3C 8.1.3-01, VPC3C 8.1.4-01, VPC3C 8.1.4-02
TEST(Boards, A_80C32_with_2_KB_finds_the_chip_at_1000H_and_nowhere_else) { expect_good(board_80c32_2k()); }

// proves: VPC3C 8.1.5-01, VPC3C 8.1.5-02
TEST(Boards, A_80C32_with_4_KB_finds_the_chip_at_2000H_and_nowhere_else) { expect_good(board_80c32_4k()); }

// proves: VPC3C 8.1.2-25, VPC3C 8.1.3-02
TEST(Boards, A_80C32_with_external_memory_has_both_and_the_decoder_leaves_the_chip_alone) { expect_good(board_80c32_memory()); }

// proves: VPC3C 8.1.2-21, VPC3C 8.1.3-03
TEST(Boards, A_80286_sees_the_chip_at_every_second_address) { expect_good(board_80286()); }

// proves: VPC3C 8.1.6-01
TEST(Boards, A_80C165_waits_for_XREADY) { expect_good(board_80c165()); }

/// The pins that figure 8-10 connects to the processor or ties, by number.
// proves: VPC3C 8.1.6-01
TEST(Boards, The_80C165_is_wired_as_the_figure_has_it) {
    std::ostringstream out;
    print_wiring(out, board_80c165());
    for (const std::string_view row : {" 1 XCS/AB11         <- XCS1", " 2 XWR/E_CLOCK/AB11 <- XWRL", " 4 XRD/R_W          <- XRD", " 8 XINT/MOT         1 kOhm to GND",
                                       " 9 X/INT            -> EX0IN", "10 AB10             <- A10", "11 DB0              <> D0", "13 XDATAEXCH/SYNC   -> LED",
                                       "14 XREADY/XDTACK    -> XREADY", "22 DB7              <> D7", "23 MODE             1 kOhm to GND", "24 ALE/AS/AB11      1 kOhm to GND",
                                       "26 TXD              -> TxD", "27 RTS              -> RTS", "30 RXD              <- RxD", "33 XCTS             1 kOhm to GND",
                                       "34 XTEST0           3.3 kOhm to VDD", "35 XTEST1           3.3 kOhm to VDD", "36 RESET            <- RESET", "42 AB5              <- A5",
                                       "44 AB0              <- A0"})
        EXPECT_NE(out.str().find(row), std::string::npos) << row << '\n' << out.str();
}

// proves: VPC3C 8.1.2-05
TEST(Boards, A_68HC16_waits_for_XDTACK) { expect_good(board_hc16()); }

// proves: VPC3C 8.1.2-06, VPC3C 8.1.2-22, VPC3C 8.1.2-23
TEST(Boards, A_68HC11_runs_with_a_quarter_of_CLKOUT_and_an_address_latch) {
    const Plan plan = board_hc11();
    expect_good(plan);
    EXPECT_EQ(core::to_ns(run(plan).shortest_cycle), 333) << "E is 3 MHz";
}

TEST(Boards, Work_at_both_supplies) {
    for (Plan plan : all_boards()) {
        plan.supply = pins::Supply::v3_3;
        plan.test_ram = false;
        expect_good(plan);
    }
}

// proves: APC3 6.2-01, APC3 6.3-01, APC3 6.3-02
TEST(BoardsWithApc3, A_80C32) { expect_good(for_apc3(board_80c32_2k())); }
// proves: APC3 6.2-02
TEST(BoardsWithApc3, A_80C32_with_external_memory) { expect_good(for_apc3(board_80c32_memory())); }
// proves: APC3 6.2-03
TEST(BoardsWithApc3, A_80286) { expect_good(for_apc3(board_80286())); }
// proves: APC3 6.4-01
TEST(BoardsWithApc3, A_80C165) { expect_good(for_apc3(board_80c165())); }

// proves: APC3 6.3-03
TEST(BoardsWithApc3, Wires_do_as_well_as_the_resistors_of_the_drawings) {
    for (Plan plan : {for_apc3(board_80c32_2k()), for_apc3(board_80c165())}) {
        for (pins::Connection& c : plan.wiring) {
            if (c.end == pins::FarEnd::pull_up) c = on_vdd(c.pin);
            else if (c.end == pins::FarEnd::pull_down) c = on_gnd(c.pin);
        }
        expect_good(plan);
    }
}

TEST(Boards, Stand_in_their_README_pin_by_pin) {
    const std::string readme = test::read_file(std::string{DPCHIP_SOURCE_DIR} + "/examples/boards/README.md");
    for (const Plan& plan : all_boards()) {
        std::ostringstream table;
        print_wiring(table, plan);
        EXPECT_NE(readme.find(table.str()), std::string::npos) << plan.name << ", should be\n" << table.str();
    }
}

// ---- where the chip answers ---------------------------------------------------------------------------------------

TEST(StartAddress, Without_its_inverter_the_chip_is_at_0000H_and_the_firmware_does_not_find_it) {
    const Plan plan = with(board_80c32_2k(), from("A12", PinId::ab4));
    const Report r = run(plan);
    EXPECT_EQ(r.selected, (std::vector<Range>{{0x0000, 0x07FF}}));
    EXPECT_TRUE(not_found(r));
    EXPECT_FALSE(r.good(plan));
}

// proves: VPC3C 8.1.4-02
TEST(StartAddress, An_inverter_in_each_line_that_is_1_in_the_address_makes_the_start_address) {
    struct Line {
        std::string_view name;
        PinId pin;
    };
    constexpr std::array<Line, 5> kLines{{{"A11", PinId::ab3}, {"A12", PinId::ab4}, {"A13", PinId::ab5}, {"A14", PinId::ab6}, {"A15", PinId::ab7}}};
    for (const std::uint32_t start : {0x0000u, 0x0800u, 0x1000u, 0x2000u, 0x4000u, 0x8000u, 0xA800u, 0xF800u}) {
        Plan plan = board_80c32_2k();
        for (std::size_t i = 0; i < kLines.size(); ++i)
            plan = with(plan, ((start >> (11 + i)) & 1u) != 0 ? from_inverted(kLines[i].name, kLines[i].pin) : from(kLines[i].name, kLines[i].pin));
        plan.base = start;
        plan.selected = {start, start + 0x7FF};
        plan.test_ram = false;
        expect_good(plan);
    }
}

// proves: VPC3C 8.1.4-02, VPC3C 8.1.5-02
TEST(StartAddress, An_AB8_that_is_not_on_GND_deselects_the_chip) {
    for (const PinId pin : {PinId::ab8, PinId::ab9, PinId::ab10}) EXPECT_TRUE(run(with(board_80c32_4k(), on_vdd(pin))).selected.empty()) << pins::info(pin).name;
}

TEST(StartAddress, With_A11_at_AB3_instead_of_AB11_the_window_of_4_KB_is_half_as_large) {
    const Plan plan = with(with(board_80c32_4k(), from("A11", PinId::ab3)), on_gnd(PinId::xcs_ab11));
    const Report r = run(plan);
    EXPECT_EQ(r.selected, (std::vector<Range>{{0x2000, 0x27FF}}));
    EXPECT_TRUE(not_found(r));
}

TEST(StartAddress, A_80286_that_counts_octets_does_not_find_the_registers) {
    Plan plan = board_80286();
    plan.stride = 1;
    plan.selected = {0xE0000, 0xE0FFF};
    EXPECT_TRUE(not_found(run(plan)));
}

// proves: VPC3C 8.1.3-02
TEST(ExternalMemory, A_decoder_that_gives_the_RAM_the_chips_window_too_makes_them_fight_for_the_bus) {
    Plan plan = board_80c32_memory();
    plan.make = [](Circuit& c, Ticks period) { return std::make_unique<Mcs51>(c, period, kMcs51Standard, ExternalMemory{.ram = {.mask = 0x8000, .value = 0x0000}}); };
    const Report r = run(plan);
    EXPECT_FALSE(r.good(plan));
    EXPECT_TRUE(says(r.findings, "against each other")) << words(plan, r);
}

// ---- clocks -------------------------------------------------------------------------------------------------------

TEST(Clock, DIVIDER_on_VDD_makes_a_standard_80C32_too_fast_and_names_what_it_misses) {
    const Plan plan = with(board_80c32_2k(), on_vdd(PinId::divider));
    const Report r = run(plan);
    EXPECT_EQ(r.violated, (std::vector<unsigned>{3, 4, 7})) << words(plan, r);
    EXPECT_TRUE(says(r.findings, "timing 3, address set-up before ALE: 1.666 ns, at least 10 ns")) << words(plan, r);
    EXPECT_NE(r.late_reads, 0u);
    EXPECT_TRUE(not_found(r));
}

TEST(Clock, E_of_6_MHz_is_too_short) {
    const Report r = run(with(board_hc11(), on_vdd(PinId::divider)));
    EXPECT_NE(std::ranges::find(r.violated, 31u), r.violated.end());
    EXPECT_FALSE(r.exchanging);
}

TEST(Clock, Without_CLKOUT_the_processor_stands_still) {
    const Plan plan = without(board_80c32_2k(), PinId::clkout);
    const Report r = run(plan);
    EXPECT_FALSE(r.clocked);
    EXPECT_EQ(r.accesses, 0u);
    EXPECT_FALSE(r.good(plan));
}

/// An edge in the wrong order is one for the package alone.
TEST(Clock, What_the_package_finds_violated_is_what_the_board_has_nothing_to_spare_of) {
    struct Case {
        Plan plan;
        std::vector<int> mhz;
    };
    std::set<unsigned> seen;
    for (const Case& c : {Case{board_80c32_memory(), {12, 20, 28, 36}}, Case{board_80c165(), {16, 25, 40}}, Case{board_80286(), {8, 12, 16}}, Case{board_hc16(), {8, 17, 25}}}) {
        for (const int mhz : c.mhz) {
            Plan plan = c.plan;
            plan.crystal_hz = std::int64_t{mhz} * 1'000'000;
            plan.test_ram = false;
            const Report r = run(plan);
            EXPECT_TRUE(std::ranges::includes(r.violated, r.without_slack)) << words(plan, r);
            EXPECT_EQ(r.violated.empty(), r.without_slack.empty()) << words(plan, r);
            seen.insert(r.violated.begin(), r.violated.end());
        }
    }
    EXPECT_GE(seen.size(), 6u) << "the clocks reach beyond the limits";
}

TEST(ChipSelect, Of_the_68HC16_falls_with_AS_and_is_too_late_for_parameter_47) {
    Plan plan = board_hc16();
    plan.make = [](Circuit& c, Ticks period) {
        return std::make_unique<Hc16>(c, period, Decoder{.mask = 0xFC000, .value = 0x84000, .delay = {}}, SelectFrom::chip_select_pin);
    };
    const Report r = run(plan);
    EXPECT_EQ(r.violated, (std::vector<unsigned>{47})) << words(plan, r);
}

// ---- straps, ties, lines ------------------------------------------------------------------------------------------

struct Fault {
    std::string what;
    Plan plan;
    std::string in_the_wiring;   ///< what the check says; empty: nothing
    std::function<bool(const Report&)> shows;
};

bool not_heard(const Report& r) { return r.config == driver::ConfigError::none && !r.exchanging && r.violated.empty(); }

std::vector<Fault> faults() {
    return {
        {"MODE on GND: nothing answers a multiplexed bus", with(board_80c32_2k(), on_gnd(PinId::mode)), "", [](const Report& r) { return not_found(r) && r.selected.empty(); }},
        {"XINT/MOT on VDD", with(board_80c165(), on_vdd(PinId::xint_mot)), "", not_found},
        {"MODE on VDD: XREADY never comes", with(board_80286(), on_vdd(PinId::mode)), "", [](const Report& r) { return not_found(r) && r.never_ready != 0; }},
        {"MODE open", without(board_hc16(), PinId::mode), "pin 23 (MODE): an input that nothing drives", [](const Report& r) { return says(r.findings, "floating_input at pin 23"); }},
        {"XREADY not wired", without(board_80c165(), PinId::xready_xdtack), "", [](const Report& r) { return r.never_ready != 0; }},
        {"XDTACK not wired", without(board_hc16(), PinId::xready_xdtack), "", [](const Report& r) { return r.never_ready != 0; }},
        {"D0 not wired: bit 0 of the status is always 1", without(board_80286(), PinId::db0), "pin 11 (DB0): the data bus goes both ways",
         [](const Report& r) { return r.config == driver::ConfigError::running; }},
        {"data bus in the wrong order", with(with(board_80c165(), both_ways("D1", PinId::db0)), both_ways("D0", PinId::db1)), "", not_heard},
        {"X/INT not wired: nobody serves the chip", without(board_80c165(), PinId::x_int), "", not_heard},
        {"RESET not wired", without(board_80c165(), PinId::reset), "pin 36 (RESET)", [](const Report& r) { return says(r.findings, "floating_input at pin 36"); }},
    };
}

TEST(Wires, Each_fault_is_told_by_the_check_or_shows_on_the_board) {
    for (const Fault& f : faults()) {
        const Report r = run(f.plan);
        EXPECT_FALSE(r.good(f.plan)) << f.what;
        EXPECT_TRUE(f.shows(r)) << f.what << '\n' << words(f.plan, r);
        if (f.in_the_wiring.empty()) EXPECT_TRUE(r.wiring.empty() || f.plan.name == "80286") << f.what << '\n' << words(f.plan, r);
        else EXPECT_TRUE(says(r.wiring, f.in_the_wiring)) << f.what << '\n' << words(f.plan, r);
    }
}

// ---- X/INT --------------------------------------------------------------------------------------------------------

/// DX_Out is pending as soon as the chip leaves Offline, and takes the line where the processor sees no request.
TEST(Interrupt, The_wrong_INT_Pol_hides_every_event) {
    Plan plan = board_80c32_2k();
    plan.int_polarity = driver::IntPolarity::high;
    const Report r = run(plan);
    EXPECT_TRUE(not_heard(r)) << words(plan, r);
}

TEST(Interrupt, A_line_that_rests_at_the_active_level_interrupts_without_end) {
    Plan plan = board_80c32_2k();
    plan.interrupt_line = "RTS";
    const Report r = run(plan);
    EXPECT_GT(r.spurious_interrupts, 10u) << words(plan, r);
    EXPECT_FALSE(r.exchanging);
}

TEST(Interrupt, An_inverter_and_INT_Pol_1_are_right_again) {
    Plan plan = with(board_80c32_2k(), to_inverted("INT0", PinId::x_int));
    plan.int_polarity = driver::IntPolarity::high;
    expect_good(plan);
}

}  // namespace
}  // namespace boards
