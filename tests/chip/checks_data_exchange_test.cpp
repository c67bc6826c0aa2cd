// SPDX-License-Identifier: Apache-2.0
// Conformance checks of Data_Exchange and the diagnosis flag: C071 to C086 (reference 8.7).
#include "checks.hpp"

namespace dpchip::checks {
namespace {

constexpr std::string_view kDiag5D = "68 05 05 68 88 82 5D 3C 3E E1 16";

// proves: VPC3C 6.1-02, VPC3C 6.1-13, APC3 5.1-12
TEST_P(Checks, C071_Data_Exchange_outside_DATA_EXCH_is_answered_RS) {
    for (const Stage stage : {Stage::p0, Stage::p1}) {
        Bench b{recipe(), stage};
        EXPECT_EQ(b.ask("68 05 05 68 08 02 7D 12 34 CD 16"), "10 02 08 03 0D 16");
        EXPECT_EQ(b.irr(), 0);
    }
}

// proves: VPC3C 4.2-14, VPC3C 5.3.1-14, VPC3C 6.1-02, VPC3C 6.2.5-01..04, VPC3C 6.2.5-21, VPC3C 6.2.5-24,
//   VPC3C 6.2.5-27, APC3 3.2-09, APC3 4.3-27, APC3 5.1-02, APC3 5.2.5.1-01..03, APC3 5.2.5.1-14..15,
//   APC3 5.2.5.2-01, E054
TEST_P(Checks, C072_Data_Exchange_brings_outputs_and_fetches_inputs) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask("68 05 05 68 08 02 7D 12 34 CD 16"), "68 05 05 68 02 08 08 AB CD 8A 16");
    EXPECT_EQ(b.irr(), irq::dx_out);
    const Outputs out = b.take_outputs();
    EXPECT_EQ(out.command & 0x0C, 0x04) << "State_U_Buffer set, U_Buffer_Cleared not";
    EXPECT_EQ(text(out.octets), "12 34");
}

TEST_P(Checks, C073_a_foreign_master_has_no_access_to_the_default_SAP) {
    Bench b{recipe(), Stage::p2};
    b.take_outputs();
    const std::uint8_t dout_sm = b.peek(control::dout_buffer_sm);
    EXPECT_EQ(b.ask("68 05 05 68 08 03 7D 12 34 CE 16"), "10 03 08 03 0E 16");
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.peek(control::dout_buffer_sm), dout_sm);
    const Outputs out = b.take_outputs();
    EXPECT_EQ(out.command & 0x04, 0);
    EXPECT_EQ(text(out.octets), "00 00");
}

TEST_P(Checks, C074_without_inputs_the_answer_is_a_short_acknowledgement) {
    Recipe r = recipe();
    r.din = 0;
    Bench b{r, Stage::p2};
    EXPECT_EQ(b.ask("68 05 05 68 08 02 7D 12 34 CD 16"), "E5");
    EXPECT_EQ(b.irr(), irq::dx_out);
}

// proves: VPC3C 5.2-11..12, VPC3C 6.2.4-05..07, VPC3C 6.2.4-09, APC3 4.2-05..06, APC3 5.2.4-02, APC3 5.2.4.1-04..05,
//   APC3 5.2.4.1-07
TEST_P(Checks, C075_the_diagnosis_flag_makes_answers_high_priority_until_the_diagnosis_is_read) {
    Bench b{recipe(), Stage::p2};
    b.give_diag(0x00);
    EXPECT_EQ(b.ask("68 05 05 68 08 02 7D 12 34 CD 16"), "68 05 05 68 02 08 0A AB CD 8C 16");
    EXPECT_TRUE(b.diag_flag());
    EXPECT_EQ(b.ask("68 05 05 68 88 82 5D 3C 3E E1 16"), kDiagDataExch);
    EXPECT_FALSE(b.diag_flag());
    EXPECT_EQ(b.ask("68 05 05 68 08 02 7D 12 34 CD 16"), "68 05 05 68 02 08 08 AB CD 8A 16");
}

TEST_P(Checks, C076_the_diagnosis_flag_without_inputs_sends_one_dummy_octet) {
    Recipe r = recipe();
    r.din = 0;
    Bench b{r, Stage::p2};
    b.give_diag(0x00);
    EXPECT_EQ(b.ask("68 05 05 68 08 02 7D 12 34 CD 16"), "68 04 04 68 02 08 0A 00 14 16");
}

// proves: VPC3C 5.3.1-15, VPC3C 6.2.4-03..04, VPC3C 6.2.4-20, VPC3C 6.2.4-22, APC3 4.3-26, APC3 5.2.4-01,
//   APC3 5.2.4.1-02..03, APC3 5.2.4.1-08, APC3 5.2.4.2-01..04, APC3 A.4-05, APC3 A.4-22, E069
TEST_P(Checks, C077_external_diagnosis_follows_the_six_octets) {
    Bench b{recipe(), Stage::p2};
    b.give_diag(0x01, "03 AA 55");
    EXPECT_EQ(b.irr(), irq::diag_buffer_changed);
    EXPECT_EQ(b.ask(kDiag5D), "68 0E 0E 68 82 88 08 3E 3C 08 0C 00 02 47 11 03 AA 55 FC 16");
}

// proves: VPC3C 6.2.4-08, APC3 5.2.4.1-06, APC3 5.2.4.1-08, APC3 5.2.4.2-03, APC3 A.4-11, E048
TEST_P(Checks, C078_static_diagnosis_keeps_the_flag) {
    Bench b{recipe(), Stage::p2};
    b.give_diag(0x02);
    EXPECT_EQ(b.ask(kDiag5D), "68 0B 0B 68 82 88 08 3E 3C 00 0E 00 02 47 11 F4 16");
    EXPECT_TRUE(b.diag_flag());
}

