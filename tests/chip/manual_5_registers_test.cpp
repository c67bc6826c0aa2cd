// SPDX-License-Identifier: Apache-2.0
// What the manuals say about mode and status registers: VPC3+C 5.1, 5.2; APC3 4.1, 4.2.
#include "checks.hpp"

namespace dpchip::checks {
namespace {

namespace mode0 = regmap::mode0;
namespace mode1 = regmap::mode1;
namespace mode2 = regmap::mode2;
namespace mode3 = regmap::mode3;

constexpr std::string_view kSync = "68 07 07 68 FF 82 46 3A 3E 20 00 5F 16";
constexpr std::string_view kSyncGroup1 = "68 07 07 68 FF 82 46 3A 3E 20 01 60 16";
constexpr std::string_view kFreeze = "68 07 07 68 FF 82 46 3A 3E 08 00 47 16";
constexpr std::string_view kEmptyDx = "10 08 02 7D 87 16";

Octets prm(const Octets& rest) {
    Octets data{0x80, 0x01, 0x01, 0x0B, 0x47, 0x11, 0x00};
    for (const std::uint8_t octet : rest) data.push_back(octet);
    return data;
}

// proves: VPC3C 5.1-01, VPC3C 5.1.1-01, APC3 4.1.1-01, APC3 4.1.1-25
TEST_P(Checks, manual_5_1_1_Mode_Register_0_takes_writes_in_Offline_only) {
    Bench b{recipe(), Stage::p0};
    b.write_word(control::mode_reg0_low, 0x0000);
    if (traits().mode_regs_readable) {
        EXPECT_EQ(b.peek_word(control::mode_reg0_low), b.recipe().mode0);
    }
    EXPECT_EQ(b.ask(kPrm), kSc) << "DP_Mode is still on";
    b.go_offline();
    b.write_word(control::mode_reg0_low, 0x0000);
    if (traits().mode_regs_readable) {
        EXPECT_EQ(b.peek_word(control::mode_reg0_low), 0x0000);
    }
    b.start();
    b.find_baud();
    EXPECT_EQ(b.ask(kPrm), kRs) << "DP_Mode is off";
}

// proves: VPC3C 5.1-01, VPC3C 5.1.1-10, E002
TEST_P(ChecksVpc3, manual_5_1_1_each_bit_of_Mode_Register_0_reads_back_alone) {
    for (const unsigned bit : {0u, 1u, 2u, 4u, 5u, 6u, 7u, 8u, 9u, 10u, 12u, 13u}) {
        Bench b{recipe(), Stage::reset};
        b.write_word(control::mode_reg0_low, static_cast<std::uint16_t>(1u << bit));
        EXPECT_EQ(b.peek_word(control::mode_reg0_low), 1u << bit) << bit;
    }
}

// proves: VPC3C 5.1.1-13, VPC3C 5.1.1-23, VPC3C 5.1.1-02, APC3 4.1.1-02, APC3 4.1.1-03, APC3 4.1.1-20
TEST_P(Checks, manual_5_1_1_bits_without_a_function_change_nothing) {
    Recipe r = recipe();
    r.mode0 |= 0x8000 | mode0::early_rdy;
    if (regmap::kSpc3Class.has(r.variant)) r.mode0 |= 1u << 14 | 1u << 11 | 1u << 10;
    Bench b{r, Stage::p2};
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    EXPECT_EQ(b.irr(), irq::dx_out);
    b.run(99_ms + 2_ms);
    EXPECT_EQ(b.dp_state(), kWaitPrm) << "WD_Test does not stop the watchdog";
    b.go_offline();
    EXPECT_EQ(b.irr() & irq::mac_reset, irq::mac_reset) << "bit 0 is MAC_Reset without clock synchronization";
}

// proves: VPC3C 5.1.1-04, VPC3C 5.1.1-06, VPC3C 6.2.6-06, APC3 4.1.1-12, APC3 4.1.1-14, APC3 5.2.6-12
TEST_P(Checks, manual_5_1_1_without_support_Sync_and_Freeze_change_nothing) {
    Recipe r = recipe();
    r.mode0 = mode0::dp_mode;
    Bench b{r, Stage::p2};
    b.ask(kSync);
    b.ask(kFreeze);
    b.acknowledge();
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    EXPECT_EQ(b.irr(), irq::dx_out);
    b.give_inputs("EF 01");
    EXPECT_EQ(b.ask("68 05 05 68 88 82 5D 38 3E DD 16"), "68 07 07 68 82 88 08 3E 38 EF 01 78 16");
    EXPECT_EQ(b.diag(), kDiagDataExch);
}

// proves: VPC3C 5.1.1-11..12, VPC3C 5.3-17, APC3 4.1.1-09..10, APC3 4.3-14
TEST_P(Checks, manual_5_1_1_INT_Pol_turns_the_levels_of_the_interrupt_pin_round) {
    for (const bool high : {false, true}) {
        Bench b{recipe(), Stage::reset};
        b.write_word(control::mode_reg0_low, high ? mode0::int_pol : std::uint16_t{0});
        b.write_word(control::int_mask_reg_low, 0x0000);
        b.run(2_clk);
        EXPECT_EQ(b.chip().level(chip::Pin::x_int), high ? chip::Level::low : chip::Level::high);
        b.write_word(control::int_req_reg_low, irq::baud_rate_detect);
        b.run(2_clk);
        EXPECT_EQ(b.chip().level(chip::Pin::x_int), high ? chip::Level::high : chip::Level::low);
    }
}

// proves: VPC3C 5.1.1-15..16, APC3 4.4.3-03, E012
TEST_P(Checks, manual_5_1_1_without_octet_7_the_watchdog_counts_by_WD_Base) {
    for (const bool milliseconds : {false, true}) {
        Recipe r = recipe();
        if (milliseconds) r.mode0 |= mode0::wd_base;
        Bench b{r, Stage::p1};
        b.run(milliseconds ? 8_ms : 88_ms);
        EXPECT_EQ(b.dp_state(), kWaitCfg);
        b.run(milliseconds ? 3_ms : 13_ms);
        EXPECT_EQ(b.dp_state(), kWaitPrm);
    }
}

// proves: VPC3C 5.1.1-19, VPC3C 5.1.1-22, VPC3C 6.2.2-02, VPC3C 6.2.2-11, VPC3C 6.2.2-19..20
TEST_P(ChecksVpc3, manual_5_1_1_octet_7_of_Set_Prm_overwrites_the_lowest_three_bits) {
    Bench b{recipe(), Stage::p0};
    for (const std::uint8_t bits : Octets{0x07, 0x00, 0x01, 0x02, 0x04}) {
        EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x3D, prm({bits}))), kSc);
        EXPECT_EQ(b.peek(control::mode_reg0_low), 0xC0 | bits);
        EXPECT_EQ(b.read(control::user_prm_data_okay), 0);
    }
}

