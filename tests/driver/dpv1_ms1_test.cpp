// SPDX-License-Identifier: Apache-2.0
// MS1 from the master's side: records, refusals, bad PDUs, deferred answers, I&M (reference 5.3, 5.6; C113 to C117, C121).
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

class Ms1 : public ::testing::TestWithParam<Kind> {
protected:
    Dpv1Bench t{GetParam()};
    Octets too_long_ = Octets(242);
};
INSTANTIATE_TEST_SUITE_P(AllChips, Ms1, ::testing::ValuesIn(kDpv1Kinds), [](const auto& param) { return std::string{param.param.name}; });

TEST_P(Ms1, IsOpenedByAnAcceptedConfigurationAndClosedWhenTheMasterLeaves) {
    t.power_up(t.dpv1_config());
    EXPECT_EQ(t.ms1({0x5E, 1, 0x10, 4}), Octets{kRs}) << "nobody's yet";
    t.master_starts();
    EXPECT_EQ(t.app.news(), (std::vector<std::string>{"ms1 open 2"}));
    EXPECT_EQ(t.ms1({0x5E, 1, 0x10, 4}), (Octets{0xDE, 0x80, 0xB0, 0x00}));
    t.drv.leave_master();
    t.wait_ms(1);
    EXPECT_EQ(t.app.news(), (std::vector<std::string>{"ms1 closed"}));
    EXPECT_EQ(t.ms1({0x5E, 1, 0x10, 4}), Octets{kRs});
    EXPECT_EQ(t.poll(51, 51), Octets{kRs});
    t.master = 3;
    t.master_starts();
    EXPECT_EQ(t.app.news(), (std::vector<std::string>{"ms1 open 3"}));
    EXPECT_EQ(t.ms1({0x5E, 1, 0x10, 4}), (Octets{0xDE, 0x80, 0xB0, 0x00}));
}

// proves: VPC3C 7.2.1-02
// proves: VPC3C 6.2.2-14, VPC3C 7.2.1-02
TEST_P(Ms1, StaysClosedWithoutDpv1Enable) {
    t.to_dpv1(t.dpv1_config(), 0x00);
    EXPECT_FALSE(t.drv.dpv1().ms1_open());
    EXPECT_EQ(t.ms1({0x5E, 1, 0x10, 4}), Octets{kRs});
}

TEST_P(Ms1, NewParametersInDataExchangeKeepItOrCloseIt) {
    t.to_dpv1();
    t.request(61, {0x80, 1, 1, 11, 0x47, 0x11, 0, 0x80, 0, 0});
    EXPECT_TRUE(t.drv.dpv1().ms1_open());
    EXPECT_TRUE(t.app.news().empty());
    t.request(61, {0x80, 1, 1, 11, 0x47, 0x11, 0, 0x00, 0, 0});
    EXPECT_EQ(t.app.news(), (std::vector<std::string>{"ms1 closed"}));
    EXPECT_EQ(t.ms1({0x5E, 1, 0x10, 4}), Octets{kRs});
}

// proves: VPC3C 1-03, VPC3C 7.2.1-54
TEST_P(Ms1, ReadsAndWritesAsTheReferenceShows) {
    t.to_dpv1();
    t.app.records[{1, 0x10}] = {1, 2, 3, 4};
    EXPECT_EQ(t.check("68 09 09 68 88 82 5D 33 33 5E 01 10 04 40 16"), hex("E5")) << "C113";
    EXPECT_EQ(t.check("68 05 05 68 88 82 7D 33 33 ED 16"), hex("68 0D 0D 68 82 88 08 33 33 5E 01 10 04 01 02 03 04 F5 16")) << "C114";
    EXPECT_EQ(t.check("68 05 05 68 88 82 7D 33 33 ED 16"), hex("E5")) << "the answer has been fetched";
    const std::uint16_t list = t.drv.dpv1().layout().entry(channel::ms1);
    EXPECT_EQ(t.chip.peek(list), 0x33) << "Response_Sent has been cleared";
    EXPECT_EQ(t.chip.peek(static_cast<std::uint16_t>(list + 1)), 0x82);
    EXPECT_EQ(t.chip.peek(static_cast<std::uint16_t>(list + 2)), 0x33);
    EXPECT_EQ(t.ms1({0x5F, 2, 7, 2, 0xAA, 0xBB}), (Octets{0x5F, 2, 7, 2}));
    EXPECT_EQ(t.ms1({0x5E, 2, 7, 240}), (Octets{0x5E, 2, 7, 2, 0xAA, 0xBB}));
}

