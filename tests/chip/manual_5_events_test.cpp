// SPDX-License-Identifier: Apache-2.0
// What the manuals say about interrupts and watchdog: VPC3+C 5.3, 5.4; APC3 4.3, 4.4.
#include "checks.hpp"

#include <algorithm>

namespace dpchip::checks {
namespace {

Octets prm(std::uint8_t status, std::uint8_t factor1, std::uint8_t factor2, const Octets& rest = {}) {
    Octets data{status, factor1, factor2, 0x0B, 0x47, 0x11, 0x00};
    for (const std::uint8_t octet : rest) data.push_back(octet);
    return data;
}

// proves: VPC3C 5.3-01..06, VPC3C 5.3-08, VPC3C 5.3.2-01, VPC3C 5.3.2-04..05, APC3 4.3-01..03, APC3 4.3-05, APC3 4.3-32
TEST_P(Checks, manual_5_3_each_event_has_its_own_bit_in_every_register_and_one_pin_serves_all) {
    for (unsigned bit = 0; bit < 16; ++bit) {
        const std::uint16_t one = static_cast<std::uint16_t>(1u << bit);
        Bench b{recipe(), Stage::reset};
        b.write_word(control::int_mask_reg_low, static_cast<std::uint16_t>(~one));
        b.write_word(control::int_req_reg_low, static_cast<std::uint16_t>(~one));
        b.run(2_clk);
        EXPECT_EQ(b.peek_word(control::int_reg_low), 0) << bit;
        EXPECT_FALSE(b.chip().interrupt_active());
        b.write_word(control::int_req_reg_low, one);
        b.run(2_clk);
        EXPECT_EQ(b.peek_word(control::int_req_reg_low), traits().interrupts) << bit;
        EXPECT_EQ(b.peek_word(control::int_reg_low), one & traits().interrupts) << bit;
        EXPECT_EQ(b.chip().interrupt_active(), (one & traits().interrupts) != 0);
    }
}

// proves: VPC3C 5.3-10..11, VPC3C 5.3.2-06..11, APC3 4.3-07, APC3 4.3-33..34
TEST_P(Checks, manual_5_3_2_the_IAR_clears_the_bits_written_as_1_but_no_New_Prm_Ext_Prm_or_Cfg) {
    const std::uint16_t all = traits().interrupts;
    for (unsigned bit = 0; bit < 16; ++bit) {
        const std::uint16_t one = static_cast<std::uint16_t>(1u << bit);
        const bool protects = bit == 10 || bit == 11 || (bit == 6 && traits().ext_prm);
        Bench b{recipe(), Stage::reset};
        b.write_word(control::int_req_reg_low, 0xFFFF);
        b.acknowledge(0x0000);
        EXPECT_EQ(b.peek_word(control::int_req_reg_low), all);
        b.acknowledge(one);
        EXPECT_EQ(b.peek_word(control::int_req_reg_low), protects ? all : all & ~one) << bit;
        b.write_word(control::int_req_reg_low, one);
        EXPECT_EQ(b.peek_word(control::int_req_reg_low), all) << "the IAR keeps nothing";
    }
}

// proves: VPC3C 5.3-12, APC3 4.3-09
TEST_P(Checks, manual_5_3_an_event_that_comes_with_the_acknowledgement_of_the_previous_one_stays) {
    Bench b{recipe(), Stage::p1};
    b.write_word(control::int_req_reg_low, irq::wd_dp_control_timeout);
    b.acknowledge(irq::wd_dp_control_timeout);
    auto before = b.chip();
    const Ticks limit = b.now() + 200_ms;
    while ((b.irr() & irq::wd_dp_control_timeout) == 0 && b.now() < limit) {
        before = b.chip();
        b.run_to(b.chip().next());
    }
    ASSERT_LT(b.now(), limit);
    before.write(control::int_req_reg_low, static_cast<std::uint8_t>(irq::wd_dp_control_timeout));
    before.advance(b.now());
    before.write(control::int_ack_reg_low, static_cast<std::uint8_t>(irq::wd_dp_control_timeout));
    EXPECT_EQ(before.peek(control::int_req_reg_low) & irq::wd_dp_control_timeout, irq::wd_dp_control_timeout);
    before.advance(b.now() + 1_us);
    before.write(control::int_ack_reg_low, static_cast<std::uint8_t>(irq::wd_dp_control_timeout));
    EXPECT_EQ(before.peek(control::int_req_reg_low) & irq::wd_dp_control_timeout, 0);
}

// proves: VPC3C 5.3.2-11..12, VPC3C 6.2.3-06..07, APC3 4.3-34, APC3 5.2.3-06, E049
TEST_P(Checks, manual_6_2_3_only_an_acknowledgement_clears_New_Cfg_Data) {
    Bench b{recipe(), Stage::p1};
    EXPECT_EQ(b.ask(kCfg), kSc);
    b.acknowledge();
    EXPECT_EQ(b.irr(), irq::new_cfg_data);
    b.read(control::user_cfg_data_okay);
    EXPECT_EQ(b.irr() & irq::new_cfg_data, 0);
}

// proves: VPC3C 5.3.2-10, VPC3C 5.3.1-03
TEST_P(ChecksStepBC, manual_5_3_2_only_an_acknowledgement_clears_New_Ext_Prm_Data) {
    Recipe r = recipe();
    r.mode0 |= regmap::mode0::set_ext_prm_supported;
    Bench b{r, Stage::p1};
    EXPECT_EQ(b.ask("68 0A 0A 68 88 82 7D 35 3E 05 81 00 00 AA 2A 16"), kSc);
    b.acknowledge();
    EXPECT_EQ(b.irr(), irq::new_ext_prm_data);
    EXPECT_EQ(b.read(control::user_prm_data_okay), 0);
    EXPECT_EQ(b.irr(), 0);
}

// proves: VPC3C 5.4-07, APC3 4.4.2-05
TEST_P(Checks, manual_5_4_Set_Prm_without_WD_On_leaves_DP_CONTROL) {
    Bench b{recipe(), Stage::p1};
    EXPECT_EQ(b.wd_state(), kDpControl);
    EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x3D, prm(0x80, 1, 1))), kSc);
    EXPECT_EQ(b.wd_state(), kBaudControl);
    EXPECT_EQ(b.dp_state(), kWaitCfg);
}

