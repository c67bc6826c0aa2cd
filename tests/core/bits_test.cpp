// SPDX-License-Identifier: Apache-2.0
// Bits: every bit and every slice, against arithmetic without shifts.

#include <cstdint>

#include <dpchip/core/bits.hpp>
#include <gtest/gtest.h>

namespace {

using namespace dpchip::core;

TEST(Bits, every_bit_of_every_octet) {
    for (unsigned value = 0; value < 256; ++value)
        for (unsigned n = 0, weight = 1; n < 8; ++n, weight *= 2)
            ASSERT_EQ(bit(value, n), value / weight % 2 == 1) << value << ' ' << n;
    EXPECT_TRUE(bit(0x8000'0000u, 31));
}

TEST(Bits, every_slice_of_every_octet) {
    for (unsigned value = 0; value < 256; ++value)
        for (unsigned lsb = 0, low_weight = 1; lsb < 8; ++lsb, low_weight *= 2)
            for (unsigned width = 1, modulus = 2; lsb + width <= 8; ++width, modulus *= 2)
                ASSERT_EQ(slice(value, lsb, width), value / low_weight % modulus) << value << ' ' << lsb << ' ' << width;
    EXPECT_EQ(slice(0xABCD'1234u, 24, 8), 0xAB);
}

TEST(Bits, words_are_their_two_octets) {
    for (unsigned value = 0; value < 0x1'0000; ++value) {
        const auto w = static_cast<std::uint16_t>(value);
        ASSERT_EQ(high(w), value / 256);
        ASSERT_EQ(low(w), value % 256);
        ASSERT_EQ(word(high(w), low(w)), w);
    }
}

TEST(Bits, an_enumerator_has_the_number_and_type_of_its_base) {
    enum class Small : std::uint8_t { a = 200 };
    static_assert(std::is_same_v<decltype(to_underlying(Small::a)), std::uint8_t> && to_underlying(Small::a) == 200);
    SUCCEED();
}

}  // namespace
