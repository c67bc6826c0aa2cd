// SPDX-License-Identifier: Apache-2.0
// PrmRules: lengths, constants, ranges, signs and bit fields.
#include <gtest/gtest.h>

#include <vector>

#include <dpchip/driver/prm_rules.hpp>

namespace dpchip::driver {
namespace {

using Octets = std::vector<std::uint8_t>;

TEST(PrmRules, LengthIsCheckedFirst) {
    PrmRules rules;
    rules.min_octets = 2;
    rules.max_octets = 4;
    EXPECT_EQ(check(rules, Octets(1)), PrmFault::length);
    EXPECT_EQ(check(rules, Octets(2)), PrmFault::none);
    EXPECT_EQ(check(rules, Octets(4)), PrmFault::none);
    EXPECT_EQ(check(rules, Octets(5)), PrmFault::length);
}

TEST(PrmRules, OnlyTheMaskedBitsOfAConstantCount) {
    static constexpr PrmConstant constants[]{{0, 0xFF, 0x12}, {1, 0xF0, 0xA0}};
    const PrmRules rules{0, 10, constants, {}};
    EXPECT_EQ(check(rules, Octets{0x12, 0xA5}), PrmFault::none);
    EXPECT_EQ(check(rules, Octets{0x13, 0xA5}), PrmFault::constant);
    EXPECT_EQ(check(rules, Octets{0x12, 0xB5}), PrmFault::constant);
    EXPECT_EQ(check(rules, Octets{0x12}), PrmFault::none);
}

TEST(PrmRules, ValuesAreReadMostSignificantOctetFirstWithTheirSign) {
    const Octets octets{0xFF, 0xFE, 0x80, 0x00, 0x00, 0x01};
    EXPECT_EQ(prm_value({.offset = 0, .octets = 1}, octets), 255);
    EXPECT_EQ(prm_value({.offset = 0, .octets = 1, .is_signed = true}, octets), -1);
    EXPECT_EQ(prm_value({.offset = 0, .octets = 2}, octets), 0xFFFE);
    EXPECT_EQ(prm_value({.offset = 0, .octets = 2, .is_signed = true}, octets), -2);
    EXPECT_EQ(prm_value({.offset = 2, .octets = 4}, octets), 0x80000001);
    EXPECT_EQ(prm_value({.offset = 2, .octets = 4, .is_signed = true}, octets), -0x7FFFFFFF);
    EXPECT_EQ(prm_value({.offset = 1, .octets = 1, .bit = 0, .width = 1}, octets), 0);
    EXPECT_EQ(prm_value({.offset = 1, .octets = 1, .bit = 1, .width = 3}, octets), 7);
    EXPECT_EQ(prm_value({.offset = 1, .octets = 1, .is_signed = true, .bit = 0, .width = 4}, octets), -2);
}

TEST(PrmRules, RangesIncludeTheirEnds) {
    static constexpr PrmValue values[]{{.offset = 0, .octets = 2, .is_signed = true, .min = -5, .max = 300}};
    const PrmRules rules{0, 10, {}, values};
    EXPECT_EQ(check(rules, Octets{0xFF, 0xFB}), PrmFault::none);
    EXPECT_EQ(check(rules, Octets{0xFF, 0xFA}), PrmFault::out_of_range);
    EXPECT_EQ(check(rules, Octets{0x01, 0x2C}), PrmFault::none);
    EXPECT_EQ(check(rules, Octets{0x01, 0x2D}), PrmFault::out_of_range);
    EXPECT_EQ(check(rules, Octets{0x01}), PrmFault::none) << "not sent: the length decides";
}

TEST(PrmRules, SeveralRangesReplaceTheOne) {
    static constexpr PrmRange list[]{{0, 0}, {2, 2}, {5, 7}};
    static constexpr PrmValue values[]{{.offset = 0, .octets = 1, .bit = 4, .width = 4, .ranges = list}};
    const PrmRules rules{0, 10, {}, values};
    EXPECT_EQ(check(rules, Octets{0x2F}), PrmFault::none);
    EXPECT_EQ(check(rules, Octets{0x7F}), PrmFault::none);
    EXPECT_EQ(check(rules, Octets{0x6F}), PrmFault::none);
    EXPECT_EQ(check(rules, Octets{0x4F}), PrmFault::out_of_range);
    EXPECT_EQ(check(rules, Octets{0x1F}), PrmFault::out_of_range);
}

TEST(PrmRules, EveryLengthAndValueOfATwoOctetRuleIsTotal) {
    static constexpr PrmValue values[]{{.offset = 1, .octets = 2, .min = 1000, .max = 2000}};
    const PrmRules rules{0, 4, {}, values};
    for (std::size_t length = 0; length < 6; ++length)
        for (unsigned v = 0; v < 0x10000; v += 37) {
            Octets octets(length, 0);
            if (length > 1) octets[1] = static_cast<std::uint8_t>(v >> 8);
            if (length > 2) octets[2] = static_cast<std::uint8_t>(v);
            const PrmFault expected = length > 4                                ? PrmFault::length
                                      : length > 2 && (v < 1000 || v > 2000) ? PrmFault::out_of_range
                                                                                : PrmFault::none;
            ASSERT_EQ(check(rules, octets), expected);
        }
}

}  // namespace
}  // namespace dpchip::driver
