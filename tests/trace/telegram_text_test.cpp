// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include <dpchip/trace/dialogue.hpp>
#include <dpchip/trace/text.hpp>

#include "octets.hpp"

namespace dpchip::trace {
namespace {

/// A telegram from its addresses, FC and data unit; FCS and delimiters are put around it.
std::vector<std::uint8_t> telegram(std::uint8_t da, std::uint8_t sa, std::uint8_t fc, std::string_view unit) {
    std::vector<std::uint8_t> out(fdl::kMaxLe + 6u);
    out.resize(fdl::encode(out, da, sa, fc, octets(unit)));
    return out;
}

struct Spoken { std::vector<std::uint8_t> octets; const char* line; };

class OneTelegram : public testing::TestWithParam<Spoken> {};

TEST_P(OneTelegram, ReadsLikeThis) {
    Dialogue dialogue;
    EXPECT_EQ(dialogue.next(GetParam().octets).line, GetParam().line);
}

INSTANTIATE_TEST_SUITE_P(Requests, OneTelegram, testing::Values(
    Spoken{octets("10 08 02 49 53 16"), "SD1 2->8 FDL_Status"},
    Spoken{octets("DC 03 02"), "SD4 2->3 token"},
    Spoken{octets("E5"), "SC acknowledged"},
    Spoken{octets("68 05 05 68 82 E3 6D 3C 3E 4C 16"), "SD2 99->2 SRD high FCB=1 first Slave_Diag"},
    Spoken{telegram(0x88, 0x82, 0x5D, "3D 3E 88 01 0A 0B 47 11 00"),
           "SD2 2->8 SRD high FCB=0 Set_Prm Lock_Req, WD_On, WD 100 ms, minTSDR 11 tBit, ident 4711H"},
    Spoken{telegram(0x88, 0x82, 0x7D, "3D 3E B8 64 64 00 47 11 05 80 00 08"),
           "SD2 2->8 SRD high FCB=1 Set_Prm Lock_Req, Sync_Req, Freeze_Req, WD_On, WD 100 s, ident 4711H, groups 1 3, user 80 00 08"},
    Spoken{telegram(0x88, 0x82, 0x7D, "3D 3E 80 01 01"), "SD2 2->8 SRD high FCB=1 Set_Prm fewer than 7 octets: 80 01 01"},
    Spoken{telegram(0x88, 0x82, 0x7D, "3E 3E 21 11"), "SD2 2->8 SRD high FCB=1 Chk_Cfg 2 out, 2 in: 21 11"},
    Spoken{telegram(0x88, 0x82, 0x7D, "3E 3E C1 81"), "SD2 2->8 SRD high FCB=1 Chk_Cfg 0 out, 0 in: C1 81 (block cut short)"},
    Spoken{octets("68 07 07 68 FF 82 46 3A 3E 02 00 41 16"), "SD2 2->all SDN high Global_Control Clear_Data to all"},
    Spoken{telegram(0xFF, 0x82, 0x46, "3A 3E 00 03"), "SD2 2->all SDN high Global_Control Operate to groups 1 2"},
    Spoken{telegram(0xFF, 0x82, 0x46, "3A 3E 80 00"), "SD2 2->all SDN high Global_Control reserved bits 80H to all"},
    Spoken{telegram(0xFF, 0x82, 0x46, "3A 3E 80"), "SD2 2->all SDN high Global_Control not 2 octets: 80"},
    Spoken{telegram(0xFE, 0x82, 0x7D, "37 3E 05 47 11 00"), "SD2 2->126 SRD high FCB=1 Set_Slave_Add new address 5, ident 4711H"},
    Spoken{telegram(8, 2, 0x7D, "12 34"), "SD2 2->8 SRD high FCB=1 Data_Exchange out 12 34"},
    Spoken{octets("10 08 02 7D 87 16"), "SD1 2->8 SRD high FCB=1 Data_Exchange"},
    Spoken{telegram(0x88, 0x82, 0x7D, "3B 3E"), "SD2 2->8 SRD high FCB=1 Get_Cfg"},
    Spoken{telegram(0x88, 0x82, 0x7D, "34 3E 01"), "SD2 2->8 SRD high FCB=1 SAP 52 data 01"},
    Spoken{telegram(0x88, 0x82, 0x7D, "33 33 5E 01 02 03"), "SD2 2->8 SRD high FCB=1 MS1 DS_Read slot 1 index 2, up to 3 octets"},
    Spoken{telegram(0x88, 0x82, 0x7D, "3D"), "SD2 2->8 no room for the SAP octets that DA and SA announce: 3D"},
    Spoken{telegram(8, 2, 0x41, ""), "SD1 2->8 reserved function 1"},
    Spoken{octets("10 02 63 49 AF 16"), "rejected, wrong FCS: 10 02 63 49 AF 16"},
    Spoken{octets("10 02 63"), "rejected, incomplete: 10 02 63"},
    Spoken{octets("42"), "rejected, no start delimiter: 42"}));

INSTANTIATE_TEST_SUITE_P(AnswersAlone, OneTelegram, testing::Values(
    Spoken{octets("10 02 08 00 0A 16"), "SD1 8->2 OK FDL_Status: slave"},
    Spoken{telegram(2, 3, 0x30, ""), "SD1 3->2 OK FDL_Status: master in ring"},
    Spoken{octets("10 02 08 03 0D 16"), "SD1 8->2 RS refused: service or SAP not activated"},
    Spoken{octets("68 0B 0B 68 E3 82 08 3E 3C 02 05 00 FF 0C DA D3 16"),
           "SD2 2->99 DL Slave_Diag: Station_Not_Ready, Prm_Req, no master, ident 0CDAH"},
    Spoken{telegram(0x82, 0x88, 0x08, "3E 3C 0A 0C 80 02 47 11 42 01"),
           "SD2 8->2 DL Slave_Diag: Station_Not_Ready, Ext_Diag, WD_On, Ext_Diag_Overflow, master 2, ident 4711H, Ext_Diag_Data 42 01"},
    Spoken{telegram(0x82, 0x88, 0x08, "3E 3C 00 01"), "SD2 8->2 DL Slave_Diag: fewer than 6 octets: 00 01"},
    Spoken{telegram(0x82, 0x88, 0x08, "3E 3B 31"), "SD2 8->2 DL Get_Cfg: 2 out, 2 in: 31"},
    Spoken{telegram(2, 8, 0x08, "01 02"), "SD2 8->2 DL Data_Exchange in 01 02"},
    Spoken{telegram(2, 8, 0x0A, "01 02"), "SD2 8->2 DH Data_Exchange diagnosis waiting in 01 02"},
    Spoken{telegram(2, 8, 0x0B, ""), "SD1 8->2 reserved response 11"}));

TEST(DialogueOfAStartUp, GivesEveryAnswerTheNameOfItsRequest) {
    Dialogue dialogue;
    const std::pair<std::vector<std::uint8_t>, const char*> conversation[]{
        {octets("10 08 02 49 53 16"), "SD1 2->8 FDL_Status"},
        {octets("10 02 08 00 0A 16"), "SD1 8->2 OK FDL_Status: slave"},
        {telegram(0x88, 0x82, 0x6D, "3D 3E 88 01 0A 00 47 11 00"), "SD2 2->8 SRD high FCB=1 first Set_Prm Lock_Req, WD_On, WD 100 ms, ident 4711H"},
        {octets("E5"), "SC 8->2 Set_Prm acknowledged"},
        {telegram(0x88, 0x82, 0x5D, "3E 3E 31"), "SD2 2->8 SRD high FCB=0 Chk_Cfg 2 out, 2 in: 31"},
        {telegram(0x88, 0x82, 0x5D, "3E 3E 31"), "SD2 2->8 SRD high FCB=0 repeated Chk_Cfg 2 out, 2 in: 31"},
        {octets("E5"), "SC 8->2 Chk_Cfg acknowledged"},
        {telegram(8, 2, 0x7D, "12 34"), "SD2 2->8 SRD high FCB=1 Data_Exchange out 12 34"},
        {octets("10 02 08 03 0D 16"), "SD1 8->2 RS Data_Exchange refused: service or SAP not activated"},
        {telegram(8, 2, 0x5D, "12 34"), "SD2 2->8 SRD high FCB=0 Data_Exchange out 12 34"},
        {octets("DC 02 02"), "SD4 2->2 token"},
        {octets("E5"), "SC acknowledged"},
    };
    for (const auto& [octets, line] : conversation) EXPECT_EQ(dialogue.next(octets).line, line);
}

TEST(Details, NameEveryOctetOfSetPrm) {
    const auto t = telegram(0x88, 0x82, 0x5D, "3D 3E 88 01 0A 0B 47 11 05 80 04 08 06 81 00 00 AA BB");
    const Explanation e = explain(*fdl::decode(t));
    const std::vector<std::string> expected{
        "DA 88H: station 8, DSAP follows", "SA 82H: station 2, SSAP follows", "FC 5DH: request SRD high, FCB 0, FCV 1",
        "DSAP 61, SSAP 62: Set_Prm", "Station_Status 88H: Lock_Req, WD_On", "WD_Fact 1 * 10: 100 ms", "minTSDR 11 tBit",
        "Ident_Number 4711H", "Group_Ident 05H: groups 1 3", "DPV1_Status_1 80H: DPV1_Enable", "DPV1_Status_2 04H: Enable_Update_Alarm",
        "DPV1_Status_3 08H: Prm_Structure", "User_Prm_Data slot 0: AA BB"};
    EXPECT_EQ(e.details, expected);
}

TEST(Details, TakeConfigurationsApart) {
    const auto t = telegram(0x88, 0x82, 0x5D, "3E 3E 31 00 C3 CF C7 01 02 03 F1");
    const Explanation e = explain(*fdl::decode(t));
    ASSERT_EQ(e.details.size(), 8u);
    EXPECT_EQ(e.details[4], "Cfg 31: 2 octets out, 2 octets in");
    EXPECT_EQ(e.details[5], "Cfg 00: empty slot");
    EXPECT_EQ(e.details[6], "Cfg C3 CF C7 01 02 03: 16 words out consistent, 8 words in consistent, manufacturer 01 02 03");
    EXPECT_EQ(e.details[7], "Cfg F1: 2 words out consistent, 2 words in consistent");
}

class Texts final : public DeviceTexts {
public:
    std::vector<std::string> device_diag(std::uint8_t station, std::span<const std::uint8_t> data) const override {
        if (station != 8 || data.size() < 2 || (data[1] & 2) == 0) return {};
        return {"bit 9 \"Fuse blown\""};
    }
    std::string channel_error(std::uint8_t, std::uint8_t error) const override { return error == 17 ? "Sensor dirty" : ""; }
};

TEST(Details, TakeTextsOfADeviceFromItsGsd) {
    const Texts texts;
    Dialogue dialogue{&texts};
    const Explanation e = dialogue.next(telegram(0x82, 0x88, 0x08, "3E 3C 08 0C 00 02 47 11 03 01 02 42 05 81 45 B1 82 80 25"));
    ASSERT_EQ(e.details.size(), 11u);
    EXPECT_EQ(e.details[7], "device related 03 01 02: bit 9 \"Fuse blown\"");
    EXPECT_EQ(e.details[8], "identifier related 42 05: modules 0 2");
    EXPECT_EQ(e.details[9], "channel related 81 45 B1: module 1 channel 5 input word: Sensor dirty");
    EXPECT_EQ(e.details[10], "channel related 82 80 25: module 2 channel 0 output bit: overtemperature");
    EXPECT_NE(e.line.find("bit 9 \"Fuse blown\""), std::string::npos);
}

TEST(Splitting, GivesEveryOctetToOnePiece) {
    const auto row = octets("AA 68 68 05 10 02 63 49 AE 16 E5 DC 02 02 10 02 63");
    const auto pieces = split(row);
    std::size_t at = 0;
    for (const Utterance& piece : pieces) {
        EXPECT_EQ(piece.offset, at);
        at += piece.octets.size();
    }
    EXPECT_EQ(at, row.size());
    ASSERT_GE(pieces.size(), 4u);
    EXPECT_TRUE(std::any_of(pieces.begin(), pieces.end(), [](const Utterance& p) { return p.good && p.octets.size() == 6; }));
    EXPECT_FALSE(pieces.back().good);
    EXPECT_EQ(pieces.back().reason, fdl::Reject::need_more);
}

TEST(Explaining, IsTotalOverAllFunctionCodesAndSaps) {
    Dialogue dialogue;
    for (unsigned fc = 0; fc < 256; ++fc)
        for (unsigned sap = 0; sap < 256; ++sap) {
            const auto t = telegram(0x88, 0x82, static_cast<std::uint8_t>(fc), hex_number(sap).substr(0, 2) + " 3E 01 02 03 04 05 06 07 08");
            const Explanation e = dialogue.next(t);
            ASSERT_TRUE(e.line.starts_with("SD2 2->8 ")) << e.line;
            ASSERT_EQ(e.line.find('\n'), std::string::npos);
        }
}

}  // namespace
}  // namespace dpchip::trace
