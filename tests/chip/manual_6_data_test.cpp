// SPDX-License-Identifier: Apache-2.0
// What the manuals say about outputs, inputs, user watchdog and Global_Control: VPC3+C 6.2.5, 6.2.6; APC3 3.1, 5.2.5, 5.2.6.
#include "checks.hpp"

namespace dpchip::checks {
namespace {

namespace mode1 = regmap::mode1;

// proves: VPC3C 6.2.5-06..07, VPC3C 6.2.5-19..20, VPC3C 6.2.5-23..25, APC3 3.2-09, APC3 5.2.5.1-04, APC3 5.2.5.1-12..14,
//   APC3 5.2.5.1-16
TEST_P(Checks, manual_6_2_5_a_slow_user_gets_the_last_outputs_a_fast_one_no_new_buffer) {
    Bench b{recipe(), Stage::p2};
    b.take_outputs();
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    EXPECT_EQ(b.ask(b.request(2, 0x5D, std::nullopt, {0x33, 0x44})), kInputs);
    EXPECT_EQ(b.ask(kDx5678), kInputs);
    const Outputs fresh = b.take_outputs();
    EXPECT_EQ(fresh.command & 0xFC, 0x04);
    EXPECT_EQ(text(fresh.octets), "56 78");
    const std::uint8_t sm = b.peek(control::dout_buffer_sm);
    const Outputs same = b.take_outputs();
    EXPECT_EQ(same.command, fresh.command & 0x03);
    EXPECT_EQ(text(same.octets), "56 78");
    EXPECT_EQ(b.peek(control::dout_buffer_sm), sm);
}

// proves: VPC3C 6.2.5-28..29, VPC3C 6.2.5-31..32, VPC3C 6.2.5-35, APC3 5.2.5.2-01, APC3 5.2.5.2-03
TEST_P(Checks, manual_6_2_5_the_latest_inputs_are_sent_and_sent_again) {
    Bench b{recipe(), Stage::p2};
    b.give_inputs("01 02");
    b.give_inputs("03 04");
    const unsigned u = b.peek(control::din_buffer_sm) >> 4 & 3u;
    b.give_inputs("05 06");
    EXPECT_EQ(b.peek(control::din_buffer_sm) >> 2 & 3u, u) << "the newest stand in N";
    for (int i = 0; i < 3; ++i) {
        const Octets answer = hex(b.ask(kDx1234));
        EXPECT_EQ(text(std::span{answer}.subspan(7, 2)), "05 06");
        EXPECT_EQ(b.peek(control::din_buffer_sm) & 3u, u) << "fetched to D";
        EXPECT_EQ(b.peek(control::din_buffer_sm) >> 2 & 3u, 0u);
    }
}

// proves: VPC3C 6.2.5-34, APC3 5.2.5.2-05
TEST_P(Checks, manual_6_2_5_in_Freeze_Mode_Data_Exchange_fetches_nothing) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask("68 07 07 68 FF 82 46 3A 3E 08 00 47 16"), kSilence);
    b.give_inputs("EF 01");
    const std::uint8_t sm = b.peek(control::din_buffer_sm);
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    EXPECT_EQ(b.peek(control::din_buffer_sm), sm);
    EXPECT_EQ(b.ask("68 07 07 68 FF 82 46 3A 3E 04 00 43 16"), kSilence);
    EXPECT_EQ(b.ask(kDx1234), "68 05 05 68 02 08 08 EF 01 02 16");
}

// proves: VPC3C 5.1.2-06..07, VPC3C 6.2.5-43, VPC3C 6.2.5-45, APC3 4.1.2-09, APC3 5.2.5.3-01, APC3 5.2.5.3-03, E070
TEST_P(Checks, manual_6_2_5_Res_User_WD_reloads_with_the_next_Data_Exchange) {
    Recipe r = recipe();
    r.user_wd = 3;
    Bench b{r, Stage::p2};
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    EXPECT_EQ(b.chip().user_wd_timer(), 1);
    b.write(control::mode_reg1_s, mode1::res_user_wd);
    b.run(1_ms);
    EXPECT_EQ(b.chip().user_wd_timer(), 1) << "not before a telegram";
    if (traits().mode_regs_readable) {
        EXPECT_EQ(b.peek(control::mode_reg1) & mode1::res_user_wd, mode1::res_user_wd);
    }
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    EXPECT_EQ(b.chip().user_wd_timer(), 3);
    EXPECT_EQ(b.peek(control::mode_reg1) & mode1::res_user_wd, 0);
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    EXPECT_EQ(b.chip().user_wd_timer(), 2);
}

