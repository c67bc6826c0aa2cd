// SPDX-License-Identifier: Apache-2.0
// Slave_Diag and Global_Control (reference 3.7, 3.9, 5.5).
#include <array>
#include <cstdint>
#include <random>
#include <set>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/dp/diag.hpp>
#include <dpchip/dp/global_control.hpp>

namespace dp = dpchip::dp;
using Octets = std::vector<std::uint8_t>;
using Flag = dp::DiagFlag;

namespace {

dp::DiagHeader header(const Octets& octets) {
    const auto h = dp::decode_diag_header(octets);
    EXPECT_TRUE(h);
    return h ? *h : dp::DiagHeader{};
}

TEST(Diag, typical_headers_say_what_the_reference_says) {
    const auto power_on = header({0x02, 0x05, 0x00, 0xFF, 0x0C, 0xDA});
    EXPECT_TRUE(power_on.has(Flag::station_not_ready) && power_on.has(Flag::prm_req));
    EXPECT_EQ(power_on.master_add, dp::kNoMaster);
    EXPECT_EQ(power_on.ident, 0x0CDA);
    EXPECT_FALSE(power_on.ready());
    const auto running = header({0x00, 0x0C, 0x00, 0x63, 0x0C, 0xDA});
    EXPECT_TRUE(running.ready() && running.has(Flag::wd_on));
    EXPECT_EQ(running.master_add, 0x63);
    EXPECT_TRUE(header({0x42, 0x05, 0x00, 0xFF, 0x47, 0x11}).has(Flag::prm_fault));
    EXPECT_TRUE(header({0x06, 0x05, 0x00, 0xFF, 0x47, 0x11}).has(Flag::cfg_fault));
    EXPECT_TRUE(header({0x00, 0x2C, 0x00, 2, 0x47, 0x11}).has(Flag::sync_mode));
    EXPECT_TRUE(header({0x00, 0x1C, 0x00, 2, 0x47, 0x11}).has(Flag::freeze_mode));
    EXPECT_TRUE(header({0x00, 0x0C, 0x80, 2, 0x47, 0x11}).has(Flag::ext_diag_overflow));
}

// proves: APC3 A.4-02..11, APC3 A.4-13..15, APC3 A.4-17, APC3 A.4-19
TEST(Diag, each_flag_is_one_bit_of_the_right_octet) {
    std::set<unsigned> seen;
    for (const auto& bit : dp::kDiagBits) {
        dp::DiagHeader h{0, 0, 0, 0, 0};
        h.set(bit.flag);
        std::array<std::uint8_t, 6> out{};
        ASSERT_TRUE(dp::encode(h, out));
        const unsigned value = static_cast<unsigned>(bit.flag);
        EXPECT_EQ(out[value / 8], 1u << (value % 8)) << bit.name;
        EXPECT_EQ(out[0] + out[1] + out[2], out[value / 8]) << bit.name;
        EXPECT_TRUE(seen.insert(value).second) << bit.name;
        EXPECT_EQ(*dp::decode_diag_header(out), h);
        h.set(bit.flag, false);
        EXPECT_FALSE(h.has(bit.flag));
    }
    EXPECT_EQ(seen.size(), 15u);
}

TEST(Diag, lengths_outside_6_to_244_are_refused) {
    const Octets octets(245, 0);
    for (std::size_t n = 0; n <= octets.size(); ++n)
        EXPECT_EQ(static_cast<bool>(dp::decode_diag_header(std::span{octets}.first(n))), n >= 6 && n <= 244) << n;
    std::array<std::uint8_t, 5> small{};
    EXPECT_EQ(dp::encode(dp::DiagHeader{}, small).error(), dp::DiagError::no_room);
}

// proves: VPC3C 6.2.4-23, APC3 5.2.4.2-05, APC3 A.4-23
TEST(ExtDiag, all_four_kinds_are_walked) {
    const Octets ext{0x06, 0x01, 0x03, 0x0D, 0xAA, 0x55, 0x43, 0x05, 0x80, 0x82, 0x44, 0xB1, 0xC7};
    dp::DiagBlockWalker walker{ext};
    dp::DiagBlock block{};
    ASSERT_TRUE(walker.next(block));
    EXPECT_EQ(block.kind, dp::DiagBlockKind::device);
    const auto alarm = dp::alarm_status(block);
    ASSERT_TRUE(alarm);
    EXPECT_FALSE(alarm->status);
    EXPECT_STREQ(dp::alarm_type_name(alarm->type), "Diagnostic_Alarm");
    EXPECT_EQ(alarm->slot, 3);
    EXPECT_EQ(alarm->seq_nr, 1);
    EXPECT_TRUE(alarm->add_ack);
    EXPECT_EQ(alarm->specifier, 1);
    EXPECT_EQ(alarm->data.size(), 2u);

    ASSERT_TRUE(walker.next(block));
    EXPECT_EQ(block.kind, dp::DiagBlockKind::identifier);
    Octets marked;
    for (std::uint8_t n = 0; n < 40; ++n)
        if (dp::identifier_marked(block, n)) marked.push_back(n);
    EXPECT_EQ(marked, (Octets{0, 2, 15}));

    ASSERT_TRUE(walker.next(block));
    const dp::ChannelDiag channel = dp::channel_diag(block);
    EXPECT_EQ(channel.identifier, 2);
    EXPECT_EQ(channel.channel, 4);
    EXPECT_TRUE(channel.input);
    EXPECT_FALSE(channel.output);
    EXPECT_STREQ(dp::channel_type_name(channel.type), "word");
    EXPECT_EQ(channel.error, 17);

    ASSERT_TRUE(walker.next(block));
    EXPECT_EQ(block.kind, dp::DiagBlockKind::revision);
    EXPECT_EQ(block.number(), 7);
    EXPECT_FALSE(walker.next(block));
    EXPECT_EQ(walker.error(), dp::DiagError::none);
}

TEST(ExtDiag, a_status_block_has_its_top_bit_set) {
    const Octets ext{0x06, 0x82, 0x00, 0x00, 0x1B, 0x03};
    dp::DiagBlockWalker walker{ext};
    dp::DiagBlock block{};
    ASSERT_TRUE(walker.next(block));
    const auto status = dp::alarm_status(block);
    ASSERT_TRUE(status);
    EXPECT_TRUE(status->status);
    EXPECT_STREQ(dp::status_type_name(status->type), "Modul_Status");
    EXPECT_EQ(dp::modul_state(status->data, 0), dp::ModulState::no_module);
    EXPECT_EQ(dp::modul_state(status->data, 1), dp::ModulState::wrong_module);
    EXPECT_EQ(dp::modul_state(status->data, 2), dp::ModulState::fault);
    EXPECT_EQ(dp::modul_state(status->data, 4), dp::ModulState::no_module);
    EXPECT_EQ(dp::modul_state(status->data, 400), dp::ModulState::ok);
}

TEST(ExtDiag, blocks_of_length_zero_and_cut_blocks_stop_the_walk) {
    const auto walk = [](const Octets& ext) {
        dp::DiagBlockWalker walker{ext};
        for (dp::DiagBlock block{}; walker.next(block);) {}
        return std::pair{walker.error(), walker.offset()};
    };
    EXPECT_EQ(walk({0xC1, 0x00, 1}), (std::pair{dp::DiagError::length_zero, std::size_t{1}}));
    EXPECT_EQ(walk({0xC1, 0x40, 1}), (std::pair{dp::DiagError::length_zero, std::size_t{1}}));
    EXPECT_EQ(walk({0xC1, 0x04, 1, 2}), (std::pair{dp::DiagError::truncated, std::size_t{1}}));
    EXPECT_EQ(walk({0x81, 0x40}), (std::pair{dp::DiagError::truncated, std::size_t{0}}));
    EXPECT_EQ(walk({0x03, 0xAA, 0x55}), (std::pair{dp::DiagError::none, std::size_t{3}}));
    EXPECT_EQ(walk({}), (std::pair{dp::DiagError::none, std::size_t{0}}));
}

TEST(ExtDiag, any_octets_are_walked_to_the_end_or_to_an_error) {
    std::mt19937 random{7};
    for (int round = 0; round < 20000; ++round) {
        Octets ext(random() % 239);
        for (auto& b : ext) b = static_cast<std::uint8_t>(random());
        dp::DiagBlockWalker walker{ext};
        std::size_t covered = 0;
        for (dp::DiagBlock block{}; walker.next(block);) {
            covered += block.octets.size();
            const auto alarm = dp::alarm_status(block);
            ASSERT_EQ(static_cast<bool>(alarm), block.kind == dp::DiagBlockKind::device && block.octets.size() >= 4);
            static_cast<void>(dp::channel_diag(block));
        }
        ASSERT_EQ(covered, walker.offset());
        ASSERT_EQ(walker.error() == dp::DiagError::none, covered == ext.size());
    }
}

TEST(ExtDiag, error_types_have_names_and_the_devices_own_are_told_apart) {
    EXPECT_STREQ(dp::channel_error_name(1), "short circuit");
    EXPECT_STREQ(dp::channel_error_name(6), "line break");
    EXPECT_STREQ(dp::channel_error_name(9), "error");
    for (std::uint8_t e = 10; e < 16; ++e) EXPECT_STREQ(dp::channel_error_name(e), "reserved");
    for (std::uint8_t e = 16; e < 32; ++e) EXPECT_STREQ(dp::channel_error_name(e), "manufacturer specific");
    EXPECT_STREQ(dp::alarm_type_name(6), "Update_Alarm");
    EXPECT_STREQ(dp::alarm_type_name(32), "Manufacturer_Specific_Alarm");
    EXPECT_STREQ(dp::alarm_type_name(127), "reserved");
    EXPECT_STREQ(dp::status_type_name(30), "PrmCmdAck");
    EXPECT_STREQ(dp::status_type_name(4), "reserved");
}

TEST(GlobalControl, the_un_bits_dominate_for_every_command) {
    for (unsigned c = 0; c < 256; ++c) {
        const dp::GlobalControl gc{static_cast<std::uint8_t>(c), 0};
        const auto expected = [c](unsigned enter, unsigned leave) {
            return (c & leave) != 0   ? dp::ModeChange::leave
                   : (c & enter) != 0 ? dp::ModeChange::enter
                                      : dp::ModeChange::none;
        };
        EXPECT_EQ(gc.sync(), expected(0x20, 0x10)) << c;
        EXPECT_EQ(gc.freeze(), expected(0x08, 0x04)) << c;
        EXPECT_EQ(gc.clear_data(), (c & 2) != 0);
        EXPECT_EQ(gc.reserved_set(), (c & 0xC1) != 0);
        const Octets data{static_cast<std::uint8_t>(c), 0};
        EXPECT_EQ(dp::valid_global_control(data), (c & 0xC1) == 0);
        EXPECT_TRUE(dp::valid_global_control(data, false));
    }
}

TEST(GlobalControl, only_two_octets_are_valid_and_groups_address_their_members) {
    EXPECT_FALSE(dp::valid_global_control(Octets{}));
    EXPECT_FALSE(dp::valid_global_control(Octets{0x02}));
    EXPECT_FALSE(dp::valid_global_control(Octets{0x02, 0, 0}));
    for (unsigned select = 0; select < 256; ++select)
        for (unsigned ident = 0; ident < 256; ++ident) {
            const dp::GlobalControl gc{0, static_cast<std::uint8_t>(select)};
            ASSERT_EQ(gc.addresses(static_cast<std::uint8_t>(ident)), select == 0 || (select & ident) != 0);
        }
    EXPECT_EQ(dp::decode_global_control(Octets{0x20, 0x02}), (dp::GlobalControl{0x20, 0x02}));
    EXPECT_EQ(dp::decode_global_control(Octets{}), dp::GlobalControl{});
    unsigned mask = 0;
    for (const auto& bit : dp::kGcBits) mask |= bit.mask;
    EXPECT_EQ(mask, 0x3Eu);
}

}  // namespace
