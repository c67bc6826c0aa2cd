// SPDX-License-Identifier: Apache-2.0
// What the manuals say about memory: VPC3+C chapter 4, APC3 chapter 3. Each test names the statements it proves.
#include "checks.hpp"

#include <array>

namespace dpchip::checks {
namespace {

constexpr std::string_view kDiagRequest = "68 05 05 68 88 82 5D 3C 3E E1 16";

// proves: VPC3C 4.1-01..02, VPC3C 4.1-08, VPC3C 4.2-01, APC3 3.1-01..02, APC3 3.1-06
TEST_P(Checks, manual_4_2_what_is_written_to_a_control_cell_does_not_show_on_its_read_side) {
    Bench b{recipe(), Stage::reset};
    for (std::uint16_t a = 0x0A; a <= 0x15; ++a) b.write(a, 0x5A);
    EXPECT_EQ(b.read(0x08), 0xE1);
    EXPECT_EQ(b.read(0x0A), 0xE1);
    EXPECT_EQ(b.read(0x0C), 0x09);
    EXPECT_EQ(b.read(0x12), traits().dxb ? 0xE1 : 0x00);
    EXPECT_EQ(b.read(0x14), 0x00);
    EXPECT_EQ(b.read(0x15), 0x00);
}

// The own cells of the chip below 16H cannot be reached: 22 cells, and the RAM begins right behind them.
// proves: VPC3C 4.1-03, VPC3C 4.1-09, VPC3C 4.3-01, APC3 3.1-07, APC3 3.3-01, E001, E043
TEST_P(Checks, manual_4_3_the_42_organizational_cells_are_plain_memory_in_Offline) {
    Bench b{recipe(), Stage::reset};
    for (unsigned value = 0; value < 256; ++value) {
        for (std::uint16_t a = org::first; a <= org::last; ++a) b.write(a, static_cast<std::uint8_t>(value + a));
        for (std::uint16_t a = org::first; a <= org::last; ++a) ASSERT_EQ(b.read(a), (value + a) & 0xFFu) << a;
        ASSERT_EQ(b.read(control::mode_reg1), 0x00);
    }
}

// proves: VPC3C 4.1-06, VPC3C 4.1-10, APC3 1-06, APC3 3.1-05, APC3 3.1-08, APC3 3.1-15
TEST_P(Checks, manual_4_1_from_40H_on_every_cell_keeps_its_own_value) {
    Bench b{recipe(), Stage::reset};
    const std::uint16_t end = traits().ram_bytes;
    for (std::uint16_t a = 0x40; a < end; ++a) b.write(a, static_cast<std::uint8_t>(a ^ (a >> 8) ^ 0xA5));
    for (std::uint16_t a = 0x40; a < end; ++a) ASSERT_EQ(b.read(a), (a ^ (a >> 8) ^ 0xA5) & 0xFF) << a;
}

/// Read_Cfg of `size` octets at segment 60H, as Get_Cfg sends it.
std::string get_cfg(const Recipe& r, unsigned shift, std::size_t size) {
    Bench b{r, Stage::configured};
    b.write(org::r_read_cfg_buf_ptr, 0x60);
    b.write(org::r_len_read_cfg_data, static_cast<std::uint8_t>(size));
    for (std::size_t i = 0; i < size; ++i)
        b.chip().write(static_cast<std::uint16_t>((0x60u << shift) + i), static_cast<std::uint8_t>(0x10 + i));
    b.start();
    b.find_baud();
    const Octets answer = hex(b.ask("68 05 05 68 88 82 5D 3B 3E E0 16"));
    return text(std::span{answer}.subspan(9, answer.size() - 11));
}
std::string counting(std::size_t size) {
    Octets octets(size);
    for (std::size_t i = 0; i < size; ++i) octets[i] = static_cast<std::uint8_t>(0x10 + i);
    return text(octets);
}

// proves: VPC3C 2.1-03..04, VPC3C 4.1-07, VPC3C 4.1-14..15, VPC3C 5.1.3-03, VPC3C 6.1-35, VPC3C 6.1-38..39, VPC3C 4.3-31..32,
//   APC3 3.3-21..22, APC3 5.1-25, APC3 5.1-27, E005, E006
TEST_P(Checks, manual_4_1_a_pointer_counts_segments_of_8_octets_and_a_buffer_may_be_longer) {
    for (const std::size_t size : {1u, 8u, 9u, 40u, 244u}) EXPECT_EQ(get_cfg(recipe(), 3, size), counting(size));
}

// proves: VPC3C 2.1-03, VPC3C 4.1-07, VPC3C 4.1-16, VPC3C 5.1.3-04, VPC3C 6.1-38..39
TEST_P(ChecksStepBC, manual_4_1_with_4_KB_a_pointer_counts_segments_of_16_octets) {
    Recipe r = recipe();
    r.mode2 = 0x01 | regmap::mode2::mode_4kb;
    for (const std::size_t size : {1u, 16u, 17u, 244u}) EXPECT_EQ(get_cfg(r, 4, size), counting(size));
}

// proves: VPC3C 4.3-02..03, APC3 3.3-02..03, E064
TEST_P(Checks, manual_4_3_the_station_address_is_R_TS_Adr_and_17H_leads_to_an_empty_list) {
    Recipe r = recipe();
    r.ts = 0x42;
    Bench b{r, Stage::p0};
    EXPECT_EQ(b.chip().address(), 0x42);
    EXPECT_EQ(b.ask(b.request(2, 0x49, std::nullopt, {})), "10 02 42 00 44 16");
    EXPECT_EQ(b.peek(static_cast<std::uint16_t>(b.peek(org::sap_list_ptr) << 3)), 0xFF);
    for (const std::uint8_t sap : {std::uint8_t{0}, std::uint8_t{49}, std::uint8_t{51}})
        EXPECT_EQ(b.ask(b.request(2, 0x5D, sap, {0x01})), "10 02 42 03 47 16") << unsigned{sap};
}

// proves: VPC3C 2.1-07, VPC3C 4.1-13, VPC3C 4.3-04, VPC3C 4.3-06..09, VPC3C 6.1-19, VPC3C 6.1-21, APC3 3.1-14, APC3 3.3-05..06,
//   APC3 5.1-17
TEST_P(Checks, manual_4_3_outputs_appear_in_each_of_the_three_Dout_buffers_in_turn) {
    Bench b{recipe(), Stage::p2};
    b.take_outputs();
    unsigned seen = 0;
    for (std::uint8_t i = 1; i <= 6; ++i) {
        EXPECT_EQ(b.ask(b.request(2, 0x5D, std::nullopt, {i, static_cast<std::uint8_t>(i + 0x50)})), kInputs);
        const Outputs out = b.take_outputs();
        EXPECT_EQ(out.octets, (Octets{i, static_cast<std::uint8_t>(i + 0x50)}));
        seen |= 1u << (out.command & 3u);
    }
    EXPECT_EQ(seen, 0x0Eu);
    EXPECT_EQ(b.chip().user_wd_timer(), b.recipe().user_wd - 6);
}

// proves: VPC3C 4.1-13, VPC3C 4.3-10..13, VPC3C 6.1-21, APC3 3.1-14, APC3 3.3-07..08
TEST_P(Checks, manual_4_3_inputs_are_sent_from_each_of_the_three_Din_buffers_in_turn) {
    Bench b{recipe(), Stage::p2};
    unsigned seen = 0;
    for (std::uint8_t i = 1; i <= 6; ++i) {
        const Octets in{i, static_cast<std::uint8_t>(0xA0 + i)};
        seen |= 1u << b.give_inputs(text(in));
        const Octets answer = hex(b.ask(kDx1234));
        EXPECT_EQ(text(std::span{answer}.subspan(7, 2)), text(in));
    }
    EXPECT_EQ(seen, 0x0Eu);
}

// proves: VPC3C 4.3-16..19, VPC3C 6.1-20, VPC3C 6.1-22, VPC3C 6.2.4-01, VPC3C 6.2.4-25, APC3 3.3-10..11, APC3 5.1-18,
//   APC3 5.2.4.2-06
TEST_P(Checks, manual_4_3_the_two_diagnosis_buffers_have_their_own_lengths_and_places) {
    Bench b{recipe(), Stage::p2};
    b.give_diag(0x01, "02 11");
    EXPECT_EQ(hex(b.ask(kDiagRequest)).size(), 17u + 2u);
    b.give_diag(0x01, "05 21 22 23 24");
    const Octets answer = hex(b.ask(kDiagRequest));
    ASSERT_EQ(answer.size(), 17u + 5u);
    EXPECT_EQ(text(std::span{answer}.subspan(15, 5)), "05 21 22 23 24");
    EXPECT_NE(b.peek(org::r_len_diag_buf1), b.peek(org::r_len_diag_buf2));
}

struct AuxCase {
    std::uint8_t sap, select;
    std::uint16_t pointer, length;
    Octets data;
};
const std::array<AuxCase, 3> kAuxCases{{
    {0x3D, regmap::aux_sel::set_prm, org::r_prm_buf_ptr, org::r_len_prm_data, {0x88, 2, 5, 0x0B, 0x47, 0x11, 0, 0x80, 0, 0}},
    {0x3E, regmap::aux_sel::chk_cfg, org::r_cfg_buf_ptr, org::r_len_cfg_data, {0x11, 0x21}},
    {0x37, regmap::aux_sel::set_slave_adr, org::r_ssa_buf_ptr, org::r_len_ssa_data, {8, 0x47, 0x11, 0, 0xC1, 0xC2}},
}};

/// Whether Aux 2 serves the telegram. VPC3+B takes Chk_Cfg through Aux 1 whatever is selected (reference 10, 16).
bool aux2_serves(const regmap::Traits& traits, const AuxCase& c, bool selected) {
    return selected && !(traits.chk_cfg_aux1 && c.sap == 0x3E);
}

/// The chip in the state the service wants, each Aux buffer with a length of its own.
Bench aux_bench(const Recipe& base, const AuxCase& c, std::uint8_t select, std::uint8_t aux1, std::uint8_t aux2) {
    Recipe r = base;
    r.ssa = true;
    r.aux_sel = select;
    r.aux1 = aux1;
    r.aux2 = aux2;
    Bench b{r, Stage::configured};
    b.start();
    b.find_baud();
    if (c.sap == 0x3E) {
        b.write(org::r_len_cntrl_buf1, 20);
        b.write(org::r_len_cntrl_buf2, 20);
        EXPECT_EQ(b.ask(kPrm), kSc);
        b.write(org::r_len_cntrl_buf1, aux1);
        b.write(org::r_len_cntrl_buf2, aux2);
    }
    b.acknowledge();
    return b;
}

// proves: VPC3C 4.3-22..30, VPC3C 6.1-23..25, VPC3C 6.1-27, VPC3C 6.1-29, VPC3C 6.1-31..34, VPC3C 6.2.1-04..06, VPC3C 6.2.1-17,
//   APC3 3.3-13..20, APC3 5.1-19..22, APC3 5.1-24, APC3 5.2.1-07..08, E007, E057
TEST_P(Checks, manual_6_1_each_telegram_goes_through_the_Aux_buffer_R_Aux_Buf_Sel_names) {
    for (const AuxCase& c : kAuxCases)
        for (const bool second : {false, true}) {
            SCOPED_TRACE(testing::Message() << "SAP " << unsigned{c.sap} << " Aux " << (second ? 2 : 1));
            const std::uint8_t others = static_cast<std::uint8_t>(~c.select & 0xF8);  // don't-care bits set
            Bench b = aux_bench(recipe(), c, static_cast<std::uint8_t>(others | (second ? c.select : 0)), 20, 20);
            const bool aux2 = aux2_serves(traits(), c, second);
            const std::uint16_t aux = aux2 ? org::r_aux_buf_ptr2 : org::r_aux_buf_ptr1;
            const std::uint16_t other = aux2 ? org::r_aux_buf_ptr1 : org::r_aux_buf_ptr2;
            const std::uint8_t was_aux = b.peek(aux), was_other = b.peek(other), was_target = b.peek(c.pointer);
            EXPECT_EQ(b.ask(b.request(2, 0x5D, c.sap, c.data)), kSc);
            EXPECT_EQ(b.peek(c.pointer), was_aux);
            EXPECT_EQ(b.peek(aux), was_target);
            EXPECT_EQ(b.peek(other), was_other);
            EXPECT_EQ(b.peek(c.length), c.data.size());
            EXPECT_EQ(b.ram(b.buffer(c.pointer), c.data.size()), c.data);
        }
}

// proves: VPC3C 4.3-20..21, VPC3C 6.1-30, APC3 3.3-12, APC3 5.1-23
TEST_P(Checks, manual_6_1_a_telegram_longer_than_its_Aux_buffer_is_answered_RR_and_changes_nothing) {
    for (const AuxCase& c : kAuxCases)
        for (const bool second : {false, true}) {
            SCOPED_TRACE(testing::Message() << "SAP " << unsigned{c.sap} << " Aux " << (second ? 2 : 1));
            const auto size = static_cast<std::uint8_t>(c.data.size());
            for (const bool fits : {true, false}) {
                const std::uint8_t mine = fits ? size : static_cast<std::uint8_t>(size - 1);
                const bool aux2 = aux2_serves(traits(), c, second);
                Bench b = aux_bench(recipe(), c, second ? c.select : std::uint8_t{0}, aux2 ? std::uint8_t{40} : mine,
                                    aux2 ? mine : std::uint8_t{40});
                const std::uint8_t target = b.peek(c.pointer);
                EXPECT_EQ(b.ask(b.request(2, 0x5D, c.sap, c.data)), fits ? kSc : kRr);
                EXPECT_EQ(b.peek(c.pointer) != target, fits);
                EXPECT_EQ(b.irr() != 0, fits);
            }
        }
}

}  // namespace
}  // namespace dpchip::checks
