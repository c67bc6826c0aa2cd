// SPDX-License-Identifier: Apache-2.0
// What the manuals say about the DP services: VPC3+C 6.1 to 6.2.4; APC3 5.1 to 5.2.4, A.1, A.2.
#include "checks.hpp"

namespace dpchip::checks {
namespace {

constexpr std::string_view kDiagRequest = "68 05 05 68 88 82 5D 3C 3E E1 16";
constexpr std::string_view kSsa8 = "68 09 09 68 88 82 5D 37 3E 08 47 11 00 3C 16";

// proves: VPC3C 4.1-04, VPC3C 6.1-15, APC3 3.1-03, APC3 5.1-15
TEST_P(Checks, manual_6_1_every_buffer_lies_where_Offline_put_its_pointer) {
    Bench b{recipe(), Stage::configured};
    const std::uint16_t cells[]{org::r_dout_buf_ptr1, org::r_dout_buf_ptr2, org::r_dout_buf_ptr3, org::r_din_buf_ptr1,
                                org::r_din_buf_ptr2, org::r_din_buf_ptr3};
    std::uint8_t segment = 0x60;
    for (const std::uint16_t cell : cells) b.write(cell, segment = static_cast<std::uint8_t>(segment + 4));
    b.start();
    b.find_baud();
    EXPECT_EQ(b.ask(kPrm), kSc);
    EXPECT_EQ(b.ask(kCfg), kSc);
    b.read(control::user_cfg_data_okay);
    b.give_inputs("AB CD");
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    const Outputs out = b.take_outputs();
    EXPECT_EQ(text(out.octets), "12 34");
    EXPECT_EQ(text(b.ram(static_cast<std::uint16_t>((0x60 + 4 * (out.command & 3)) << 3), 2)), "12 34");
}

// proves: VPC3C 6.1-17, APC3 5.1-16
TEST_P(Checks, manual_6_1_in_WAIT_CFG_the_user_adapts_the_lengths_to_the_configuration) {
    Bench b{recipe(), Stage::p1};
    EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x3E, {0x10, 0x23})), kSc);
    b.write(org::r_len_dout_buf, 4);
    b.write(org::r_len_din_buf, 1);
    EXPECT_EQ(b.read(control::user_cfg_data_okay), 0);
    b.give_inputs("77");
    EXPECT_EQ(b.dp_state(), kDataExch);
    EXPECT_EQ(b.ask(b.request(2, 0x5D, std::nullopt, {1, 2, 3, 4})), "68 04 04 68 02 08 08 77 89 16");
    EXPECT_EQ(text(b.take_outputs().octets), "01 02 03 04");
}

// proves: VPC3C 6.1-28, VPC3C 6.1-12
TEST_P(Checks, manual_6_1_without_Aux_2_a_slave_reaches_data_exchange) {
    Recipe r = recipe();
    r.aux2 = 0;
    Bench b{r, Stage::p2};
    EXPECT_EQ(b.peek(org::r_aux_buf_ptr2), 0);
    EXPECT_EQ(b.ask(kDx1234), kInputs);
}

// proves: VPC3C 6.1-13, APC3 5.1-12, E016, E055
TEST_P(Checks, manual_6_1_RD_Input_and_RD_Output_open_in_DATA_EXCH_for_every_master) {
    for (const std::uint8_t sap : {std::uint8_t{56}, std::uint8_t{57}}) {
        Bench before{recipe(), Stage::p1};
        EXPECT_EQ(before.ask(before.request(3, 0x5D, sap, {})), "10 03 08 03 0E 16") << unsigned{sap};
        Bench b{recipe(), Stage::p2};
        for (const std::uint8_t master : {std::uint8_t{2}, std::uint8_t{3}}) {
            const Octets answer = hex(b.ask(b.request(master, 0x5D, sap, {})));
            ASSERT_EQ(answer.size(), 13u);
            EXPECT_EQ(text(std::span{answer}.subspan(9, 2)), sap == 56 ? "AB CD" : "00 00");
        }
    }
}

