// SPDX-License-Identifier: Apache-2.0
// Conformance checks of registers and interrupts: C105 to C112 (reference 8.10).
#include "checks.hpp"

namespace dpchip::checks {
namespace {

// proves: VPC3C 4.2-24, VPC3C 5.1.1-03, VPC3C 5.1.2-04, VPC3C 5.2-14, VPC3C 5.2-31, VPC3C 5.3.1-01, VPC3C 5.3.2-02,
//   APC3 3.2-05, APC3 3.2-16, APC3 3.2-18, APC3 4.2-02, APC3 4.2-28, APC3 4.3-31, E045
TEST_P(Checks, C105_registers_have_their_reset_values) {
    Bench b{recipe(), Stage::reset};
    for (std::uint16_t a = 0x00; a <= 0x04; ++a) EXPECT_EQ(b.read(a), 0x00) << a;
    EXPECT_EQ(b.read(0x05), traits().release << 4 | 0x0F);
    EXPECT_EQ(b.read(0x06), 0x00);
    EXPECT_EQ(b.read(0x07), 0x00);
    EXPECT_EQ(b.read(0x08), 0xE1);
    EXPECT_EQ(b.read(0x0A), 0xE1);
    EXPECT_EQ(b.read(0x0C), 0x09);
    EXPECT_EQ(b.read(0x12), traits().dxb ? 0xE1 : 0x00);
    EXPECT_EQ(b.read(0x15), 0x00);
}

// proves: VPC3C 5.3-07..09, VPC3C 5.3.2-03..05, VPC3C 5.3-13, APC3 1-08, APC3 3.2-21, APC3 4.3-03..06, APC3 4.3-10,
//   APC3 4.3-21, APC3 4.3-30, APC3 4.3-32, E050, E052
TEST_P(Checks, C105_all_interrupts_are_masked_after_reset) {
    Bench b{recipe(), Stage::reset};
    b.write_word(control::int_req_reg_low, 0xFFFF);
    b.run(2_clk);
    EXPECT_EQ(b.peek_word(control::int_req_reg_low), traits().interrupts);
    EXPECT_EQ(b.peek_word(control::int_reg_low), 0);
    EXPECT_FALSE(b.chip().interrupt_active());
    b.write_word(control::int_mask_reg_low, 0x0000);
    b.run(2_clk);
    EXPECT_EQ(b.peek_word(control::int_reg_low), traits().interrupts);
    EXPECT_TRUE(b.chip().interrupt_active());
}

// proves: VPC3C 5.1.3-02, VPC3C 5.1.3-15, VPC3C 6.2.6-03, E008, E026
TEST_P(ChecksVpc3, C105_Mode_Reg2_is_01_after_reset_every_Global_Control_is_indicated) {
    Bench b{recipe(), Stage::p2};
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(b.ask("68 07 07 68 FF 82 46 3A 3E 00 00 3F 16"), kSilence);
        EXPECT_EQ(b.irr(), irq::new_gc_command);
        b.acknowledge();
    }
}

// proves: VPC3C 5.1.2-16, VPC3C 6.2.5-08, VPC3C 6.2.5-11, VPC3C 6.2.5-15..18, VPC3C 6.2.5-22, VPC3C 6.2.5-25,
//   APC3 4.3-28, APC3 5.2.5.1-05, APC3 5.2.5.1-08, APC3 5.2.5.1-11, APC3 5.2.5.1-13, APC3 5.2.5.1-15, E023
TEST_P(Checks, C106_Start_clears_the_outputs) {
    Bench b{recipe(), Stage::searching};
    EXPECT_EQ(b.read(0x0A), 0x27);
    EXPECT_EQ(b.read(0x0B), 0x0D);
    EXPECT_EQ(b.read(0x0A), 0x93);
    EXPECT_EQ(b.irr(), irq::dx_out);
}

// proves: VPC3C 4.2-02, VPC3C 4.2-25, VPC3C 4.2-41, VPC3C 4.3-05, VPC3C 8.1.1-01, APC3 3.2-01, APC3 3.3-04
TEST_P(Checks, C107_Motorola_mode_swaps_the_octets_of_word_registers_only) {
    Recipe r = recipe();
    r.bus_mode = chip::BusMode::motorola;
    Bench b{r, Stage::reset};
    chip::Chip<>& chip = b.chip();
    chip.write(0x06, 0x01);
    chip.write(0x07, 0xC0);
    chip.write(0x18, 0x12);
    chip.write(0x19, 0x34);
    chip.write(0x16, 0x08);
    chip.write(0x17, 0x48);
    if (traits().mode_regs_readable) {
        EXPECT_EQ(chip.read(0x06), 0x01);
        EXPECT_EQ(chip.read(0x07), 0xC0);
    }
    chip.set_bus_mode(chip::BusMode::intel);
    if (traits().mode_regs_readable) {
        EXPECT_EQ(chip.read(0x06), 0xC0);
        EXPECT_EQ(chip.read(0x07), 0x01);
    }
    EXPECT_EQ(chip.read(0x18), 0x34);
    EXPECT_EQ(chip.read(0x19), 0x12);
    EXPECT_EQ(chip.read(0x16), 0x08);
    EXPECT_EQ(chip.read(0x17), 0x48);
}

// proves: VPC3C 4.2-25, VPC3C 4.2-41, VPC3C 4.3-04, APC3 3.2-01, APC3 3.3-04
TEST_P(Checks, C107_a_slave_works_in_Motorola_mode_as_in_Intel_mode) {
    Recipe r = recipe();
    r.bus_mode = chip::BusMode::motorola;
    Bench b{r, Stage::p2};
    EXPECT_EQ(b.ask(kDx1234), kInputs);
    EXPECT_EQ(b.irr(), irq::dx_out);
    EXPECT_EQ(b.chip().user_wd_timer(), r.user_wd - 1);
    EXPECT_EQ(text(b.take_outputs().octets), "12 34");
}

/// The interrupt C108 and C109 play with: User_Timer_Clock where the chip has it.
std::uint16_t toy_interrupt(const regmap::Traits& traits) {
    return traits.user_timer ? irq::user_timer_clock : irq::baud_rate_detect;
}

/// Online, with only that interrupt unmasked and requested right after it would have come by itself.
void raise(Bench& b, std::uint16_t interrupt) {
    const Ticks limit = b.now() + 2_ms;
    b.acknowledge();
    while (b.traits().user_timer && (b.peek(control::int_req_reg_low) & irq::user_timer_clock) == 0 && b.now() < limit)
        b.run(1_us);
    b.acknowledge();
    b.write_word(control::int_mask_reg_low, static_cast<std::uint16_t>(~interrupt));
    b.run(2_clk);
    EXPECT_FALSE(b.chip().interrupt_active());
    b.write_word(control::int_req_reg_low, interrupt);
    b.run(2_clk);
    EXPECT_EQ(b.peek_word(control::int_reg_low), interrupt);
    EXPECT_TRUE(b.chip().interrupt_active());
    EXPECT_EQ(b.chip().level(chip::Pin::x_int), chip::Level::low);
}

// proves: VPC3C 2.1-12, VPC3C 5.1.1-34, VPC3C 5.1.2-14, VPC3C 5.3-08, VPC3C 5.3-14..16, VPC3C 5.3-18,
//   VPC3C 5.3.2-07, VPC3C 10.7.1-02, VPC3C 5.1.1-11, APC3 4.1.1-09, APC3 4.1.1-18, APC3 4.1.2-04, APC3 4.3-05,
//   APC3 4.3-11..13, APC3 4.3-15, APC3 4.3-33, E047, E051
TEST_P(Checks, C108_EOI_makes_the_interrupt_inactive_for_a_microsecond) {
    Bench b{recipe(), Stage::p0};
    raise(b, toy_interrupt(traits()));
    b.write(control::mode_reg1_s, regmap::mode1::eoi);
    const Ticks eoi = b.now();
    EXPECT_FALSE(b.chip().interrupt_active());
    b.run_to(eoi + 47_clk);
    EXPECT_FALSE(b.chip().interrupt_active());
    EXPECT_EQ(b.chip().level(chip::Pin::x_int), chip::Level::high);
    b.run_to(eoi + 50_clk);
    EXPECT_TRUE(b.chip().interrupt_active()) << "still requested";
    b.acknowledge();
    b.run(2_clk);
    EXPECT_TRUE(b.chip().interrupt_active()) << "IAR alone leaves the pin active";
    b.write(control::mode_reg1_s, regmap::mode1::eoi);
    b.run(4_us);
    EXPECT_FALSE(b.chip().interrupt_active());
}

// proves: VPC3C 5.1.1-35, VPC3C 5.3-16, VPC3C 10.7.1-02, APC3 4.1.1-19, APC3 4.3-12..13, E047
TEST_P(Checks, C109_EOI_Time_Base_makes_it_a_millisecond) {
    Recipe r = recipe();
    r.mode0 |= regmap::mode0::eoi_time_base;
    Bench b{r, Stage::p0};
    raise(b, toy_interrupt(traits()));
    b.write(control::mode_reg1_s, regmap::mode1::eoi);
    const Ticks eoi = b.now();
    EXPECT_FALSE(b.chip().interrupt_active());
    b.run_to(eoi + 1_ms - 1_clk);
    EXPECT_FALSE(b.chip().interrupt_active());
    b.run_to(eoi + 1_ms + 2_clk);
    EXPECT_TRUE(b.chip().interrupt_active());
}

// proves: VPC3C 3.1-11, VPC3C 4.1-15, VPC3C 5.1.3-03
TEST_P(ChecksVpc3, C110_two_kilobytes_wrap_at_800H) {
    Bench b{recipe(), Stage::reset};
    b.write(0x7FF, 0x11);
    EXPECT_EQ(b.read(0xFFF), 0x11);
    b.write(0xFFF, 0x22);
    EXPECT_EQ(b.read(0x7FF), 0x22);
    b.write(0x840, 0x33);
    EXPECT_EQ(b.read(0x040), 0x33);
}

// proves: VPC3C 3.1-11, VPC3C 4.1-16, VPC3C 5.1.3-04
TEST_P(ChecksStepBC, C110_four_kilobytes_are_distinct_cells) {
    Bench b{recipe(), Stage::reset};
    b.write(control::mode_reg2, 0x01 | regmap::mode2::mode_4kb);
    b.write(0x7FF, 0x11);
    b.write(0xFFF, 0x22);
    b.write(0x800, 0x33);
    b.write(0x840, 0x44);
    b.write(0x040, 0x55);
    EXPECT_EQ(b.read(0x7FF), 0x11);
    EXPECT_EQ(b.read(0xFFF), 0x22);
    EXPECT_EQ(b.read(0x800), 0x33);
    EXPECT_EQ(b.read(0x840), 0x44);
    EXPECT_EQ(b.read(0x040), 0x55);
}

// proves: APC3 3.1-09..12, APC3 4.2-07..08, APC3 4.3-17, E065
TEST_P(ChecksSpc3Class, C111_an_address_beyond_the_RAM_folds_and_ends_in_Offline) {
    for (const bool write : {true, false}) {
        SCOPED_TRACE(write ? "write" : "read");
        Bench b{recipe(), Stage::p0};
        if (write) {
            b.write(0x600, 0x5A);
        } else {
            b.write(0x200, 0x5A);
            EXPECT_EQ(b.read(0x600), 0x5A);
        }
        EXPECT_EQ(b.peek(control::status_reg_low) & 0x08, 0x08);
        EXPECT_EQ(b.peek(0x200), 0x5A);
        b.run(48_clk);
        EXPECT_EQ(b.irr() & irq::mac_reset, irq::mac_reset);
        EXPECT_EQ(b.peek(control::status_reg_low) & 0x01, 0);
        EXPECT_EQ(b.ask(kFdlStatus), kSilence);
        b.start();
        EXPECT_EQ(b.peek(control::status_reg_low) & 0x09, 0x01) << "the next Start clears the violation";
    }
}

// proves: VPC3C 4.2-11..12, VPC3C 6.2.5-30, VPC3C 6.2.5-36..39, VPC3C 6.2.5-40..41, APC3 3.2-06..07,
//   APC3 5.2.5.2-02, APC3 5.2.5.2-06..07, E067
TEST_P(Checks, C112_New_Din_Buffer_Cmd_turns_the_buffers_over) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.peek(0x08), 0xE1);
    EXPECT_EQ(b.read(0x09), 0x03);
    EXPECT_EQ(b.peek(0x08), 0x39);
    EXPECT_EQ(b.read(0x09), 0x02);
    EXPECT_EQ(b.peek(0x08), 0x2D);
    EXPECT_EQ(b.read(0x09), 0x03);
    EXPECT_EQ(b.peek(0x08), 0x39);
}

}  // namespace
}  // namespace dpchip::checks
