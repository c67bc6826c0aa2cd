// SPDX-License-Identifier: Apache-2.0
// Conformance checks of Set_Prm: C028 to C051 (reference 8.5).
#include "checks.hpp"

namespace dpchip::checks {
namespace {

constexpr std::uint16_t kSpecClear = regmap::mode0::spec_clear_mode;

// proves: VPC3C 4.1-05, VPC3C 4.3-38..39, APC3 3.1-04, APC3 3.3-25, APC3 5.2.4-01, APC3 5.2.4.2-02, APC3 A.4-01,
//   APC3 A.4-03, APC3 A.4-10, APC3 A.4-12, APC3 A.4-16, APC3 A.4-18, APC3 A.4-20..21
TEST_P(Checks, C028_the_first_diagnosis_asks_for_parameters) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("68 05 05 68 88 82 6D 3C 3E F1 16"), "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 47 11 EA 16");
}

// proves: VPC3C 2.1-10, VPC3C 2.1-15, VPC3C 5.2-07, VPC3C 5.4-06, VPC3C 5.4.2-04, VPC3C 6.2.2-01, VPC3C 6.2.2-06,
//   VPC3C 6.2.2-25, APC3 4.2-10, APC3 4.4.2-04, APC3 5.2.2-01..02, APC3 A.2-01, APC3 A.2-05, APC3 A.4-13,
//   APC3 A.4-20, E018
TEST_P(Checks, C029_seven_octets_with_watchdog_lead_to_WAIT_CFG_without_interrupt) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("68 0C 0C 68 88 82 5D 3D 3E 88 02 05 0B 47 11 00 D4 16"), "E5");
    EXPECT_EQ(b.dp_state(), kWaitCfg);
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.wd_state(), kDpControl);
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 02 0C 00 02 47 11 F4 16");
}

// proves: VPC3C 5.4.2-05, VPC3C 6.2.2-06, APC3 4.4.2-05, APC3 A.2-05, APC3 A.4-13
TEST_P(Checks, C030_without_watchdog_the_state_is_BAUD_CONTROL) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("68 0C 0C 68 88 82 5D 3D 3E 80 01 01 0B 47 11 00 C7 16"), "E5");
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 02 04 00 02 47 11 EC 16");
    EXPECT_EQ(b.wd_state(), kBaudControl);
}

// proves: VPC3C 4.2-17, VPC3C 4.3-27..28, VPC3C 5.1.1-28, VPC3C 5.3.1-16, VPC3C 5.3.2-09, VPC3C 5.3.2-12,
//   VPC3C 6.2.2-01, VPC3C 6.2.2-03, VPC3C 6.2.2-13, VPC3C 6.2.2-22..24, VPC3C 6.2.2-26..29, VPC3C 6.2.2-31..32,
//   APC3 3.2-12, APC3 3.3-17..18, APC3 4.1.1-21, APC3 4.3-25, APC3 4.3-34, APC3 5.2.2-04..09, APC3 5.2.2-11,
//   APC3 A.2-11..12, E018, E049, E050
TEST_P(Checks, C031_ten_octets_are_indicated_and_only_the_acknowledgement_clears_the_interrupt) {
    Bench b{recipe(), Stage::p0};
    const std::uint8_t prm = b.peek(org::r_prm_buf_ptr), aux = b.peek(org::r_aux_buf_ptr1);
    EXPECT_EQ(b.ask("68 0F 0F 68 88 82 5D 3D 3E 88 02 05 0B 47 11 01 80 00 00 55 16"), "E5");
    EXPECT_EQ(b.irr(), irq::new_prm_data);
    EXPECT_EQ(b.peek(org::r_len_prm_data), 0x0A);
    EXPECT_EQ(b.peek(org::r_prm_buf_ptr), aux);
    EXPECT_EQ(b.peek(org::r_aux_buf_ptr1), prm);
    EXPECT_EQ(text(b.ram(b.buffer(org::r_prm_buf_ptr), 10)), "88 02 05 0B 47 11 01 80 00 00");
    b.acknowledge(0x0800);
    EXPECT_EQ(b.irr(), irq::new_prm_data);
    EXPECT_EQ(b.read(control::user_prm_data_okay), 0x00);
    EXPECT_EQ(b.irr(), 0);
}

// proves: VPC3C 6.2.2-09, VPC3C 4.3-38, APC3 3.3-25, APC3 A.2-09, APC3 A.2-23, APC3 A.4-08
TEST_P(Checks, C032_a_wrong_ident_is_a_parameter_fault) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("68 0C 0C 68 88 82 5D 3D 3E 88 02 05 0B 47 12 00 D5 16"), "E5");
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 42 05 00 FF 47 11 2A 16");
}

