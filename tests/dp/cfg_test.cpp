// SPDX-License-Identifier: Apache-2.0
// Configuration octets against the formulas and examples of reference 7.2 and 7.3.
#include <array>
#include <cstdint>
#include <ostream>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/dp/cfg.hpp>

namespace dp = dpchip::dp;
using Octets = std::vector<std::uint8_t>;

namespace {

struct Example {
    Octets cfg;
    int inputs, outputs, blocks;
};
std::ostream& operator<<(std::ostream& os, const Example& e) { return os << testing::PrintToString(e.cfg); }

class CfgExamples : public testing::TestWithParam<Example> {};
// proves: APC3 A.3-10, APC3 A.3-13..16, APC3 A.3-20, E062
TEST_P(CfgExamples, add_up_to_the_lengths_of_the_reference) {
    const auto& e = GetParam();
    const dp::CfgTotals t = dp::cfg_totals(e.cfg);
    EXPECT_TRUE(t.ok());
    EXPECT_EQ(t.input_octets, e.inputs);
    EXPECT_EQ(t.output_octets, e.outputs);
    EXPECT_EQ(t.blocks, e.blocks);
}
// clang-format off
INSTANTIATE_TEST_SUITE_P(Reference, CfgExamples, testing::Values(
    Example{{}, 0, 0, 0}, Example{{0x10}, 1, 0, 1}, Example{{0x20}, 0, 1, 1}, Example{{0x30}, 1, 1, 1}, Example{{0x11}, 2, 0, 1},
    Example{{0x21}, 0, 2, 1}, Example{{0x50}, 2, 0, 1}, Example{{0x61}, 0, 4, 1}, Example{{0x70}, 2, 2, 1}, Example{{0xF1}, 4, 4, 1},
    Example{{0x13}, 4, 0, 1}, Example{{0x23}, 0, 4, 1}, Example{{0x11, 0x21}, 2, 2, 2}, Example{{0x00}, 0, 0, 1},
    Example{{0xC3, 0xCF, 0xC7, 1, 2, 3}, 16, 32, 1}, Example{{0x40, 0x3F}, 64, 0, 1}, Example{{0x80, 0x7F}, 0, 128, 1},
    Example{{0x0F}, 0, 0, 1}, Example{{0x4F, 0x00, 0x10}, 2, 0, 2}, Example{{0x02, 0xAA, 0xBB, 0x20}, 0, 1, 2}));
// clang-format on

// proves: APC3 A.3-03..06, APC3 A.3-08..09, E062
TEST(Cfg, every_general_octet_follows_the_formula) {
    int seen = 0;
    for (unsigned b = 0; b < 256; ++b) {
        if ((b & 0x30) == 0) continue;
        const std::array<std::uint8_t, 1> cfg{static_cast<std::uint8_t>(b)};
        const auto block = dp::cfg_block(cfg, 0, dp::CfgUse::get_cfg);
        ASSERT_TRUE(block) << b;
        const unsigned octets = ((b & 15) + 1) * ((b & 0x40) != 0 ? 2 : 1);
        EXPECT_EQ(block->input.octets, (b & 0x10) != 0 ? octets : 0u) << b;
        EXPECT_EQ(block->output.octets, (b & 0x20) != 0 ? octets : 0u) << b;
        EXPECT_EQ(block->size, 1u);
        EXPECT_FALSE(block->special);
        EXPECT_FALSE(block->empty_slot());
        const dp::CfgLength& any = (b & 0x10) != 0 ? block->input : block->output;
        EXPECT_EQ(any.words, (b & 0x40) != 0);
        EXPECT_EQ(any.whole, (b & 0x80) != 0);
        EXPECT_EQ(dp::general_cfg((b & 0x10) != 0, (b & 0x20) != 0, (b & 15) + 1, any.words, any.whole), b);
        ++seen;
    }
    EXPECT_EQ(seen, 192);
}

// proves: APC3 A.3-07, APC3 A.3-11..19, APC3 A.3-21, E063
TEST(Cfg, every_special_header_with_every_length_octet_follows_the_formula) {
    for (unsigned header = 0; header < 256; ++header) {
        if ((header & 0x30) != 0) continue;
        const std::size_t k = (header & 15) == 15 ? 0 : header & 15;
        const std::size_t size = 1 + (header >> 7) + ((header >> 6) & 1) + k;
        for (unsigned length = 0; length < 256; ++length) {
            Octets cfg(size, 0x5A);
            cfg[0] = static_cast<std::uint8_t>(header);
            for (std::size_t i = 1; i < size - k; ++i) cfg[i] = static_cast<std::uint8_t>(length);
            const auto block = dp::cfg_block(cfg, 0);
            ASSERT_TRUE(block) << header;
            const unsigned octets = ((length & 63) + 1) * ((length & 0x40) != 0 ? 2 : 1);
            EXPECT_EQ(block->input.octets, (header & 0x40) != 0 ? octets : 0u);
            EXPECT_EQ(block->output.octets, (header & 0x80) != 0 ? octets : 0u);
            EXPECT_EQ(block->manufacturer.size(), k);
            EXPECT_EQ(block->size, size);
            EXPECT_EQ(block->empty_slot(), header < 0x40);
        }
    }
}

TEST(Cfg, every_shortened_special_block_is_truncated_at_its_first_octet) {
    for (unsigned header = 0; header < 256; ++header) {
        const std::size_t size = dp::cfg_block_size(static_cast<std::uint8_t>(header));
        for (std::size_t cut = 1; cut < size; ++cut) {
            Octets cfg{0x10};
            cfg.resize(1 + cut, 0);
            cfg[1] = static_cast<std::uint8_t>(header);
            const dp::CfgTotals t = dp::cfg_totals(cfg);
            EXPECT_EQ(t.error, dp::CfgError::truncated);
            EXPECT_EQ(t.error_offset, 1);
            EXPECT_EQ(t.input_octets, 1) << "the block before it still counts";
        }
    }
}

// proves: APC3 A.3-16
TEST(Cfg, the_outputs_length_octet_comes_first_in_a_block_with_both) {
    const Octets cfg{0xC0, 0x01, 0x82};
    const auto block = dp::cfg_block(cfg, 0);
    ASSERT_TRUE(block);
    EXPECT_EQ(block->output, (dp::CfgLength{2, false, false}));
    EXPECT_EQ(block->input, (dp::CfgLength{3, false, true}));
}

TEST(Cfg, a_manufacturer_count_of_15_is_a_wildcard_in_Chk_Cfg_and_forbidden_in_Get_Cfg) {
    const Octets cfg{0x4F, 0x03};
    EXPECT_TRUE(dp::cfg_totals(cfg).ok());
    EXPECT_EQ(dp::cfg_totals(cfg, dp::CfgUse::get_cfg).error, dp::CfgError::wildcard);
    EXPECT_TRUE(dp::cfg_matches(Octets{0x42, 0x03, 7, 8, 0x10}, Octets{0x4F, 0x03, 0x10}));
    EXPECT_TRUE(dp::cfg_matches(Octets{0x40, 0x03}, cfg));
    EXPECT_FALSE(dp::cfg_matches(Octets{0x42, 0x04, 7, 8}, cfg)) << "another length";
    EXPECT_FALSE(dp::cfg_matches(Octets{0x82, 0x03, 7, 8}, cfg)) << "another direction";
    EXPECT_FALSE(dp::cfg_matches(Octets{0x13}, cfg)) << "the general format is another block";
}

TEST(Cfg, matching_is_exact_without_a_wildcard) {
    EXPECT_TRUE(dp::cfg_matches(Octets{0x11, 0x21}, Octets{0x11, 0x21}));
    EXPECT_FALSE(dp::cfg_matches(Octets{0x11, 0x21}, Octets{0x11}));
    EXPECT_FALSE(dp::cfg_matches(Octets{0x11}, Octets{0x11, 0x21}));
    EXPECT_FALSE(dp::cfg_matches(Octets{0x11}, Octets{0x91}));
    EXPECT_FALSE(dp::cfg_matches(Octets{0x42, 0x03, 1, 2}, Octets{0x42, 0x03, 1, 3}));
    EXPECT_FALSE(dp::cfg_matches(Octets{0x40}, Octets{0x40})) << "damaged on both sides";
}

TEST(Cfg, more_than_244_octets_in_a_direction_are_refused_with_the_block_that_is_too_much) {
    const Octets in{0x5F, 0x5F, 0x5F, 0x5F, 0x5F, 0x5F, 0x5F, 0x59};
    EXPECT_EQ(dp::cfg_totals(in).input_octets, 7 * 32 + 20);
    Octets more = in;
    more.push_back(0x10);
    EXPECT_EQ(dp::cfg_totals(more).error, dp::CfgError::too_many_inputs);
    EXPECT_EQ(dp::cfg_totals(more).error_offset, 8);
    EXPECT_EQ(dp::cfg_totals(Octets{0x80, 0x7F, 0x80, 0x7F}).error, dp::CfgError::too_many_outputs);
}

TEST(Cfg, any_octets_are_walked_to_the_end_or_to_an_error) {
    std::mt19937 random{20};
    for (int round = 0; round < 20000; ++round) {
        Octets cfg(random() % 245);
        for (auto& b : cfg) b = static_cast<std::uint8_t>(random());
        dp::CfgWalker walker{cfg};
        std::size_t covered = 0;
        for (dp::CfgBlock block{}; walker.next(block);) {
            ASSERT_EQ(block.offset, covered);
            covered += block.size;
        }
        ASSERT_EQ(walker.offset(), covered);
        ASSERT_EQ(walker.error() == dp::CfgError::none, covered == cfg.size());
        ASSERT_TRUE(dp::cfg_matches(cfg, cfg) || walker.error() != dp::CfgError::none);
    }
}

}  // namespace
