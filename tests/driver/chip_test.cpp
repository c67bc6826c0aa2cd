// SPDX-License-Identifier: Apache-2.0
// The driver on the model of the chip: power-up to data exchange and everything that may happen on the way, for all
// variants, with the interrupt pin and without (reference 3, 8, 10).
#include <gtest/gtest.h>

#include <string>

#include "driver/on_the_chip.hpp"

namespace dpchip::driver {
namespace {

using testing::kKinds;
using testing::Kind;
using testing::Octets;
using testing::OnTheChip;

class DriverOnTheChip : public ::testing::TestWithParam<Kind> {
protected:
    OnTheChip t{GetParam()};
    bool has(bool regmap::Traits::* feature) const { return regmap::traits(GetParam().variant).*feature; }
};

INSTANTIATE_TEST_SUITE_P(AllChips, DriverOnTheChip, ::testing::ValuesIn(kKinds),
                         [](const auto& param) { return std::string{param.param.name}; });

TEST_P(DriverOnTheChip, ComesUpAndRepeatsOutputsAsInputs) {
    t.to_data_exch(t.config());
    EXPECT_EQ(t.get_cfg(), (Octets{0x11, 0x21}));
    EXPECT_EQ(t.exchange({0x12, 0x34}), (Octets{0x12, 0x34})) << "the firmware is faster than minTSDR";
    EXPECT_EQ(t.exchange({0x56, 0x78}), (Octets{0x56, 0x78}));
    EXPECT_EQ(t.app.last, Outputs::fresh);
    EXPECT_EQ(t.drv.dp_state(), 2);
    EXPECT_EQ(t.drv.wd_state(), 2);
    EXPECT_EQ(t.drv.release(), regmap::traits(GetParam().variant).release);
}

TEST_P(DriverOnTheChip, LaysTheBuffersOutWithoutAnyFinding) {
    t.to_data_exch(t.config());
    while (!t.chip.findings().empty()) {
        const auto finding = t.chip.findings().pop();
        ADD_FAILURE() << regmap::kRules[finding.rule].text << " " << finding.detail;
    }
}

TEST_P(DriverOnTheChip, RefusesParametersThatBreakARule) {
    static constexpr PrmConstant constants[]{{0, 0xF8, 0x00}};
    static constexpr PrmValue values[]{{.offset = 3, .octets = 2, .min = 10, .max = 1000}};
    Config c = t.config();
    c.prm_rules = {5, 5, constants, values};
    t.power_up(c);
    const Octets good{0x88, 2, 5, 11, 0x47, 0x11, 0, 0x00, 0, 0, 0x01, 0x00};
    Octets constant = good, range = good, short_one = good, long_one = good;
    constant[7] = 0x08;
    range[10] = 0x7F;
    short_one.pop_back();
    long_one.push_back(0);
    for (const Octets& bad : {constant, range, short_one, long_one}) {
        EXPECT_EQ(t.set_prm(bad), OnTheChip::sc());
        EXPECT_EQ(t.diag(), (Octets{0x42, 0x05, 0x00, 0xFF, 0x47, 0x11}));
    }
    EXPECT_EQ(t.app.prm_faults, 4);
    EXPECT_EQ(t.set_prm(good), OnTheChip::sc());
    EXPECT_EQ(t.diag(), (Octets{0x02, 0x0C, 0x00, 0x02, 0x47, 0x11}));
    EXPECT_EQ(t.chk_cfg({0x11, 0x21}), OnTheChip::sc());
    EXPECT_EQ(t.diag(), (Octets{0x00, 0x0C, 0x00, 0x02, 0x47, 0x11}));
}

TEST_P(DriverOnTheChip, SevenOctetsOfParametersAreTooFewForAStationThatNeedsMore) {
    Config c = t.config();
    c.prm_rules.min_octets = 3;
    t.power_up(c);
    t.set_prm({0x88, 2, 5, 11, 0x47, 0x11, 0});
    t.chk_cfg({0x11, 0x21});
    EXPECT_EQ(t.diag(), (Octets{0x06, 0x05, 0x00, 0xFF, 0x47, 0x11}));
}

// proves: VPC3C 6.2.3-01
TEST_P(DriverOnTheChip, RefusesAnotherConfiguration) {
    t.power_up(t.config());
    t.set_prm({0x88, 2, 5, 11, 0x47, 0x11, 0});
    EXPECT_EQ(t.chk_cfg({0x11}), OnTheChip::sc());
    EXPECT_EQ(t.diag(), (Octets{0x06, 0x05, 0x00, 0xFF, 0x47, 0x11}));
    EXPECT_EQ(t.app.cfg_faults, 1);
    t.set_prm({0x88, 2, 5, 11, 0x47, 0x11, 0});
    t.chk_cfg({0x11, 0x21});
    EXPECT_EQ(t.app.entered, 1);
}

// proves: VPC3C 6.1-18, APC3 5.1-16
TEST_P(DriverOnTheChip, FollowsTheMastersConfigurationWhenToldTo) {
    Config c = t.config();
    c.cfg_policy = CfgPolicy::follow_master;
    c.max_inputs = c.max_outputs = 8;
    c.max_cfg = 4;
    t.power_up(c);
    t.set_prm({0x88, 2, 5, 11, 0x47, 0x11, 0});
    t.chk_cfg({0x13, 0x23});
    EXPECT_EQ(t.get_cfg(), (Octets{0x13, 0x23}));
    EXPECT_EQ(t.exchange({5, 6, 7, 8}), (Octets{5, 6, 7, 8}));
    EXPECT_EQ(t.drv.outputs(), 4);
    // The same again in DATA-EXCH is fine, another one is not.
    t.chk_cfg({0x13, 0x23});
    EXPECT_EQ(t.drv.dp_state(), 2);
    t.chk_cfg({0x11, 0x21});
    EXPECT_EQ(t.drv.dp_state(), 0);
    t.set_prm({0x88, 2, 5, 11, 0x47, 0x11, 0});
    t.chk_cfg({0x19});
    EXPECT_EQ(t.diag(), (Octets{0x06, 0x05, 0x00, 0xFF, 0x47, 0x11})) << "ten octets do not fit into eight";
    t.set_prm({0x88, 2, 5, 11, 0x47, 0x11, 0});
    t.chk_cfg({0x11, 0x21});
    EXPECT_EQ(t.drv.outputs(), 2);
    EXPECT_EQ(t.get_cfg(), (Octets{0x11, 0x21}));
    EXPECT_EQ(t.app.entered, 2);
}

TEST_P(DriverOnTheChip, TwoSetPrmAndTwoChkCfgBeforeTheFirmwareLooksAreBothJudged) {
    t.power_up(t.config());
    t.serving = false;
    t.set_prm({0x88, 2, 5, 11, 0x47, 0x11, 0, 0x00});
    EXPECT_EQ(t.set_prm({0x88, 2, 5, 11, 0x47, 0x11, 0, 0x00, 0x00}), OnTheChip::sc());
    t.chk_cfg({0x11, 0x22});
    EXPECT_EQ(t.chk_cfg({0x11, 0x21}), OnTheChip::sc());
    t.serving = true;
    t.run(core::microseconds(50));
    EXPECT_EQ(t.app.prms, 2);
    EXPECT_EQ(t.app.entered, 1) << "the second Chk_Cfg was right";
    EXPECT_EQ(t.diag(), (Octets{0x00, 0x0C, 0x00, 0x02, 0x47, 0x11}));
}

TEST_P(DriverOnTheChip, ParametersMayComeAgainInDataExchange) {
    t.to_data_exch(t.config());
    t.set_prm({0x88, 2, 5, 11, 0x47, 0x11, 0, 0x00});
    EXPECT_EQ(t.app.prms, 1);
    EXPECT_EQ(t.drv.dp_state(), 2);
    EXPECT_EQ(t.app.left, 0);
}

TEST_P(DriverOnTheChip, DiagnosisWithSeveralBlocksReachesTheMasterAndGoesAway) {
    t.to_data_exch(t.config());
    const std::uint8_t ext[]{0x04, 0x11, 0x22, 0x33, 0x42, 0x01, 0x80, 0x05, 0x21};
    EXPECT_EQ(t.drv.set_diagnosis(ext, {.ext_diag = true, .ext_diag_overflow = true}), DiagResult::handed_over);
    EXPECT_EQ(t.send({8, 2, 0x5D}, {1, 2}).at(6), 0x0A) << "high priority says: fetch the diagnosis";
    t.fc = 0x7D;
    EXPECT_EQ(t.diag(), (Octets{0x08, 0x0C, 0x80, 0x02, 0x47, 0x11, 0x04, 0x11, 0x22, 0x33, 0x42, 0x01, 0x80, 0x05, 0x21}));
    t.run(core::microseconds(10));
    EXPECT_EQ(t.drv.set_diagnosis({}), DiagResult::handed_over);
    EXPECT_EQ(t.diag(), (Octets{0x00, 0x0C, 0x00, 0x02, 0x47, 0x11}));
}

TEST_P(DriverOnTheChip, StaticDiagnosisKeepsTheFlagUntilItIsTakenBack) {
    t.to_data_exch(t.config());
    t.drv.set_diagnosis({}, {.stat_diag = true});
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(t.diag(), (Octets{0x00, 0x0E, 0x00, 0x02, 0x47, 0x11}));
        EXPECT_EQ(t.send({8, 2, t.fc}, {1, 2}).at(6), 0x0A);
        t.fc = t.fc == 0x5D ? 0x7D : 0x5D;
    }
    t.drv.set_diagnosis({});
    t.diag();
    EXPECT_EQ(t.send({8, 2, t.fc}, {1, 2}).at(6), 0x08);
}

TEST_P(DriverOnTheChip, EachDiagnosisIsSeenWhenTheMasterShallSeeEach) {
    Config c = t.config();
    c.diag_delivery = DiagDelivery::each;
    t.to_data_exch(c);
    const std::uint8_t first[]{0x02, 0x01}, second[]{0x02, 0x02};
    EXPECT_EQ(t.drv.set_diagnosis(first, {.ext_diag = true}), DiagResult::handed_over);
    EXPECT_EQ(t.drv.set_diagnosis(second, {.ext_diag = true}), DiagResult::queued);
    EXPECT_EQ(t.diag().at(7), 1);
    t.drv.poll();
    EXPECT_EQ(t.diag().at(7), 2);
}

TEST_P(DriverOnTheChip, ADiagnosisAtAnyMomentOfASlaveDiagCycleArrives) {
    t.to_data_exch(t.config());
    for (std::uint8_t i = 0; i < 100; ++i) {
        const std::uint8_t old[]{0x02, 0x00};
        t.drv.set_diagnosis(old, {.ext_diag = true});
        t.run(core::microseconds(1));
        t.say_later(t.chip.now() + core::microseconds(3 * i), {0x02, static_cast<std::uint8_t>(0x80 + i)});
        const Octets during = t.diag();
        EXPECT_TRUE(during.at(7) == 0x00 || during.at(7) == 0x80 + i);
        t.run(core::microseconds(300));
        EXPECT_EQ(t.diag().at(7), 0x80 + i) << i;
        EXPECT_EQ(t.exchange({1, 2}).size(), 2u);
    }
}

TEST_P(DriverOnTheChip, ClearDataAndALostMasterClearTheOutputs) {
    t.to_data_exch(t.config());
    t.exchange({0x12, 0x34});
    EXPECT_EQ(t.app.last, Outputs::fresh);
    t.global_control(0x02);
    EXPECT_EQ(t.app.gc, 0x02);
    EXPECT_EQ(t.app.last, Outputs::cleared);
    EXPECT_EQ(t.app.outputs[0], 0);
    t.exchange({0x12, 0x34});
    t.run(core::milliseconds(110));
    EXPECT_EQ(t.app.wd, 1);
    EXPECT_EQ(t.app.left, 1);
    EXPECT_EQ(t.app.last, Outputs::cleared);
    EXPECT_EQ(t.app.outputs[1], 0);
}

TEST_P(DriverOnTheChip, SyncHoldsOutputsBackAndFreezeHoldsInputs) {
    t.to_data_exch(t.config());
    t.global_control(0x20);
    t.exchange({0x12, 0x34});
    EXPECT_EQ(t.app.outputs[0], 0);
    t.global_control(0x20);
    EXPECT_EQ(t.app.outputs[0], 0x12);
    t.global_control(0x10);
    const std::uint8_t inputs[]{0xAB, 0xCD}, later[]{0x01, 0x02};
    t.drv.write_inputs(inputs);
    t.global_control(0x08);
    t.drv.write_inputs(later);
    EXPECT_EQ(OnTheChip::answer_data(t.request(56, {})), (Octets{0xAB, 0xCD}));
    t.global_control(0x04);
    EXPECT_EQ(OnTheChip::answer_data(t.request(56, {})), (Octets{0x01, 0x02}));
}

TEST_P(DriverOnTheChip, FailSafeTakesAnEmptyDataExchangeAsClear) {
    Config c = t.config();
    c.fail_safe = true;
    t.to_data_exch(c);
    t.exchange({0x12, 0x34});
    t.exchange({});
    EXPECT_EQ(t.app.last, Outputs::cleared);
    EXPECT_EQ(t.drv.dp_state(), 2);
}

TEST_P(DriverOnTheChip, TheAddressMayBeGivenByTheMaster) {
    Config c = t.config();
    c.address = 126;
    c.set_slave_add = true;
    t.slave = 126;
    t.power_up(c);
    EXPECT_EQ(t.request(55, {9, 0x47, 0x11, 0xFF}), OnTheChip::sc());
    EXPECT_EQ(t.app.new_address, 9);
    EXPECT_TRUE(t.app.no_add_chg);
    EXPECT_EQ(t.drv.address(), 9);
    t.slave = 9;
    EXPECT_EQ(t.request(55, {10, 0x47, 0x11, 0x00}), OnTheChip::sc()) << "locked: acknowledged and ignored";
    EXPECT_EQ(t.app.ssa, 1);
    EXPECT_EQ(t.diag().size(), 6u);
}

TEST_P(DriverOnTheChip, AStarvedUserWatchdogLeavesTheMaster) {
    Config c = t.config();
    c.user_watchdog = 5;
    t.to_data_exch(c);
    for (std::uint8_t i = 0; i < 20; ++i) {
        t.exchange({i, i});
        t.drv.poll();
    }
    EXPECT_EQ(t.app.left, 0) << "fed";
    if (GetParam().service == Service::polled) return;  // no poll, no service either
    for (std::uint8_t i = 0; i < 12; ++i) t.exchange({i, i});
    EXPECT_EQ(t.app.left, 1);
}

TEST_P(DriverOnTheChip, LeavesTheMasterAndRestartsOnRequest) {
    t.to_data_exch(t.config());
    t.drv.leave_master();
    t.run(core::microseconds(100));
    EXPECT_EQ(t.app.left, 1);
    EXPECT_EQ(t.diag(), (Octets{0x02, 0x05, 0x00, 0xFF, 0x47, 0x11}));
    const std::uint8_t ext[]{0x02, 0x07};
    t.drv.set_diagnosis(ext, {.ext_diag = true});
    t.app.baud = -1;
    t.drv.restart();
    t.run(core::milliseconds(1));
    t.drv.poll();
    EXPECT_EQ(t.app.offlines, 1);
    EXPECT_EQ(t.drv.state(), State::online);
    for (int i = 0; i < 200 && t.app.baud < 0; ++i) t.fdl_status();
    t.fc = 0x6D;
    EXPECT_EQ(t.diag(), (Octets{0x0A, 0x05, 0x00, 0xFF, 0x47, 0x11, 0x02, 0x07})) << "the diagnosis is still told";
    t.set_prm({0x88, 2, 5, 11, 0x47, 0x11, 0});
    t.chk_cfg({0x11, 0x21});
    EXPECT_EQ(t.app.entered, 2);
    EXPECT_EQ(t.exchange({1, 2}).size(), 2u);
    t.drv.go_offline();
    t.run(core::milliseconds(1));
    t.drv.poll();
    EXPECT_EQ(t.drv.state(), State::offline);
    EXPECT_EQ(t.diag(), Octets{});
    EXPECT_EQ(t.drv.configure(t.config()), ConfigError::none) << "and may be configured anew";
}

TEST_P(DriverOnTheChip, WorksWithOneAuxBufferAndWithPrmOnTheSecond) {
    for (const AuxUse aux : {AuxUse::all_on_1, AuxUse::prm_on_2}) {
        OnTheChip other{GetParam()};
        Config c = other.config();
        c.aux = aux;
        other.to_data_exch(c);
        other.set_prm({0x88, 2, 5, 11, 0x47, 0x11, 0, 0x00});
        EXPECT_EQ(other.app.prms, 1);
        EXPECT_EQ(other.exchange({3, 4}), (Octets{3, 4}));
    }
}

TEST_P(DriverOnTheChip, WorksWithTheSpecialParameterBuffer) {
    Config c = t.config();
    c.spec_prm_buf_mode = true;
    c.max_prm = 120;
    t.power_up(c);
    Octets prm{0x88, 2, 5, 11, 0x47, 0x11, 0};
    prm.resize(120);
    EXPECT_EQ(t.set_prm(prm), OnTheChip::sc());
    EXPECT_EQ(t.app.prms, 1);
    t.chk_cfg({0x11, 0x21});
    EXPECT_EQ(t.app.entered, 1);
}

TEST_P(DriverOnTheChip, SetExtPrmIsTheApplicationsToJudge) {
    if (!has(&regmap::Traits::ext_prm)) {
        Config c = t.config();
        c.set_ext_prm = true;
        EXPECT_EQ(t.drv.configure(c), ConfigError::not_in_this_chip);
        return;
    }
    Config c = t.config();
    c.set_ext_prm = true;
    t.power_up(c);
    t.set_prm({0x88, 2, 5, 11, 0x47, 0x11, 0});
    EXPECT_EQ(t.request(53, {0x05, 0x81, 0x00, 0x00, 0xAA}), OnTheChip::sc());
    EXPECT_EQ(t.app.ext_prms, 1);
    t.chk_cfg({0x11, 0x21});
    EXPECT_EQ(t.app.entered, 1);
}

TEST_P(DriverOnTheChip, ARaisedTimerIsServed) {
    if (!has(&regmap::Traits::user_timer)) {
        Config c = t.config();
        c.user_timer = UserTimer::ms_1;
        EXPECT_EQ(t.drv.configure(c), ConfigError::not_in_this_chip);
        return;
    }
    Config c = t.config();
    c.user_timer = UserTimer::ms_1;
    ASSERT_EQ(t.drv.configure(c), ConfigError::none);
    ASSERT_TRUE(t.drv.start());
    for (int i = 0; i < 10; ++i) t.run(core::milliseconds(1));
    EXPECT_GE(t.app.timers, 9);
    EXPECT_LE(t.app.timers, 11);
}

TEST_P(DriverOnTheChip, AStationWithoutOutputsWorks) {
    static constexpr std::uint8_t inputs_only[]{0x11};
    Config c = t.config();
    c.cfg = inputs_only;
    t.power_up(c);
    t.set_prm({0x88, 2, 5, 11, 0x47, 0x11, 0});
    t.chk_cfg({0x11});
    EXPECT_EQ(t.app.entered, 1);
    const std::uint8_t inputs[]{0xAB, 0xCD};
    t.drv.write_inputs(inputs);
    EXPECT_EQ(t.exchange({}), (Octets{0xAB, 0xCD}));
}

}  // namespace
}  // namespace dpchip::driver
