// SPDX-License-Identifier: Apache-2.0
// MS1, MS2, alarms and status messages in words; telegrams of the reference's checks C113 to C122.
#include <gtest/gtest.h>

#include <random>

#include <dpchip/dp/identification.hpp>
#include <dpchip/gsd/parse.hpp>
#include <dpchip/trace/dialogue.hpp>
#include <dpchip/trace/gsd_texts.hpp>
#include <dpchip/trace/service_text.hpp>

#include "octets.hpp"

namespace dpchip::trace {
namespace {

struct Said { const char* octets; const char* line; };
class AcyclicTelegram : public testing::TestWithParam<Said> {};

TEST_P(AcyclicTelegram, ReadsLikeThis) {
    EXPECT_EQ(Dialogue{}.next(octets(GetParam().octets)).line, GetParam().line);
}

INSTANTIATE_TEST_SUITE_P(Reference, AcyclicTelegram, testing::Values(
    Said{"68 09 09 68 88 82 5D 33 33 5E 01 10 04 40 16", "SD2 2->8 SRD high FCB=0 MS1 DS_Read slot 1 index 16, up to 4 octets"},
    Said{"68 0D 0D 68 82 88 08 33 33 5E 01 10 04 01 02 03 04 F5 16", "SD2 8->2 DL MS1: DS_Read slot 1 index 16, 4 octets: 01 02 03 04"},
    Said{"68 05 05 68 88 82 7D 33 33 ED 16", "SD2 2->8 SRD high FCB=1 MS1 poll"},
    Said{"68 09 09 68 82 88 08 33 33 DE 80 B0 00 86 16", "SD2 8->2 DL MS1: DS_Read refused: invalid index (access), 80 B0 00"},
    Said{"68 19 19 68 88 82 5D 31 32 57 00 00 00 03 E8 01 00 00 00 00 00 00 02 00 02 00 00 00 00 11 16",
         "SD2 2->8 SRD high FCB=0 MS2 Resource_Manager Initiate Send_Timeout 10000 ms, DS_Read and DS_Write"},
    Said{"68 09 09 68 82 88 08 32 31 56 30 00 64 5F 16", "SD2 8->2 DL MS2 Resource_Manager: RM SAP 48, Send_Timeout 1000 ms"},
    Said{"68 15 15 68 82 88 08 32 30 57 F0 01 00 00 00 00 00 00 02 00 02 00 00 00 00 C0 16",
         "SD2 8->2 DL MS2 SAP 48: Initiate longest record 240 octets, DS_Read and DS_Write"},
    Said{"68 07 07 68 88 82 5D 30 32 48 00 11 16", "SD2 2->8 SRD high FCB=0 MS2 SAP 48 Idle"},
    Said{"68 09 09 68 88 82 5D 30 32 58 01 20 00 42 16", "SD2 2->8 SRD high FCB=0 MS2 SAP 48 Abort by user: reason 0, local subnet"},
    Said{"68 0D 0D 68 88 82 5D 33 33 5F 00 FF 04 08 00 FD E8 1C 16",
         "SD2 2->8 SRD high FCB=0 MS1 DS_Write slot 0 index 255, 4 octets: 08 00 FD E8 (I&M0 call)"},
    Said{"68 09 09 68 82 88 08 33 33 5F 00 FF 04 DA 16", "SD2 8->2 DL MS1: DS_Write slot 0 index 255, 4 octets taken"},
    Said{"68 09 09 68 88 82 5D 33 33 5C 01 02 08 34 16", "SD2 2->8 SRD high FCB=0 MS1 Alarm_Ack Process_Alarm slot 1 Seq_Nr 1"}));

struct Spoken { dp::AcyclicDirection way; const char* octets; const char* words; };
class AcyclicPdu : public testing::TestWithParam<Spoken> {};

TEST_P(AcyclicPdu, ReadsLikeThis) { EXPECT_EQ(acyclic_text(GetParam().way, octets(GetParam().octets)).words, GetParam().words); }

constexpr auto kReq = dp::AcyclicDirection::request, kRes = dp::AcyclicDirection::answer;
INSTANTIATE_TEST_SUITE_P(More, AcyclicPdu, testing::Values(
    Spoken{kReq, "", "poll"},
    Spoken{kRes, "58 00 13", "Abort by MSAC_C2: timeout (TO)"},
    Spoken{kRes, "58 00 05", "Abort by FDL: reason 5"},
    Spoken{kReq, "51 01 02 01 AA", "Data_Transport slot 1 index 2, 1 octet: AA"},
    Spoken{kRes, "DF FF 12 34", "DS_Write refused: error of HART, FF 12 34"},
    Spoken{kRes, "DC 80 B5 00", "Alarm_Ack refused: state conflict (access), 80 B5 00"},
    Spoken{kReq, "5E 01 02 00", "DS_Read damaged (Length is 0): 5E 01 02 00"},
    Spoken{kReq, "5F 01 02 05 AA", "DS_Write damaged (Length does not fit the octets): 5F 01 02 05 AA"},
    Spoken{kReq, "57 00", "Initiate damaged (too few octets): 57 00"},
    Spoken{kReq, "42 00", "unknown function damaged (another or an unknown function): 42 00"}));

TEST(AcyclicText, NeverFailsOverAnyOctets) {
    std::mt19937 random{5};
    for (int i = 0; i < 20'000; ++i) {
        std::vector<std::uint8_t> pdu(random() % 30);
        for (auto& o : pdu) o = static_cast<std::uint8_t>(random());
        if (!pdu.empty() && i % 2 == 0) pdu[0] = std::vector<std::uint8_t>{0x48, 0x51, 0x56, 0x57, 0x58, 0x5C, 0x5E, 0x5F, 0xDE, 0xDF}[random() % 10];
        for (const auto way : {kReq, kRes}) ASSERT_EQ(acyclic_text(way, pdu).words.empty(), pdu.empty() && way == kRes);
    }
}

TEST(AcyclicText, TakesIdentificationApart) {
    dp::Im0 im0{};
    im0.manufacturer_id = 0x002A;
    im0.order_id = dp::im_text<20>(std::string_view{"6ES7 1"});
    im0.software_revision = {'V', 2, 0, 11};
    im0.im_supported = 0x06;
    std::vector<std::uint8_t> pdu{0x5E, 0, 255, 68, 8, 0, 0xFD, 0xE8};
    for (const std::uint8_t o : dp::encode(im0)) pdu.push_back(o);
    const DataText text = acyclic_text(kRes, pdu);
    EXPECT_TRUE(text.words.ends_with("(I&M0)"));
    const std::vector<std::string> lines = im_record_text(dp::kIm0, std::span{pdu}.subspan(8));
    EXPECT_EQ(lines, (std::vector<std::string>{"MANUFACTURER_ID 002AH", "ORDER_ID \"6ES7 1\"", "SERIAL_NUMBER \"\"", "HARDWARE_REVISION 0",
                                               "SOFTWARE_REVISION V2.0.11", "REVISION_COUNTER 0", "PROFILE_ID 0000H, PROFILE_SPECIFIC_TYPE 0000H",
                                               "IM_VERSION 1.1", "IM_SUPPORTED 0006H: I&M1 I&M2"}));
    for (const std::string& line : lines) EXPECT_NE(std::ranges::find(text.details, line), text.details.end()) << line;
    EXPECT_EQ(im_record_text(dp::kIm0 + 2, dp::encode(dp::Im2{dp::im_text<16>(std::string_view{"2026-11-22"})})),
              (std::vector<std::string>{"INSTALLATION_DATE \"2026-11-22\""}));
    EXPECT_TRUE(im_record_text(0, {}).empty());
    EXPECT_TRUE(im_record_text(dp::kIm0, {}).empty());
}

class DiagnosisOfADpv1Slave : public testing::Test {
protected:
    const gsd::Gsd v1_ = [] {
        gsd::Gsd g;
        g.dpv1.slave = true;
        return g;
    }();
    const gsd::Gsd v0_{};
    GsdTexts texts_;
    std::string words(std::uint8_t station, const char* ext) {
        return diag_text(octets(std::string{"08 0C 00 02 47 11 "} + ext), station, &texts_).words;
    }
    void SetUp() override {
        texts_.set(8, &v1_);
        texts_.set(9, &v0_);
    }
};

TEST_F(DiagnosisOfADpv1Slave, SaysAlarmsAndStatusMessagesInWords) {
    EXPECT_TRUE(words(8, "06 01 01 19 AA BB").ends_with(", Diagnostic_Alarm slot 1 Seq_Nr 3 appears: AA BB"));
    EXPECT_TRUE(words(8, "04 02 05 FC").ends_with(", Process_Alarm slot 5 Seq_Nr 31, Add_Ack"));
    EXPECT_TRUE(words(8, "04 28 00 03").ends_with(", Manufacturer_Specific_Alarm 40 slot 0 Seq_Nr 0 disappears, others remain"));
    EXPECT_TRUE(words(8, "04 81 02 02").ends_with(", Status_Message slot 2 disappears"));
    EXPECT_TRUE(words(8, "06 82 00 00 84 03").ends_with(", Modul_Status: slot 2 fault, slot 4 wrong module, slot 5 no module"));
    EXPECT_TRUE(words(8, "05 82 00 00 00").ends_with(", Modul_Status: all slots ok"));
    EXPECT_TRUE(words(8, "04 07 01 00").ends_with(", reserved 7 slot 1 Seq_Nr 0"));
}

TEST_F(DiagnosisOfADpv1Slave, IsAGuessWithoutGsdAndNothingForAnother) {
    EXPECT_TRUE(words(7, "04 01 01 09").ends_with(", with DP-V1 Diagnostic_Alarm slot 1 Seq_Nr 1 appears"));
    EXPECT_EQ(words(7, "04 07 01 00").find("DP-V1"), std::string::npos);
    EXPECT_EQ(words(7, "04 81 01 0C").find("DP-V1"), std::string::npos);
    EXPECT_EQ(words(9, "04 01 01 09").find("Alarm"), std::string::npos);
}

}  // namespace
}  // namespace dpchip::trace
