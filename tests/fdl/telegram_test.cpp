// SPDX-License-Identifier: Apache-2.0
// The telegram formats of reference 2.1 and 2.7 and the FC octet of 2.2 and 2.3.
#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/fdl/telegram.hpp>

namespace {

using namespace dpchip::fdl;

TEST(Sd1, carries_addresses_and_function_code_only) {
    static constexpr std::uint8_t octets[]{0x10, 0x08, 0x02, 0x49, 0x53, 0x16};
    constexpr auto telegram = decode(octets);
    static_assert(telegram && telegram->size == 6 && telegram->sd == kSd1);
    EXPECT_EQ(telegram->destination(), 8);
    EXPECT_EQ(telegram->source(), 2);
    EXPECT_TRUE(telegram->has_addresses());
    EXPECT_TRUE(telegram->has_fc());
    EXPECT_TRUE(telegram->unit.empty());
    EXPECT_EQ(telegram->fc.request(), Request::fdl_status);
}

TEST(Sd2, carries_a_data_unit_with_both_saps) {
    static constexpr std::uint8_t octets[]{0x68, 0x05, 0x05, 0x68, 0x82, 0xE3, 0x6D, 0x3C, 0x3E, 0x4C, 0x16};
    constexpr auto telegram = decode(octets);
    static_assert(telegram && telegram->size == 11);
    EXPECT_EQ(telegram->destination(), 2);
    EXPECT_EQ(telegram->source(), 0x63);
    ASSERT_TRUE(telegram->has_dsap() && telegram->has_ssap() && telegram->saps_present());
    EXPECT_EQ(telegram->dsap(), 60);
    EXPECT_EQ(telegram->ssap(), 62);
    EXPECT_TRUE(telegram->data().empty());
    EXPECT_TRUE(telegram->fc.fcb());
    EXPECT_FALSE(telegram->fc.fcv());
}

TEST(Sd2, with_one_sap_finds_it_first_in_the_data_unit) {
    std::array<std::uint8_t, 32> out{};
    const std::array<std::uint8_t, 3> unit{0x3E, 0xAA, 0xBB};
    const std::size_t size = encode(out, 2, 0x88, 0x08, unit);
    const auto telegram = decode({out.data(), size});
    ASSERT_TRUE(telegram);
    EXPECT_FALSE(telegram->has_dsap());
    EXPECT_EQ(telegram->sap_octets(), 1u);
    EXPECT_EQ(telegram->ssap(), 0x3E);
    EXPECT_EQ(telegram->data().size(), 2u);
}

TEST(Sd2, that_announces_more_saps_than_it_has_room_for_says_so) {
    std::array<std::uint8_t, 32> out{};
    const std::array<std::uint8_t, 1> unit{0x3E};
    const auto telegram = decode({out.data(), encode(out, 0x82, 0x88, 0x08, unit)});
    ASSERT_TRUE(telegram);
    EXPECT_FALSE(telegram->saps_present());
}

TEST(Sd3, carries_exactly_eight_octets) {
    static constexpr std::uint8_t octets[]{0xA2, 0x08, 0x02, 0x5D, 1, 2, 3, 4, 5, 6, 7, 8, 0x8B, 0x16};
    constexpr auto telegram = decode(octets);
    static_assert(telegram && telegram->size == 14 && telegram->unit.size() == 8 && telegram->unit[7] == 8);
    EXPECT_EQ(telegram->fc.request(), Request::srd_high);
}

TEST(Sd4, is_three_octets_without_checksum) {
    static constexpr std::uint8_t octets[]{0xDC, 3, 2};
    constexpr auto telegram = decode(octets);
    static_assert(telegram && telegram->size == 3 && telegram->da == 3 && telegram->sa == 2);
    EXPECT_FALSE(telegram->has_fc());
    EXPECT_TRUE(telegram->has_addresses());
}

TEST(ShortAcknowledgement, is_one_octet_without_addresses) {
    static constexpr std::uint8_t octets[]{0xE5, 0x10};
    constexpr auto telegram = decode(octets);
    static_assert(telegram && telegram->size == 1);
    EXPECT_FALSE(telegram->has_addresses());
}

TEST(Encode, refuses_what_does_not_fit) {
    std::array<std::uint8_t, 260> out{};
    const std::array<std::uint8_t, 247> unit{};
    const std::span<const std::uint8_t> data{unit};
    EXPECT_EQ(encode(out, 1, 2, 0, data), 0u);
    EXPECT_EQ(encode(out, 1, 2, 0, data.first(246)), 255u);
    EXPECT_EQ(encode(std::span{out}.first(254), 1, 2, 0, data.first(246)), 0u);
    EXPECT_EQ(encode_sd1(std::span{out}.first(5), 1, 2, 0), 0u);
    EXPECT_EQ(encode_token(std::span{out}.first(2), 1, 2), 0u);
    EXPECT_EQ(finish_sd2(out, 1, 2, 0, 0), 0u);
    EXPECT_EQ(encode(out, SapTelegram{1, 2, 0, 60, 62, data.first(245)}), 0u);
    EXPECT_EQ(encode(out, SapTelegram{1, 2, 0, 60, 62, data.first(244)}), 255u);
}

TEST(Encode, gives_the_recorded_diagnosis_request) {
    std::array<std::uint8_t, 32> out{};
    const std::vector<std::uint8_t> recorded{0x68, 0x05, 0x05, 0x68, 0x82, 0xE3, 0x6D, 0x3C, 0x3E, 0x4C, 0x16};
    const std::size_t size =
        encode(out, SapTelegram{2, 0x63, request_fc(Request::srd_high, true, false), 60, 62, {}});
    EXPECT_TRUE(std::ranges::equal(std::span{out}.first(size), recorded));
}

TEST(Resync, keeps_a_good_telegram_behind_garbage) {
    const std::vector<std::uint8_t> good{0x10, 0x08, 0x02, 0x49, 0x53, 0x16};
    for (unsigned first = 0; first < 256; ++first) {
        for (unsigned second = 0; second < 256; second += 7) {
            std::vector<std::uint8_t> in{static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(second)};
            in.insert(in.end(), good.begin(), good.end());
            in.resize(in.size() + 300);  // whatever garbage announced, there are octets enough to judge it
            std::span<const std::uint8_t> rest{in};
            bool found = false;
            while (!rest.empty() && !found) {
                const auto telegram = decode(rest);
                found = telegram && std::ranges::equal(rest.first(telegram->size), good);
                if (telegram && !found) rest = rest.subspan(1);  // garbage may look like SC or a token
                else if (!telegram) rest = rest.subspan(std::min(resync(rest), rest.size()));
            }
            ASSERT_TRUE(found) << first << ' ' << second;
        }
    }
}

TEST(Resync, always_drops_at_least_one_octet) {
    EXPECT_EQ(resync({}), 1u);
    const std::vector<std::uint8_t> nothing{1, 2, 3}, delimiters{0x68, 0x68}, later{0x68, 0, 0xDC};
    EXPECT_EQ(resync(nothing), 3u);
    EXPECT_EQ(resync(delimiters), 1u);
    EXPECT_EQ(resync(later), 2u);
}

TEST(Delimiters, differ_in_at_least_four_bits) {
    constexpr std::array<std::uint8_t, 5> all{kSd1, kSd2, kSd3, kSd4, kSc};
    for (const auto a : all) {
        for (const auto b : all) {
            if (a == b) continue;
            EXPECT_GE(std::popcount(static_cast<unsigned>(a ^ b)), 4);
        }
    }
}

struct RequestRow {
    unsigned code;
    const char* name;
    bool counts, answered_sda, answered_srd, unanswered;
};
// clang-format off
constexpr RequestRow kRequests[]{
    {0, "Time_Event",   false, false, false, false}, {1, "reserved",    false, false, false, false},
    {2, "reserved",     false, false, false, false}, {3, "SDA low",     true,  true,  false, false},
    {4, "SDN low",      false, false, false, true},  {5, "SDA high",    true,  true,  false, false},
    {6, "SDN high",     false, false, false, true},  {7, "MSRD",        true,  false, false, false},
    {8, "reserved",     false, false, false, false}, {9, "FDL_Status",  false, false, false, false},
    {10, "reserved",    false, false, false, false}, {11, "reserved",   false, false, false, false},
    {12, "SRD low",     true,  false, true,  false}, {13, "SRD high",   true,  false, true,  false},
    {14, "Ident",       false, false, false, false}, {15, "LSAP status", false, false, false, false},
};
constexpr const char* kResponses[]{"OK", "UE", "RR", "RS", "reserved", "reserved", "reserved", "reserved",
                                   "DL", "NR", "DH", "reserved", "RDL", "RDH", "reserved", "reserved"};
// clang-format on

TEST(FunctionCode, knows_all_sixteen_requests) {
    for (const RequestRow& row : kRequests) {
        const FunctionCode fc{static_cast<std::uint8_t>(0x40u | row.code)};
        EXPECT_TRUE(fc.is_request());
        EXPECT_STREQ(name(fc.request()), row.name);
        EXPECT_EQ(uses_frame_count(fc.request()), row.counts) << row.name;
        EXPECT_EQ(is_sda(fc.request()), row.answered_sda) << row.name;
        EXPECT_EQ(is_srd(fc.request()), row.answered_srd) << row.name;
        EXPECT_EQ(is_sdn(fc.request()), row.unanswered) << row.name;
    }
}

TEST(FunctionCode, knows_all_sixteen_responses_of_all_four_station_types) {
    for (unsigned code = 0; code < 16; ++code) {
        for (unsigned type = 0; type < 4; ++type) {
            const FunctionCode fc{response_fc(static_cast<Response>(code), static_cast<StationType>(type))};
            EXPECT_FALSE(fc.is_request());
            EXPECT_EQ(fc.function(), code);
            EXPECT_EQ(fc.station_type(), static_cast<StationType>(type));
            EXPECT_STREQ(name(fc.response()), kResponses[code]);
        }
    }
}

TEST(FunctionCode, puts_the_frame_count_bits_where_masters_put_them) {
    static_assert(request_fc(Request::srd_high, true, false) == 0x6D);
    static_assert(request_fc(Request::srd_high, false, true) == 0x5D);
    static_assert(request_fc(Request::srd_high, true, true) == 0x7D);
    static_assert(request_fc(Request::fdl_status, false, false) == 0x49);
    static_assert(request_fc(Request::sdn_high, false, false) == 0x46);
    EXPECT_TRUE(FunctionCode{0xC0}.clock_value());
    EXPECT_FALSE(FunctionCode{0x40}.clock_value());
    EXPECT_TRUE(FunctionCode{0x7D}.fcb() && FunctionCode{0x7D}.fcv());
}

}  // namespace