// proves: VPC3C 6.2.5-46, APC3 5.2.5.3-04
TEST_P(Checks, manual_6_2_5_Res_User_WD_set_at_power_up_loads_the_timer_with_the_first_Data_Exchange) {
    Bench b{recipe(), Stage::configured};
    b.write(control::mode_reg1_s, mode1::res_user_wd);
    b.start();
    b.find_baud();
    EXPECT_EQ(b.ask(kPrm), kSc);
    EXPECT_EQ(b.ask(kCfg), kSc);
    b.read(control::user_cfg_data_okay);
    b.give_inputs("AB CD");
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    EXPECT_EQ(b.chip().user_wd_timer(), b.recipe().user_wd);
    EXPECT_EQ(b.ask(kDx5678), kInputs);
    EXPECT_EQ(b.chip().user_wd_timer(), b.recipe().user_wd - 1);
}

// proves: VPC3C 6.2.5-43, APC3 5.2.5.3-01
TEST_P(Checks, manual_6_2_5_the_user_watchdog_counts_16_bits) {
    Recipe r = recipe();
    r.user_wd = 0x0100;
    Bench b{r, Stage::p2};
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    EXPECT_EQ(b.chip().user_wd_timer(), 0x00FF);
    EXPECT_EQ(b.dp_state(), kDataExch);
}

// proves: VPC3C 6.2.6-04, APC3 5.2.6-10, E046
TEST_P(Checks, manual_6_2_6_only_the_APC3_presets_R_GC_Command) {
    Bench b{recipe(), Stage::configured};
    b.write(org::r_gc_command, 0x77);
    b.start();
    EXPECT_EQ(b.peek(org::r_gc_command), traits().presets_gc_command ? 0x00 : 0x77);
    EXPECT_EQ(traits().presets_gc_command, regmap::kSpc3Class.has(traits().variant));
}

// proves: VPC3C 6.2.6-07, VPC3C 6.2.6-13, APC3 5.2.6-02, APC3 5.2.6-08, E071
TEST_P(Checks, manual_6_2_6_each_reserved_bit_makes_a_command_invalid) {
    for (const std::uint8_t command : Octets{0x01, 0x40, 0x80, 0x42, 0xA0}) {
        Bench b{recipe(), Stage::p2};
        b.write(org::r_gc_command, 0x77);
        EXPECT_EQ(b.ask(b.request(2, 0x46, 0x3A, {command, 0x00})), kSilence);
        EXPECT_EQ(b.peek(org::r_gc_command), 0x77);
        EXPECT_EQ(b.irr(), 0);
        EXPECT_EQ(b.diag(), kDiagDataExch);
    }
}

// proves: APC3 3.1-13, APC3 4.3-17
TEST_P(ChecksSpc3Class, manual_3_1_a_buffer_beyond_the_RAM_is_a_violation_too) {
    Bench b{recipe(), Stage::configured};
    b.write(org::r_read_cfg_buf_ptr, 0xC0);
    b.chip().write_block(0x200, hex("51 52"));
    b.start();
    b.find_baud();
    b.acknowledge();
    EXPECT_EQ(b.ask("68 05 05 68 88 82 5D 3B 3E E0 16"), "68 07 07 68 82 88 08 3E 3B 51 52 2E 16");
    b.run(48_clk);
    EXPECT_EQ(b.peek(control::status_reg_low) & 0x09, 0x08);
    EXPECT_EQ(b.irr() & irq::mac_reset, irq::mac_reset);
}

}  // namespace
}  // namespace dpchip::checks
