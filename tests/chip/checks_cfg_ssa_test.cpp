// SPDX-License-Identifier: Apache-2.0
// Conformance checks of Chk_Cfg, Set_Ext_Prm, Get_Cfg and Set_Slave_Add: C052 to C070 (reference 8.6).
#include "checks.hpp"

namespace dpchip::checks {
namespace {

constexpr std::string_view kCfgInDataExch = "68 07 07 68 88 82 5D 3E 3E 11 21 15 16";
constexpr std::string_view kExtPrm = "68 0A 0A 68 88 82 7D 35 3E 05 81 00 00 AA 2A 16";
constexpr std::string_view kSsa9 = "68 09 09 68 88 82 5D 37 3E 09 47 11 00 3D 16";

Recipe with_ssa(Recipe r) {
    r.ssa = true;
    return r;
}

// proves: APC3 5.2.3-01
TEST_P(Checks, C052_Chk_Cfg_before_Set_Prm_is_acknowledged_and_ignored) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("68 07 07 68 88 82 7D 3E 3E 11 21 35 16"), "E5");
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.dp_state(), kWaitPrm);
}

// proves: VPC3C 4.2-19, VPC3C 4.3-29..30, VPC3C 5.2-08, VPC3C 5.3.1-08, VPC3C 5.3.1-17, VPC3C 6.2.3-02..06,
//   VPC3C 6.2.3-09..10, VPC3C 6.2.3-15, APC3 3.2-14, APC3 3.3-19..20, APC3 4.2-11, APC3 4.3-18, APC3 4.3-24,
//   APC3 5.2.3-02..06, APC3 5.2.3-10, APC3 5.2.3-14, APC3 A.4-03, E024
TEST_P(Checks, C053_an_acknowledged_Chk_Cfg_leads_to_DATA_EXCH) {
    Bench b{recipe(), Stage::p1};
    b.give_inputs("AB CD");  // APC3 and SPC3 wait for it
    EXPECT_EQ(b.ask("68 07 07 68 88 82 7D 3E 3E 11 21 35 16"), "E5");
    EXPECT_EQ(b.irr(), irq::new_cfg_data);
    EXPECT_EQ(b.peek(org::r_len_cfg_data), 0x02);
    EXPECT_EQ(text(b.ram(b.buffer(org::r_cfg_buf_ptr), 2)), "11 21");
    EXPECT_EQ(b.chip().level(chip::Pin::xdataexch_sync), chip::Level::high);
    EXPECT_EQ(b.read(control::user_cfg_data_okay), 0x00);
    b.run(2_clk);
    EXPECT_EQ(b.dp_state(), kDataExch);
    EXPECT_EQ(b.irr(), irq::go_leave_data_exch);
    EXPECT_EQ(b.chip().level(chip::Pin::xdataexch_sync), chip::Level::low);
    EXPECT_EQ(b.peek(control::status_reg_low), 0xA1);
}

// proves: VPC3C 4.2-20, VPC3C 6.2.3-06, VPC3C 6.2.3-08, VPC3C 6.2.3-18, APC3 3.2-15, APC3 5.2.3-07, APC3 5.2.3-14,
//   APC3 A.4-04, E073
TEST_P(Checks, C054_a_refused_Chk_Cfg_is_a_configuration_fault) {
    Bench b{recipe(), Stage::p1};
    EXPECT_EQ(b.ask("68 07 07 68 88 82 7D 3E 3E 11 21 35 16"), "E5");
    EXPECT_EQ(b.read(control::user_cfg_data_not_okay), 0x00);
    b.run(2_clk);
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 06 05 00 FF 47 11 EE 16");
}

TEST_P(Checks, C055_Chk_Cfg_of_a_foreign_master_is_acknowledged_and_ignored) {
    Bench b{recipe(), Stage::p1};
    EXPECT_EQ(b.ask("68 07 07 68 88 83 6D 3E 3E 11 21 26 16"), "E5");
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.dp_state(), kWaitCfg);
}

