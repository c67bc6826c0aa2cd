// SPDX-License-Identifier: Apache-2.0
// Conformance checks of Global_Control and of the RD services: C087 to C104 (reference 8.8, 8.9).
#include "checks.hpp"

namespace dpchip::checks {
namespace {

constexpr std::string_view kSync = "68 07 07 68 FF 82 46 3A 3E 20 00 5F 16";
constexpr std::string_view kFreeze = "68 07 07 68 FF 82 46 3A 3E 08 00 47 16";
constexpr std::string_view kGroup1 = "68 0C 0C 68 88 82 5D 3D 3E 88 02 05 0B 47 11 01 D5 16";
constexpr std::string_view kSyncGroup1 = "68 07 07 68 FF 82 46 3A 3E 20 01 60 16";
constexpr std::string_view kRdInput = "68 05 05 68 88 82 5D 38 3E DD 16",
                           kOldInputs = "68 07 07 68 82 88 08 3E 38 AB CD 00 16";
constexpr std::string_view kRdOutput = "68 05 05 68 88 82 5D 39 3E DE 16";
constexpr std::string_view kDiagSync = "68 0B 0B 68 82 88 08 3E 3C 00 2C 00 02 47 11 12 16";
constexpr std::string_view kDiagFreeze = "68 0B 0B 68 82 88 08 3E 3C 00 1C 00 02 47 11 02 16";

void expect_clear(Bench& b, std::string_view telegram) {
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    EXPECT_EQ(text(b.take_outputs().octets), "12 34");
    b.acknowledge();
    EXPECT_EQ(b.ask(telegram), kSilence);
    EXPECT_EQ(b.peek(org::r_gc_command), 0x02);
    EXPECT_EQ(b.irr(), irq::new_gc_command | irq::dx_out);
    const unsigned n = (b.peek(control::dout_buffer_sm) >> 2) & 3u;
    ASSERT_NE(n, 0u);
    EXPECT_EQ(text(b.ram(b.buffer(static_cast<std::uint16_t>(org::r_dout_buf_ptr1 + n - 1)), 2)), "00 00");
    const Outputs out = b.take_outputs();
    EXPECT_EQ(out.command & 0x0C, 0x0C);
    EXPECT_EQ(text(out.octets), "00 00");
}

void expect_ignored(Bench& b, std::string_view telegram) {
    b.write(org::r_gc_command, 0x77);
    EXPECT_EQ(b.ask(telegram), kSilence);
    EXPECT_EQ(b.peek(org::r_gc_command), 0x77);
    EXPECT_EQ(b.irr(), 0);
}

// proves: VPC3C 4.3-40, VPC3C 5.3.1-19, VPC3C 6.1-07, VPC3C 6.2.5-10..11, VPC3C 6.2.6-01, VPC3C 6.2.6-05,
//   VPC3C 6.2.6-12, APC3 3.3-26, APC3 5.1-07, APC3 5.2.5.1-07..08, APC3 5.2.6-01, APC3 5.2.6-03, APC3 5.2.6-11,
//   E009
TEST_P(Checks, C087_Clear_Data_to_all_clears_the_outputs) {
    Bench b{recipe(), Stage::p2};
    expect_clear(b, "68 07 07 68 FF 82 46 3A 3E 02 00 41 16");
}

TEST_P(Checks, C088_Clear_Data_to_this_station_clears_the_outputs) {
    Bench b{recipe(), Stage::p2};
    expect_clear(b, "68 07 07 68 88 82 46 3A 3E 02 00 CA 16");
}

TEST_P(Checks, C089_Global_Control_of_a_foreign_master_is_ignored) {
    Bench b{recipe(), Stage::p2};
    expect_ignored(b, "68 07 07 68 FF 83 46 3A 3E 02 00 42 16");
}

// proves: VPC3C 6.1-13, APC3 5.1-12
TEST_P(Checks, C090_Global_Control_outside_DATA_EXCH_is_ignored) {
    Bench b{recipe(), Stage::p1};
    expect_ignored(b, "68 07 07 68 FF 82 46 3A 3E 02 00 41 16");
}

// proves: VPC3C 5.1.3-12, VPC3C 6.2.6-13, APC3 5.2.6-02, E071
TEST_P(Checks, C091_a_reserved_bit_makes_Global_Control_invalid) {
    Bench b{recipe(), Stage::p2};
    expect_ignored(b, "68 07 07 68 FF 82 46 3A 3E 01 00 40 16");
}

// proves: VPC3C 5.1.3-13
TEST_P(ChecksVpc3, C091_No_Check_GC_Reserved_lets_reserved_bits_pass) {
    Recipe r = recipe();
    r.mode2 = 0x01 | regmap::mode2::no_check_gc_reserved;
    Bench b{r, Stage::p2};
    EXPECT_EQ(b.ask("68 07 07 68 FF 82 46 3A 3E 01 00 40 16"), kSilence);
    EXPECT_EQ(b.peek(org::r_gc_command), 0x01);
    EXPECT_EQ(b.irr(), irq::new_gc_command);
}

TEST_P(Checks, C092_Global_Control_of_three_octets_is_ignored) {
    Bench b{recipe(), Stage::p2};
    expect_ignored(b, "68 08 08 68 FF 82 46 3A 3E 02 00 00 41 16");
}

TEST_P(Checks, C093_SRD_to_SAP_58_is_answered_RS) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask("68 07 07 68 88 82 7D 3A 3E 02 00 01 16"), "10 02 08 03 0D 16");
    EXPECT_EQ(b.irr(), 0);
}