// proves: VPC3C 6.2.2-02, VPC3C 6.2.2-19..20, APC3 A.2-13, APC3 A.2-15
TEST_P(Checks, manual_6_2_2_octet_7_of_Set_Prm_switches_stop_and_start_control) {
    for (const std::uint8_t bits : Octets{0x00, 0x01, 0x02, 0x03}) {
        Bench b{recipe(), Stage::p0};
        EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x3D, prm({bits}))), kSc);
        b.tell({hex(kFdlStatus), {}, {{2, 3}}});
        EXPECT_EQ(b.listen_text(), (bits & 1) != 0 ? kFdlStatusOk : kSilence);
        b.tell({hex(kFdlStatus), {{2, fdl::fault_stop}}, {}});
        EXPECT_EQ(b.listen_text(), (bits & 2) != 0 ? kFdlStatusOk : kSilence);
    }
}

// proves: APC3 A.2-14, APC3 A.2-16, E060
TEST_P(Checks, manual_A_2_before_any_Set_Prm_the_APC3_checks_stop_bits_but_no_gaps) {
    Bench b{recipe(), Stage::reset};
    b.write(org::r_ts_adr, 8);
    b.start();
    b.find_baud();
    b.tell({hex(kFdlStatus), {}, {{2, 3}}});
    EXPECT_EQ(b.listen_text(), regmap::kSpc3Class.has(traits().variant) ? kFdlStatusOk : kSilence);
    b.tell({hex(kFdlStatus), {{2, fdl::fault_stop}}, {}});
    EXPECT_EQ(b.listen_text(), kSilence);
}