// proves: VPC3C 4.2-23, VPC3C 6.2.1-10..13, APC3 3.2-17, APC3 5.2.1-11, APC3 5.2.1-13
TEST_P(Checks, manual_6_2_1_reading_14H_makes_room_for_the_next_Set_Slave_Add) {
    Recipe r = recipe();
    r.ssa = true;
    Bench b{r, Stage::p0};
    EXPECT_EQ(b.ask(kSsa8), kSc);
    EXPECT_EQ(b.ask(kSsa8), kRr);
    EXPECT_EQ(b.read(control::ssa_buffer_free_cmd), 0x00);
    b.acknowledge();
    EXPECT_EQ(b.ask(kSsa8), kSc);
    EXPECT_EQ(b.irr(), irq::new_ssa_data);
}

// proves: VPC3C 6.2.1-03, APC3 5.2.1-06
TEST_P(Checks, manual_6_2_1_after_a_restart_the_kept_address_and_its_lock_hold_again) {
    Recipe r = recipe();
    r.ssa = true;
    Bench before{r, Stage::p0};
    EXPECT_EQ(before.ask(before.request(2, 0x5D, 0x37, {0x21, 0x47, 0x11, 0x01})), kSc);
    r.ts = before.peek(org::r_ts_adr);
    EXPECT_EQ(r.ts, 0x21);
    const std::uint8_t locked = before.peek(org::r_real_no_add_change);
    EXPECT_EQ(locked, 0xFF);
    Bench b{r, Stage::configured};
    b.write(org::r_real_no_add_change, locked);
    b.start();
    b.find_baud();
    b.acknowledge();
    EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x37, {0x22, 0x47, 0x11, 0x00})), kSc) << "acknowledged, not obeyed";
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.chip().address(), 0x21);
}

// proves: VPC3C 6.2.2-06, APC3 A.2-06
TEST_P(Checks, manual_6_2_2_the_reserved_bits_of_Station_Status_do_not_matter) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x3D, {0x87, 1, 1, 0x0B, 0x47, 0x11, 0})), kSc);
    EXPECT_EQ(b.dp_state(), kWaitCfg);
}

// proves: VPC3C 6.2.2-13, VPC3C 6.2.2-27, APC3 A.2-12, E019
TEST_P(Checks, manual_6_2_2_a_Set_Prm_may_have_244_octets_and_no_more) {
    for (const std::size_t size : {244u, 245u}) {
        Bench b{recipe(), Stage::configured};
        b.write(org::r_aux_buf_ptr1, 0x60);
        b.write(org::r_prm_buf_ptr, 0x80);
        b.write(org::r_len_cntrl_buf1, 244);
        b.start();
        b.find_baud();
        Octets data{0x80, 1, 1, 0x0B, 0x47, 0x11, 0, 0, 0, 0};
        while (data.size() < size) data.push_back(static_cast<std::uint8_t>(data.size()));
        const Octets request = b.request(2, 0x5D, 0x3D, data);
        if (size > 244) {
            EXPECT_TRUE(request.empty()) << "does not fit into a telegram";
            continue;
        }
        EXPECT_EQ(b.ask(request), kSc);
        EXPECT_EQ(b.peek(org::r_len_prm_data), 244);
        EXPECT_EQ(b.ram(0x60 << 3, size), data);
    }
}

// proves: VPC3C 6.2.2-36, VPC3C 6.2.2-38..39, APC3 5.2.2-12, APC3 5.2.2-14..15
TEST_P(Checks, manual_6_2_2_a_refusal_returns_Prm_Conflict_too_and_changes_nothing) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask(kPrm10), kSc);
    const Octets second{0x80, 1, 1, 0x0B, 0x47, 0x11, 0x02, 0x80, 0, 0, 0x99};
    EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x3D, second)), kSc);
    EXPECT_EQ(b.read(control::user_prm_data_not_okay), 0x01);
    EXPECT_EQ(b.dp_state(), kWaitCfg);
    EXPECT_EQ(b.irr(), irq::new_prm_data);
    EXPECT_EQ(b.ram(b.buffer(org::r_prm_buf_ptr), second.size()), second);
    EXPECT_EQ(b.read(control::user_prm_data_not_okay), 0x00);
    EXPECT_EQ(b.diag(), kDiagPrmFault);
}