TEST_P(Checks, C033_six_octets_are_a_parameter_fault) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("68 0B 0B 68 88 82 5D 3D 3E 88 02 05 0B 47 11 D4 16"), "E5");
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 42 05 00 FF 47 11 2A 16");
}

// proves: VPC3C 6.2.2-07, APC3 A.2-07
TEST_P(Checks, C034_a_watchdog_factor_of_zero_is_a_parameter_fault) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("68 0C 0C 68 88 82 5D 3D 3E 88 00 05 0B 47 11 00 D2 16"), "E5");
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 42 05 00 FF 47 11 2A 16");
}

// proves: VPC3C 6.2.2-06, APC3 A.2-03..04, APC3 A.4-06
TEST_P(Checks, C035_Sync_Req_without_support_is_reported_as_not_supported) {
    Recipe s = recipe();
    s.mode0 = static_cast<std::uint16_t>(s.mode0 & ~regmap::mode0::sync_supported);
    Bench b{s, Stage::p0};
    EXPECT_EQ(b.ask("68 0C 0C 68 88 82 5D 3D 3E B8 02 05 0B 47 11 01 05 16"), "E5");
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 52 05 00 FF 47 11 3A 16");
}

// proves: VPC3C 6.2.2-06, APC3 A.2-03..04
TEST_P(Checks, C036_Sync_Req_and_Freeze_Req_with_support_activate_nothing_yet) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("68 0C 0C 68 88 82 5D 3D 3E B8 02 05 0B 47 11 01 05 16"), "E5");
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 02 0C 00 02 47 11 F4 16");
}

constexpr std::string_view kC037 = "68 0F 0F 68 88 82 5D 3D 3E 88 02 05 0B 47 11 00 80 02 00 56 16";
constexpr std::string_view kC038 = "68 0F 0F 68 88 82 5D 3D 3E 88 02 05 0B 47 11 00 80 00 00 54 16";
constexpr std::string_view kC040 = "68 0F 0F 68 88 82 5D 3D 3E 88 02 05 0B 47 11 00 C0 00 10 A4 16";

// proves: VPC3C 5.1.3-05, VPC3C 6.2.2-12, E017
TEST_P(ChecksStepBC, C037_a_reserved_bit_of_DPV1_Status_2_is_a_parameter_fault) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask(kC037), "E5");
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 42 05 00 FF 47 11 2A 16");
    EXPECT_EQ(b.irr(), 0);
}

// proves: VPC3C 5.1.3-06, VPC3C 6.2.2-12, E017
TEST_P(ChecksStepBC, C037_No_Check_Prm_Reserved_lets_reserved_bits_pass) {
    Recipe s = recipe();
    s.mode2 = 0x01 | regmap::mode2::no_check_prm_reserved;
    Bench b{s, Stage::p0};
    EXPECT_EQ(b.ask(kC037), "E5");
    EXPECT_EQ(b.irr(), irq::new_prm_data);
}

// proves: VPC3C 6.2.2-15, VPC3C 7.1-02, E032
TEST_P(ChecksStepBC, C038_DPV1_Enable_without_Fail_Safe_is_a_parameter_fault_in_Spec_Clear_Mode) {
    Recipe s = recipe();
    s.mode0 |= kSpecClear;
    Bench b{s, Stage::p0};
    EXPECT_EQ(b.ask(kC038), "E5");
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 42 05 00 FF 47 11 2A 16");
}

// proves: VPC3C 6.2.2-15, VPC3C 7.1-02
TEST_P(Checks, C039_DPV1_Enable_with_Fail_Safe_is_accepted_in_Spec_Clear_Mode) {
    Recipe s = recipe();
    s.mode0 |= kSpecClear;
    Bench b{s, Stage::p0};
    EXPECT_EQ(b.ask("68 0F 0F 68 88 82 5D 3D 3E 88 02 05 0B 47 11 00 C0 00 00 94 16"), "E5");
    EXPECT_EQ(b.irr(), irq::new_prm_data);
}

TEST_P(ChecksStepBC, C040_IsoM_Req_without_SYNC_Ena_is_a_parameter_fault) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask(kC040), "E5");
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 42 05 00 FF 47 11 2A 16");
}

// proves: APC3 5.2.2-03, APC3 A.2-12
TEST_P(ChecksPlainPrm, C037_C038_C040_octets_7_to_9_are_user_data_where_the_chip_knows_no_DPV1) {
    for (const std::string_view telegram : {kC037, kC038, kC040}) {
        Recipe s = recipe();
        s.mode0 |= kSpecClear;
        Bench b{s, Stage::p0};
        EXPECT_EQ(b.ask(telegram), "E5");
        EXPECT_EQ(b.irr(), irq::new_prm_data);
        EXPECT_EQ(b.dp_state(), kWaitCfg);
    }
}

