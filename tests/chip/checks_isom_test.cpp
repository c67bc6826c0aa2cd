// SPDX-License-Identifier: Apache-2.0
// Isochron Mode and Simple Sync Mode: C128 and C129 (reference 8.11), figures 7-16 to 7-19 (7.3.2; reference 6.2;
// hardware reference 8).
#include <support/golden.hpp>

#include "dpv2_bench.hpp"

namespace dpchip::checks {
namespace {

namespace m2 = regmap::mode2;
constexpr std::uint8_t kIsochron = m2::gc_int_mode | m2::sync_ena, kSimpleSync = m2::gc_int_mode | m2::dx_int_port;
/// Set_Prm with Group_Ident = 80H.
constexpr std::string_view kPrmGroup8 = "68 0C 0C 68 88 82 5D 3D 3E 88 02 05 0B 47 11 80 54 16";
/// A Global_Control to all groups that is no SYNCH: Unsync.
constexpr std::string_view kOtherControl = "68 07 07 68 FF 82 46 3A 3E 10 00 4F 16";
constexpr auto kPin13 = static_cast<std::uint8_t>(1u << static_cast<unsigned>(chip::Pin::xdataexch_sync));

struct Compare {
    std::uint8_t sync_pw = 0x0C, command = 0x00, group = 0x80;
};

Bench synchronous(Recipe r, std::uint8_t mode2, Compare compare = {}) {
    r.mode2 = mode2;
    if ((mode2 & m2::sync_ena) != 0) r.mode0 |= regmap::mode0::spec_clear_mode;
    Bench b{r, Stage::configured};
    b.write(control::sync_pw_reg, compare.sync_pw);
    b.write(control::control_command_reg, compare.command);
    b.write(control::group_select_reg, compare.group);
    start_to_p2(b, (mode2 & m2::sync_ena) != 0 ? kPrm : kPrmGroup8);
    b.write_word(control::int_mask_reg_low, 0x0000);
    b.chip().watch(kPin13);
    return b;
}

bool pin_13_high(const Bench& b) { return b.chip().level(chip::Pin::xdataexch_sync) == chip::Level::high; }

// proves: VPC3C 1-04, VPC3C 4.2-35, VPC3C 5.1.3-08, VPC3C 7.3.2-02, VPC3C 7.3.2-04, VPC3C 7.3.2-08..09,
//   VPC3C 7.3.2-16, VPC3C 7.3.2-19, E040
TEST_P(ChecksStepBC, C128_a_SYNCH_gives_a_pulse_of_48_clk_and_New_GC_Command) {
    Bench b = synchronous(recipe(), kIsochron);
    b.write(org::r_gc_command, 0xFF);
    tell(b, kSynch);
    b.run(100_us);
    const auto edges = sync_edges(b);
    ASSERT_EQ(edges.size(), 2u);
    EXPECT_EQ(edges[0].at, b.request_end() + 4_clk);
    EXPECT_EQ(edges[0].level, chip::Level::low) << "SYNC_Pol = 0";
    EXPECT_EQ(edges[1].at - edges[0].at, 48_clk);
    EXPECT_EQ(edges[1].level, chip::Level::high);
    EXPECT_EQ(b.irr(), irq::new_gc_command);
    EXPECT_EQ(b.peek(org::r_gc_command), 0x00);
}

// proves: VPC3C 7.3.2-03, VPC3C 7.3.2-10..12, VPC3C 7.3.2-25
TEST_P(ChecksStepBC, C129_Simple_Sync_holds_DX_Out_back_until_the_SYNCH) {
    Bench b = synchronous(recipe(), kSimpleSync);
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    EXPECT_EQ(b.irr(), 0) << "the event is only stored";
    tell(b, kSynch);
    EXPECT_EQ(b.irr(), irq::dx_out | irq::new_gc_command);
    b.acknowledge();
    tell(b, kSynch);
    EXPECT_EQ(b.irr(), irq::new_gc_command);
}

// ---- figure 7-17 ----------------------------------------------------------------------------------------------------

std::string figure_7_17(Bench& b) {
    Recording recording{b};
    const auto step = [&](std::string_view name, std::string_view octets) {
        recording.heading(name);
        if (octets == kDx1234) EXPECT_EQ(b.ask(octets), kInputs);
        else tell(b, octets);
        b.run(10_us);
        b.acknowledge();
        b.write(control::mode_reg1_s, regmap::mode1::eoi);
    };
    step("Data_Ex", kDx1234);
    step("SYNCH", kSynch);
    step("SYNCH", kSynch);
    step("Data_Ex", kDx1234);
    step("GC", kOtherControl);
    step("SYNCH", kSynch);
    return recording.text();
}

// proves: VPC3C 7.3.2-05
TEST_P(ChecksStepBC, figure_7_17_Isochron_Mode) {
    Bench b = synchronous(recipe(), kIsochron);
    EXPECT_TRUE(matches_golden(GetParam().path, "chip/figure_7_17_isochron.trace", figure_7_17(b)));
}

// proves: VPC3C 7.3.2-15
TEST_P(ChecksStepBC, figure_7_17_Simple_Sync_Mode) {
    Bench b = synchronous(recipe(), kSimpleSync);
    EXPECT_TRUE(matches_golden(GetParam().path, "chip/figure_7_17_simple_sync.trace", figure_7_17(b)));
}

// ---- the SYNCH telegram ---------------------------------------------------------------------------------------------

// proves: VPC3C 4.2-36..37, VPC3C 7.3.2-04, VPC3C 7.3.2-13..14
TEST_P(ChecksStepBC, figure_7_16_both_octets_are_compared) {
    struct Row { std::uint8_t command, group; bool synch; };
    for (const Row& row : {Row{0x04, 0x81, true}, Row{0x04, 0x80, false}, Row{0x00, 0x81, false}, Row{0x05, 0x81, false}}) {
        Bench b = synchronous(recipe(), kIsochron, {.command = 0x04, .group = 0x81});
        b.tell(Stimulus{telegram(0xFF, 0x82, 0x46, {0x3A, 0x3E, row.command, row.group}), {}, {}});
        b.run(100_us);
        EXPECT_EQ(sync_edges(b).size(), row.synch ? 2u : 0u);
        EXPECT_EQ(b.irr(), row.synch ? irq::new_gc_command : 0) << "no group of the station is meant";
    }
}

TEST_P(ChecksStepBC, any_master_may_send_the_SYNCH_but_only_to_everybody) {
    Bench b = synchronous(recipe(), kIsochron);
    b.tell(Stimulus{telegram(0xFF, 0x85, 0x46, hex("3A 3E 00 80")), {}, {}});
    b.run(100_us);
    EXPECT_EQ(sync_edges(b).size(), 2u);
    b.tell(Stimulus{telegram(0x88, 0x82, 0x46, hex("3A 3E 00 80")), {}, {}});
    b.run(100_us);
    EXPECT_EQ(sync_edges(b).size(), 0u);
}

TEST_P(ChecksStepBC, a_SYNCH_outside_DATA_EXCH_is_none) {
    Recipe r = recipe();
    r.mode2 = kIsochron;
    Bench b{r, Stage::configured};
    b.write(control::sync_pw_reg, 12);
    b.write(control::group_select_reg, 0x80);
    b.start();
    b.find_baud();
    b.ask(kPrm);
    b.acknowledge();
    b.chip().watch(kPin13);
    tell(b, kSynch);
    b.run(100_us);
    EXPECT_EQ(sync_edges(b).size(), 0u);
    EXPECT_EQ(b.irr(), 0);
}

// proves: VPC3C 7.3.2-22
TEST_P(ChecksStepBC, in_Isochron_Mode_a_SYNCH_is_not_executed_as_Global_Control) {
    // Sync, to group 8: a slave that is not in group 8 shall not enter Sync_Mode by its SYNCH (figure 7-18).
    Bench b = synchronous(recipe(), kIsochron, {.command = 0x20, .group = 0x80});
    b.tell(Stimulus{telegram(0xFF, 0x82, 0x46, hex("3A 3E 20 80")), {}, {}});
    b.run(100_us);
    EXPECT_EQ(sync_edges(b).size(), 2u);
    EXPECT_EQ(b.chip().state().sync_mode, 0);
    EXPECT_EQ(b.peek(org::r_gc_command), 0x20);
}

// proves: VPC3C 7.3.2-11, VPC3C 7.3.2-29
TEST_P(ChecksStepBC, in_Simple_Sync_Mode_a_SYNCH_is_executed_as_Global_Control_too) {
    // Freeze, to group 8, of which the slave is a member (figure 7-19).
    Bench b = synchronous(recipe(), kSimpleSync, {.command = 0x08, .group = 0x80});
    b.ask(kDx1234);
    b.tell(Stimulus{telegram(0xFF, 0x82, 0x46, hex("3A 3E 08 80")), {}, {}});
    b.run(2_clk);
    EXPECT_EQ(b.irr(), irq::dx_out | irq::new_gc_command);
    EXPECT_EQ(b.chip().state().freeze_mode, 1);
}

// ---- the pulse ------------------------------------------------------------------------------------------------------

// proves: VPC3C 7.3.2-19
TEST_P(ChecksStepBC, Sync_PW_counts_in_twelfths_of_a_microsecond) {
    for (const std::uint8_t width : {std::uint8_t{1}, std::uint8_t{12}, std::uint8_t{255}}) {
        Bench b = synchronous(recipe(), kIsochron, {.sync_pw = width});
        tell(b, kSynch);
        b.run(100_us);
        const auto edges = sync_edges(b);
        ASSERT_EQ(edges.size(), 2u);
        EXPECT_EQ(edges[1].at - edges[0].at, core::kClk * (4 * width));
    }
    Bench b = synchronous(recipe(), kIsochron, {.sync_pw = 0});
    tell(b, kSynch);
    b.run(100_us);
    EXPECT_EQ(sync_edges(b).size(), 0u) << "Sync_PW = 0: no pulse";
    EXPECT_EQ(b.irr(), irq::new_gc_command);
}

// proves: VPC3C 5.1.3-07, VPC3C 7.3.2-18, VPC3C 7.3.2-26, E041
TEST_P(ChecksStepBC, SYNC_Pol_turns_pin_13_round_in_both_modes) {
    for (const std::uint8_t mode : {kIsochron, kSimpleSync}) {
        Bench b = synchronous(recipe(), static_cast<std::uint8_t>(mode | m2::sync_pol));
        EXPECT_FALSE(pin_13_high(b)) << "idle";
        b.ask(kDx1234);
        sync_edges(b);
        tell(b, kSynch);
        b.run(4_clk);
        const auto edges = sync_edges(b);
        ASSERT_EQ(edges.size(), 1u);
        EXPECT_EQ(edges[0].level, chip::Level::high);
    }
}

TEST_P(ChecksStepBC, a_SYNCH_while_a_pulse_lasts_begins_it_anew) {
    // At 12 Mbit/s a SYNCH follows a SYNCH within 15 us, and a pulse may last 21.25 us.
    Recipe r = recipe();
    r.baud = BaudCode::mbit_12;
    Bench b = synchronous(r, kIsochron, {.sync_pw = 255});
    b.tell(kSynch);
    const Ticks first = b.request_end();
    b.tell(kSynch);
    const Ticks second = b.request_end();
    ASSERT_LT(second - first, 1020_clk);
    b.run(100_us);
    const auto edges = sync_edges(b);
    ASSERT_EQ(edges.size(), 2u);
    EXPECT_EQ(edges[0].at, first + 4_clk);
    EXPECT_EQ(edges[1].at, second + 4_clk + 1020_clk);
}

TEST_P(ChecksStepBC, sync_pulse_delay_clk_moves_the_pulse) {
    Recipe r = recipe();
    r.options.sync_pulse_delay_clk = 40;
    Bench b = synchronous(r, kIsochron);
    tell(b, kSynch);
    b.run(100_us);
    EXPECT_EQ(sync_edges(b).at(0).at, b.request_end() + 40_clk);
}

TEST_P(ChecksStepBC, a_late_SYNCH_gives_a_late_pulse_and_a_missing_one_none) {
    Bench b = synchronous(recipe(), kIsochron);
    const Ticks begin = b.now();
    std::vector<Ticks> ends;
    for (const int at_us : {1000, 2000, 3050, 5000}) {  // the third is late, the fourth missing
        b.run_to(begin + core::microseconds(at_us));
        b.tell(kSynch);
        ends.push_back(b.request_end());
    }
    b.run(100_us);
    const auto edges = sync_edges(b);
    ASSERT_EQ(edges.size(), 2 * ends.size());
    for (std::size_t i = 0; i < ends.size(); ++i) EXPECT_EQ(edges[2 * i].at, ends[i] + 4_clk);
}

// proves: VPC3C 5.1.3-09, VPC3C 7.3.2-25
TEST_P(ChecksStepBC, DX_Int_Port_does_nothing_with_SYNC_Ena) {
    Bench b = synchronous(recipe(), kIsochron | m2::dx_int_port);
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    EXPECT_EQ(b.irr(), irq::dx_out);
    tell(b, kSynch);
    b.run(100_us);
    EXPECT_EQ(sync_edges(b).size(), 2u);
}

// ---- Simple Sync Mode -----------------------------------------------------------------------------------------------

// proves: VPC3C 7.3.2-08, VPC3C 7.3.2-10, VPC3C 7.3.2-31
TEST_P(ChecksStepBC, in_Simple_Sync_Mode_pin_13_is_active_until_DX_Out_is_acknowledged) {
    Bench b = synchronous(recipe(), kSimpleSync);
    b.ask(kDx1234);
    EXPECT_TRUE(pin_13_high(b));
    tell(b, kSynch);
    EXPECT_FALSE(pin_13_high(b));
    b.acknowledge(irq::new_gc_command);
    b.run(5_ms);
    EXPECT_FALSE(pin_13_high(b)) << "another acknowledgement does not end it";
    b.acknowledge(irq::dx_out);
    EXPECT_TRUE(pin_13_high(b));
}

// proves: VPC3C 7.3.2-30
TEST_P(ChecksStepBC, a_masked_DX_Out_does_not_show_on_pin_13) {
    Bench b = synchronous(recipe(), kSimpleSync);
    b.write_word(control::int_mask_reg_low, irq::dx_out);
    b.ask(kDx1234);
    tell(b, kSynch);
    EXPECT_EQ(b.irr() & irq::dx_out, irq::dx_out);
    EXPECT_TRUE(pin_13_high(b));
}

TEST_P(ChecksStepBC, a_missing_SYNCH_merges_the_events_of_two_Data_Exchanges) {
    Bench b = synchronous(recipe(), kSimpleSync);
    b.ask(kDx1234);
    b.ask(kDx5678);
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(text(b.take_outputs().octets), "56 78") << "only the event waits, the outputs do not";
    tell(b, kSynch);
    EXPECT_EQ(b.irr(), irq::dx_out | irq::new_gc_command);
    b.acknowledge();
    tell(b, kSynch);
    EXPECT_EQ(b.irr(), irq::new_gc_command);
}

TEST_P(ChecksStepBC, LEAVE_MASTER_forgets_the_stored_event_and_the_pulse) {
    for (const std::uint8_t mode : {kIsochron, kSimpleSync}) {
        Bench b = synchronous(recipe(), mode, {.sync_pw = 255});
        b.ask(kDx1234);
        tell(b, kSynch);
        b.run(4_clk);
        EXPECT_FALSE(pin_13_high(b));
        b.ask(kDx5678);
        b.write(control::mode_reg1_s, regmap::mode1::user_leave_master);
        b.run(2_clk);
        EXPECT_TRUE(pin_13_high(b));
        EXPECT_EQ(b.chip().state().dx_stored, 0);
    }
}

// ---- Set_Prm (figures 7-18, 7-19) -----------------------------------------------------------------------------------

/// Set_Prm with an IsoM block, type 4, behind octets 7 to 9.
Octets set_prm_isom(const Bench& b, std::uint8_t status_1) {
    Octets d = hex("88 02 05 0B 47 11 00 00 00 18 1C 04 00 00 01 00 00 2E E0 00 01 01 00 00 03 E8 00 01 00 01 00 00 0B B8 00 0C 00 0C");
    d[7] = status_1;
    return b.request(2, 0x5D, 0x3D, d);
}

// proves: VPC3C 7.3.2-06, VPC3C 7.3.2-16..17, VPC3C 7.3.2-21..24
TEST_P(ChecksStepBC, figure_7_18_IsoM_Req_with_its_block_needs_SYNC_Ena_and_Fail_Safe) {
    struct Row { std::uint8_t mode2, status_1; unsigned state; };
    for (const Row& row : {Row{kIsochron, 0xC0, kWaitCfg}, Row{kIsochron, 0x80, kWaitPrm}, Row{kSimpleSync, 0xC0, kWaitPrm}}) {
        Recipe r = recipe();
        r.mode2 = row.mode2;
        r.mode0 |= regmap::mode0::spec_clear_mode;
        r.aux1 = 64;
        Bench b{r, Stage::p0};
        EXPECT_EQ(b.ask(set_prm_isom(b, row.status_1)), kSc);
        EXPECT_EQ(b.dp_state(), row.state);
    }
}

// proves: VPC3C 7.3.2-07, VPC3C 7.3.2-27, E019
TEST_P(ChecksStepBC, figure_7_19_a_slave_on_an_isochrone_bus_is_a_member_of_group_8) {
    Bench b = synchronous(recipe(), kSimpleSync);
    EXPECT_EQ(b.chip().state().group_ident, 0x80);
    EXPECT_EQ(b.dp_state(), kDataExch);
}

}  // namespace
}  // namespace dpchip::checks