// proves: APC3 4.1.1-07..08, E029
TEST_P(ChecksSpc3Class, manual_4_1_1_combi_operation_answers_later) {
    for (const bool combi : {false, true}) {
        Bench b{recipe(), Stage::reset};
        b.write_word(control::mode_reg0_low, static_cast<std::uint16_t>(mode0::dp_mode | (combi ? mode0::min_tsdr : 0)));
        b.write(org::r_ts_adr, 8);
        b.start();
        b.find_baud();
        EXPECT_EQ(b.ask(kFdlStatus), kFdlStatusOk);
        EXPECT_EQ(b.last_answer().start - b.request_end(), b.bits(combi ? 255 : 11));
    }
}

// proves: VPC3C 5.1.1-24..25, VPC3C 7.1-04
TEST_P(ChecksStepBC, manual_5_1_1_PrmCmd_is_refused_unless_supported) {
    for (const bool supported : {false, true}) {
        Recipe r = recipe();
        if (supported) r.mode0 |= mode0::prm_cmd_supported;
        Bench b{r, Stage::p0};
        EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x3D, prm({0x00, 0x00, 0x80}))), kSc);
        EXPECT_EQ(b.irr(), supported ? irq::new_prm_data : 0);
        EXPECT_EQ(b.dp_state(), supported ? kWaitCfg : kWaitPrm);
    }
}

// proves: VPC3C 4.3-41, VPC3C 5.1.1-29, APC3 3.3-27, APC3 4.1.1-06, APC3 4.1.1-22
TEST_P(Checks, manual_5_1_1_in_Spec_Prm_Buf_Mode_parameters_bypass_the_Aux_buffer) {
    Recipe r = recipe();
    r.mode0 |= mode0::spec_prm_buf_mode;
    r.aux1 = 4;
    for (const std::uint8_t length : {std::uint8_t{12}, std::uint8_t{11}}) {
        Bench b{r, Stage::configured};
        b.write(org::r_len_spec_prm_buf, length);
        b.start();
        b.find_baud();
        b.acknowledge();
        const std::uint8_t prm_buffer = b.peek(org::r_prm_buf_ptr), aux = b.peek(org::r_aux_buf_ptr1);
        const Octets data = prm({0x00, 0x00, 0x00, 0x21, 0x22});
        EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x3D, data)), length >= data.size() ? kSc : kRr);
        EXPECT_EQ(b.peek(org::r_prm_buf_ptr), prm_buffer);
        EXPECT_EQ(b.peek(org::r_aux_buf_ptr1), aux);
        EXPECT_EQ(b.irr(), length >= data.size() ? irq::new_prm_data : 0);
        if (length >= data.size()) {
            EXPECT_EQ(b.ram(b.buffer(org::r_prm_buf_ptr), data.size()), data);
        }
    }
}

Ticks user_timer_period(Bench& b) {
    Ticks seen[3]{};
    for (Ticks& moment : seen) {
        b.acknowledge();
        const Ticks limit = b.now() + 50_ms;
        while ((b.peek(control::int_req_reg_low) & irq::user_timer_clock) == 0 && b.now() < limit) b.run(1_us);
        moment = b.now();
    }
    return seen[2] - seen[1];
}

// proves: VPC3C 5.1.1-32..33, VPC3C 5.3.1-05
TEST_P(ChecksVpc3, manual_5_1_1_User_Timer_Clock_comes_every_millisecond_or_every_ten) {
    for (const bool ten : {false, true}) {
        Recipe r = recipe();
        if (ten) r.mode0 |= mode0::user_time_base;
        Bench b{r, Stage::p0};
        const Ticks period = user_timer_period(b);
        EXPECT_GE(period, (ten ? 10_ms : 1_ms) - 2_us);
        EXPECT_LE(period, (ten ? 10_ms : 1_ms) + 2_us);
    }
}

