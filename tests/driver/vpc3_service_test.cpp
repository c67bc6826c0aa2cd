// SPDX-License-Identifier: Apache-2.0
// The driver against scripted registers: its decisions, its data, its queue of diagnoses.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "driver/driver_fixture.hpp"

namespace dpchip::driver {
namespace {

using testing::Access;
using testing::FakeBus;
using testing::FakeChip;
using testing::station;
using App = testing::ListeningApp;
using Driver = testing::DriverFixture;
namespace irq = regmap::interrupt;

TEST_F(Driver, JudgesSetPrmByItsRulesAndThenAsksTheApplication) {
    static constexpr PrmConstant constants[]{{0, 0xFF, 0x00}};
    static constexpr PrmValue values[]{{.offset = 1, .octets = 1, .min = 1, .max = 3}};
    Config c = station();
    c.prm_rules = {2, 2, constants, values};
    bring_up(c);
    const auto given = [&](const std::vector<std::uint8_t>& octets) {
        chip.log.clear();
        prm_arrives(octets);
        drv.poll();
        return acknowledgements();
    };
    const std::vector<int> okay{0x0E}, not_okay{0x0F};
    EXPECT_EQ(given({0x88, 2, 5, 11, 0x47, 0x11, 0, 0x00, 2}), okay);
    EXPECT_EQ(given({0x88, 2, 5, 11, 0x47, 0x11, 0, 0x00}), not_okay) << "too short";
    EXPECT_EQ(given({0x88, 2, 5, 11, 0x47, 0x11, 0, 0x00, 2, 2}), not_okay) << "too long";
    EXPECT_EQ(given({0x88, 2, 5, 11, 0x47, 0x11, 0, 0x01, 2}), not_okay) << "constant";
    EXPECT_EQ(given({0x88, 2, 5, 11, 0x47, 0x11, 0, 0x00, 4}), not_okay) << "range";
    EXPECT_EQ(app.prms.size(), 1u);
    app.prm = Verdict::refuse;
    EXPECT_EQ(given({0x88, 2, 5, 11, 0x47, 0x11, 0, 0x00, 2}), not_okay) << "application";
    EXPECT_EQ(std::count(app.heard.begin(), app.heard.end(), "prm_refused"), 4);
    for (const Access& a : chip.registers('w'))
        if (a.address == 0x03) { EXPECT_EQ(a.value & 0x0C, 0) << "Prm and Cfg are not the IAR's"; }
}

TEST_F(Driver, JudgesAgainAfterAPrmConflict) {
    bring_up(station());
    prm_arrives({0x88, 2, 5, 11, 0x47, 0x11, 0, 0xAA});
    chip.answers[0x0E] = {0x01, 0x00};
    chip.request(irq::new_prm_data);
    drv.poll();
    EXPECT_EQ(acknowledgements(), (std::vector<int>{0x0E, 0x0E}));
    EXPECT_EQ(app.prms.size(), 2u);
}

TEST_F(Driver, APrmConflictMayBringTheOtherService) {
    Config c = station();
    c.set_ext_prm = true;
    bring_up(c);
    prm_arrives({0x88, 2, 5, 11, 0x47, 0x11, 0, 0xAA});
    chip.answers[0x0E] = {0x01, 0x00};
    chip.request(irq::new_ext_prm_data);
    drv.poll();
    EXPECT_EQ(app.prms.size(), 1u);
    EXPECT_EQ(app.heard, (std::vector<std::string>{"set_ext_prm"}));
}

TEST_F(Driver, JudgesNoMoreThanAFewConflictsInOneCall) {
    bring_up(station());
    prm_arrives({0x88, 2, 5, 11, 0x47, 0x11, 0, 0xAA});
    chip.value[0x0E] = 0x01;
    for (int i = 0; i < 20; ++i) chip.request(irq::new_prm_data);
    drv.poll();
    EXPECT_LE(acknowledgements().size(), 4u);
}

// proves: VPC3C 6.2.3-01
TEST_F(Driver, ChkCfgMustEqualThePluggedModules) {
    bring_up(station());
    chip.value[0x04] = 0x11;
    cfg_arrives({0x11, 0x21});
    drv.poll();
    EXPECT_EQ(acknowledgements(), std::vector<int>{0x10});
    chip.log.clear();
    cfg_arrives({0x11, 0x22});
    drv.poll();
    EXPECT_EQ(acknowledgements(), std::vector<int>{0x11});
    EXPECT_EQ(app.heard, std::vector<std::string>{"cfg_refused"});
    chip.log.clear();
    app.cfg = Verdict::refuse;
    cfg_arrives({0x11, 0x21});
    drv.poll();
    EXPECT_EQ(acknowledgements(), std::vector<int>{0x11});
}

TEST_F(Driver, JudgesAgainAfterACfgConflict) {
    bring_up(station());
    cfg_arrives({0x11, 0x21});
    chip.answers[0x10] = {0x01, 0x00};
    drv.poll();
    EXPECT_EQ(acknowledgements(), (std::vector<int>{0x10, 0x10}));
}

TEST_F(Driver, PrmIsAnsweredBeforeCfg) {
    bring_up(station());
    put(drv.layout().prm, {0x88, 2, 5, 11, 0x47, 0x11, 0, 0});
    chip.ram[org::r_len_prm_data] = 8;
    put(drv.layout().cfg, {0x11, 0x21});
    chip.ram[org::r_len_cfg_data] = 2;
    chip.request(irq::new_cfg_data | irq::new_prm_data);
    drv.poll();
    EXPECT_EQ(acknowledgements(), (std::vector<int>{0x0E, 0x10}));
}

TEST_F(Driver, AMissingUserPrmIsNoticedAtChkCfg) {
    Config c = station();
    c.prm_rules.min_octets = 3;
    bring_up(c);
    cfg_arrives({0x11, 0x21});
    drv.poll();
    EXPECT_EQ(acknowledgements(), std::vector<int>{0x11});
    chip.log.clear();
    prm_arrives({0x88, 2, 5, 11, 0x47, 0x11, 0, 0, 0, 0});
    drv.poll();
    cfg_arrives({0x11, 0x21});
    drv.poll();
    EXPECT_EQ(acknowledgements(), (std::vector<int>{0x0E, 0x10}));
}

TEST_F(Driver, FollowsTheMasterWhenToldTo) {
    Config c = station();
    c.cfg_policy = CfgPolicy::follow_master;
    c.max_inputs = 4;
    c.max_outputs = 8;
    c.max_cfg = 6;
    bring_up(c);
    for (const std::uint8_t s : drv.layout().dout) put(s, {9, 9, 9, 9, 9, 9, 9, 9});
    cfg_arrives({0x10, 0x27});
    drv.poll();
    EXPECT_EQ(acknowledgements(), std::vector<int>{0x10});
    EXPECT_EQ(drv.inputs(), 1);
    EXPECT_EQ(drv.outputs(), 8);
    EXPECT_EQ(chip.ram[org::r_len_din_buf], 1);
    EXPECT_EQ(chip.ram[org::r_len_dout_buf], 8);
    EXPECT_EQ(chip.ram[org::r_len_read_cfg_data], 2);
    EXPECT_EQ(chip.ram[drv.layout().address(drv.layout().read_cfg) + 1u], 0x27);
    const unsigned dout = drv.layout().address(drv.layout().dout[0]);
    EXPECT_EQ(chip.ram[dout + 1], 9) << "old octets stay";
    for (unsigned i = 2; i < 8; ++i) EXPECT_EQ(chip.ram[dout + i], 0) << "gained octets are cleared";
    // In DATA-EXCH only the same again.
    chip.value[0x04] = 0x21;
    chip.log.clear();
    cfg_arrives({0x10, 0x27});
    drv.poll();
    EXPECT_EQ(acknowledgements(), std::vector<int>{0x10});
    chip.log.clear();
    cfg_arrives({0x11, 0x21});
    drv.poll();
    EXPECT_EQ(acknowledgements(), std::vector<int>{0x11});
    // Too long for the buffers, damaged, or a wildcard: refused.
    chip.value[0x04] = 0x11;
    for (const auto& bad : std::vector<std::vector<std::uint8_t>>{{0x17}, {0x40}, {0x0F}, {0x70, 0x70, 0x70}, {}}) {
        chip.log.clear();
        cfg_arrives(bad);
        drv.poll();
        EXPECT_EQ(acknowledgements(), std::vector<int>{0x11});
    }
    // And back to the plugged one.
    chip.log.clear();
    cfg_arrives({0x11, 0x21});
    drv.poll();
    EXPECT_EQ(acknowledgements(), std::vector<int>{0x10});
    EXPECT_EQ(drv.inputs(), 2);
    EXPECT_EQ(drv.outputs(), 2);
}

TEST_F(Driver, FetchesOutputsOnlyWhenTheChipHasNewOnes) {
    bring_up(station());
    std::vector<std::uint8_t> out(2, 0xEE);
    chip.answers[0x0B] = {0x02};
    EXPECT_EQ(drv.fetch_outputs(out), Outputs::unchanged);
    EXPECT_EQ(chip.log.size(), 1u);
    EXPECT_EQ(out[0], 0xEE);
    put(drv.layout().dout[2], {0x12, 0x34});
    chip.answers[0x0B] = {0x07};
    EXPECT_EQ(drv.fetch_outputs(out), Outputs::fresh);
    EXPECT_EQ(out, (std::vector<std::uint8_t>{0x12, 0x34}));
    put(drv.layout().dout[0], {0, 0});
    chip.answers[0x0B] = {0x0D};
    EXPECT_EQ(drv.fetch_outputs(out), Outputs::cleared);
    EXPECT_EQ(out, (std::vector<std::uint8_t>{0, 0}));
    std::vector<std::uint8_t> one(1);
    chip.answers[0x0B] = {0x07};
    EXPECT_EQ(drv.fetch_outputs(one), Outputs::fresh);
    EXPECT_EQ(one[0], 0x12);
}

TEST_F(Driver, WritesInputsIntoTheUsersBufferAndFollowsTheExchange) {
    bring_up(station());
    const auto din = [&](int n) { return drv.layout().address(drv.layout().din[static_cast<std::size_t>(n - 1)]); };
    chip.answers[0x09] = {0x03, 0x01};
    const std::uint8_t in[]{0xAB, 0xCD, 0xEF};
    drv.write_inputs(in);  // E1H: the user owns buffer 2
    EXPECT_EQ(chip.ram[din(2)], 0xAB);
    EXPECT_EQ(chip.ram[din(2) + 1u], 0xCD);
    EXPECT_EQ(chip.ram[din(2) + 2u], 0) << "what is too much is dropped";
    chip.ram[din(3) + 1u] = 0x77;
    drv.write_inputs(std::span{in, 1});
    EXPECT_EQ(chip.ram[din(3)], 0xAB);
    EXPECT_EQ(chip.ram[din(3) + 1u], 0) << "what lacks is zero";
}

TEST_F(Driver, DiagnosisGoesIntoTheUsersBuffer) {
    bring_up(station());
    const std::uint8_t ext[]{0x03, 0xAA, 0x55};
    EXPECT_EQ(drv.set_diagnosis(ext, {.ext_diag = true}), DiagResult::handed_over);
    const unsigned buffer = drv.layout().address(drv.layout().diag[0]);
    EXPECT_EQ(chip.ram[buffer], 0x01);
    EXPECT_EQ(chip.ram[buffer + 6], 0x03);
    EXPECT_EQ(chip.ram[buffer + 8], 0x55);
    EXPECT_EQ(chip.ram[org::r_len_diag_buf1], 9);
    EXPECT_EQ(chip.registers('r').back().address, 0x0D);
    chip.value[0x0C] = 0x06;  // now buffer 2 is the user's
    EXPECT_EQ(drv.set_diagnosis({}, {.stat_diag = true, .ext_diag_overflow = true}), DiagResult::handed_over);
    EXPECT_EQ(chip.ram[drv.layout().address(drv.layout().diag[1])], 0x06);
    EXPECT_EQ(chip.ram[org::r_len_diag_buf2], 6);
    const std::vector<std::uint8_t> long_one(15);
    EXPECT_EQ(drv.set_diagnosis(long_one), DiagResult::too_long);
}

TEST_F(Driver, DiagnosisWaitsForABufferAndTheLatestIsNeverLost) {
    bring_up(station());
    chip.value[0x0C] = 0x0E;  // no user buffer: one is being sent
    const auto say = [&](std::uint8_t what) { return drv.set_diagnosis(std::span{&what, 1}, {.ext_diag = true}); };
    EXPECT_EQ(say(1), DiagResult::queued);
    EXPECT_EQ(say(2), DiagResult::replaced);
    EXPECT_EQ(say(3), DiagResult::replaced);
    drv.poll();
    EXPECT_EQ(chip.ram[drv.layout().address(drv.layout().diag[0]) + 6u], 0);
    chip.value[0x0C] = 0x09;
    chip.request(irq::diag_buffer_changed);
    drv.poll();
    EXPECT_EQ(chip.ram[drv.layout().address(drv.layout().diag[0]) + 6u], 3);
    EXPECT_EQ(app.heard, std::vector<std::string>{"diag"});
}

TEST(DriverQueue, EachDiagnosisWaitsUntilTheOneBeforeIsFetched) {
    FakeChip chip;
    App app;
    Vpc3<FakeBus, App, 3> drv{FakeBus{&chip}, app};
    Config c = station();
    c.diag_delivery = DiagDelivery::each;
    c.service = Service::polled;
    ASSERT_EQ(drv.configure(c), ConfigError::none);
    ASSERT_TRUE(drv.start());
    const auto say = [&](std::uint8_t what) { return drv.set_diagnosis(std::span{&what, 1}, {.ext_diag = true}); };
    EXPECT_EQ(say(1), DiagResult::handed_over);
    chip.value[0x04] = 0x25;  // Diag_Flag
    EXPECT_EQ(say(2), DiagResult::queued);
    EXPECT_EQ(say(3), DiagResult::queued);
    EXPECT_EQ(say(4), DiagResult::queued);
    EXPECT_EQ(say(5), DiagResult::replaced);
    const unsigned first = drv.layout().address(drv.layout().diag[0]) + 6u;
    std::vector<int> seen;
    for (int i = 0; i < 4; ++i) {
        chip.answers[0x04] = {0x21};  // fetched once
        drv.poll();
        seen.push_back(chip.ram[first]);
    }
    EXPECT_EQ(seen, (std::vector<int>{2, 3, 5, 5}));
}

TEST_F(Driver, AnAddressChangeIsTakenOverAndTheBufferFreed) {
    Config c = station();
    c.set_slave_add = true;
    bring_up(c);
    put(drv.layout().ssa, {0x09, 0x47, 0x11, 0x00});
    chip.ram[org::r_len_ssa_data] = 4;
    chip.request(irq::new_ssa_data);
    drv.poll();
    EXPECT_EQ(app.heard, std::vector<std::string>{"ssa 9"});
    EXPECT_EQ(drv.address(), 9);
    EXPECT_EQ(chip.registers('r').back().address, 0x14);
}

TEST_F(Driver, GoesOfflineAndComesBackWithItsDiagnosis) {
    bring_up(station());
    const std::uint8_t ext[]{0x02, 0x77};
    drv.set_diagnosis(ext, {.ext_diag = true});
    drv.restart();
    EXPECT_EQ(drv.state(), State::going_offline);
    drv.poll();
    EXPECT_EQ(drv.state(), State::going_offline) << "the status still says Passive_Idle";
    chip.value[0x04] = 0x00;
    chip.ram[drv.layout().address(drv.layout().diag[0]) + 7u] = 0;
    chip.log.clear();
    drv.poll();
    EXPECT_EQ(drv.state(), State::online);
    EXPECT_EQ(app.heard, std::vector<std::string>{"offline"});
    EXPECT_EQ(chip.ram[drv.layout().address(drv.layout().diag[0]) + 7u], 0x77);
    // A MAC_Reset of then, seen only now, changes nothing.
    chip.value[0x04] = 0x01;
    chip.request(irq::mac_reset);
    drv.poll();
    EXPECT_EQ(drv.state(), State::online);
    drv.go_offline();
    chip.value[0x04] = 0x00;
    chip.request(irq::mac_reset);
    drv.poll();
    EXPECT_EQ(drv.state(), State::offline);
    EXPECT_EQ(drv.poll(), 0);
    EXPECT_TRUE(drv.start());
}

TEST_F(Driver, EverythingElseIsToldToTheApplication) {
    Config c = station();
    c.user_timer = UserTimer::ms_1;
    bring_up(c);
    chip.value[0x04] = 0x21;
    chip.value[0x05] = 0xC3;
    chip.request(irq::go_leave_data_exch | irq::baud_rate_detect | irq::wd_dp_control_timeout | irq::user_timer_clock);
    drv.poll();
    EXPECT_EQ(app.heard, (std::vector<std::string>{"entered", "wd", "baud 3", "timer"}));
    chip.value[0x04] = 0x01;
    chip.request(irq::go_leave_data_exch);
    drv.poll();
    EXPECT_EQ(app.heard.back(), "left");
    EXPECT_EQ(drv.dp_state(), 0);
    drv.leave_master();
    EXPECT_EQ(chip.log.back(), (Access{'w', 0x08, 0x08}));
}

TEST(DriverUnconfigured, DoesNothing) {
    FakeChip chip;
    App app;
    Vpc3<FakeBus, App> drv{FakeBus{&chip}, app};
    std::uint8_t octet = 0;
    EXPECT_EQ(drv.poll(), 0);
    EXPECT_EQ(drv.on_interrupt(), 0);
    EXPECT_EQ(drv.fetch_outputs({&octet, 1}), Outputs::unchanged);
    EXPECT_EQ(drv.set_diagnosis({}), DiagResult::not_ready);
    drv.write_inputs({&octet, 1});
    drv.go_offline();
    drv.restart();
    drv.leave_master();
    EXPECT_FALSE(drv.start());
    EXPECT_TRUE(chip.log.empty());
}

}  // namespace
}  // namespace dpchip::driver
