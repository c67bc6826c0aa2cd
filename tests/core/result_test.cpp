// SPDX-License-Identifier: Apache-2.0
// Result: a value or a reason, never both.

#include <cstdint>
#include <type_traits>

#include <dpchip/core/result.hpp>
#include <gtest/gtest.h>

namespace {

using dpchip::core::Result;

enum class Why : std::uint8_t { odd, large };
struct Half {
    int value;
};

constexpr Result<Half, Why> half(int n) {
    if (n > 100) return Why::large;
    if (n % 2 != 0) return Why::odd;
    return Half{n / 2};
}

TEST(Result, holds_the_value) {
    const auto result = half(8);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->value, 4);
    EXPECT_EQ((*result).value, 4);
}

TEST(Result, holds_the_reason) {
    EXPECT_FALSE(half(3));
    EXPECT_EQ(half(3).error(), Why::odd);
    EXPECT_EQ(half(102).error(), Why::large);
}

TEST(Result, is_a_constant_expression_and_no_bool_by_accident) {
    static_assert(half(2) && half(2)->value == 1 && half(1).error() == Why::odd);
    static_assert(!std::is_convertible_v<Result<Half, Why>, bool>);
    SUCCEED();
}

}  // namespace