// proves: VPC3C 6.2.2-34, VPC3C 6.2.2-37..38, VPC3C 6.2.3-13, VPC3C 6.2.3-17, VPC3C 6.2.3-20..21, APC3 5.2.2-13..14, APC3 5.2.3-16..17
TEST_P(Checks, manual_6_2_3_an_acknowledgement_of_nothing_is_Not_Allowed) {
    for (const Stage stage : {Stage::p0, Stage::p1, Stage::p2}) {
        Bench b{recipe(), stage};
        const unsigned state = b.dp_state();
        for (const std::uint16_t address : {control::user_prm_data_okay, control::user_prm_data_not_okay,
                                            control::user_cfg_data_okay, control::user_cfg_data_not_okay})
            EXPECT_EQ(b.read(address), 0x03);
        EXPECT_EQ(b.dp_state(), state);
        EXPECT_EQ(b.irr(), 0);
    }
}

// proves: VPC3C 6.2.3-12..13, VPC3C 6.2.3-16, VPC3C 6.2.3-19, VPC3C 6.2.3-21, APC3 5.2.3-13, APC3 5.2.3-15, APC3 5.2.3-17
TEST_P(Checks, manual_6_2_3_a_second_Chk_Cfg_before_the_acknowledgement_is_a_conflict) {
    for (const std::uint16_t address : {control::user_cfg_data_okay, control::user_cfg_data_not_okay}) {
        Bench b{recipe(), Stage::p1};
        EXPECT_EQ(b.ask(kCfg), kSc);
        EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x3E, {0x12, 0x22, 0x32})), kSc);
        EXPECT_EQ(text(b.ram(b.buffer(org::r_cfg_buf_ptr), 2)), "11 21");
        EXPECT_EQ(b.read(address), 0x01);
        EXPECT_EQ(b.irr(), irq::new_cfg_data);
        EXPECT_EQ(b.dp_state(), kWaitCfg);
        EXPECT_EQ(b.peek(org::r_len_cfg_data), 3);
        EXPECT_EQ(text(b.ram(b.buffer(org::r_cfg_buf_ptr), 3)), "12 22 32");
        EXPECT_EQ(b.read(address), 0x00);
        EXPECT_EQ(b.irr() & irq::new_cfg_data, 0);
        if (address == control::user_cfg_data_not_okay) {
            EXPECT_EQ(b.diag(), kDiagCfgFault);
        }
    }
}

// proves: VPC3C 6.2.3-11, APC3 5.2.3-11, E022
TEST_P(Checks, manual_6_2_3_the_user_may_write_a_new_Read_Cfg_before_the_acknowledgement) {
    Bench b{recipe(), Stage::p1};
    EXPECT_EQ(b.ask(kCfg), kSc);
    b.chip().write_block(b.buffer(org::r_read_cfg_buf_ptr), hex("31 32 33"));
    b.write(org::r_len_read_cfg_data, 3);
    EXPECT_EQ(b.read(control::user_cfg_data_okay), 0);
    const Octets answer = hex(b.ask("68 05 05 68 88 82 5D 3B 3E E0 16"));
    EXPECT_EQ(text(std::span{answer}.subspan(9, answer.size() - 11)), "31 32 33");
}

// proves: APC3 5.2.3-08, E066
TEST_P(ChecksSpc3Class, manual_5_2_3_without_inputs_the_acknowledgement_alone_leads_to_DATA_EXCH) {
    Recipe r = recipe();
    r.din = 0;
    Bench b{r, Stage::p1};
    EXPECT_EQ(b.ask(kCfg), kSc);
    EXPECT_EQ(b.read(control::user_cfg_data_okay), 0);
    EXPECT_EQ(b.dp_state(), kDataExch);
    EXPECT_EQ(b.irr(), irq::go_leave_data_exch);
}