// proves: VPC3C 6.2.2-08, APC3 A.2-08, APC3 A.2-21
TEST_P(Checks, C041_without_Lock_only_minTSDR_is_taken) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("68 0C 0C 68 88 82 5D 3D 3E 00 00 00 14 00 00 00 F6 16"), "E5");
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 47 11 EA 16");
    EXPECT_EQ(b.last_answer().start - b.request_end(), b.bits(20));
}

// proves: VPC3C 4.3-20, VPC3C 6.1-30, APC3 3.3-12, APC3 5.1-23
TEST_P(Checks, C042_more_octets_than_the_Aux_Buffer_holds_are_answered_RR) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("68 1A 1A 68 88 82 5D 3D 3E 88 02 05 0B 47 11 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 D4 16"),
              "10 02 08 02 0C 16");
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.diag(), kDiagWaitPrm);
}

// proves: VPC3C 6.2.2-33, VPC3C 6.2.2-39, APC3 5.2.2-12, APC3 5.2.2-15
TEST_P(Checks, C043_a_second_Set_Prm_before_the_acknowledgement_is_a_conflict) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("68 0F 0F 68 88 82 5D 3D 3E 88 02 05 0B 47 11 01 80 00 00 55 16"), "E5");
    const std::uint8_t prm = b.peek(org::r_prm_buf_ptr), aux = b.peek(org::r_aux_buf_ptr1);
    EXPECT_EQ(b.ask("68 0F 0F 68 88 82 5D 3D 3E 88 02 05 0B 47 11 01 80 00 00 55 16"), "E5");
    EXPECT_EQ(b.peek(org::r_prm_buf_ptr), prm) << "the second telegram waits in the Aux-Buffer";
    EXPECT_EQ(b.read(control::user_prm_data_okay), 0x01);
    EXPECT_EQ(b.irr(), irq::new_prm_data);
    EXPECT_EQ(b.peek(org::r_prm_buf_ptr), aux);
    EXPECT_EQ(b.peek(org::r_aux_buf_ptr1), prm);
    EXPECT_EQ(b.read(control::user_prm_data_okay), 0x00);
    EXPECT_EQ(b.irr(), 0);
}

// proves: VPC3C 6.2.2-34, VPC3C 6.2.2-38, APC3 5.2.2-13..14
TEST_P(Checks, C044_an_acknowledgement_with_nothing_pending_is_not_allowed) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.read(control::user_prm_data_okay), 0x03);
}

// proves: VPC3C 4.2-18, VPC3C 6.2.2-28, VPC3C 6.2.2-30, VPC3C 6.2.2-35, APC3 3.2-13, APC3 5.2.2-10..11, APC3 A.4-08
TEST_P(Checks, C045_a_negative_acknowledgement_is_a_parameter_fault) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("68 0F 0F 68 88 82 5D 3D 3E 88 02 05 0B 47 11 01 80 00 00 55 16"), "E5");
    EXPECT_EQ(b.read(control::user_prm_data_not_okay), 0x00);
    b.run(2_clk);
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 42 05 00 FF 47 11 2A 16");
}

// proves: VPC3C 6.2.2-06, APC3 A.2-02
TEST_P(Checks, C046_Unlock_frees_the_slave) {
    Bench b{recipe(), Stage::p1};
    EXPECT_EQ(b.ask("68 0C 0C 68 88 82 5D 3D 3E 40 01 01 00 47 11 00 7C 16"), "E5");
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 47 11 EA 16");
}

TEST_P(Checks, C047_Lock_and_Unlock_together_are_Unlock) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask("68 0C 0C 68 88 82 5D 3D 3E C0 01 01 00 47 11 00 FC 16"), "E5");
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.irr(), irq::go_leave_data_exch | irq::dx_out);
    EXPECT_EQ(b.diag(), kDiagWaitPrm);
}

// proves: E074
TEST_P(Checks, C048_a_good_Set_Prm_keeps_data_exchange_going) {
    Bench b{recipe(), Stage::p2};
    for (const char* telegram : {"68 0C 0C 68 88 82 7D 3D 3E 88 02 05 0B 47 11 00 F4 16",
                                 "68 0C 0C 68 88 82 5D 3D 3E 88 02 05 0B 47 11 00 D4 16"}) {
        // After P2 a literal 7D would be a retry: ask() sends it as 5D, and the other one as 7D.
        EXPECT_EQ(b.ask(telegram), "E5");
        EXPECT_EQ(b.dp_state(), kDataExch);
        EXPECT_EQ(b.irr(), 0);
    }
    EXPECT_EQ(b.diag(), kDiagDataExch);
}

