// SPDX-License-Identifier: Apache-2.0
// I&M records and calls, alarm and diagnosis blocks (reference 5.5, 5.6).
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/dp/alarm.hpp>
#include <dpchip/dp/identification.hpp>

namespace dp = dpchip::dp;
using Bytes = std::vector<std::uint8_t>;

namespace {

template <std::size_t N>
constexpr dp::ImText<N> text(std::string_view t) { return dp::im_text<N>({t.data(), t.size()}); }

TEST(Identification, a_call_is_08_00_and_the_index) {
    const auto call = dp::decode_im_call(Bytes{0x08, 0x00, 0xFD, 0xE8});
    ASSERT_TRUE(call);
    EXPECT_EQ(call->im_index, dp::kIm0);
    EXPECT_TRUE(call->record.empty());
    for (std::size_t length = 0; length < 80; ++length) {
        Bytes data(length);
        if (length > 0) data[0] = 8;
        const auto any = dp::decode_im_call(data);
        if (length < 4) EXPECT_EQ(any.error(), dp::ImError::too_short);
        else if (length == 4 || length == 68) EXPECT_TRUE(any);
        else EXPECT_EQ(any.error(), dp::ImError::length);
    }
    EXPECT_EQ(dp::decode_im_call(Bytes{7, 0, 0xFD, 0xE8}).error(), dp::ImError::function);
    EXPECT_EQ(dp::decode_im_call(Bytes{8, 1, 0xFD, 0xE8}).error(), dp::ImError::function);
    std::array<std::uint8_t, 68> out{};
    EXPECT_EQ(*dp::encode(dp::ImCall{dp::kIm4, {}}, out), 4U);
    EXPECT_EQ(out[3], 0xEC);
    EXPECT_EQ(dp::encode(dp::ImCall{dp::kIm0, std::span{out}.first(10)}, out).error(), dp::ImError::length);
    EXPECT_EQ(dp::encode(dp::ImCall{dp::kIm0, std::span{out}.first(64)}, std::span{out}.first(67)).error(), dp::ImError::no_room);
}

TEST(Identification, im0_lies_where_the_reference_says) {
    dp::Im0 im{};
    im.manufacturer_id = 0x002A;
    im.order_id = text<20>("ORDER 4711");
    im.serial_number = text<16>("0815");
    im.hardware_revision = 0x0102;
    im.software_revision = {'V', 3, 4, 5};
    im.revision_counter = 7;
    im.profile_id = 0x9700;
    im.profile_specific_type = 1;
    im.im_supported = 0x001E;
    const dp::ImOctets o = dp::encode(im);
    EXPECT_EQ(o[10], 0x00);
    EXPECT_EQ(o[11], 0x2A);
    EXPECT_EQ(o[12], 'O');
    EXPECT_EQ(o[31], ' ');
    EXPECT_EQ(o[32], '0');
    EXPECT_EQ(o[49], 0x02);
    EXPECT_EQ(o[50], 'V');
    EXPECT_EQ(o[53], 5);
    EXPECT_EQ(o[55], 7);
    EXPECT_EQ(o[56], 0x97);
    EXPECT_EQ(o[60], 1);
    EXPECT_EQ(o[61], 1);
    EXPECT_EQ(o[63], 0x1E);
    EXPECT_EQ(*dp::decode_im0(o), im);
    EXPECT_EQ(dp::decode_im0(std::span{o}.first(63)).error(), dp::ImError::length);
}

TEST(Identification, the_maintenance_records_come_out_as_they_went_in) {
    const dp::Im1 im1{text<32>("pump 3"), text<22>("cellar")};
    const dp::Im2 im2{text<16>("2024-02-29 12:00")};
    const dp::Im3 im3{text<54>("spare")};
    dp::Im4 im4{};
    im4.signature[53] = 9;
    EXPECT_EQ(*dp::decode_im1(dp::encode(im1)), im1);
    EXPECT_EQ(*dp::decode_im2(dp::encode(im2)), im2);
    EXPECT_EQ(*dp::decode_im3(dp::encode(im3)), im3);
    EXPECT_EQ(*dp::decode_im4(dp::encode(im4)), im4);
    EXPECT_EQ(dp::encode(im1)[10], 'p');
    EXPECT_EQ(dp::encode(im1)[42], 'c');
    EXPECT_EQ(dp::encode(im2)[26], 0) << "38 octets behind the date are reserved";
    EXPECT_EQ(dp::encode(im4)[63], 9);
}

TEST(Alarm, a_block_comes_out_as_it_went_in) {
    const Bytes data{0xAA, 0xBB};
    dp::AlarmStatus a{};
    a.type = 2;
    a.slot = 5;
    a.seq_nr = 31;
    a.add_ack = true;
    a.specifier = 1;
    a.data = data;
    std::array<std::uint8_t, 63> out{};
    const auto length = dp::encode(a, out);
    ASSERT_TRUE(length);
    EXPECT_EQ(Bytes(out.begin(), out.begin() + 6), (Bytes{0x06, 0x02, 0x05, 0xFD, 0xAA, 0xBB}));
    dp::DiagBlockWalker walker{std::span{out}.first(*length)};
    dp::DiagBlock block{};
    ASSERT_TRUE(walker.next(block));
    const auto again = dp::alarm_status(block);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->seq_nr, 31);
    EXPECT_TRUE(again->add_ack);
    EXPECT_FALSE(again->status);
    EXPECT_EQ(again->data.size(), 2U);
    EXPECT_EQ(dp::alarm_ack(*again), (dp::AlarmAck{5, 2, 0xFD}));
}