// proves: VPC3C 7.2.1-05
TEST_P(Ms1, AnotherMasterIsNotServed) {
    t.to_dpv1();
    t.master = 3;
    EXPECT_EQ(t.check("68 09 09 68 88 83 6D 33 33 5E 01 10 04 51 16"), hex("10 03 08 03 0E 16")) << "C115";
    EXPECT_EQ(t.poll(51, 51), Octets{kRs});
    t.master = 2;
    EXPECT_EQ(Dpv1Bench::pdu_of(t.acyclic(51, 50, {0x5E, 1, 0x10, 4})), Octets{kRs}) << "nor another SSAP";
    EXPECT_TRUE(t.app.calls.empty());
}

// proves: VPC3C 7.2.1-05
TEST_P(Ms1, ASecondRequestFindsNoBuffer) {
    t.to_dpv1();
    t.app.later = true;
    EXPECT_TRUE(t.ms1({0x5E, 1, 0x10, 4}).empty());
    EXPECT_EQ(t.check("68 09 09 68 88 82 7D 33 33 5E 01 10 04 60 16"), hex("10 02 08 02 0C 16")) << "C116";
    EXPECT_TRUE(t.drv.complete(t.app.handle, refused(dp::ErrorCode1::invalid_index)));
    EXPECT_EQ(t.check("68 05 05 68 88 82 5D 33 33 CD 16"), hex("68 09 09 68 82 88 08 33 33 DE 80 B0 00 86 16")) << "C117";
    EXPECT_FALSE(t.drv.complete(t.app.handle, answered())) << "answered already";
}

TEST_P(Ms1, AnswersComeLater) {
    t.to_dpv1();
    t.app.later = true;
    EXPECT_TRUE(t.ms1({0x5E, 1, 0x10, 3}).empty());
    for (int i = 0; i < 5; ++i) EXPECT_TRUE(t.poll(51, 51).empty());
    const Octets data{9, 8, 7, 6};
    EXPECT_TRUE(t.drv.complete(t.app.handle, answered(), data));
    EXPECT_EQ(t.poll(51, 51), (Octets{0x5E, 1, 0x10, 3, 9, 8, 7})) << "no more than was asked for";
    EXPECT_TRUE(t.ms1({0x5F, 1, 0x10, 3, 1, 2, 3}).empty());
    EXPECT_FALSE(t.drv.complete(t.app.handle, answer_later()));
    EXPECT_TRUE(t.drv.complete(t.app.handle, answered(2)));
    EXPECT_EQ(t.poll(51, 51), (Octets{0x5F, 1, 0x10, 2}));
}

TEST_P(Ms1, ADeferredRequestDiesWithTheRelation) {
    t.to_dpv1();
    t.app.later = true;
    EXPECT_TRUE(t.ms1({0x5E, 1, 0x10, 3}).empty());
    const Handle old = t.app.handle;
    t.drv.leave_master();
    t.wait_ms(1);
    EXPECT_EQ(t.app.news(), (std::vector<std::string>{"dropped 51", "ms1 closed"}));
    t.master_starts();
    EXPECT_TRUE(t.ms1({0x5E, 1, 0x10, 3}).empty());
    EXPECT_FALSE(t.drv.complete(old, answered(), Octets{1, 2, 3}));
    EXPECT_TRUE(t.drv.complete(t.app.handle, answered(), Octets{1, 2, 3}));
}

TEST_P(Ms1, EveryErrorCodeReachesTheMaster) {
    t.to_dpv1();
    for (int code = 0xA0; code < 0xE0; ++code) {
        const auto c = static_cast<std::uint8_t>(code);
        t.app.refusals[{1, 1}] = {0x80, c, 0x5A};
        EXPECT_EQ(t.ms1({0x5E, 1, 1, 10}), (Octets{0xDE, 0x80, c, 0x5A}));
        EXPECT_EQ(t.ms1({0x5F, 1, 1, 1, 0}), (Octets{0xDF, 0x80, c, 0x5A}));
    }
    t.app.refusals[{1, 1}] = {0xFE, 1, 2};
    EXPECT_EQ(t.ms1({0x5E, 1, 1, 10}), (Octets{0xDE, 0xFE, 1, 2}));
}