// proves: VPC3C 4.2-15..16, VPC3C 6.2.4-02, VPC3C 6.2.4-11..15, VPC3C 6.2.4-17..19, VPC3C 2.1-08, APC3 3.2-10..11, APC3 5.2.4.1-01,
//   APC3 5.2.4.1-09..12
TEST_P(Checks, manual_6_2_4_one_diagnosis_buffer_is_the_users_the_other_the_chips) {
    Bench b{recipe(), Stage::p2};
    unsigned user = (b.peek(control::diag_buffer_sm) & 3u) == 1 ? 1 : 2;
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(b.peek(control::diag_buffer_sm), user == 1 ? 0b1001 : 0b0110);
        user = 3 - user;
        EXPECT_EQ(b.read(control::new_diag_buffer_cmd), user);
    }
}

// proves: VPC3C 6.2.4-11, VPC3C 6.2.4-13..16, APC3 5.2.4.1-09, APC3 5.2.4.1-11
TEST_P(Checks, manual_6_2_4_while_the_diagnosis_is_sent_no_buffer_is_the_users) {
    Bench b{recipe(), Stage::p2};
    const std::uint8_t before = b.peek(control::diag_buffer_sm);
    b.tell("68 05 05 68 88 83 6D 3C 3E F2 16");
    fdl::Transmission answer;
    const Ticks limit = b.now() + 1_ms;
    while (!b.chip().take(answer) && b.now() < limit) b.chip().advance(b.chip().next());
    ASSERT_LT(b.now(), limit);
    b.chip().advance(answer.start + b.bits(30));
    const unsigned sending = (before & 3u) == 2 ? 0x03 : 0x0C;
    EXPECT_EQ(b.peek(control::diag_buffer_sm) & sending, sending) << "VPC3_Send_Mode";
    EXPECT_EQ(b.read(control::new_diag_buffer_cmd), 0x00) << "No_Buffer";
    EXPECT_EQ(b.irr(), 0);
    b.chip().advance(answer.end() + 4_clk);
    EXPECT_EQ(b.irr(), irq::diag_buffer_changed);
    EXPECT_EQ(b.peek(control::diag_buffer_sm), before == 0b1001 ? 0b0110 : 0b1001);
    EXPECT_TRUE(b.diag_flag());
}

// proves: VPC3C 6.2.4-21..22, VPC3C 6.2.4-25, APC3 5.2.4.2-04, APC3 5.2.4.2-06
TEST_P(Checks, manual_6_2_4_a_diagnosis_has_up_to_244_octets) {
    Bench b{recipe(), Stage::configured};
    b.write(org::r_diag_buf_ptr1, 0x60);
    b.write(org::r_diag_buf_ptr2, 0x80);
    b.start();
    b.find_baud();
    Octets ext(238);
    for (std::size_t i = 0; i < ext.size(); ++i) ext[i] = static_cast<std::uint8_t>(i);
    b.give_diag(0x01, text(ext));
    const Octets answer = hex(b.ask(kDiagRequest));
    ASSERT_EQ(answer.size(), 244u + 11u);
    EXPECT_EQ(text(std::span{answer}.subspan(15, 238)), text(ext));
}

// proves: APC3 A.4-20, E061
TEST_P(Checks, manual_A_4_Master_Add_is_the_address_of_whoever_sent_the_parameters) {
    for (const std::uint8_t master : {std::uint8_t{0}, std::uint8_t{1}, std::uint8_t{125}, std::uint8_t{126}}) {
        Bench b{recipe(), Stage::p0};
        EXPECT_EQ(b.ask(b.request(master, 0x5D, 0x3D, {0x80, 1, 1, 0x0B, 0x47, 0x11, 0})), kSc);
        const Octets answer = hex(b.ask(b.request(master, 0x5D, 0x3C, {})));
        EXPECT_EQ(answer.at(12), master);
    }
}

}  // namespace
}  // namespace dpchip::checks
