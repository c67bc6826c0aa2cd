// SPDX-License-Identifier: Apache-2.0
// The SAP list in RAM, what a configuration may ask for, and the order of accesses (reference 5.1, 10.13).
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <dpchip/driver/dpv1.hpp>

#include "driver/dpv1_bench.hpp"
#include "driver/driver_fixture.hpp"

namespace dpchip::driver {
namespace {

using testing::Access;
using testing::FakeBus;
using testing::FakeChip;
using testing::station;
namespace irq = regmap::interrupt;

struct App : AcyclicEvents {
    RecordAnswer read(const RecordCall&, std::span<std::uint8_t> out) {
        std::fill(out.begin(), out.end(), std::uint8_t{0x55});
        return answered(2);
    }
};

Config with_dpv1() {
    Config c = station();
    c.max_diag = 32;
    c.dpv1 = {.ms1 = true, .ms1_max_data = 16, .alarm_sap = true, .connections = 2, .ms2_max_data = 16, .alarms = 0xFC, .max_alarm = 8};
    return c;
}

constexpr std::uint8_t kModule[]{0x11, 0x21};
constexpr Config kFits{.address = 8, .ident = 1, .cfg = kModule, .dpv1 = {.ms1 = true, .connections = 3}};
static_assert(lay_out_acyclic(kFits, lay_out(kFits)).error == ConfigError::none, "firmware can ask at compile time");

TEST(AcyclicLayout, BuffersDoNotOverlapAndStayInsideTheRam) {
    for (const RamSize ram : {RamSize::bytes_2048, RamSize::bytes_4096})
        for (std::uint8_t connections = 0; connections < 8; ++connections) {
            Config c = with_dpv1();
            c.ram = ram;
            c.dpv1.connections = connections;
            c.dpv1.ms2_max_data = 100;
            const Layout cyclic = lay_out(c);
            const AcyclicLayout l = lay_out_acyclic(c, cyclic);
            ASSERT_EQ(l.error, ConfigError::none);
            std::set<int> used;
            const auto take = [&](std::uint8_t segment, std::size_t octets) {
                for (std::size_t i = 0; i < octets; ++i) EXPECT_TRUE(used.insert(l.address(segment) + static_cast<int>(i)).second);
            };
            take(l.list, l.entries() * kSapEntry + 1);
            for (std::uint8_t ch = 0; ch < l.channels(); ++ch) {
                if (!l.has(ch)) continue;
                take(l.request_buffer(ch), kAcyclicHeader + l.max_pdu(ch));
                if (ch >= channel::connection0) take(l.second_buffer(ch), kAcyclicHeader + dp::kMaxAbortPdu);
                if (ch == channel::resource_manager) take(l.answer_buffer(ch), kAcyclicHeader + dp::kResourceManagerPdu);
            }
            EXPECT_GE(*used.begin(), cyclic.used_bytes);
            EXPECT_LT(*used.rbegin(), l.used_bytes);
            EXPECT_LE(l.used_bytes, bytes(ram));
        }
}

TEST(AcyclicLayout, TheRamDecidesHowManyConnectionsFit) {
    Config c = with_dpv1();
    c.dpv1.ms2_max_data = 240;
    const std::uint8_t small = connections_that_fit(c);
    EXPECT_GE(small, 4);
    c.dpv1.connections = small;
    EXPECT_EQ(lay_out_acyclic(c, lay_out(c)).error, ConfigError::none);
    c.dpv1.connections = static_cast<std::uint8_t>(small + 1);
    EXPECT_EQ(lay_out_acyclic(c, lay_out(c)).error, ConfigError::acyclic_space);
    c.ram = RamSize::bytes_4096;
    EXPECT_GE(connections_that_fit(c), 2 * small);
    c.dpv1.ms2_max_data = 16;
    EXPECT_LE(connections_that_fit(c), kMaxConnections);
}

class Refusal : public ::testing::Test {
protected:
    FakeChip chip;
    App app;
    Vpc3<FakeBus, App, 1, Dpv1<2, 4>> drv{FakeBus{&chip}, app};
    ConfigError refused(void (*change)(Config&)) {
        Config c = with_dpv1();
        change(c);
        const ConfigError e = drv.configure(c);
        EXPECT_STRNE(name(e), "no error");
        return e;
    }
};

TEST_F(Refusal, EveryRuleHasItsOwnName) {
    EXPECT_EQ(refused([](Config& c) { c.dpv1.ms1_max_data = 3; }), ConfigError::record_length);
    EXPECT_EQ(refused([](Config& c) { c.dpv1.ms2_max_data = 241; }), ConfigError::record_length);
    EXPECT_EQ(refused([](Config& c) { c.dpv1.connections = 3; }), ConfigError::connections) << "made for two";
    EXPECT_EQ(refused([](Config& c) { c.dpv1.connections = 50; }), ConfigError::connections);
    EXPECT_EQ(refused([](Config& c) { c.dpv1.max_initiate = 19; }), ConfigError::initiate_length);
    EXPECT_EQ(refused([](Config& c) { c.dpv1.max_initiate = 245; }), ConfigError::initiate_length);
    EXPECT_EQ(refused([](Config& c) { c.dpv1.max_alarm = 3; }), ConfigError::alarm_length);
    EXPECT_EQ(refused([](Config& c) { c.dpv1.max_alarm = 27; }), ConfigError::alarm_length) << "6 + 27 > max_diag";
    EXPECT_EQ(refused([](Config& c) { c.dpv1.max_alarm = 0; }), ConfigError::alarm_length);
    EXPECT_EQ(refused([](Config& c) { c.dpv1.ms1 = false; }), ConfigError::alarm_relation);
    EXPECT_EQ(refused([](Config& c) { c.dpv1.alarm_sequence = 33; }), ConfigError::alarm_relation);
    EXPECT_EQ(refused([](Config& c) { c.variant = Variant::apc3, c.ram = RamSize::bytes_1536; }), ConfigError::not_in_this_chip);
    EXPECT_EQ(refused([](Config& c) { c.max_inputs = c.max_outputs = 244; c.dpv1.ms1_max_data = 240; c.max_diag = 100; }),
              ConfigError::acyclic_space);
    Events events;
    Vpc3<FakeBus> without{FakeBus{&chip}, events};
    EXPECT_EQ(without.configure(with_dpv1()), ConfigError::no_dpv1);
    EXPECT_STRNE(name(ConfigError::no_dpv1), "no error");
}

// proves: VPC3C 7.2.1-01, VPC3C 7.2.1-03, VPC3C 7.2.1-04
// proves: VPC3C 7.2.1-10, VPC3C 7.2.1-11, VPC3C 7.2.1-13, VPC3C 7.2.1-17, VPC3C 7.2.1-19, VPC3C 4.1-11
TEST_F(Refusal, TheListIsWrittenBeforeStartLockedExceptForTheResourceManager) {
    ASSERT_EQ(drv.configure(with_dpv1()), ConfigError::none);
    ASSERT_TRUE(drv.start());
    const std::uint16_t list = static_cast<std::uint16_t>(chip.ram[org::sap_list_ptr] * 8);
    const std::uint8_t expected[5][4]{{51, 8, 0, 0x0B}, {50, 8, 0, 0x0B}, {49, 0x7F, 0x7F, 0x0B}, {48, 8, 0, 0x0B}, {47, 8, 0, 0x0B}};
    for (std::size_t i = 0; i < 5; ++i)
        for (std::size_t o = 0; o < 4; ++o) EXPECT_EQ(chip.ram[list + 7 * i + o], expected[i][o]) << i << ' ' << o;
    EXPECT_EQ(chip.ram[list + 35], 0xFF);
    const std::uint16_t rm = static_cast<std::uint16_t>(chip.ram[list + 14 + 6] * 8);
    EXPECT_EQ(chip.ram[rm], 0xA0);
    EXPECT_EQ(chip.ram[rm + 2], 4);
    EXPECT_EQ(chip.ram[rm + 3], 0x08);
    EXPECT_EQ(chip.ram[rm + 4], 0x56);
    EXPECT_EQ(chip.ram[rm + 5], 48);
    EXPECT_EQ(core::word(chip.ram[rm + 6], chip.ram[rm + 7]), 0x190) << "the rate is not known yet";
    const auto start = std::find(chip.log.begin(), chip.log.end(), Access{'w', ctl::mode_reg1_s, regmap::mode1::start_vpc3});
    const auto end_mark = std::find(chip.log.begin(), chip.log.end(), Access{'w', static_cast<std::uint16_t>(list + 35), 0xFF});
    EXPECT_LT(end_mark - chip.log.begin(), start - chip.log.begin());
}

// proves: VPC3C 7.2.1-47..49, VPC3C 7.2.1-53
TEST_F(Refusal, InterruptsAreAcknowledgedFirstAndTheControlOctetIsWrittenLast) {
    ASSERT_EQ(drv.configure(with_dpv1()), ConfigError::none);
    ASSERT_TRUE(drv.start());
    const std::uint16_t list = static_cast<std::uint16_t>(chip.ram[org::sap_list_ptr] * 8);
    const std::uint16_t buffer = static_cast<std::uint16_t>(chip.ram[list + 4] * 8);
    chip.value[0x04] = 0x21;                                                  // DATA-EXCH
    for (const std::uint8_t d : drv.layout().diag) chip.ram[drv.layout().address(d) + 3] = 2;
    const std::uint8_t prm[]{0x88, 2, 5, 11, 0x47, 0x11, 0, 0x80, 0, 0};
    FakeBus{&chip}.write_block(drv.layout().address(chip.ram[org::r_prm_buf_ptr]), prm);
    chip.ram[org::r_len_prm_data] = sizeof prm;
    chip.request(irq::new_prm_data);
    drv.on_interrupt();
    chip.request(irq::go_leave_data_exch);
    drv.on_interrupt();
    ASSERT_TRUE(drv.dpv1().ms1_open());
    EXPECT_EQ(chip.ram[list + 1], 0x82);
    EXPECT_EQ(chip.ram[list + 2], 0x33);

    const std::uint8_t request[]{0xC0, 20, 4, 0x0D, 0x5E, 1, 2, 8};
    FakeBus{&chip}.write_block(buffer, request);
    chip.ram[list + 3 * 7] |= 0x80;                                           // another answer has been sent meanwhile
    chip.log.clear();
    chip.request(irq::fdl_ind | irq::poll_end_ind);
    drv.on_interrupt();
    const auto at = [&](const Access& a) { return std::find(chip.log.begin(), chip.log.end(), a) - chip.log.begin(); };
    const auto acknowledged = at({'w', ctl::int_ack_reg_high, 0xC0}), poll_end = at({'w', static_cast<std::uint16_t>(list + 21), 48}),
               taken = at({'w', buffer, 0x80}), ready = at({'w', buffer, 0xA0});
    EXPECT_LT(acknowledged, poll_end);
    EXPECT_LT(poll_end, taken) << "Poll_End_Ind before FDL_Ind";
    EXPECT_LT(taken, ready);
    for (auto i = static_cast<std::size_t>(ready) + 1; i < chip.log.size(); ++i)
        EXPECT_FALSE(chip.log[i].kind == 'w' && chip.log[i].address >= buffer && chip.log[i].address < buffer + 24) << "A0H is last";
    const std::uint8_t answer[]{0xA0, 20, 6, 0x08, 0x5E, 1, 2, 2, 0x55, 0x55};
    for (std::size_t i = 0; i < sizeof answer; ++i) EXPECT_EQ(chip.ram[buffer + i], answer[i]) << i;
}

TEST(AcyclicLayout, ADriverMadeForDpv1ServesAStationWithoutItOnAnyChip) {
    for (const Variant variant : {Variant::vpc3a, Variant::vpc3c, Variant::apc3, Variant::spc3}) {
        Config c = station();
        c.variant = variant;
        c.ram = variant == Variant::vpc3a || variant == Variant::vpc3c ? RamSize::bytes_2048 : RamSize::bytes_1536;
        FakeChip chip;
        App app;
        Vpc3<FakeBus, App, 1, Dpv1<0, 1>> drv{FakeBus{&chip}, app};
        ASSERT_EQ(drv.configure(c), ConfigError::none);
        EXPECT_EQ(drv.dpv1().layout().used_bytes, drv.layout().used_bytes);
        ASSERT_TRUE(drv.start());
        EXPECT_EQ(chip.ram[chip.ram[org::sap_list_ptr] * 8u], 0xFF);
        drv.tick(100000);
        chip.request(irq::fdl_ind | irq::poll_end_ind);
        drv.on_interrupt();
        EXPECT_FALSE(drv.complete(Handle{48, 0}, answered()));
        EXPECT_FALSE(drv.complete(Handle{51, 0}, answered()));
        EXPECT_FALSE(drv.abort_connection(48, 0));
        EXPECT_EQ(drv.raise({.type = 1}).result, AlarmResult::too_long);
        c.dpv1.ms1 = true;
        EXPECT_EQ(drv.configure(c), regmap::traits(variant).dpv1 ? ConfigError::none : ConfigError::not_in_this_chip);
    }
}

TEST(AcyclicAddress, LockedSapsFollowASetSlaveAddress) {
    testing::Dpv1Bench t;
    Config c = t.dpv1_config();
    c.set_slave_add = true;
    t.power_up(c);
    t.request(55, {20, 0x47, 0x11, 0});
    t.slave = 20;
    t.wait_ms(1);
    EXPECT_EQ(t.drv.address(), 20);
    const std::uint16_t entry = t.drv.dpv1().layout().entry(channel::ms1);
    EXPECT_EQ(t.chip.peek(static_cast<std::uint16_t>(entry + 1)), 20);
    EXPECT_EQ(t.ms1({0x5E, 1, 1, 4}), testing::Octets{testing::kRs});
    EXPECT_EQ(t.open(), 48);
    t.master_starts();
    EXPECT_EQ(t.ms1({0x5E, 1, 1, 4})[0], 0xDE);
}

}  // namespace
}  // namespace dpchip::driver
