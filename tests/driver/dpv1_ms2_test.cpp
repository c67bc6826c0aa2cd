// SPDX-License-Identifier: Apache-2.0
// MS2 from the master's side: the resource manager, connections, aborts, timeouts (reference 5.4, 10.13, 10.14; C118 to
// C120).
#include <gtest/gtest.h>

#include "driver/dpv1_bench.hpp"

namespace dpchip::driver {
namespace {

using testing::Dpv1Bench;
using testing::hex;
using testing::kDpv1Kinds;
using testing::Kind;
using testing::kRr;
using testing::kRs;
using testing::Octets;
using News = std::vector<std::string>;

class Ms2 : public ::testing::TestWithParam<Kind> {
protected:
    Dpv1Bench t{GetParam()};
    void SetUp() override { t.power_up(t.dpv1_config()); }
};
INSTANTIATE_TEST_SUITE_P(AllChips, Ms2, ::testing::ValuesIn(kDpv1Kinds), [](const auto& param) { return std::string{param.param.name}; });

// proves: VPC3C 1-03, E031
TEST_P(Ms2, AConnectionWithoutAnyClass1MasterAsTheReferenceShows) {
    EXPECT_EQ(t.check("68 19 19 68 88 82 5D 31 32 57 00 00 00 03 E8 01 00 00 00 00 00 00 02 00 02 00 00 00 00 11 16"),
              hex("68 09 09 68 82 88 08 32 31 56 30 00 64 5F 16")) << "C118";
    EXPECT_EQ(t.app.send_timeout, 1000);
    EXPECT_EQ(t.check("68 05 05 68 88 82 7D 30 32 E9 16"),
              hex("68 15 15 68 82 88 08 32 30 57 F0 01 00 00 00 00 00 00 02 00 02 00 00 00 00 C0 16")) << "C119";
    EXPECT_EQ(t.check("68 07 07 68 88 82 5D 30 32 48 00 11 16"), hex("E5"));
    EXPECT_EQ(t.check("68 05 05 68 88 82 7D 30 32 E9 16"), hex("68 07 07 68 82 88 08 32 30 48 00 BC 16")) << "C120";
    EXPECT_EQ(t.check("68 09 09 68 88 82 5D 30 32 58 01 20 00 42 16"), hex("E5"));
    EXPECT_EQ(t.check("68 05 05 68 88 82 7D 30 32 E9 16"), hex("10 02 08 03 0D 16"));
    EXPECT_EQ(t.app.news(), (News{"open 48 by 2", "closed 48 by master 0"}));
}

TEST_P(Ms2, RecordsAndTransportOverAConnection) {
    const int sap = t.open();
    ASSERT_EQ(sap, 48);
    t.app.records[{1, 2}] = {7, 8, 9};
    EXPECT_EQ(t.ms2(sap, {0x5E, 1, 2, 240}), (Octets{0x5E, 1, 2, 3, 7, 8, 9}));
    EXPECT_EQ(t.ms2(sap, {0x5F, 1, 2, 1, 5}), (Octets{0x5F, 1, 2, 1}));
    EXPECT_EQ(t.ms2(sap, {0x51, 3, 4, 3, 1, 2, 3}), (Octets{0x51, 3, 4, 3, 3, 2, 1}));
    EXPECT_EQ(t.ms2(sap, {0x51, 3, 4, 0}), (Octets{0x51, 3, 4, 0}));
    EXPECT_EQ(t.ms2(sap, {0x5E, 9, 9, 240}), (Octets{0xDE, 0x80, 0xB0, 0x00}));
    t.app.refusals[{3, 4}] = dp::ErrorCode1::resource_busy;
    EXPECT_EQ(t.ms2(sap, {0x51, 3, 4, 1, 0}), (Octets{0xD1, 0x80, 0xC2, 0x00}));
    EXPECT_EQ(t.ms2(sap, {0x51, 3, 4, 2, 0}), (Octets{0xD1, 0x80, 0xB3, 0x00}));
    EXPECT_EQ(t.ms2(sap, {0x5E, 3, 4, 0}), (Octets{0xDE, 0x80, 0xB3, 0x00}));
    EXPECT_EQ(t.ms2(sap, {0x5F, 3, 4, 0}), (Octets{0xDF, 0x80, 0xB3, 0x00}));
    EXPECT_EQ(t.app.calls[0].relation, Relation::ms2);
    EXPECT_EQ(t.app.calls[0].master, 2);
    t.app.im[dp::kIm0] = dp::encode(dp::Im0{});
    EXPECT_EQ(t.ms2(sap, {0x5F, 0, 0xFF, 4, 8, 0, 0xFD, 0xE8}), (Octets{0x5F, 0, 0xFF, 4}));
    EXPECT_EQ(t.ms2(sap, {0x5E, 0, 0xFF, 68}).size(), 72U);
}

TEST_P(Ms2, ConnectionsAreHandedOutFrom48DownwardsUntilNoneIsLeft) {
    EXPECT_EQ(t.open(), 48);
    t.master = 3;
    EXPECT_EQ(t.open(), 47);
    t.master = 2;
    EXPECT_EQ(t.open(), 46);
    EXPECT_EQ(t.open(), -int{kRs}) << "none left";
    EXPECT_EQ(t.ms2(48, {0x48, 1}), (Octets{0x48, 1}));
    EXPECT_EQ(t.ms2(46, {0x48, 2}), (Octets{0x48, 2}));
    EXPECT_EQ(t.ms2(47, {0x48, 3}), Octets{kRs}) << "that one is master 3's";
    t.acyclic(48, 50, {0x58, 1, 0x20, 0});
    EXPECT_EQ(t.open(), 48) << "free again";
    EXPECT_EQ(t.open(), -int{kRs});
}

TEST_P(Ms2, TwoMastersRaceForTheLastConnection) {
    EXPECT_EQ(t.open(), 48);
    EXPECT_EQ(t.open(), 47);
    t.serving = false;
    const Octets first = Dpv1Bench::pdu_of(t.acyclic(49, 50, Dpv1Bench::initiate_req()));
    t.master = 3;
    const Octets second = Dpv1Bench::pdu_of(t.acyclic(49, 50, Dpv1Bench::initiate_req()));
    t.serving = true;
    EXPECT_EQ(first, (Octets{0x56, 46, 0x00, 0x64}));
    EXPECT_EQ(second, Octets{kRs}) << "SAP 49 is the first one's until the firmware has looked";
    t.wait_ms(1);
    t.master = 2;
    EXPECT_EQ(t.poll(46, 50).size(), 16U);
    t.master = 3;
    EXPECT_EQ(t.open(), -int{kRs});
    EXPECT_EQ(t.poll(46, 50), Octets{kRs});
    EXPECT_EQ(t.app.news(), (News{"open 48 by 2", "open 47 by 2", "open 46 by 2"}));
}

TEST_P(Ms2, ASecondInitiateBeforeTheFirmwareLooksIsToldToComeAgain) {
    t.serving = false;
    EXPECT_EQ(Dpv1Bench::pdu_of(t.acyclic(49, 50, Dpv1Bench::initiate_req())).size(), 4U);
    EXPECT_EQ(Dpv1Bench::pdu_of(t.acyclic(49, 50, Dpv1Bench::initiate_req())), Octets{kRr});
    EXPECT_EQ(t.poll(48, 50), Octets{kRs}) << "not bound yet";
    t.serving = true;
    t.wait_ms(1);
    EXPECT_EQ(t.poll(48, 50).size(), 16U);
    EXPECT_EQ(t.open(), 47);
}

TEST_P(Ms2, AStrayPollOfTheResourceManagerCostsNothing) {
    t.master = 5;
    EXPECT_EQ(t.poll(49, 50), (Octets{0x56, 48, 0x00, 0x64}));
    EXPECT_EQ(t.poll(49, 50), (Octets{0x56, 48, 0x00, 0x64}));
    t.master = 2;
    EXPECT_EQ(t.open(), 48);
    EXPECT_EQ(t.open(), 47);
}

TEST_P(Ms2, AnInitiateThatIsNoneIsAborted) {
    const auto refused = [&](const Octets& pdu) {
        const Octets rm = Dpv1Bench::pdu_of(t.acyclic(49, 50, pdu));
        if (rm.size() != 4) return rm;
        const Octets abort = t.poll(rm[1], 50);
        EXPECT_EQ(t.poll(rm[1], 50), Octets{kRs}) << "closed after the poll that fetched the Abort";
        return abort;
    };
    const Octets too_short{0x58, 0x00, 0x17}, faulty{0x58, 0x00, 0x12};
    Octets pdu = Dpv1Bench::initiate_req();
    for (std::size_t octets = 1; octets < 20; ++octets) EXPECT_EQ(refused(Octets(pdu.begin(), pdu.begin() + static_cast<std::ptrdiff_t>(octets))), too_short);
    pdu.push_back(0);
    EXPECT_EQ(refused(pdu), faulty) << "one octet too many";
    pdu = Dpv1Bench::initiate_req();
    pdu[13] = 3;
    EXPECT_EQ(refused(pdu), faulty);
    pdu[13] = 1;
    pdu[15] = 3;
    EXPECT_EQ(refused(pdu), faulty) << "no room for API and SCL";
    pdu = Dpv1Bench::initiate_req();
    for (const std::uint8_t function : Octets{0x48, 0x51, 0x5E, 0x5F, 0x58, 0x00, 0xFF}) {
        pdu[0] = function;
        EXPECT_EQ(refused(pdu), faulty) << int{function};
    }
    EXPECT_TRUE(t.app.news().empty()) << "the application hears nothing of it";
    Octets overlong(60);
    overlong[0] = 0x57;
    EXPECT_EQ(refused(overlong), Octets{kRr}) << "longer than max_initiate";
    EXPECT_GE(t.open(), 47);
}

TEST_P(Ms2, TheAnswersSourceIsTheRequestsDestination) {
    Octets pdu{0x57, 0, 0, 0, 0, 100, 1, 0, 0, 0, 0, 0, 1, 8, 0, 2, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
    ASSERT_EQ(Dpv1Bench::pdu_of(t.acyclic(49, 50, pdu)).size(), 4U);
    const Octets answer = t.poll(48, 50);
    const auto res = dp::decode_initiate_res(answer);
    ASSERT_TRUE(res);
    EXPECT_EQ(res->source.octets.size(), 2U);
    EXPECT_EQ(res->source.api(), 9);
    EXPECT_EQ(res->destination.type, 1);
    EXPECT_EQ(res->destination.octets.size(), 8U);
}

TEST_P(Ms2, TheApplicationDecidesAboutAConnectionNowOrLater) {
    t.app.refuse_initiate = 5;
    EXPECT_EQ(Dpv1Bench::pdu_of(t.acyclic(49, 50, Dpv1Bench::initiate_req())), (Octets{0x56, 48, 0, 0x64}));
    EXPECT_EQ(t.poll(48, 50), (Octets{0x58, 0x00, 0x25})) << "instance user";
    EXPECT_EQ(t.poll(48, 50), Octets{kRs});
    t.app.refuse_initiate = -1;
    t.app.initiate_later = true;
    t.acyclic(49, 50, Dpv1Bench::initiate_req());
    const Handle first = t.app.handle;
    EXPECT_EQ(first.sap, 47) << "that was on offer before 48 was free again";
    EXPECT_TRUE(t.poll(47, 50).empty());
    EXPECT_TRUE(t.drv.complete(first, accept_connection({.features_1 = 1, .profile_ident = 0x9700})));
    const Octets answer = t.poll(47, 50);
    ASSERT_EQ(answer.size(), 16U);
    EXPECT_EQ(dp::decode_initiate_res(answer)->features.profile_ident, 0x9700);
    EXPECT_FALSE(t.drv.complete(first, accept_connection()));
}

TEST_P(Ms2, AnAnswerOfAnotherServiceEndsTheConnectionWithIV) {
    t.app.initiate_later = true;
    t.acyclic(49, 50, Dpv1Bench::initiate_req());
    EXPECT_FALSE(t.drv.complete(t.app.handle, answered())) << "no record is waited for";
    EXPECT_EQ(t.poll(48, 50), (Octets{0x58, 0x00, 0x15}));
    t.app.initiate_later = false;
    ASSERT_EQ(t.open(), 47);
    t.app.later = true;
    t.acyclic(47, 50, {0x5E, 1, 0x10, 4});
    EXPECT_FALSE(t.drv.complete(t.app.handle, accept_connection())) << "no connection is waited for";
    EXPECT_EQ(t.poll(47, 50), (Octets{0x58, 0x00, 0x15}));
    EXPECT_EQ(t.poll(47, 50), Octets{kRs});
}

TEST_P(Ms2, TheApplicationRefusesWithAReasonOfMsac) {
    struct Case {
        InitiateAnswer answer;
        std::uint8_t octet;
    };
    for (const Case& c : {Case{refuse_connection(dp::AbortReason::resource_error), 0x1F}, Case{refuse_connection(dp::AbortReason::invalid_address), 0x17}}) {
        t.app.initiate_later = true;
        const std::uint8_t sap = Dpv1Bench::pdu_of(t.acyclic(49, 50, Dpv1Bench::initiate_req()))[1];
        EXPECT_TRUE(t.drv.complete(t.app.handle, c.answer));
        EXPECT_EQ(t.poll(sap, 50), (Octets{0x58, 0x00, c.octet}));
    }
}

TEST_P(Ms2, RequestsOutOfTurnAreASequenceError) {
    ASSERT_EQ(t.open(), 48);
    t.app.news();
    t.app.later = true;
    EXPECT_TRUE(t.ms2(48, {0x5E, 1, 1, 4}).empty());
    EXPECT_TRUE(Dpv1Bench::pdu_of(t.acyclic(48, 50, {0x48, 0x00})).empty()) << "taken into the second buffer";
    EXPECT_EQ(t.app.news(), (News{"dropped 48", "closed 48 by driver 1"}));
    EXPECT_FALSE(t.drv.complete(t.app.handle, answered()));
    EXPECT_EQ(t.poll(48, 50), (Octets{0x58, 0x00, 0x11}));
    EXPECT_EQ(t.poll(48, 50), Octets{kRs});
    EXPECT_EQ(t.open(), 47);
}

TEST_P(Ms2, AnAbortGetsThroughWhileTheApplicationWorks) {
    ASSERT_EQ(t.open(), 48);
    t.app.news();
    t.app.later = true;
    EXPECT_TRUE(t.ms2(48, {0x5F, 1, 1, 4, 0, 0, 0, 0}).empty());
    EXPECT_TRUE(Dpv1Bench::pdu_of(t.acyclic(48, 50, {0x58, 0x02, 0x13})).empty());
    EXPECT_EQ(t.app.news(), (News{"dropped 48", "closed 48 by master 3"}));
    EXPECT_EQ(t.poll(48, 50), Octets{kRs});
}

TEST_P(Ms2, AnAbortThatMeetsAWaitingAnswerIsAnsweredWithIt) {
    ASSERT_EQ(t.open(), 48);
    t.app.records[{1, 1}] = {1};
    EXPECT_TRUE(Dpv1Bench::pdu_of(t.acyclic(48, 50, {0x5E, 1, 1, 4})).empty());
    EXPECT_EQ(Dpv1Bench::pdu_of(t.acyclic(48, 50, {0x58, 0x01, 0x20})), (Octets{0x5E, 1, 1, 1, 1})) << "5.2 step 5";
    EXPECT_EQ(t.poll(48, 50), Octets{kRs});
    EXPECT_EQ(t.open(), 47);
    EXPECT_EQ(t.open(), 48);
}

TEST_P(Ms2, UnknownServicesAreAnInvalidRequest) {
    for (const Octets& bad : {Octets{0x00}, Octets{0x56, 1, 2, 3}, Octets{0x57, 0}, Octets{0x5C, 1, 1, 1}, Octets{0xDE, 0, 0, 0}, Octets{0x48},
                              Octets{0x48, 0, 0}, Octets{0xFF}}) {
        const int sap = t.open();
        ASSERT_GT(sap, 0);
        EXPECT_EQ(t.ms2(sap, bad), (Octets{0x58, 0x00, 0x12})) << int{bad[0]};
        EXPECT_EQ(t.poll(static_cast<std::uint8_t>(sap), 50), Octets{kRs});
    }
    for (const Octets& abort : {Octets{0x58}, Octets{0x58, 0}, Octets{0x58, 0, 0x13}, Octets{0x58, 1, 0x20, 0}, Octets{0x58, 1, 0xFF, 0}, Octets{0x58, 0, 0, 0, 0, 0}}) {
        const int sap = t.open();
        ASSERT_GT(sap, 0);
        EXPECT_EQ(t.ms2(sap, abort), Octets{kRs}) << "an Abort is an Abort, whatever its length";
    }
}

TEST_P(Ms2, AnAnswerThatDoesNotComeInTimeIsReplacedByAnAbort) {
    ASSERT_EQ(t.open(120), 48);
    t.app.news();
    t.app.later = true;
    EXPECT_TRUE(t.ms2(48, {0x5E, 1, 1, 4}).empty());
    t.wait_ms(1180);
    EXPECT_TRUE(t.app.news().empty());
    t.wait_ms(30);
    EXPECT_EQ(t.app.news(), (News{"dropped 48", "closed 48 by driver 3"}));
    EXPECT_EQ(t.poll(48, 50), (Octets{0x58, 0x00, 0x13}));
    EXPECT_EQ(t.poll(48, 50), Octets{kRs});
}

TEST_P(Ms2, AConnectionThatTheApplicationDoesNotDecideAboutIsAborted) {
    t.app.initiate_later = true;
    ASSERT_EQ(Dpv1Bench::pdu_of(t.acyclic(49, 50, Dpv1Bench::initiate_req(100))).size(), 4U);
    t.wait_ms(1020);
    EXPECT_EQ(t.app.news(), (News{"dropped 48", "closed 48 by driver 3"}));
    EXPECT_EQ(t.poll(48, 50), (Octets{0x58, 0x00, 0x13}));
    EXPECT_FALSE(t.drv.complete(t.app.handle, accept_connection()));
}

TEST_P(Ms2, AnAbortThatNobodyFetchesEndsWithTheSecondTimeout) {
    ASSERT_EQ(t.open(100), 48);
    EXPECT_TRUE(Dpv1Bench::pdu_of(t.acyclic(48, 50, {0x00})).empty());
    t.wait_ms(980);
    EXPECT_EQ(t.drv.dpv1().connection(0), detail::C2State::aborting);
    t.wait_ms(30);
    EXPECT_EQ(t.drv.dpv1().connection(0), detail::C2State::closed);
    EXPECT_EQ(t.poll(48, 50), Octets{kRs});
    EXPECT_EQ(t.app.news(), (News{"open 48 by 2", "closed 48 by driver 2"})) << "said once";
}

TEST_P(Ms2, AnAnswerThatNobodyFetchesIsReplacedByAnAbort) {
    ASSERT_EQ(t.open(100), 48);
    t.app.news();
    EXPECT_TRUE(Dpv1Bench::pdu_of(t.acyclic(48, 50, {0x5E, 1, 1, 4})).empty());
    t.wait_ms(980);
    EXPECT_TRUE(t.app.news().empty());
    t.wait_ms(30);
    EXPECT_EQ(t.app.news(), (News{"closed 48 by driver 3"}));
    EXPECT_EQ(t.poll(48, 50), (Octets{0x58, 0x00, 0x13}));
    EXPECT_EQ(t.poll(48, 50), Octets{kRs});
}

TEST_P(Ms2, AMasterThatVanishesLosesItsConnectionAfterTwiceTheTimeAndOnceMore) {
    ASSERT_EQ(t.open(100), 48);
    t.app.news();
    t.wait_ms(1980);
    EXPECT_TRUE(t.app.news().empty());
    t.wait_ms(30);
    EXPECT_EQ(t.app.news(), (News{"closed 48 by driver 3"}));
    EXPECT_EQ(t.drv.dpv1().connection(0), detail::C2State::aborting);
    EXPECT_EQ(t.open(), 47);
    t.wait_ms(1000);
    EXPECT_EQ(t.drv.dpv1().connection(0), detail::C2State::closed);
    EXPECT_EQ(t.poll(48, 50), Octets{kRs});
}

TEST_P(Ms2, IdleKeepsAConnection) {
    ASSERT_EQ(t.open(100), 48);
    t.app.news();
    for (int i = 0; i < 10; ++i) {
        t.wait_ms(1000);
        EXPECT_EQ(t.ms2(48, {0x48, static_cast<std::uint8_t>(i)}), (Octets{0x48, static_cast<std::uint8_t>(i)}));
    }
    EXPECT_TRUE(t.app.news().empty());
}

TEST_P(Ms2, TheMastersSendTimeoutCountsWhenItIsTheLonger) {
    ASSERT_EQ(t.open(0), 48);
    EXPECT_EQ(t.app.send_timeout, 100);
    ASSERT_EQ(t.open(0xFFFF), 47);
    EXPECT_EQ(t.app.send_timeout, 0x7FFF);
    Config c = t.dpv1_config();
    c.dpv1.send_timeout = 250;
    Dpv1Bench own{GetParam()};
    own.power_up(c);
    EXPECT_EQ(Dpv1Bench::pdu_of(own.acyclic(49, 50, Dpv1Bench::initiate_req(200))), (Octets{0x56, 48, 0x00, 250}));
    EXPECT_EQ(own.app.send_timeout, 250);
}

TEST_P(Ms2, TheApplicationMayAbort) {
    ASSERT_EQ(t.open(), 48);
    t.app.news();
    EXPECT_FALSE(t.drv.abort_connection(47, 1));
    EXPECT_FALSE(t.drv.abort_connection(49, 1));
    EXPECT_TRUE(t.drv.abort_connection(48, 9));
    EXPECT_FALSE(t.drv.abort_connection(48, 9));
    EXPECT_EQ(t.app.news(), (News{"closed 48 by user 9"}));
    EXPECT_EQ(t.poll(48, 50), (Octets{0x58, 0x00, 0x29}));
    EXPECT_EQ(t.poll(48, 50), Octets{kRs});
}

TEST_P(Ms2, ConnectionsSurviveTheClass1MasterAndEndWithTheChip) {
    ASSERT_EQ(t.open(), 48);
    t.app.records[{1, 1}] = {1};
    t.master_starts();
    t.drv.leave_master();
    t.wait_ms(1);
    EXPECT_EQ(t.ms2(48, {0x5E, 1, 1, 1}), (Octets{0x5E, 1, 1, 1, 1}));
    t.app.news();
    t.drv.go_offline();
    t.wait_ms(1);
    EXPECT_EQ(t.app.news(), (News{"closed 48 by offline 0"}));
}

TEST_P(Ms2, AResponseIsRepeatedWhenTheMasterMissedIt) {
    ASSERT_EQ(t.open(), 48);
    t.app.records[{1, 1}] = {1, 2};
    EXPECT_TRUE(Dpv1Bench::pdu_of(t.acyclic(48, 50, {0x5E, 1, 1, 2})).empty());
    const std::uint8_t fc = t.fc;
    const Octets first = t.acyclic(48, 50, {});
    t.fc = fc;
    EXPECT_EQ(t.acyclic(48, 50, {}), first);
    EXPECT_EQ(t.ms2(48, {0x48, 1}), (Octets{0x48, 1})) << "the connection goes on";
}

TEST_P(Ms2, TimeMayComeFromTheProgramInsteadOfTheChip) {
    Config c = t.dpv1_config();
    c.user_timer = UserTimer::off;
    Dpv1Bench u{GetParam()};
    u.power_up(c);
    ASSERT_EQ(u.open(100), 48);
    u.app.news();
    u.wait_ms(5000);
    EXPECT_TRUE(u.app.news().empty());
    for (int i = 0; i < 199; ++i) u.drv.tick(10);
    EXPECT_TRUE(u.app.news().empty());
    u.drv.tick(10);
    EXPECT_EQ(u.app.news(), (News{"closed 48 by driver 3"}));
}

}  // namespace
}  // namespace dpchip::driver
