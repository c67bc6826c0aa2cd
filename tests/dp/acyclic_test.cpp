// SPDX-License-Identifier: Apache-2.0
// PDUs of the acyclic services: every function, every length, cut and overlong (reference 5.3, 5.4).
#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/dp/acyclic.hpp>
#include <dpchip/dp/acyclic_error.hpp>
#include <dpchip/dp/initiate.hpp>

namespace dp = dpchip::dp;
using Bytes = std::vector<std::uint8_t>;
using Error = dp::AcyclicError;
using Fn = dp::AcyclicFunction;
using Way = dp::AcyclicDirection;

namespace {

Bytes record_pdu(std::uint8_t function, std::size_t octets) {
    Bytes pdu{function, 1, 16, static_cast<std::uint8_t>(octets)};
    for (std::size_t i = 0; i < octets; ++i) pdu.push_back(static_cast<std::uint8_t>(i));
    return pdu;
}

const Bytes kInitiateReq{0x57, 0, 0, 0, 0x03, 0xE8, 1, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 0, 0, 0};
const Bytes kInitiateRes{0x57, 0xF0, 1, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 0, 0, 0};

TEST(Acyclic, the_telegrams_of_the_reference_are_good) {
    const Bytes read{0x5E, 1, 0x10, 4}, ack{0x5C, 1, 2, 8}, idle{0x48, 0}, abort{0x58, 1, 0x20, 0}, rm{0x56, 0x30, 0, 0x64};
    const Bytes negative{0xDE, 0x80, 0xB0, 0};
    for (const Bytes& pdu : {read, ack, idle, abort, kInitiateReq, record_pdu(0x5F, 4), record_pdu(0x51, 0)})
        EXPECT_EQ(dp::check_pdu(Way::request, pdu), Error::none) << int{pdu[0]};
    for (const Bytes& pdu : {record_pdu(0x5E, 4), ack, idle, abort, kInitiateRes, Bytes{0x5F, 1, 2, 4}, rm, negative})
        EXPECT_EQ(dp::check_pdu(Way::answer, pdu), Error::none) << int{pdu[0]};
}

TEST(Acyclic, a_read_asks_for_1_to_240_octets_in_exactly_four) {
    for (int length = 0; length < 256; ++length) {
        const Bytes pdu{0x5E, 3, 7, static_cast<std::uint8_t>(length)};
        const auto head = dp::decode_ds_read_req(pdu);
        if (length == 0) EXPECT_EQ(head.error(), Error::length_zero);
        else if (length > 240) EXPECT_EQ(head.error(), Error::length_range);
        else EXPECT_EQ(*head, (dp::RecordHead{3, 7, static_cast<std::uint8_t>(length)}));
    }
    EXPECT_EQ(dp::decode_ds_read_req(Bytes{0x5E, 1, 2}).error(), Error::too_short);
    EXPECT_EQ(dp::decode_ds_read_req(Bytes{0x5E, 1, 2, 4, 0}).error(), Error::too_long);
    EXPECT_EQ(dp::decode_ds_read_req(Bytes{0x5F, 1, 2, 4}).error(), Error::function);
    EXPECT_EQ(dp::decode_ds_read_req(Bytes{}).error(), Error::empty);
}

TEST(Acyclic, the_length_octet_of_a_record_must_fit_what_follows) {
    for (const std::uint8_t function : {std::uint8_t{0x5F}, std::uint8_t{0x51}}) {
        const Way way = Way::request;
        for (std::size_t octets = 0; octets <= 240; ++octets) {
            Bytes pdu = record_pdu(function, octets);
            const bool empty_write = function == 0x5F && octets == 0;
            EXPECT_EQ(dp::check_pdu(way, pdu), empty_write ? Error::length_zero : Error::none);
            pdu.push_back(0);
            EXPECT_EQ(dp::check_pdu(way, pdu), Error::length_mismatch);
            pdu.resize(pdu.size() - 1);
            if (octets == 0) continue;
            pdu.pop_back();
            EXPECT_EQ(dp::check_pdu(way, pdu), Error::length_mismatch);
        }
        Bytes pdu = record_pdu(function, 241);
        EXPECT_EQ(dp::check_pdu(way, pdu), Error::length_range);
        for (std::size_t cut = 1; cut < 4; ++cut)
            EXPECT_EQ(dp::check_pdu(way, std::span{pdu}.first(cut)), Error::too_short);
    }
    EXPECT_TRUE(dp::decode_ds_read_res(Bytes{0x5E, 1, 2, 0})) << "a read may find nothing";
}

TEST(Acyclic, pdus_of_a_fixed_length_have_exactly_that_length) {
    const std::map<std::string, std::pair<Bytes, Way>> fixed{
        {"alarm_ack", {{0x5C, 1, 2, 8}, Way::request}}, {"idle", {{0x48, 7}, Way::request}},
        {"rm", {{0x56, 48, 0, 0x64}, Way::answer}},     {"write answer", {{0x5F, 1, 2, 4}, Way::answer}},
        {"negative", {{0xDF, 0x80, 0xB1, 0}, Way::answer}}};
    for (const auto& [name, it] : fixed) {
        Bytes pdu = it.first;
        EXPECT_EQ(dp::check_pdu(it.second, pdu), Error::none) << name;
        pdu.push_back(0);
        EXPECT_EQ(dp::check_pdu(it.second, pdu), Error::too_long) << name;
        for (std::size_t cut = 1; cut < it.first.size(); ++cut)
            EXPECT_EQ(dp::check_pdu(it.second, std::span{it.first}.first(cut)), Error::too_short) << name << cut;
    }
}

TEST(Acyclic, every_first_octet_is_a_function_or_refused_in_its_direction) {
    const std::set<int> requests{0x48, 0x51, 0x57, 0x58, 0x5C, 0x5E, 0x5F};
    const std::set<int> answers{0x48, 0x51, 0x56, 0x57, 0x58, 0x5C, 0x5E, 0x5F, 0xD1, 0xDC, 0xDE, 0xDF};
    for (int octet = 0; octet < 256; ++octet) {
        const Bytes pdu{static_cast<std::uint8_t>(octet)};
        EXPECT_EQ(dp::check_pdu(Way::request, pdu) == Error::function, requests.count(octet) == 0) << octet;
        EXPECT_EQ(dp::check_pdu(Way::answer, pdu) == Error::function, answers.count(octet) == 0) << octet;
    }
    EXPECT_EQ(dp::check_pdu(Way::request, Bytes{}), Error::empty);
}

TEST(Acyclic, encoding_what_was_decoded_gives_the_same_octets) {
    std::array<std::uint8_t, dp::kMaxAcyclicPdu> out{};
    const auto same = [&](const Bytes& pdu, const dp::AcyclicResult<std::size_t>& length) {
        return length && Bytes(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(*length)) == pdu;
    };
    const Bytes read{0x5E, 1, 0x10, 4}, ack{0x5C, 1, 2, 8}, idle{0x48, 9}, rm{0x56, 0x30, 1, 0x90}, negative{0xD1, 0xFE, 0xB0, 3};
    EXPECT_TRUE(same(read, dp::encode(Fn::ds_read, *dp::decode_ds_read_req(read), out)));
    EXPECT_TRUE(same(ack, dp::encode(*dp::decode_alarm_ack(ack), out)));
    EXPECT_TRUE(same(idle, dp::encode_idle(*dp::decode_idle(idle), out)));
    EXPECT_TRUE(same(rm, dp::encode(*dp::decode_resource_manager(rm), out)));
    EXPECT_TRUE(same(negative, dp::encode(*dp::decode_negative(negative), out)));
    EXPECT_TRUE(same(kInitiateReq, dp::encode(*dp::decode_initiate_req(kInitiateReq), out)));
    EXPECT_TRUE(same(kInitiateRes, dp::encode(*dp::decode_initiate_res(kInitiateRes), out)));
    for (std::size_t octets = 1; octets <= 240; ++octets) {
        const Bytes write = record_pdu(0x5F, octets);
        EXPECT_TRUE(same(write, dp::encode(Fn::ds_write, *dp::decode_ds_write_req(write), out)));
    }
}

TEST(Acyclic, encoding_refuses_what_does_not_fit) {
    std::array<std::uint8_t, 19> small{};
    const Bytes data(241);
    std::array<std::uint8_t, 300> large{};
    EXPECT_EQ(dp::encode(Fn::ds_write, dp::Record{0, 0, std::span{data}.first(16)}, small).error(), Error::no_room);
    EXPECT_EQ(dp::encode(Fn::ds_write, dp::Record{0, 0, data}, large).error(), Error::length_range);
    EXPECT_EQ(dp::encode(Fn::ds_read, dp::RecordHead{0, 0, 241}, large).error(), Error::length_range);
    EXPECT_EQ(dp::encode(Fn::ds_read, dp::RecordHead{}, std::span{small}.first(3)).error(), Error::no_room);
    EXPECT_EQ(dp::encode(dp::AlarmAck{}, std::span{small}.first(3)).error(), Error::no_room);
    EXPECT_EQ(dp::encode_idle(0, std::span{small}.first(1)).error(), Error::no_room);
    EXPECT_EQ(dp::encode(dp::ResourceManager{}, std::span{small}.first(3)).error(), Error::no_room);
    EXPECT_EQ(dp::encode(dp::NegativeAnswer{Fn::ds_read, {}}, std::span{small}.first(3)).error(), Error::no_room);
    EXPECT_EQ(dp::encode(dp::NegativeAnswer{Fn::idle, {}}, large).error(), Error::function);
    EXPECT_EQ(dp::encode(dp::Abort{}, std::span{small}.first(2)).error(), Error::no_room);
    EXPECT_EQ(dp::encode(*dp::decode_initiate_req(kInitiateReq), small).error(), Error::no_room);
    dp::InitiateReq no_address{};
    EXPECT_EQ(dp::encode(no_address, large).error(), Error::address_length);
    const Bytes long_address(130);
    no_address.source.octets = no_address.destination.octets = long_address;
    EXPECT_EQ(dp::encode(no_address, large).error(), Error::too_long);
}

TEST(AcyclicError, words_follow_the_table_of_the_reference) {
    EXPECT_STREQ(dp::error_code_name(0xA0), "read error");
    EXPECT_STREQ(dp::error_code_name(0xA9), "feature not supported");
    EXPECT_STREQ(dp::error_code_name(0xB0), "invalid index");
    EXPECT_STREQ(dp::error_code_name(0xB5), "state conflict");
    EXPECT_STREQ(dp::error_code_name(0xC3), "resource unavailable");
    EXPECT_STREQ(dp::error_code_name(0xD0), "user specific");
    EXPECT_STREQ(dp::error_code_name(0xA3), "reserved");
    EXPECT_STREQ(dp::error_decode_name(0x80), "DPV1");
    EXPECT_STREQ(dp::error_decode_name(0xFE), "FMS");
    EXPECT_STREQ(dp::error_decode_name(0xFF), "HART");
    EXPECT_STREQ(dp::error_class_name(0xB7), "access");
    int user = 0, reserved = 0, named = 0;
    for (int code = 0; code < 256; ++code) {
        const std::string words = dp::error_code_name(static_cast<std::uint8_t>(code));
        if (words == "user specific") ++user;
        else if (words == "reserved") ++reserved;
        else ++named;
    }
    EXPECT_EQ(named, 5 + 10 + 4);
    EXPECT_EQ(user, 6 + 6 + 8 + 16);
    EXPECT_EQ(reserved, 256 - 19 - 36);
}

TEST(Initiate, twenty_octets_are_the_least) {
    for (std::size_t cut = 1; cut < kInitiateReq.size(); ++cut)
        EXPECT_EQ(dp::decode_initiate_req(std::span{kInitiateReq}.first(cut)).error(), Error::too_short) << cut;
    for (std::size_t cut = 1; cut < kInitiateRes.size(); ++cut)
        EXPECT_EQ(dp::decode_initiate_res(std::span{kInitiateRes}.first(cut)).error(), Error::too_short) << cut;
    const auto req = dp::decode_initiate_req(kInitiateReq);
    ASSERT_TRUE(req);
    EXPECT_EQ(req->send_timeout, 1000);
    EXPECT_EQ(req->features.features_1, dp::kFeatureReadWrite);
    EXPECT_EQ(req->source.octets.size(), 2U);
}

TEST(Initiate, address_lengths_must_fit_each_other_and_the_pdu) {
    Bytes pdu = kInitiateReq;
    pdu.push_back(0);
    EXPECT_EQ(dp::decode_initiate_req(pdu).error(), Error::address_mismatch);
    pdu = kInitiateReq;
    pdu[13] = 1;
    EXPECT_EQ(dp::decode_initiate_req(pdu).error(), Error::address_length);
    pdu[13] = 3;
    EXPECT_EQ(dp::decode_initiate_req(pdu).error(), Error::address_mismatch);
    for (int s = 0; s < 256; ++s)
        for (int d = 0; d < 256; d += 5) {
            Bytes any = kInitiateReq;
            any.resize(16 + 9);
            any[13] = static_cast<std::uint8_t>(s);
            any[15] = static_cast<std::uint8_t>(d);
            EXPECT_EQ(static_cast<bool>(dp::decode_initiate_req(any)), s >= 2 && d >= 2 && s + d == 9) << s << ' ' << d;
        }
}

TEST(Initiate, addresses_come_out_as_they_went_in) {
    const Bytes source{1, 2, 3, 4, 5, 6, 7, 8}, destination{9, 10};
    dp::InitiateReq req{};
    req.send_timeout = 0x1234;
    req.features = {1, 2, 3, 4, 0x9700};
    req.source = {1, source};
    req.destination = {0, destination};
    std::array<std::uint8_t, dp::kMaxInitiatePdu> out{};
    const auto length = dp::encode(req, out);
    ASSERT_TRUE(length);
    const auto again = dp::decode_initiate_req(std::span{out}.first(*length));
    ASSERT_TRUE(again);
    EXPECT_EQ(again->send_timeout, 0x1234);
    EXPECT_EQ(again->features, req.features);
    EXPECT_EQ(Bytes(again->source.octets.begin(), again->source.octets.end()), source);
    EXPECT_EQ(again->source.type, 1);
    EXPECT_EQ(again->destination.api(), 9);
    EXPECT_EQ(again->destination.scl(), 10);
}

TEST(SendTimeout, the_slower_the_line_the_longer_and_never_shorter_than_the_slaves_own) {
    const std::uint16_t own[]{0x64, 0x64, 0x64, 0x64, 0xC8, 0x190, 0x190, 0x190, 0x190, 0x190};
    for (std::uint8_t code = 0; code < 10; ++code) EXPECT_EQ(dp::min_send_timeout(code), own[code]);
    EXPECT_EQ(dp::min_send_timeout(15), 0x190);
    EXPECT_EQ(dp::agreed_send_timeout(100, 1000), 1000);
    EXPECT_EQ(dp::agreed_send_timeout(100, 1), 100);
    EXPECT_EQ(dp::agreed_send_timeout(0, 0), 1);
    EXPECT_EQ(dp::agreed_send_timeout(100, 0xFFFF), 0x7FFF);
}

TEST(Abort, three_octets_or_four_and_two_bits_that_are_zero) {
    const auto user = dp::decode_abort(Bytes{0x58, 1, 0x23, 0});
    ASSERT_TRUE(user);
    EXPECT_EQ(*user, dp::Abort(dp::AbortSubnet::local, dp::AbortInstance::user, 3));
    EXPECT_EQ(dp::decode_abort(Bytes{0x58, 0}).error(), Error::too_short);
    EXPECT_EQ(dp::decode_abort(Bytes{0x58, 0, 0x13, 0, 0}).error(), Error::too_long);
    EXPECT_EQ(dp::decode_abort(Bytes{0x58, 0, 0x53}).error(), Error::reserved);
    std::array<std::uint8_t, 3> out{};
    ASSERT_TRUE(dp::encode(dp::Abort{dp::AbortReason::timeout}, out));
    EXPECT_EQ(out, (std::array<std::uint8_t, 3>{0x58, 0x00, 0x13}));
    EXPECT_STREQ(dp::abort_reason_name(3), "timeout (TO)");
    EXPECT_STREQ(dp::abort_reason_name(15), "resource error (RES)");
    EXPECT_STREQ(dp::abort_reason_name(9), "reserved");
    EXPECT_STREQ(dp::name(dp::AbortInstance::fdl), "FDL");
    EXPECT_STREQ(dp::abort_subnet_name(2), "remote subnet");
}

TEST(Acyclic, random_octets_are_decoded_or_refused_and_good_ones_survive_a_round_trip) {
    std::mt19937 random{4711};
    std::uniform_int_distribution<int> octet{0, 255}, length{0, 40};
    constexpr std::uint8_t first[]{0x48, 0x51, 0x56, 0x57, 0x58, 0x5C, 0x5E, 0x5F, 0xDE};
    int good = 0;
    for (int run = 0; run < 20000; ++run) {
        Bytes pdu(static_cast<std::size_t>(length(random)));
        for (std::uint8_t& o : pdu) o = static_cast<std::uint8_t>(octet(random) & 0x1F);
        if (!pdu.empty()) pdu[0] = first[static_cast<std::size_t>(octet(random)) % 9];
        for (const Way way : {Way::request, Way::answer}) good += dp::check_pdu(way, pdu) == Error::none ? 1 : 0;
    }
    EXPECT_GT(good, 100) << "seed 4711";
}

}  // namespace
