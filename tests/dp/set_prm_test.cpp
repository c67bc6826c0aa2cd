// SPDX-License-Identifier: Apache-2.0
// Set_Prm, structured blocks, Set_Slave_Add and SAPs (reference 3.1, 3.3, 3.4).
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/dp/saps.hpp>
#include <dpchip/dp/set_prm.hpp>
#include <dpchip/dp/set_slave_add.hpp>
#include <dpchip/dp/structured_prm.hpp>

namespace dp = dpchip::dp;
using Octets = std::vector<std::uint8_t>;

namespace {

TEST(SetPrm, the_recorded_telegram_of_C134_is_taken_apart_and_put_together_again) {
    const Octets octets{0xB8, 0x1E, 0x01, 0x00, 0x0A, 0x35, 0x01, 0x00, 0x00, 0x00, 0x82, 0x00, 0x00, 0x00};
    const auto prm = dp::decode_set_prm(octets);
    ASSERT_TRUE(prm);
    EXPECT_TRUE(prm->lock_req() && prm->sync_req() && prm->freeze_req() && prm->wd_on());
    EXPECT_FALSE(prm->unlock_req());
    EXPECT_EQ(dp::t_wd_ms(prm->wd, prm->wd_base()), 300u);
    EXPECT_EQ(prm->ident, 0x0A35);
    EXPECT_EQ(prm->group_ident, 1);
    EXPECT_EQ(prm->user_prm.size(), 7u);
    EXPECT_EQ(prm->behind_dpv1_status().front(), 0x82);
    std::array<std::uint8_t, dp::kMaxSetPrm> out{};
    const auto length = dp::encode(*prm, out);
    ASSERT_TRUE(length);
    EXPECT_EQ(Octets(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(*length)), octets);
}

TEST(SetPrm, lengths_outside_7_to_244_are_refused) {
    const Octets octets(245, 0x88);
    for (std::size_t n = 0; n <= octets.size(); ++n) {
        const auto prm = dp::decode_set_prm(std::span{octets}.first(n));
        ASSERT_EQ(static_cast<bool>(prm), n >= 7 && n <= 244) << n;
        if (!prm) { EXPECT_EQ(prm.error(), n < 7 ? dp::SetPrmError::too_short : dp::SetPrmError::too_long); }
    }
    std::array<std::uint8_t, 6> small{};
    EXPECT_EQ(dp::encode(dp::SetPrm{}, small).error(), dp::SetPrmError::no_room);
    dp::SetPrm big{};
    big.user_prm = std::span{octets}.first(238);
    std::array<std::uint8_t, 300> room{};
    EXPECT_EQ(dp::encode(big, room).error(), dp::SetPrmError::too_long);
}

// proves: VPC3C 6.2.2-04
TEST(SetPrm, DPV1_octets_that_were_not_sent_read_as_zero) {
    const Octets octets{0x88, 2, 5, 11, 0x47, 0x11, 0, 0xC4};
    const auto prm = dp::decode_set_prm(octets);
    ASSERT_TRUE(prm);
    EXPECT_EQ(prm->dpv1_status_1(), 0xC4);
    EXPECT_EQ(prm->dpv1_status_2(), 0);
    EXPECT_EQ(prm->dpv1_status_3(), 0);
    EXPECT_TRUE(prm->behind_dpv1_status().empty());
    EXPECT_EQ(prm->wd_base(), dp::WdBase::ms_1);
    EXPECT_EQ(dp::t_wd_ms(prm->wd, prm->wd_base()), 10u);
}

// proves: VPC3C 7.1-01, VPC3C 6.2.2-04
TEST(SetPrm, the_bit_table_names_every_defined_bit_once) {
    std::array<unsigned, 10> masks{};
    for (const auto& bit : dp::kPrmBits) {
        EXPECT_EQ(masks[bit.octet] & bit.mask, 0u) << bit.name;
        masks[bit.octet] |= bit.mask;
    }
    EXPECT_EQ(masks[0], 0xF8u);
    EXPECT_EQ(masks[7], 0xE7u);
    EXPECT_EQ(masks[8], 0xFDu);
    EXPECT_EQ(masks[9], 0x98u);
}

TEST(Watchdog, chosen_factors_are_the_shortest_time_that_is_long_enough) {
    std::vector<std::uint32_t> shortest(255 * 255 + 1, 0);  // the least product that is not less than the index
    for (std::uint32_t a = 1; a <= 255; ++a)
        for (std::uint32_t b = 1; b <= 255; ++b) shortest[a * b] = a * b;
    for (std::size_t n = shortest.size() - 1; n-- > 0;)
        if (shortest[n] == 0) shortest[n] = shortest[n + 1];
    for (std::uint32_t units = 2; units <= 255 * 255; units += units < 2000 ? 1 : 89) {
        for (const dp::WdBase base : {dp::WdBase::ms_10, dp::WdBase::ms_1}) {
            const auto f = dp::wd_factors(units * dp::milliseconds(base), base);
            ASSERT_TRUE(f);
            ASSERT_EQ(std::uint32_t{f->factor_1} * f->factor_2, shortest[units]) << units;
        }
    }
}

TEST(Watchdog, borders_and_examples) {
    EXPECT_EQ(*dp::wd_factors(0, dp::WdBase::ms_10), (dp::WdFactors{1, 2})) << "never 1 * 1";
    EXPECT_EQ(dp::t_wd_ms(*dp::wd_factors(11, dp::WdBase::ms_10), dp::WdBase::ms_10), 20u);
    EXPECT_EQ(dp::t_wd_ms(*dp::wd_factors(300, dp::WdBase::ms_10), dp::WdBase::ms_10), 300u);
    EXPECT_EQ(dp::t_wd_ms(*dp::wd_factors(257, dp::WdBase::ms_1), dp::WdBase::ms_1), 258u) << "257 is prime";
    EXPECT_EQ(*dp::wd_factors(650250, dp::WdBase::ms_10), (dp::WdFactors{255, 255}));
    EXPECT_FALSE(dp::wd_factors(650251, dp::WdBase::ms_10));
    EXPECT_FALSE(dp::wd_factors(0xFFFFFFFF, dp::WdBase::ms_1));
    EXPECT_EQ(dp::t_wd_ms({0, 5}, dp::WdBase::ms_10), 0u);
}

TEST(Watchdog, alarm_modes_limit_the_outstanding_alarms) {
    const std::array<int, 8> expected{0, 2, 4, 8, 12, 16, 24, 32};
    for (std::uint8_t mode = 0; mode < 8; ++mode) EXPECT_EQ(dp::alarm_limit(mode), expected[mode]);
}

// proves: VPC3C 7.1-05, VPC3C 7.1-07
TEST(StructuredPrm, blocks_are_walked_with_type_slot_and_data) {
    const Octets octets{5, 0x81, 0, 0, 0xAA, 9, 3, 0, 0, 1, 9, 4, 1, 2, 8, 2, 4, 0x18, 1, 0, 0, 0};
    dp::PrmBlockWalker walker{octets};
    dp::PrmBlock block{};
    ASSERT_TRUE(walker.next(block));
    EXPECT_EQ(block.type, 0x81);
    EXPECT_EQ(block.data.size(), 1u);
    ASSERT_TRUE(walker.next(block));
    EXPECT_STREQ(dp::prm_block_name(block.type), "DXB_Linktable");
    EXPECT_EQ(block.data.size(), 5u);
    ASSERT_TRUE(walker.next(block));
    EXPECT_EQ(block.slot, 4);
    EXPECT_EQ(block.reserved, 0x18);
    EXPECT_FALSE(walker.next(block));
    EXPECT_EQ(walker.error(), dp::PrmBlockError::none);
}

// proves: VPC3C 7.1-05
TEST(StructuredPrm, bad_lengths_stop_the_walk_at_the_bad_block) {
    for (unsigned length = 0; length < 256; ++length) {
        Octets octets{5, 0x81, 0, 0, 0xAA, static_cast<std::uint8_t>(length), 1, 2, 3, 4, 5};
        dp::PrmBlockWalker walker{octets};
        dp::PrmBlock block{};
        ASSERT_TRUE(walker.next(block));
        ASSERT_EQ(walker.next(block), length == 5 || length == 6) << length;
        if (length < 5 || length > 244) {
            EXPECT_EQ(walker.error(), dp::PrmBlockError::length_range);
        } else if (length > 6) {
            EXPECT_EQ(walker.error(), dp::PrmBlockError::truncated);
        }
        if (length < 5 || length > 6) { EXPECT_EQ(walker.offset(), 5u); }
    }
}

TEST(StructuredPrm, types_have_the_names_of_the_reference) {
    EXPECT_STREQ(dp::prm_block_name(2), "PrmCmd");
    EXPECT_STREQ(dp::prm_block_name(129), "User_Prm_Data");
    EXPECT_STREQ(dp::prm_block_name(32), "manufacturer specific");
    EXPECT_STREQ(dp::prm_block_name(128), "manufacturer specific");
    EXPECT_STREQ(dp::prm_block_name(6), "reserved");
    EXPECT_STREQ(dp::prm_block_name(130), "reserved");
}

TEST(SetSlaveAdd, round_trip_and_short_data) {
    const Octets octets{9, 0x47, 0x11, 0xFF, 1, 2};
    const auto s = dp::decode_set_slave_add(octets);
    ASSERT_TRUE(s);
    EXPECT_EQ(s->address, 9);
    EXPECT_EQ(s->ident, 0x4711);
    EXPECT_TRUE(s->no_add_chg);
    std::array<std::uint8_t, 6> out{};
    EXPECT_EQ(*dp::encode(*s, out), 6u);
    EXPECT_EQ(Octets(out.begin(), out.end()), octets);
    EXPECT_FALSE(dp::encode(*s, std::span{out}.first(5)));
    EXPECT_FALSE(dp::decode_set_slave_add(std::span{octets}.first(3)));
}

TEST(Saps, every_SAP_has_the_service_of_the_map) {
    for (unsigned sap = 0; sap < 256; ++sap) {
        const dp::Service s = dp::service(static_cast<std::uint8_t>(sap));
        const std::string_view name = dp::name(s);
        if (sap <= 48) EXPECT_EQ(name, "MS2") << sap;
        else if (sap == 52 || sap == 54 || (sap >= 63 && sap < 255)) EXPECT_EQ(s, dp::Service::none) << sap;
        else EXPECT_NE(name, "no service") << sap;
    }
    EXPECT_STREQ(dp::name(dp::service(dp::kDefaultSap)), "Data_Exchange");
    EXPECT_STREQ(dp::name(dp::service(60)), "Slave_Diag");
    EXPECT_STREQ(dp::name(dp::service(61)), "Set_Prm");
    EXPECT_STREQ(dp::name(dp::service(62)), "Chk_Cfg");
}

}  // namespace