// proves: VPC3C 5.1.1-36..37, APC3 4.1.1-16..17, E033
TEST_P(Checks, manual_5_1_1_without_DP_Mode_only_the_bus_itself_is_answered) {
    for (const bool dp : {false, true}) {
        Recipe r = recipe();
        r.mode0 = dp ? mode0::dp_mode : std::uint16_t{0};
        Bench b{r, Stage::p0};
        EXPECT_EQ(b.ask(kFdlStatus), kFdlStatusOk);
        EXPECT_EQ(b.diag(), dp ? kDiagWaitPrm : kRs);
        EXPECT_EQ(b.ask(kPrm), dp ? kSc : kRs);
        EXPECT_EQ(b.ask(kCfg), dp ? kSc : kRs);
        EXPECT_EQ(b.ask("68 05 05 68 88 82 5D 3B 3E E0 16"), dp ? "68 07 07 68 82 88 08 3E 3B 11 21 BD 16" : kRs);
    }
}

// proves: VPC3C 5.1.2-01..03, VPC3C 5.1.2-05, E078
TEST_P(ChecksVpc3, manual_5_1_2_bits_of_Mode_Register_1_are_set_at_08H_and_reset_at_09H) {
    Bench b{recipe(), Stage::p0};
    b.write(control::mode_reg1_s, mode1::en_change_cfg_buffer);
    b.write(control::mode_reg1_s, mode1::res_user_wd);
    b.write(control::mode_reg1_s, 0x00);
    EXPECT_EQ(b.read(control::mode_reg1), mode1::start_vpc3 | mode1::en_change_cfg_buffer | mode1::res_user_wd);
    b.write(control::mode_reg1_s, 0xC0);
    EXPECT_EQ(b.read(control::mode_reg1) & 0x3F, mode1::start_vpc3 | mode1::en_change_cfg_buffer | mode1::res_user_wd);
    b.write(control::mode_reg1_r, 0x00);
    b.write(control::mode_reg1_r, mode1::res_user_wd);
    EXPECT_EQ(b.read(control::mode_reg1) & 0x3F, mode1::start_vpc3 | mode1::en_change_cfg_buffer);
    b.write(control::mode_reg1_r, mode1::en_change_cfg_buffer);
    EXPECT_EQ(b.read(control::mode_reg1) & 0x3F, mode1::start_vpc3);
}

// proves: VPC3C 5.1.2-02..03, VPC3C 5.1.2-08, APC3 4.1-01, APC3 4.1.2-01..02, APC3 4.1.2-07, E078
TEST_P(Checks, manual_5_1_2_with_En_Change_Cfg_Buffer_reset_again_Cfg_and_Read_Cfg_stay_in_place) {
    Bench b{recipe(), Stage::p1};
    b.write(control::mode_reg1_s, mode1::en_change_cfg_buffer);
    b.write(control::mode_reg1_r, mode1::en_change_cfg_buffer);
    EXPECT_EQ(b.ask(kCfg), kSc);
    const std::uint8_t cfg = b.peek(org::r_cfg_buf_ptr), read_cfg = b.peek(org::r_read_cfg_buf_ptr);
    EXPECT_EQ(b.read(control::user_cfg_data_okay), 0);
    EXPECT_EQ(b.peek(org::r_cfg_buf_ptr), cfg);
    EXPECT_EQ(b.peek(org::r_read_cfg_buf_ptr), read_cfg);
    EXPECT_EQ(b.read(control::mode_reg1), traits().mode_regs_readable ? mode1::start_vpc3 : 0x00);
}