TEST_P(Ms1, LengthsThatCannotBeAreATypeConflict) {
    t.to_dpv1();
    const Octets read_conflict{0xDE, 0x80, 0xB3, 0x00}, write_conflict{0xDF, 0x80, 0xB3, 0x00}, ack_conflict{0xDC, 0x80, 0xB3, 0x00};
    for (const Octets& bad : {Octets{0x5E}, Octets{0x5E, 1}, Octets{0x5E, 1, 1}, Octets{0x5E, 1, 1, 0}, Octets{0x5E, 1, 1, 241},
                              Octets{0x5E, 1, 1, 4, 0}})
        EXPECT_EQ(t.ms1(bad), read_conflict) << bad.size();
    for (const Octets& bad : {Octets{0x5F}, Octets{0x5F, 1, 1}, Octets{0x5F, 1, 1, 0}, Octets{0x5F, 1, 1, 2, 0}, Octets{0x5F, 1, 1, 2, 0, 0, 0},
                              Octets{0x5F, 1, 1, 0xFF, 0}})
        EXPECT_EQ(t.ms1(bad), write_conflict) << bad.size();
    for (const Octets& bad : {Octets{0x5C}, Octets{0x5C, 1, 1}, Octets{0x5C, 1, 1, 1, 1}}) EXPECT_EQ(t.ms1(bad), ack_conflict);
    EXPECT_TRUE(t.app.calls.empty());
    EXPECT_EQ(t.drv.dp_state(), 2);
}

TEST_P(Ms1, RecordsOf240OctetsAndNotOneMore) {
    t.to_dpv1();
    Octets write{0x5F, 1, 1, 240};
    for (int i = 0; i < 240; ++i) write.push_back(static_cast<std::uint8_t>(i));
    EXPECT_EQ(t.ms1(write), (Octets{0x5F, 1, 1, 240}));
    write[0] = 0x5E;
    EXPECT_EQ(t.ms1({0x5E, 1, 1, 240}), write);
    Config c = t.dpv1_config();
    c.dpv1.ms1_max_data = 16;
    Dpv1Bench small{GetParam()};
    small.to_dpv1(c);
    EXPECT_EQ(small.ms1({0x5F, 1, 1, 17, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}), Octets{kRr}) << "longer than the buffer";
    small.app.records[{1, 1}] = Octets(100, 0x55);
    EXPECT_EQ(small.ms1({0x5E, 1, 1, 240}).size(), 20U);
}

TEST_P(Ms1, AnUnknownFunctionLosesTheMaster) {
    for (int function = 1; function < 256; ++function) {
        if (function == 0x5C || function == 0x5E || function == 0x5F) continue;
        if (function % 37 != 0 && function != 0x48 && function != 0x51 && function != 0x56 && function != 0x57 && function != 0x58) continue;
        Dpv1Bench fresh{GetParam()};
        fresh.to_dpv1();
        EXPECT_EQ(fresh.drv.dp_state(), 2);
        fresh.acyclic(51, 51, {static_cast<std::uint8_t>(function), 0, 0, 0});
        EXPECT_EQ(fresh.drv.dp_state(), 0) << function;
        EXPECT_EQ(fresh.app.news(), (std::vector<std::string>{"ms1 closed"}));
    }
    t.to_dpv1();
    t.acyclic(50, 51, {0x5E, 1, 1, 4});
    EXPECT_EQ(t.drv.dp_state(), 0) << "SAP 50 is for Alarm_Ack alone";
}

TEST_P(Ms1, AMasterThatVanishesInMidRequestLeavesNothingBehind) {
    t.to_dpv1();
    t.app.later = true;
    t.acyclic(51, 51, {0x5E, 1, 1, 4});
    t.drv.restart();
    t.wait_ms(1);
    EXPECT_EQ(t.app.news(), (std::vector<std::string>{"dropped 51", "ms1 closed"}));
    t.app.later = false;
    t.app.baud = -1;
    for (int i = 0; i < 200 && t.app.baud < 0; ++i) t.fdl_status();
    t.master = 7;
    t.master_starts();
    EXPECT_EQ(t.ms1({0x5E, 1, 1, 4}), (Octets{0xDE, 0x80, 0xB0, 0x00}));
}