// proves: VPC3C 5.4.3-09..10, APC3 4.4.3-07..08
TEST_P(Checks, manual_5_4_3_another_master_brings_its_own_watchdog) {
    for (const bool watchdog : {false, true}) {
        Bench b{recipe(), Stage::p1};
        EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x3D, prm(0x40, 1, 1))), kSc);
        EXPECT_EQ(b.dp_state(), kWaitPrm);
        EXPECT_EQ(b.ask(b.request(3, 0x5D, 0x3D, prm(watchdog ? 0x88 : 0x80, 10, 10))), kSc);
        EXPECT_EQ(b.wd_state(), watchdog ? kDpControl : kBaudControl);
        EXPECT_EQ(b.chip().owner(), 3);
    }
}

// proves: VPC3C 5.4.1-04..05, VPC3C 5.4.1-02, E030
TEST_P(Checks, manual_5_4_1_SD2_and_SD3_telegrams_to_anybody_prove_the_rate) {
    for (const std::string_view telegram : {"68 05 05 68 89 82 6D 3C 3E F2 16", "A2 89 82 7D 3E 3E 10 10 20 20 11 21 96 16"}) {
        Bench b{recipe(), Stage::searching};
        b.acknowledge();
        const Ticks limit = b.now() + 1_s;
        while (b.wd_state() == kBaudSearch && b.now() < limit) {
            b.tell(telegram);
            b.run(4_clk);
        }
        EXPECT_EQ(b.wd_state(), kBaudControl);
        EXPECT_EQ(b.irr(), irq::baud_rate_detect);
    }
}

// proves: VPC3C 5.4.1-08, VPC3C 5.4.2-01, APC3 4.4.1-04, APC3 4.4.2-01
TEST_P(Checks, manual_5_4_2_only_telegrams_to_the_own_address_restart_BAUD_CONTROL) {
    for (const bool own : {false, true}) {
        Recipe r = recipe();
        r.baud_control = 2;
        Bench b{r, Stage::p0};
        for (int i = 0; i < 10; ++i) {
            b.run(15_ms);
            b.tell(own ? "10 08 02 49 53 16" : "10 09 02 49 54 16");
            if (own) {
                EXPECT_EQ(b.listen_text(), kFdlStatusOk);
            }
            if (b.wd_state() == kBaudSearch) break;
        }
        EXPECT_EQ(b.wd_state(), own ? kBaudControl : kBaudSearch);
    }
}

// proves: VPC3C 5.4.3-04, E011
TEST_P(Checks, manual_5_4_3_both_factors_may_be_1) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x3D, prm(0x88, 1, 1))), kSc);
    EXPECT_EQ(b.wd_state(), kDpControl);
    b.run(11_ms);
    EXPECT_EQ(b.wd_state(), kBaudControl);
    EXPECT_EQ(b.irr() & irq::wd_dp_control_timeout, irq::wd_dp_control_timeout);
}

// proves: VPC3C 5.4.3-02..03, VPC3C 5.4.3-05, APC3 4.4.3-02, APC3 4.4.3-04, E011
TEST_P(Checks, manual_5_4_3_the_monitoring_time_reaches_from_1_ms_to_650_s) {
    struct { std::uint8_t base, f1, f2; Ticks kept, over; } const rows[]{
        {0x04, 1, 1, 0_ms, 2_ms}, {0x04, 2, 1, 500_us, 3_ms}, {0x04, 255, 255, 65020_ms, 65030_ms}, {0x00, 255, 255, 650_s, 651_s}};
    for (const auto& row : rows) {
        Recipe r = recipe();
        r.baud_control = 255;
        Bench b{r, Stage::p0};
        EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x3D, prm(0x88, row.f1, row.f2, {row.base}))), kSc);
        const Ticks begin = b.request_end();
        b.run_to(begin + std::max(row.kept, b.now() - begin));
        if (row.kept > 0_ms) {
            EXPECT_EQ(b.wd_state(), kDpControl);
        }
        b.run_to(begin + row.over);
        EXPECT_EQ(b.wd_state(), kBaudControl);
    }
}

TEST_P(ChecksVpc3, a_tick_of_the_user_timer_survives_an_acknowledgement_in_the_same_CLK) {
    Bench b{recipe(), Stage::searching};
    const Ticks tick = b.chip().state().user_clock_due;
    for (const std::int64_t n : {0, 1}) {  // the first tick, and one that comes while the event is pending
        b.run_to(tick + 1_ms * n);
        b.write(control::int_ack_reg_low, 0x10);
        EXPECT_EQ(b.peek(control::int_req_reg_low) & 0x10, 0x10) << n;
    }
    b.run(2_clk);
    b.write(control::int_ack_reg_low, 0x10);
    EXPECT_EQ(b.peek(control::int_req_reg_low) & 0x10, 0);
}

}  // namespace
}  // namespace dpchip::checks