TEST_P(Checks, C049_a_foreign_master_cannot_take_the_slave_over) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask("68 0C 0C 68 88 83 6D 3D 3E 88 02 05 0B 47 11 00 E5 16"), "E5");
    EXPECT_EQ(b.dp_state(), kDataExch);
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.diag(), kDiagDataExch);
}

TEST_P(Checks, C050_a_foreign_master_cannot_unlock) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask("68 0C 0C 68 88 83 6D 3D 3E 40 01 01 00 47 11 00 8D 16"), "E5");
    EXPECT_EQ(b.dp_state(), kDataExch);
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.diag(), kDiagDataExch);
}

TEST_P(Checks, C051_a_faulty_Set_Prm_of_the_owner_ends_data_exchange) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask("68 0C 0C 68 88 82 5D 3D 3E 88 02 05 0B 47 12 00 D5 16"), "E5");
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.irr(), irq::go_leave_data_exch | irq::dx_out);
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 42 05 00 FF 47 11 2A 16");
}

// ---- what the ids leave open (reference 3.4.3, 3.4.4) --------------------------------------------------------------

TEST_P(Checks, a_good_Set_Prm_clears_the_faults_reported_before) {
    Recipe r = recipe();
    r.mode0 = static_cast<std::uint16_t>(r.mode0 & ~regmap::mode0::sync_supported);
    Bench b{r, Stage::p0};
    EXPECT_EQ(b.ask("68 0C 0C 68 88 82 5D 3D 3E B8 02 05 0B 47 11 01 05 16"), "E5");
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 52 05 00 FF 47 11 3A 16");
    EXPECT_EQ(b.ask(kPrm), "E5");
    EXPECT_EQ(b.diag(), kDiagWaitCfg);
    EXPECT_EQ(b.ask(kCfg), "E5");
    EXPECT_EQ(b.read(control::user_cfg_data_not_okay), 0x00);
    EXPECT_EQ(b.diag(), kDiagCfgFault);
    EXPECT_EQ(b.ask(kPrm), "E5");
    EXPECT_EQ(b.diag(), kDiagWaitCfg);
}

TEST_P(Checks, minTSDR_of_Set_Prm_is_kept_when_zero_and_eleven_at_least) {
    Recipe r = recipe();
    r.min_tsdr = 20;
    Bench b{r, Stage::p0};
    const auto delay_after = [&b](std::uint8_t min_tsdr) {
        EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x3D, {0x88, 0x02, 0x05, min_tsdr, 0x47, 0x11, 0x00})), kSc);
        EXPECT_EQ(b.ask(kFdlStatus), kFdlStatusOk);
        return (b.last_answer().start - b.request_end()) / b.bit();
    };
    EXPECT_EQ(delay_after(0), 20);
    EXPECT_EQ(delay_after(30), 30);
    EXPECT_EQ(delay_after(0), 30);
    EXPECT_EQ(delay_after(255), 255);
    EXPECT_EQ(delay_after(1), 11);
    EXPECT_EQ(delay_after(10), 11);
    EXPECT_EQ(b.ask("68 0C 0C 68 88 82 5D 3D 3E 40 01 01 00 47 11 00 7C 16"), kSc);
    EXPECT_EQ(delay_after(0), 11) << "kept over LEAVE-MASTER";
}

TEST_P(Checks, LEAVE_MASTER_drops_parameters_and_configurations_that_wait_for_their_acknowledgement) {
    Bench b{recipe(), Stage::p0};
    for (int i = 0; i < 2; ++i) EXPECT_EQ(b.ask(kPrm10), "E5");
    EXPECT_EQ(b.read(control::user_prm_data_okay), regmap::acknowledge::conflict);
    EXPECT_EQ(b.ask(kCfg), "E5");
    EXPECT_EQ(b.irr(), irq::new_prm_data | irq::new_cfg_data);
    EXPECT_EQ(b.ask("68 0C 0C 68 88 82 5D 3D 3E 40 01 01 00 47 11 00 7C 16"), "E5");
    EXPECT_EQ(b.irr(), irq::dx_out);
    EXPECT_EQ(b.read(control::user_prm_data_okay), regmap::acknowledge::not_allowed);
    EXPECT_EQ(b.read(control::user_cfg_data_okay), regmap::acknowledge::not_allowed);
    EXPECT_EQ(b.ask(kPrm10), "E5");
    EXPECT_EQ(b.read(control::user_prm_data_okay), regmap::acknowledge::finished) << "the counters began at 0";
    EXPECT_EQ(b.dp_state(), kWaitCfg);
}

}  // namespace
}  // namespace dpchip::checks