// proves: VPC3C 5.1.1-07, VPC3C 6.2.5-13..14, VPC3C 6.2.6-08, APC3 4.1.1-13, APC3 5.2.5.1-10, APC3 5.2.6-07,
//   APC3 A.4-15, E068
TEST_P(Checks, C094_outputs_wait_in_Sync_Mode_for_the_next_Sync) {
    Bench b{recipe(), Stage::p2};
    b.take_outputs();
    EXPECT_EQ(b.ask("68 07 07 68 FF 82 46 3A 3E 20 00 5F 16"), kSilence);
    EXPECT_EQ(b.irr(), irq::new_gc_command) << "nothing was waiting in D";
    b.acknowledge();
    EXPECT_EQ(b.ask("68 05 05 68 08 02 7D 12 34 CD 16"), kInputs);
    EXPECT_EQ(b.ask("68 05 05 68 08 02 5D 56 78 35 16"), kInputs);
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.take_outputs().command & 0x04, 0);
    EXPECT_EQ(b.ask("68 07 07 68 FF 82 46 3A 3E 20 00 5F 16"), kSilence);
    EXPECT_EQ(b.irr() & irq::dx_out, irq::dx_out);
    const Outputs out = b.take_outputs();
    EXPECT_EQ(out.command & 0x0C, 0x04);
    EXPECT_EQ(text(out.octets), "56 78");
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 00 2C 00 02 47 11 12 16");
}

// proves: VPC3C 6.2.5-14, VPC3C 6.2.6-09, APC3 5.2.5.1-10, APC3 5.2.6-06, E068
TEST_P(Checks, C095_Unsync_wins_over_Sync) {
    Bench b{recipe(), Stage::p2};
    b.take_outputs();
    EXPECT_EQ(b.ask(kSync), kSilence);
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    b.acknowledge();
    EXPECT_EQ(b.ask("68 07 07 68 FF 82 46 3A 3E 30 00 6F 16"), kSilence);
    EXPECT_EQ(b.irr(), irq::new_gc_command | irq::dx_out);
    EXPECT_EQ(text(b.take_outputs().octets), "12 34");
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 00 0C 00 02 47 11 F2 16");
}

// proves: VPC3C 5.1.1-05, VPC3C 6.2.6-10..11, VPC3C 6.2.7-02, APC3 4.1.1-15, APC3 5.2.6-04..05, APC3 5.2.7-01,
//   APC3 A.4-14
TEST_P(Checks, C096_Freeze_holds_the_inputs_until_Unfreeze) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask("68 07 07 68 FF 82 46 3A 3E 08 00 47 16"), kSilence);
    b.give_inputs("EF 01");
    EXPECT_EQ(b.ask("68 05 05 68 88 82 5D 38 3E DD 16"), kOldInputs);
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 00 1C 00 02 47 11 02 16");
    EXPECT_EQ(b.ask("68 07 07 68 FF 82 46 3A 3E 04 00 43 16"), kSilence);
    EXPECT_EQ(b.ask(kRdInput), "68 07 07 68 82 88 08 3E 38 EF 01 78 16");
    EXPECT_EQ(b.diag(), kDiagDataExch);
}

TEST_P(Checks, C097_Unfreeze_wins_over_Freeze) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask(kFreeze), kSilence);
    EXPECT_EQ(b.diag(), kDiagFreeze);
    b.give_inputs("EF 01");
    EXPECT_EQ(b.ask("68 07 07 68 FF 82 46 3A 3E 0C 00 4B 16"), kSilence);
    EXPECT_EQ(b.ask(kRdInput), "68 07 07 68 82 88 08 3E 38 EF 01 78 16");
    EXPECT_EQ(b.diag(), kDiagDataExch);
}

// proves: VPC3C 6.2.2-10, VPC3C 6.2.6-02, APC3 5.2.6-01, APC3 A.2-10, APC3 A.2-24
TEST_P(Checks, C098_only_the_groups_addressed_obey) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask("68 0C 0C 68 88 82 5D 3D 3E 88 02 05 0B 47 11 01 D5 16"), kSc);
    expect_ignored(b, "68 07 07 68 FF 82 46 3A 3E 20 02 61 16");
    EXPECT_EQ(b.diag(), kDiagDataExch);
    EXPECT_EQ(b.ask("68 07 07 68 FF 82 46 3A 3E 20 01 60 16"), kSilence);
    EXPECT_EQ(b.peek(org::r_gc_command), 0x20);
    EXPECT_EQ(b.irr(), irq::new_gc_command);
    EXPECT_EQ(b.diag(), kDiagSync);
}