TEST_P(Ms1, IdentificationIsCalledAndThenRead) {
    t.to_dpv1();
    dp::Im0 im0{};
    im0.manufacturer_id = 0x4711;
    im0.im_supported = 0x0E;
    t.app.im[dp::kIm0] = dp::encode(im0);
    t.app.im[dp::kIm0 + 1] = dp::encode(dp::Im1{});
    EXPECT_EQ(t.ms1({0x5E, 0, 0xFF, 68}), (Octets{0xDE, 0x80, 0xB5, 0x00})) << "nothing has been called";
    EXPECT_EQ(t.check("68 0D 0D 68 88 82 5D 33 33 5F 00 FF 04 08 00 FD E8 1C 16"), hex("E5")) << "C121";
    EXPECT_EQ(t.poll(51, 51), (Octets{0x5F, 0, 0xFF, 4}));
    EXPECT_EQ(t.check("68 09 09 68 88 82 7D 33 33 5E 00 FF 44 8E 16"), hex("E5"));
    const Octets answer = t.poll(51, 51);
    ASSERT_EQ(answer.size(), 72U);
    EXPECT_EQ(Octets(answer.begin(), answer.begin() + 8), (Octets{0x5E, 0, 0xFF, 68, 8, 0, 0xFD, 0xE8}));
    EXPECT_EQ(*dp::decode_im0(std::span{answer}.subspan(8)), im0);
    EXPECT_EQ(t.ms1({0x5E, 0, 0xFF, 68}), (Octets{0xDE, 0x80, 0xB5, 0x00})) << "a call is good for one read";
}

TEST_P(Ms1, IdentificationRefusesWhatItDoesNotHave) {
    t.to_dpv1();
    t.app.im[dp::kIm0] = dp::encode(dp::Im0{});
    t.app.im[dp::kIm0 + 1] = dp::encode(dp::Im1{});
    EXPECT_EQ(t.ms1({0x5F, 0, 0xFF, 4, 8, 0, 0xFD, 0xED}), (Octets{0xDF, 0x80, 0xB0, 0x00})) << "I&M5";
    EXPECT_EQ(t.ms1({0x5F, 1, 0xFF, 4, 8, 0, 0xFD, 0xE8}), (Octets{0xDF, 0x80, 0xB0, 0x00})) << "another slot";
    EXPECT_EQ(t.ms1({0x5F, 0, 0xFF, 4, 8, 1, 0xFD, 0xE8}), (Octets{0xDF, 0x80, 0xB8, 0x00})) << "not a call";
    EXPECT_EQ(t.ms1({0x5F, 0, 0xFF, 5, 8, 0, 0xFD, 0xE8, 0}), (Octets{0xDF, 0x80, 0xB1, 0x00})) << "neither 4 nor 68";
    Octets write{0x5F, 0, 0xFF, 68, 8, 0, 0xFD, 0xE9};
    const dp::ImOctets tag = dp::encode(dp::Im1{dp::im_text<32>(std::span{"pump", 4}), {}});
    write.insert(write.end(), tag.begin(), tag.end());
    EXPECT_EQ(t.ms1({0x5F, 0, 0xFF, 4, 8, 0, 0xFD, 0xE9}), (Octets{0x5F, 0, 0xFF, 4}));
    EXPECT_EQ(t.ms1(write), (Octets{0x5F, 0, 0xFF, 68}));
    EXPECT_EQ(t.app.im[dp::kIm0 + 1], tag);
    EXPECT_EQ(t.ms1({0x5E, 0, 0xFF, 68}), (Octets{0xDE, 0x80, 0xB5, 0x00})) << "a written record gives nothing to read";
    write[7] = 0xE8;
    EXPECT_EQ(t.ms1(write), (Octets{0xDF, 0x80, 0xB6, 0x00})) << "I&M0 is not written";
    EXPECT_EQ(t.ms1({0x5F, 0, 0xFF, 4, 8, 0, 0xFD, 0xE8}), (Octets{0x5F, 0, 0xFF, 4}));
    EXPECT_EQ(t.ms1({0x5E, 1, 0xFF, 68}), (Octets{0xDE, 0x80, 0xB5, 0x00})) << "called on slot 0";
    EXPECT_EQ(t.ms1({0x5E, 0, 0xFF, 10}).size(), 14U) << "as short as the master wants it";
}

}  // namespace
}  // namespace dpchip::driver