// proves: VPC3C 6.2.4-20, APC3 5.2.4.1-08, APC3 5.2.4.2-03, APC3 A.4-19
TEST_P(Checks, C079_diagnosis_overflow_is_bit_7_of_octet_2) {
    Bench b{recipe(), Stage::p2};
    b.give_diag(0x04);
    EXPECT_EQ(b.ask(kDiag5D), "68 0B 0B 68 82 88 08 3E 3C 00 0C 80 02 47 11 72 16");
}

TEST_P(Checks, C080_a_foreign_master_reads_the_diagnosis_without_clearing_the_flag) {
    Bench b{recipe(), Stage::p2};
    b.give_diag(0x00);
    EXPECT_EQ(b.ask("68 05 05 68 88 83 6D 3C 3E F2 16"), "68 0B 0B 68 83 88 08 3E 3C 00 0C 00 02 47 11 F3 16");
    EXPECT_TRUE(b.diag_flag());
}

// proves: VPC3C 4.3-06, APC3 3.3-05, APC3 A.4-04
TEST_P(Checks, C081_too_few_outputs_are_answered_and_end_data_exchange) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask("68 04 04 68 08 02 7D 01 88 16"), "68 05 05 68 02 08 08 AB CD 8A 16");
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.irr(), irq::go_leave_data_exch | irq::dx_out);
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 06 05 00 FF 47 11 EE 16");
}

TEST_P(Checks, C082_too_many_outputs_are_answered_RR_and_end_data_exchange) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask("68 06 06 68 08 02 7D 01 02 03 8D 16"), "10 02 08 02 0C 16");
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.irr(), irq::go_leave_data_exch | irq::dx_out);
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 06 05 00 FF 47 11 EE 16");
}

// proves: VPC3C 5.1.1-26, APC3 4.1.1-23
TEST_P(Checks, C083_no_outputs_end_data_exchange_without_Spec_Clear_Mode) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask("10 08 02 7D 87 16"), "68 05 05 68 02 08 08 AB CD 8A 16");
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.diag(), kDiagCfgFault);
}

// proves: VPC3C 5.1.1-27, APC3 4.1.1-05, APC3 4.1.1-24
TEST_P(Checks, C084_no_outputs_clear_them_in_Spec_Clear_Mode) {
    Recipe r = recipe();
    r.mode0 |= regmap::mode0::spec_clear_mode;
    Bench b{r, Stage::p2};
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    EXPECT_EQ(text(b.take_outputs().octets), "12 34");
    b.acknowledge();
    EXPECT_EQ(b.ask("10 08 02 7D 87 16"), "68 05 05 68 02 08 08 AB CD 8A 16");
    EXPECT_EQ(b.dp_state(), kDataExch);
    EXPECT_EQ(b.irr(), irq::dx_out);
    const Outputs out = b.take_outputs();
    EXPECT_EQ(out.command & 0x0C, 0x0C);
    EXPECT_EQ(text(out.octets), "00 00");
}

// proves: VPC3C 6.2.5-43..44, VPC3C 6.2.5-42, APC3 5.2.5.3-01..02
TEST_P(Checks, C085_the_user_watchdog_ends_data_exchange_after_the_answer) {
    Recipe r = recipe();
    r.user_wd = 2;
    Bench b{r, Stage::p2};
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    EXPECT_EQ(b.dp_state(), kDataExch);
    b.acknowledge();
    EXPECT_EQ(b.ask(kDx5678), kInputs);
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.irr(), irq::go_leave_data_exch | irq::dx_out);
    EXPECT_EQ(b.ask(kDx1234), "10 02 08 03 0D 16");
}

// proves: VPC3C 5.1.2-12, VPC3C 5.2-14, VPC3C 5.3.1-10, VPC3C 5.3.1-09, VPC3C 6.2.9-03, APC3 4.1.2-05, APC3 4.2-02,
//   APC3 4.3-16, APC3 4.3-18, APC3 5.2.9-03, E004
TEST_P(Checks, C086_Go_Offline_ends_everything) {
    Bench b{recipe(), Stage::p2};
    b.go_offline();
    EXPECT_EQ(b.irr(), irq::mac_reset | irq::go_leave_data_exch | irq::dx_out);
    EXPECT_EQ(b.peek(control::status_reg_low) & 0x01, 0);
    EXPECT_EQ(b.ask("10 08 02 49 53 16"), kSilence);
    EXPECT_EQ(b.chip().level(chip::Pin::rts), chip::Level::low);
}

// proves: E079
TEST_P(Checks, a_repetition_on_a_SAP_that_is_not_enabled_any_more_is_answered_RS) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask("68 05 05 68 08 02 7D 12 34 CD 16"), kInputs);
    EXPECT_EQ(b.ask_again(), kInputs);
    b.write(control::mode_reg1_s, 0x08);  // User_LEAVE-MASTER
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.ask_again(), kRs);
}

// proves: E079
TEST_P(Checks, a_repeated_RD_Input_without_inputs_is_RS_too_once_DATA_EXCH_is_left) {
    Recipe r = recipe();
    r.din = 0;
    Bench b{r, Stage::p2};
    EXPECT_EQ(b.ask("68 05 05 68 88 82 5D 38 3E DD 16"), kSc);
    EXPECT_EQ(b.ask_again(), kSc);
    b.write(control::mode_reg1_s, 0x08);  // User_LEAVE-MASTER
    EXPECT_EQ(b.ask_again(), kRs);
}

}  // namespace
}  // namespace dpchip::checks
