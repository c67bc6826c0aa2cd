// SPDX-License-Identifier: Apache-2.0
// Alarms and status messages from the master's side: in the diagnosis, one at a time, enabled, numbered, acknowledged
// (reference 5.5, 10.12; C122).
#include <gtest/gtest.h>

#include <dpchip/dp/diag.hpp>

#include "driver/dpv1_bench.hpp"

namespace dpchip::driver {
namespace {

using testing::Dpv1Bench;
using testing::hex;
using testing::kDpv1Kinds;
using testing::Kind;
using testing::Octets;
using News = std::vector<std::string>;

dp::AlarmStatus alarm(std::uint8_t type, std::uint8_t slot = 1, std::span<const std::uint8_t> data = {}) {
    dp::AlarmStatus a{};
    a.type = type;
    a.slot = slot;
    a.data = data;
    return a;
}
dp::AlarmStatus status(std::uint8_t type, std::uint8_t slot = 1) {
    dp::AlarmStatus a = alarm(type, slot);
    a.status = true;
    return a;
}

class Alarms : public ::testing::TestWithParam<Kind> {
protected:
    Dpv1Bench t{GetParam()};

    void start(std::uint8_t status_2 = 0xFC, std::uint8_t alarm_mode = 0) { start(t.dpv1_config(), status_2, alarm_mode); }
    void start(const Config& c, std::uint8_t status_2 = 0xFC, std::uint8_t alarm_mode = 0) {
        t.to_dpv1(c, 0x80, status_2, alarm_mode);
        t.exchange({0, 0});
    }
    /// Ext_Diag_Data of one Slave_Diag, and a Data_Exchange after it.
    Octets fetch() {
        const Octets diag = t.diag();
        t.exchange({0, 0});
        return diag.size() < 6 ? Octets{} : Octets(diag.begin() + 6, diag.end());
    }
    /// True when the answer to Data_Exchange asks for a Slave_Diag.
    bool has_diagnosis() {
        const Octets answer = t.send({t.slave, t.master, t.next_fc()}, {0, 0});
        return answer.size() > 6 && (answer[6] & 0x0F) == 0x0A;
    }
    Octets ack(std::uint8_t slot, std::uint8_t type, std::uint8_t specifier, std::uint8_t sap = 51) { return t.ask(sap, 51, {0x5C, slot, type, specifier}); }
    AlarmResult raise(const dp::AlarmStatus& a) { return t.drv.raise(a).result; }
};
INSTANTIATE_TEST_SUITE_P(AllChips, Alarms, ::testing::ValuesIn(kDpv1Kinds), [](const auto& param) { return std::string{param.param.name}; });

// proves: VPC3C 1-03, VPC3C 6.2.4-24, VPC3C 7.2.2-02, VPC3C 7.2.2-05
TEST_P(Alarms, AnAlarmIsShownAcknowledgedAndGone) {
    start();
    const Octets data{0xAA, 0xBB};
    const AlarmRaised raised = t.drv.raise(alarm(2, 1, data));
    EXPECT_EQ(raised.result, AlarmResult::queued);
    EXPECT_EQ(raised.seq_nr, 0);
    EXPECT_TRUE(has_diagnosis());
    EXPECT_EQ(fetch(), (Octets{6, 2, 1, 0x00, 0xAA, 0xBB}));
    EXPECT_FALSE(has_diagnosis());
    EXPECT_EQ(ack(1, 2, 0x00), (Octets{0x5C, 1, 2, 0x00}));
    EXPECT_EQ(t.app.news(), (News{"ack 2/0"}));
    EXPECT_TRUE(has_diagnosis());
    EXPECT_EQ(fetch(), Octets{});
    EXPECT_EQ(raise(alarm(2)), AlarmResult::queued);
    EXPECT_EQ(fetch(), (Octets{4, 2, 1, 0x08}));
    EXPECT_EQ(t.check("68 09 09 68 88 82 5D 33 33 5C 01 02 08 34 16"), hex("E5")) << "C122";
    EXPECT_EQ(t.check("68 05 05 68 88 82 7D 33 33 ED 16"), hex("68 09 09 68 82 88 08 33 33 5C 01 02 08 DF 16"));
    EXPECT_EQ(t.app.news(), (News{"ack 2/1"}));
}

TEST_P(Alarms, StartWithTheFirstDataExchange) {
    t.to_dpv1();
    EXPECT_EQ(raise(alarm(1)), AlarmResult::closed);
    t.exchange({0, 0});
    EXPECT_EQ(raise(alarm(1)), AlarmResult::queued);
}

TEST_P(Alarms, OnlyEnabledTypesAreSent) {
    start(dp::kEnableProcessAlarm | dp::kEnablePullPlugAlarm);
    EXPECT_EQ(raise(alarm(1)), AlarmResult::not_enabled);
    EXPECT_EQ(raise(alarm(2)), AlarmResult::queued);
    EXPECT_EQ(raise(alarm(3)), AlarmResult::queued);
    EXPECT_EQ(raise(alarm(4)), AlarmResult::queued);
    EXPECT_EQ(raise(alarm(5)), AlarmResult::not_enabled);
    EXPECT_EQ(raise(alarm(6)), AlarmResult::not_enabled);
    EXPECT_EQ(raise(alarm(40)), AlarmResult::not_enabled);
    EXPECT_EQ(raise(alarm(7)), AlarmResult::malformed);
    EXPECT_EQ(raise(status(1)), AlarmResult::queued) << "a status needs no permission";
    Config c = t.dpv1_config();
    c.dpv1.alarms = dp::kEnableUpdateAlarm;
    Dpv1Bench one{GetParam()};
    one.to_dpv1(c);
    one.exchange({0, 0});
    EXPECT_EQ(one.drv.raise(alarm(2)).result, AlarmResult::not_enabled) << "the configuration knows no process alarms";
    EXPECT_EQ(one.drv.raise(alarm(6)).result, AlarmResult::queued);
}

TEST_P(Alarms, WithoutDpv1EnableThereAreNone) {
    t.to_dpv1(t.dpv1_config(), 0x00);
    t.exchange({0, 0});
    EXPECT_EQ(raise(alarm(1)), AlarmResult::closed);
    EXPECT_EQ(raise(status(1)), AlarmResult::closed);
}

TEST_P(Alarms, OneOfEachTypeInTypeModeAndOneAtATimeInTheDiagnosis) {
    start();
    for (const std::uint8_t type : Octets{1, 1, 2}) EXPECT_EQ(raise(alarm(type)), AlarmResult::queued);
    EXPECT_EQ(fetch(), (Octets{4, 1, 1, 0x00}));
    EXPECT_EQ(fetch(), (Octets{4, 2, 1, 0x10})) << "the second of type 1 waits";
    EXPECT_FALSE(has_diagnosis());
    EXPECT_EQ(ack(1, 1, 0x00), (Octets{0x5C, 1, 1, 0x00}));
    EXPECT_EQ(fetch(), (Octets{4, 1, 1, 0x08}));
    EXPECT_EQ(ack(1, 2, 0x10), (Octets{0x5C, 1, 2, 0x10}));
    EXPECT_EQ(ack(1, 1, 0x08), (Octets{0x5C, 1, 1, 0x08}));
    EXPECT_EQ(fetch(), Octets{});
    EXPECT_FALSE(has_diagnosis());
}

TEST_P(Alarms, AsManyInSequenceModeAsTheMasterAllows) {
    start(0xFC, 1);  // two in total
    for (int i = 0; i < 3; ++i) EXPECT_EQ(raise(alarm(1)), AlarmResult::queued);
    EXPECT_EQ(fetch(), (Octets{4, 1, 1, 0x00}));
    EXPECT_EQ(fetch(), (Octets{4, 1, 1, 0x08}));
    EXPECT_FALSE(has_diagnosis()) << "two are outstanding";
    ack(1, 1, 0x08);
    EXPECT_EQ(fetch(), (Octets{4, 1, 1, 0x10})) << "acknowledged out of order";
    EXPECT_EQ(ack(1, 1, 0x08), (Octets{0xDC, 0x80, 0xB5, 0x00})) << "not twice";
}

TEST_P(Alarms, NumbersGoRoundAndTheQueueSaysWhenItIsFull) {
    start(0xFC, 7);
    for (int i = 0; i < 40; ++i) {
        const AlarmRaised raised = t.drv.raise(alarm(2));
        ASSERT_EQ(raised.result, AlarmResult::queued);
        EXPECT_EQ(raised.seq_nr, i % 32);
        const auto specifier = static_cast<std::uint8_t>(raised.seq_nr << 3);
        EXPECT_EQ(fetch(), (Octets{4, 2, 1, specifier}));
        EXPECT_EQ(ack(1, 2, specifier)[0], 0x5C);
    }
    for (int i = 0; i < 8; ++i) EXPECT_EQ(raise(alarm(2)), AlarmResult::queued);
    EXPECT_EQ(raise(alarm(2)), AlarmResult::queue_full);
}

TEST_P(Alarms, AnAcknowledgementMustFitTheAlarm) {
    start();
    raise(alarm(1, 4));
    EXPECT_EQ(ack(4, 1, 0x00), (Octets{0x5C, 4, 1, 0x00})) << "the master may have seen it before the firmware has noticed";
    raise(alarm(1, 4));
    fetch();
    const Octets conflict{0xDC, 0x80, 0xB5, 0x00};
    EXPECT_EQ(ack(5, 1, 0x08), conflict);
    EXPECT_EQ(ack(4, 2, 0x08), conflict);
    EXPECT_EQ(ack(4, 1, 0x10), conflict);
    EXPECT_EQ(ack(4, 1, 0x08, 50), (Octets{0x5C, 4, 1, 0x08})) << "SAP 50 serves as well";
    EXPECT_EQ(t.app.news(), (News{"ack 1/0", "ack 1/1"}));
}

TEST_P(Alarms, TheApplicationsOwnBlocksStayInFront) {
    start();
    EXPECT_EQ(t.drv.set_diagnosis(Octets{0x42, 0x01}, {.ext_diag = true}), DiagResult::handed_over);
    EXPECT_EQ(fetch(), (Octets{0x42, 0x01}));
    raise(alarm(1));
    EXPECT_EQ(fetch(), (Octets{0x42, 0x01, 4, 1, 1, 0x00}));
    t.drv.set_diagnosis(Octets{0x42, 0x03}, {.ext_diag = true});
    EXPECT_EQ(fetch(), (Octets{0x42, 0x03, 4, 1, 1, 0x00})) << "not acknowledged yet";
    ack(1, 1, 0x00);
    EXPECT_EQ(fetch(), (Octets{0x42, 0x03}));
    EXPECT_EQ(t.drv.set_diagnosis(Octets(11), {}), DiagResult::too_long) << "room for an alarm is kept free";
    const Octets longest(12), too_long(13);
    EXPECT_EQ(raise(alarm(1, 1, longest)), AlarmResult::queued);
    EXPECT_EQ(raise(alarm(2, 1, too_long)), AlarmResult::too_long);
    EXPECT_EQ(raise(alarm(2, 1, Octets(60))), AlarmResult::too_long);
}

// proves: VPC3C 6.2.4-24, VPC3C 7.2.2-03
TEST_P(Alarms, AStatusMessageIsShownOnce) {
    start();
    EXPECT_EQ(raise(status(1, 3)), AlarmResult::queued);
    EXPECT_EQ(raise(alarm(1)), AlarmResult::queued);
    EXPECT_EQ(fetch(), (Octets{4, 0x81, 3, 0}));
    EXPECT_EQ(fetch(), (Octets{4, 1, 1, 0}));
    ack(1, 1, 0);
    EXPECT_EQ(fetch(), Octets{});
    EXPECT_FALSE(has_diagnosis());
}

TEST_P(Alarms, TheMasterLeavesAndNothingIsLeftOver) {
    start(0xFC, 3);
    for (const std::uint8_t type : Octets{1, 2, 2}) raise(alarm(type));
    raise(status(1));
    fetch();
    t.app.news();
    t.drv.leave_master();
    t.wait_ms(1);
    EXPECT_EQ(t.app.news(), (News{"ms1 closed", "drop 1/0", "drop 2/1", "drop 2/2"}));
    EXPECT_EQ(raise(alarm(1)), AlarmResult::closed);
    t.master_starts();
    EXPECT_EQ(fetch(), Octets{}) << "the old alarm is not shown to the next master";
    EXPECT_EQ(ack(1, 1, 0x00), (Octets{0xDC, 0x80, 0xB5, 0x00}));
}

TEST_P(Alarms, StaticDiagnosisHoldsTheNextOneBackUntilTheAcknowledgement) {
    start(0xFC, 3);
    t.drv.set_diagnosis({}, {.stat_diag = true});
    raise(alarm(1));
    raise(alarm(2));
    for (int i = 0; i < 3; ++i) EXPECT_EQ(fetch(), (Octets{4, 1, 1, 0}));
    ack(1, 1, 0);
    EXPECT_EQ(fetch(), (Octets{4, 2, 1, 8}));
}

TEST_P(Alarms, GetThroughHeavyTraffic) {
    start(0xFC, 7);
    t.app.records[{1, 1}] = {1, 2, 3};
    int acknowledged = 0;
    for (int i = 0; i < 400; ++i) {
        if (i % 7 == 0) t.drv.raise(alarm(static_cast<std::uint8_t>(1 + i % 2), static_cast<std::uint8_t>(i % 200)));
        const Octets answer = t.send({t.slave, t.master, t.next_fc()}, {1, static_cast<std::uint8_t>(i)});
        if (i % 3 == 0) {
            EXPECT_EQ(t.ms1({0x5E, 1, 1, 3}), (Octets{0x5E, 1, 1, 3, 1, 2, 3}));
        }
        if (answer.size() < 7 || (answer[6] & 0x0F) != 0x0A) continue;
        const Octets diag = t.diag();
        if (diag.size() <= 6) continue;
        ASSERT_EQ(diag.size(), 10U);
        EXPECT_EQ(t.ms1({0x5C, diag[8], diag[7], diag[9]})[0], 0x5C);
        ++acknowledged;
    }
    EXPECT_GE(acknowledged, 57);
    EXPECT_EQ(t.app.news().size(), static_cast<std::size_t>(acknowledged));
}

}  // namespace
}  // namespace dpchip::driver
