// SPDX-License-Identifier: Apache-2.0
// DPCHIP_ASSERT stops checked builds; other builds do not even look at the condition.

#include <dpchip/core/assert.hpp>
#include <dpchip/core/fixed_queue.hpp>
#include <gtest/gtest.h>

namespace {

TEST(Assert, a_condition_that_holds_does_nothing) {
    int looked = 0;
    DPCHIP_ASSERT(++looked == 1);
#if defined(DPCHIP_CHECKED)
    EXPECT_EQ(looked, 1);
#else
    EXPECT_EQ(looked, 0);
#endif
}

#if defined(DPCHIP_CHECKED)
TEST(AssertDeathTest, a_programmer_error_stops_the_process) {
    EXPECT_DEATH({ DPCHIP_ASSERT(1 == 2); }, "");
    dpchip::core::FixedQueue<int, 1> queue;
    EXPECT_DEATH(static_cast<void>(queue.pop()), "");
}
#endif

}  // namespace