// proves: VPC3C 5.1.2-10..11, VPC3C 5.2-06, VPC3C 5.3.1-09, VPC3C 6.2.5-09, VPC3C 6.2.5-11, APC3 4.1.2-06, APC3 4.2-09, APC3 4.3-29,
//   APC3 5.2.5.1-06, APC3 5.2.5.1-08, E023, E053
TEST_P(Checks, manual_5_1_2_User_LEAVE_MASTER_goes_to_WAIT_PRM_with_cleared_outputs) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    b.take_outputs();
    b.acknowledge();
    b.write(control::mode_reg1_s, mode1::user_leave_master);
    b.run(2_clk);
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.irr(), irq::go_leave_data_exch | irq::dx_out);
    EXPECT_EQ(b.peek(control::mode_reg1) & mode1::user_leave_master, 0);
    const Outputs out = b.take_outputs();
    EXPECT_EQ(out.command & 0x0C, 0x0C);
    EXPECT_EQ(text(out.octets), "00 00");
    EXPECT_EQ(b.diag(), kDiagWaitPrm);
}

// proves: VPC3C 5.1.2-12..13, VPC3C 5.3.1-10, APC3 4.1.2-05, APC3 4.3-16
TEST_P(Checks, manual_5_1_2_Go_Offline_waits_for_the_running_request) {
    Bench b{recipe(), Stage::p0};
    b.tell(kFdlStatus);
    b.write(control::mode_reg1_s, mode1::go_offline);
    EXPECT_EQ(b.listen_text(), kFdlStatusOk);
    b.run(48_clk);
    EXPECT_EQ(b.peek(control::status_reg_low) & 0x01, 0);
    EXPECT_EQ(b.peek(control::mode_reg1) & mode1::go_offline, 0);
    EXPECT_EQ(b.irr() & irq::mac_reset, irq::mac_reset);
    EXPECT_EQ(b.ask(kFdlStatus), kSilence);
}

// proves: VPC3C 5.1.2-15..16, VPC3C 5.1.2-18, VPC3C 5.2-15, APC3 4.1.2-03..04, APC3 4.2-03
TEST_P(Checks, manual_5_1_2_Start_leads_to_Passive_Idle_and_clears_Go_Offline) {
    Bench b{recipe(), Stage::configured};
    b.write(control::mode_reg1_s, mode1::go_offline);
    b.start();
    b.write(control::mode_reg1_s, mode1::eoi);
    b.run(2_ms);
    EXPECT_EQ(b.peek(control::status_reg_low) & 0x01, 0x01);
    EXPECT_EQ(b.peek(control::mode_reg1), traits().mode_regs_readable ? mode1::start_vpc3 : 0x00);
}

// proves: VPC3C 5.1.3-01, VPC3C 5.1.4-01
TEST_P(ChecksStepBC, manual_5_1_3_Mode_Registers_2_and_3_take_writes_in_Offline_only) {
    Bench b{recipe(), Stage::p2};
    b.write(control::mode_reg2, 0x00);
    b.write(control::mode_reg3, mode3::dx_int_mode_2);
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(b.ask(kSync), kSilence);
        EXPECT_EQ(b.irr() & irq::new_gc_command, irq::new_gc_command) << "GC_Int_Mode is still 1";
        b.acknowledge();
    }
    EXPECT_EQ(b.ask("68 07 07 68 FF 82 46 3A 3E 10 00 4F 16"), kSilence);
    b.acknowledge();
    b.take_outputs();
    EXPECT_EQ(b.ask("68 05 05 68 08 02 7D 00 00 87 16"), kInputs);
    EXPECT_EQ(b.irr(), irq::dx_out) << "DX_Int_Mode_2 is still 0";
}

// proves: VPC3C 5.1.3-10..11, VPC3C 5.1.4-04, E028
TEST_P(ChecksVpc3, manual_5_1_3_DX_Int_Mode_decides_about_exchanges_without_outputs) {
    for (const bool always : {false, true}) {
        Recipe r = recipe();
        r.dout = 0;
        r.mode2 = static_cast<std::uint8_t>(mode2::gc_int_mode | (always ? mode2::dx_int_mode : 0));
        Bench b{r, Stage::p2};
        EXPECT_EQ(b.ask(kEmptyDx), kInputs);
        EXPECT_EQ(b.irr(), always ? irq::dx_out : 0);
    }
}