// proves: VPC3C 6.2.3-14, VPC3C 6.2.5-33, VPC3C 6.2.3-09, E072
TEST_P(Checks, C056_DATA_EXCH_waits_for_the_parameters_to_be_acknowledged) {
    Bench b{recipe(), Stage::p0};
    b.give_inputs("AB CD");
    EXPECT_EQ(b.ask("68 0F 0F 68 88 82 5D 3D 3E 88 02 05 0B 47 11 01 80 00 00 55 16"), "E5");
    EXPECT_EQ(b.ask("68 07 07 68 88 82 7D 3E 3E 11 21 35 16"), "E5");
    EXPECT_EQ(b.irr(), irq::new_prm_data | irq::new_cfg_data);
    EXPECT_EQ(b.read(control::user_cfg_data_okay), 0x00);
    b.run(2_clk);
    EXPECT_EQ(b.dp_state(), kWaitCfg);
    EXPECT_EQ(b.read(control::user_prm_data_okay), 0x00);
    b.run(2_clk);
    EXPECT_EQ(b.dp_state(), kDataExch);
    EXPECT_EQ(b.irr(), irq::go_leave_data_exch);
}

// proves: VPC3C 4.3-31..32, VPC3C 5.1.2-09, VPC3C 6.1-23, VPC3C 6.2.9-01..02, APC3 3.3-21..22, APC3 4.1.2-08,
//   APC3 5.1-25, APC3 5.2.3-12, APC3 5.2.9-01..02, E022, E056
TEST_P(Checks, C057_En_Change_Cfg_Buffer_exchanges_Cfg_and_Read_Cfg) {
    Bench b{recipe(), Stage::p1};
    b.write(control::mode_reg1_s, regmap::mode1::en_change_cfg_buffer);
    EXPECT_EQ(b.ask("68 07 07 68 88 82 7D 3E 3E 11 21 35 16"), "E5");
    const std::uint8_t cfg = b.peek(org::r_cfg_buf_ptr), read_cfg = b.peek(org::r_read_cfg_buf_ptr);
    b.write(org::r_len_read_cfg_data, b.peek(org::r_len_cfg_data));
    EXPECT_EQ(b.read(control::user_cfg_data_okay), 0x00);
    EXPECT_EQ(b.peek(org::r_cfg_buf_ptr), read_cfg);
    EXPECT_EQ(b.peek(org::r_read_cfg_buf_ptr), cfg);
    EXPECT_EQ(b.ask("68 05 05 68 88 82 5D 3B 3E E0 16"), "68 07 07 68 82 88 08 3E 3B 11 21 BD 16");
}

// proves: VPC3C 6.2.3-05, APC3 5.2.3-05
TEST_P(Checks, C058_a_Chk_Cfg_in_format_SD3_is_accepted) {
    Bench b{recipe(), Stage::p1};
    EXPECT_EQ(b.ask("A2 88 82 7D 3E 3E 10 10 20 20 11 21 95 16"), "E5");
    EXPECT_EQ(b.irr(), irq::new_cfg_data);
    EXPECT_EQ(b.peek(org::r_len_cfg_data), 0x06);
    EXPECT_EQ(text(b.ram(b.buffer(org::r_cfg_buf_ptr), 6)), "10 10 20 20 11 21");
}

TEST_P(Checks, C059_a_Chk_Cfg_refused_in_DATA_EXCH_ends_it) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask(kCfgInDataExch), "E5");
    EXPECT_EQ(b.irr(), irq::new_cfg_data);
    EXPECT_EQ(b.read(control::user_cfg_data_not_okay), 0x00);
    b.run(2_clk);
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.irr(), irq::go_leave_data_exch | irq::dx_out);
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 06 05 00 FF 47 11 EE 16");
}

// proves: APC3 5.2.3-09, APC3 5.2.5.2-04, E024, E025, E066
TEST_P(ChecksSpc3Class, C060_DATA_EXCH_waits_for_the_first_inputs) {
    Bench b{recipe(), Stage::p1};
    EXPECT_EQ(b.ask("68 07 07 68 88 82 7D 3E 3E 11 21 35 16"), "E5");
    EXPECT_EQ(b.read(control::user_cfg_data_okay), 0x00);
    b.run(2_clk);
    EXPECT_EQ(b.dp_state(), kWaitCfg);
    EXPECT_EQ(b.irr(), 0);
    b.read(control::new_din_buffer_cmd);
    b.run(2_clk);
    EXPECT_EQ(b.dp_state(), kDataExch);
    EXPECT_EQ(b.irr(), irq::go_leave_data_exch);
}