TEST(Alarm, what_no_block_can_say_is_refused_by_name) {
    std::array<std::uint8_t, 63> out{};
    const Bytes sixty(60);
    const auto refused = [&](auto change) {
        dp::AlarmStatus a{};
        a.type = 1;
        change(a);
        const auto result = dp::encode(a, out);
        EXPECT_FALSE(result);
        return result ? dp::BlockError::no_room : result.error();
    };
    EXPECT_EQ(refused([](auto& a) { a.type = 0; }), dp::BlockError::type);
    EXPECT_EQ(refused([](auto& a) { a.type = 127; }), dp::BlockError::type);
    EXPECT_EQ(refused([](auto& a) { a.slot = 255; }), dp::BlockError::slot);
    EXPECT_EQ(refused([](auto& a) { a.seq_nr = 32; }), dp::BlockError::seq_nr);
    EXPECT_EQ(refused([](auto& a) { a.specifier = 4; }), dp::BlockError::specifier);
    EXPECT_EQ(refused([](auto& a) { a.status = true, a.add_ack = true; }), dp::BlockError::specifier);
    EXPECT_EQ(refused([&](auto& a) { a.data = sixty; }), dp::BlockError::too_long);
    EXPECT_EQ(dp::encode(dp::AlarmStatus{.type = 1}, std::span{out}.first(3)).error(), dp::BlockError::no_room);
}

TEST(Alarm, every_type_has_its_enable_bit) {
    const std::uint8_t bits[]{0, 0x20, 0x40, 0x80, 0x80, 0x08, 0x04};
    for (std::uint8_t type = 0; type < 7; ++type) EXPECT_EQ(dp::alarm_enable_bit(type), bits[type]);
    for (int type = 7; type < 256; ++type)
        EXPECT_EQ(dp::alarm_enable_bit(static_cast<std::uint8_t>(type)), type >= 32 && type <= 126 ? 0x10 : 0) << type;
}

TEST(DiagBlocks, modul_status_has_two_bits_a_slot) {
    std::array<std::uint8_t, 63> out{};
    std::vector<dp::ModulState> states(9, dp::ModulState::ok);
    states[1] = dp::ModulState::no_module;
    states[8] = dp::ModulState::fault;
    const auto length = dp::encode_modul_status(states, out);
    ASSERT_TRUE(length);
    EXPECT_EQ(Bytes(out.begin(), out.begin() + 7), (Bytes{0x07, 0x82, 0, 0, 0x0C, 0x00, 0x01}));
    for (std::size_t n = 0; n < states.size(); ++n)
        EXPECT_EQ(dp::modul_state(std::span{out}.subspan(4, *length - 4), n), states[n]) << n;
    EXPECT_EQ(dp::encode_modul_status(std::vector<dp::ModulState>(237), out).error(), dp::BlockError::too_long);
    EXPECT_EQ(dp::encode_modul_status(states, std::span{out}.first(6)).error(), dp::BlockError::no_room);
}

TEST(DiagBlocks, identifiers_and_channels_read_back) {
    std::array<std::uint8_t, 63> out{};
    const auto length = dp::encode_identifiers(10, [](std::size_t n) { return n == 0 || n == 9; }, out);
    ASSERT_TRUE(length);
    EXPECT_EQ(Bytes(out.begin(), out.begin() + 3), (Bytes{0x43, 0x01, 0x02}));
    const dp::DiagBlock block{dp::DiagBlockKind::identifier, 0, std::span{out}.first(*length)};
    EXPECT_TRUE(dp::identifier_marked(block, 9));
    EXPECT_FALSE(dp::identifier_marked(block, 8));
    EXPECT_EQ(dp::encode_identifiers(497, [](std::size_t) { return true; }, out).error(), dp::BlockError::too_long);

    const dp::ChannelDiag channel{.identifier = 5, .channel = 3, .input = true, .output = false, .type = 4, .error = 6};
    ASSERT_TRUE(dp::encode(channel, out));
    EXPECT_EQ(Bytes(out.begin(), out.begin() + 3), (Bytes{0x85, 0x43, 0x86}));
    const auto again = dp::channel_diag({dp::DiagBlockKind::channel, 0, std::span{out}.first(3)});
    EXPECT_EQ(again.identifier, 5);
    EXPECT_TRUE(again.input && !again.output);
    EXPECT_EQ(again.error, 6);
    EXPECT_EQ(dp::encode(dp::ChannelDiag{.identifier = 64}, out).error(), dp::BlockError::slot);
    EXPECT_EQ(dp::encode(dp::ChannelDiag{.error = 32}, out).error(), dp::BlockError::specifier);
}

}  // namespace