// proves: VPC3C 5.1.4-02..05, E028
TEST_P(ChecksStepBC, manual_5_1_4_DX_Int_Mode_2_raises_DX_Out_for_changed_outputs_only) {
    for (const std::uint8_t mode : Octets{0x00, 0xFC, 0x02}) {
        Recipe r = recipe();
        if (mode != 0) r.mode3 = mode;
        Bench b{r, Stage::p2};
        EXPECT_EQ(b.ask(kDx1234), kInputs);
        EXPECT_EQ(b.irr(), irq::dx_out);
        b.take_outputs();
        b.acknowledge();
        EXPECT_EQ(b.ask(kDx1234), kInputs);
        EXPECT_EQ(b.irr(), mode == mode3::dx_int_mode_2 ? 0 : irq::dx_out);
        b.acknowledge();
        EXPECT_EQ(b.ask(kDx5678), kInputs);
        EXPECT_EQ(b.irr(), irq::dx_out);
    }
}

// proves: VPC3C 5.1.4-06, E027
TEST_P(ChecksStepBC, manual_5_1_4_GC_Int_Mode_Ext_changes_nothing_while_every_command_is_indicated) {
    Recipe r = recipe();
    r.mode2 = mode2::gc_int_mode;
    r.mode3 = mode3::gc_int_mode_ext;
    Bench b{r, Stage::p2};
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(b.ask(kSync), kSilence);
        EXPECT_EQ(b.irr(), irq::new_gc_command);
        b.acknowledge();
    }
    EXPECT_EQ(b.ask(kSyncGroup1), kSilence);
    EXPECT_EQ(b.irr(), 0) << "not a member of group 1";
}

/// No code of the Status Register that the manuals call impossible.
void expect_possible(const Bench& b) {
    const unsigned status = b.peek_word(control::status_reg_low);
    EXPECT_NE(status >> 6 & 3u, 3u);
    EXPECT_NE(status >> 4 & 3u, 3u);
    EXPECT_EQ(status & 0x0Au, 0u);
    const unsigned baud = status >> 8 & 15u;
    EXPECT_TRUE(baud <= 9 || baud == 15) << baud;
    EXPECT_EQ(status >> 12, b.traits().release);
}

// proves: VPC3C 2.1-11, VPC3C 5.2-01, VPC3C 5.2-05..10, VPC3C 5.2-13, VPC3C 5.2-15, VPC3C 5.2-20, VPC3C 5.2-32, APC3 1-07,
//   APC3 4.2-01, APC3 4.2-03..04, APC3 4.2-09..12, APC3 4.2-16, APC3 4.2-27..28
TEST_P(Checks, manual_5_2_the_Status_Register_shows_only_codes_of_its_table_and_cannot_be_written) {
    Bench b{recipe(), Stage::searching};
    expect_possible(b);
    b.find_baud();
    expect_possible(b);
    EXPECT_EQ(b.peek(control::status_reg_low), 0x41);
    b.ask(kPrm);
    expect_possible(b);
    EXPECT_EQ(b.peek(control::status_reg_low), 0x91);
    b.ask(kCfg);
    b.read(control::user_cfg_data_okay);
    b.give_inputs("AB CD");
    expect_possible(b);
    EXPECT_EQ(b.peek(control::status_reg_low), 0xA1);
    for (const std::uint16_t value : {std::uint16_t{0x0000}, std::uint16_t{0xFFFF}}) {
        b.write_word(control::int_mask_reg_low, value);
        EXPECT_EQ(b.peek(control::status_reg_low), 0xA1);
    }
    for (int i = 0; i < 20; ++i) {
        b.run(300_ms);
        expect_possible(b);
    }
    b.go_offline();
    expect_possible(b);
}

// proves: VPC3C 5.2-16..18
TEST_P(Checks, manual_5_2_the_release_tells_the_steps_apart) {
    Bench b{recipe(), Stage::reset};
    const unsigned release = b.peek(control::status_reg_high) >> 4;
    if (traits().variant == Variant::vpc3c) EXPECT_EQ(release, 0b1100u);
    else if (traits().variant == Variant::vpc3b) EXPECT_EQ(release, 0b1011u);
    else EXPECT_EQ(release, 0u);
}

}  // namespace
}  // namespace dpchip::checks