// proves: VPC3C 6.1-08, VPC3C 6.1-35, VPC3C 6.2.9-01, APC3 5.1-08, APC3 5.1-25, APC3 5.2.9-01
TEST_P(Checks, C061_Get_Cfg_is_answered_in_every_state) {
    for (const Stage stage : {Stage::p0, Stage::p1, Stage::p2}) {
        Bench b{recipe(), stage};
        EXPECT_EQ(b.ask("68 05 05 68 88 82 5D 3B 3E E0 16"), "68 07 07 68 82 88 08 3E 3B 11 21 BD 16");
        EXPECT_EQ(b.irr(), 0);
    }
}

// proves: VPC3C 5.1.1-31, VPC3C 5.3.1-03, VPC3C 6.1-03, VPC3C 7.1-06, VPC3C 7.1-08
TEST_P(ChecksStepBC, C062_Set_Ext_Prm_in_WAIT_CFG_is_indicated) {
    Recipe r = recipe();
    r.mode0 |= regmap::mode0::set_ext_prm_supported;
    Bench b{r, Stage::p1};
    EXPECT_EQ(b.ask(kExtPrm), "E5");
    EXPECT_EQ(b.irr(), irq::new_ext_prm_data);
    EXPECT_EQ(b.peek(org::r_len_prm_data), 5);
    EXPECT_EQ(text(b.ram(b.buffer(org::r_prm_buf_ptr), 5)), "05 81 00 00 AA");
    EXPECT_EQ(b.read(control::user_prm_data_okay), 0x00);
    EXPECT_EQ(b.irr(), 0);
}

// proves: VPC3C 6.1-03, VPC3C 7.1-06, E015
TEST_P(ChecksStepBC, C063_Set_Ext_Prm_outside_WAIT_CFG_is_answered_RS) {
    Recipe r = recipe();
    r.mode0 |= regmap::mode0::set_ext_prm_supported;
    for (const Stage stage : {Stage::p0, Stage::p2}) {
        Bench b{r, stage};
        EXPECT_EQ(b.ask(kExtPrm), "10 02 08 03 0D 16");
        EXPECT_EQ(b.irr(), 0);
    }
}

// proves: VPC3C 5.1.1-30, APC3 5.1-03
TEST_P(Checks, C063_Set_Ext_Prm_is_answered_RS_while_SAP_53_is_off) {
    for (const Stage stage : {Stage::p0, Stage::p1, Stage::p2}) {
        Bench b{recipe(), stage};
        EXPECT_EQ(b.ask(kExtPrm), "10 02 08 03 0D 16");
        EXPECT_EQ(b.irr(), 0);
    }
}

// proves: VPC3C 6.1-14, VPC3C 6.2.1-01, APC3 5.1-13, APC3 5.2.1-03
TEST_P(Checks, C064_Set_Slave_Add_without_SSA_buffer_is_answered_RS) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("68 09 09 68 88 82 5D 37 3E 09 47 11 00 3D 16"), "10 02 08 03 0D 16");
}

// proves: VPC3C 4.3-25..26, VPC3C 4.3-37, VPC3C 5.3.1-18, VPC3C 6.1-04, VPC3C 6.2.1-06..08, VPC3C 6.2.1-14,
//   APC3 4.3-23, APC3 5.1-04, APC3 5.2.1-01, APC3 5.2.1-08..10, APC3 A.1-01
TEST_P(Checks, C065_Set_Slave_Add_moves_the_slave_to_the_new_address) {
    Bench b{with_ssa(recipe()), Stage::p0};
    EXPECT_EQ(b.ask("68 09 09 68 88 82 5D 37 3E 09 47 11 00 3D 16"), "E5");
    EXPECT_EQ(b.irr(), irq::new_ssa_data);
    EXPECT_EQ(b.peek(org::r_len_ssa_data), 0x04);
    EXPECT_EQ(b.peek(org::r_ts_adr), 0x09);
    EXPECT_EQ(b.peek(org::r_real_no_add_change), 0x00);
    EXPECT_EQ(text(b.ram(b.buffer(org::r_ssa_buf_ptr), 4)), "09 47 11 00");
    EXPECT_EQ(b.ask("10 09 02 49 54 16"), "10 02 09 00 0B 16");
    EXPECT_EQ(b.ask("10 08 02 49 53 16"), kSilence);
}