void expect_interrupt_on_change_only(Bench& b) {
    EXPECT_EQ(b.ask("68 07 07 68 FF 82 46 3A 3E 00 00 3F 16"), kSilence);
    EXPECT_EQ(b.irr(), 0) << "00/00 is the start value";
    EXPECT_EQ(b.ask("68 07 07 68 FF 82 46 3A 3E 20 00 5F 16"), kSilence);
    EXPECT_EQ(b.irr(), irq::new_gc_command);
    b.acknowledge();
    EXPECT_EQ(b.ask("68 07 07 68 FF 82 46 3A 3E 20 00 5F 16"), kSilence);
    EXPECT_EQ(b.irr(), 0);
}

// proves: VPC3C 5.1.3-14, VPC3C 6.2.6-03, E008, E026
TEST_P(ChecksVpc3, C099_with_GC_Int_Mode_0_only_a_changed_command_is_indicated) {
    Recipe r = recipe();
    r.mode2 = 0x00;
    Bench b{r, Stage::p2};
    expect_interrupt_on_change_only(b);
}

// proves: APC3 4.3-22, APC3 5.2.6-09, E026, E066
TEST_P(ChecksSpc3Class, C099_only_a_changed_command_is_indicated) {
    Bench b{recipe(), Stage::p2};
    expect_interrupt_on_change_only(b);
}

/// A changed group with the same command; true when it was indicated.
bool indicates_changed_group(Bench& b) {
    EXPECT_EQ(b.ask(kGroup1), kSc);
    EXPECT_EQ(b.ask(kSync), kSilence);
    EXPECT_EQ(b.irr(), irq::new_gc_command);
    b.acknowledge();
    EXPECT_EQ(b.ask(kSyncGroup1), kSilence);
    EXPECT_EQ(b.irr() & ~irq::new_gc_command, 0);
    const bool indicated = b.irr() != 0;
    b.acknowledge();
    EXPECT_EQ(b.ask(kSyncGroup1), kSilence);
    EXPECT_EQ(b.irr(), 0) << "neither command nor group changed any more";
    return indicated;
}

// proves: VPC3C 5.1.4-07..08, E027
TEST_P(ChecksStepBC, C100_GC_Int_Mode_Ext_leaves_the_group_out_of_the_comparison) {
    for (const bool extended : {false, true}) {
        Recipe r = recipe();
        r.mode2 = 0x00;
        r.mode3 = extended ? regmap::mode3::gc_int_mode_ext : std::uint8_t{0};
        Bench b{r, Stage::p2};
        EXPECT_EQ(indicates_changed_group(b), !extended);
    }
}

// proves: APC3 4.3-22, APC3 5.2.6-09
TEST_P(ChecksSpc3Class, C100_a_changed_group_alone_is_not_indicated) {
    Bench b{recipe(), Stage::p2};
    EXPECT_FALSE(indicates_changed_group(b));
}

// proves: VPC3C 6.1-05, VPC3C 6.1-37, VPC3C 6.2.7-01, APC3 5.1-05, APC3 5.1-26, APC3 5.2.7-01
TEST_P(Checks, C101_RD_Input_returns_the_inputs) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask("68 05 05 68 88 82 5D 38 3E DD 16"), "68 07 07 68 82 88 08 3E 38 AB CD 00 16");
    EXPECT_EQ(b.irr(), 0);
}

// proves: VPC3C 6.1-06, VPC3C 6.1-37, VPC3C 6.2.5-05, VPC3C 6.2.8-01, APC3 5.1-06, APC3 5.1-26, APC3 5.2.5.1-03,
//   APC3 5.2.8-01
TEST_P(Checks, C102_RD_Output_returns_the_users_buffer) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask(kRdOutput), "68 07 07 68 82 88 08 3E 39 00 00 89 16");
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    b.take_outputs();
    EXPECT_EQ(b.ask("68 05 05 68 88 82 5D 39 3E DE 16"), "68 07 07 68 82 88 08 3E 39 12 34 CF 16");
}

// proves: VPC3C 6.2.8-03, APC3 5.2.8-01, E044
TEST_P(Checks, C103_a_retry_of_RD_Output_reads_the_buffer_anew) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    b.take_outputs();
    EXPECT_EQ(b.ask(kDx5678), kInputs);
    EXPECT_EQ(b.ask("68 05 05 68 88 82 5D 39 3E DE 16"), "68 07 07 68 82 88 08 3E 39 12 34 CF 16");
    b.take_outputs();
    EXPECT_EQ(b.ask_again(), "68 07 07 68 82 88 08 3E 39 56 78 57 16");
}

// proves: VPC3C 6.1-13, APC3 5.1-12
TEST_P(Checks, C104_RD_Input_outside_DATA_EXCH_is_answered_RS) {
    Bench b{recipe(), Stage::p1};
    EXPECT_EQ(b.ask("68 05 05 68 88 82 5D 38 3E DD 16"), "10 02 08 03 0D 16");
}

}  // namespace
}  // namespace dpchip::checks