// proves: VPC3C 6.2.1-12, VPC3C 6.2.1-15, APC3 5.2.1-12, APC3 A.1-01
TEST_P(Checks, C066_Set_Slave_Add_with_a_wrong_ident_is_ignored) {
    Bench b{with_ssa(recipe()), Stage::p0};
    EXPECT_EQ(b.ask("68 09 09 68 88 82 5D 37 3E 09 47 12 00 3E 16"), "E5");
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.peek(org::r_ts_adr), 0x08);
    EXPECT_EQ(b.ask(kFdlStatus), kFdlStatusOk);
}

// proves: VPC3C 4.3-37, VPC3C 6.2.1-09, VPC3C 6.2.1-16, APC3 3.3-24, APC3 5.2.1-05, APC3 A.1-02, E059
TEST_P(Checks, C067_No_Add_Chg_locks_the_address) {
    Bench b{with_ssa(recipe()), Stage::p0};
    EXPECT_EQ(b.ask("68 09 09 68 88 82 5D 37 3E 09 47 11 FF 3C 16"), "E5");
    EXPECT_EQ(b.peek(org::r_real_no_add_change), 0xFF);
    EXPECT_EQ(b.read(control::ssa_buffer_free_cmd), 0x00);
    b.acknowledge();
    EXPECT_EQ(b.ask(b.request(2, 0x7D, 0x37, {0x0A, 0x47, 0x11, 0x00})), "E5");
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.peek(org::r_ts_adr), 0x09);
    EXPECT_EQ(b.ask("10 09 02 49 54 16"), "10 02 09 00 0B 16");
}

// proves: VPC3C 6.2.1-11
TEST_P(Checks, C068_a_second_Set_Slave_Add_before_the_buffer_is_free_is_answered_RR) {
    Bench b{with_ssa(recipe()), Stage::p0};
    EXPECT_EQ(b.ask("68 09 09 68 88 82 5D 37 3E 09 47 11 00 3D 16"), "E5");
    EXPECT_EQ(b.ask(b.request(2, 0x7D, 0x37, {0x0A, 0x47, 0x11, 0x00})), "10 02 09 02 0D 16");
    EXPECT_EQ(b.peek(org::r_ts_adr), 0x09);
    EXPECT_EQ(b.read(control::ssa_buffer_free_cmd), 0x00);
    EXPECT_EQ(b.ask(b.request(2, 0x7D, 0x37, {0x0A, 0x47, 0x11, 0x00})), "E5");
    EXPECT_EQ(b.peek(org::r_ts_adr), 0x0A);
}

// proves: APC3 5.2.1-02
TEST_P(Checks, C069_Set_Slave_Add_in_DATA_EXCH_is_ignored) {
    Bench b{with_ssa(recipe()), Stage::p2};
    EXPECT_EQ(b.ask(kSsa9), "E5");
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.peek(org::r_ts_adr), 0x08);
    EXPECT_EQ(b.dp_state(), kDataExch);
    EXPECT_EQ(b.ask(kFdlStatus), kFdlStatusOk);
}

TEST_P(Checks, C070_the_default_address_126_is_changed_by_Set_Slave_Add) {
    Recipe r = with_ssa(recipe());
    r.ts = 126;
    Bench b{r, Stage::p0};
    EXPECT_EQ(b.ask("68 09 09 68 FE 82 6D 37 3E 08 47 11 00 C2 16"), "E5");
    EXPECT_EQ(b.peek(org::r_ts_adr), 0x08);
    EXPECT_EQ(b.ask(kFdlStatus), kFdlStatusOk);
}

// proves: E082
TEST_P(ChecksStepBC, Set_Ext_Prm_is_answered_RS_from_the_first_Chk_Cfg_on_whoever_sends_it) {
    Recipe r = recipe();
    r.mode0 |= 0x0800;  // Set_Ext_Prm_Supported
    Bench b{r, Stage::p1};
    EXPECT_EQ(b.ask("68 0A 0A 68 88 83 6D 35 3E 05 81 00 00 AA 1B 16"), kSc) << "another master, ignored";
    EXPECT_EQ(b.ask(kCfg), kSc);
    EXPECT_EQ(b.ask("68 0A 0A 68 88 83 5D 35 3E 05 81 00 00 AA 0B 16"), "10 03 08 03 0E 16");
    EXPECT_EQ(b.ask("68 0A 0A 68 88 82 7D 35 3E 05 81 00 00 AA 2A 16"), kRs);
}

}  // namespace
}  // namespace dpchip::checks
