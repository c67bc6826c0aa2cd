// SPDX-License-Identifier: Apache-2.0
// FixedQueue: order, wrap-around, and the count of what did not fit.

#include <deque>
#include <random>

#include <dpchip/core/fixed_queue.hpp>
#include <gtest/gtest.h>

namespace {

using dpchip::core::FixedQueue;

TEST(FixedQueue, gives_back_in_order) {
    FixedQueue<int, 3> queue;
    EXPECT_TRUE(queue.empty());
    for (const int i : {1, 2, 3}) queue.push(i);
    EXPECT_EQ(queue.size(), queue.capacity());
    for (const int i : {1, 2, 3}) EXPECT_EQ(queue.pop(), i);
    EXPECT_TRUE(queue.empty());
    EXPECT_EQ(queue.overflows(), 0u);
}

TEST(FixedQueue, what_does_not_fit_is_dropped_and_counted_and_what_is_in_stays) {
    FixedQueue<int, 2> queue;
    for (const int i : {1, 2, 3, 4, 5}) queue.push(i);
    EXPECT_EQ(queue.overflows(), 3u);
    EXPECT_EQ(queue.pop(), 1);
    queue.push(6);
    EXPECT_EQ(queue.pop(), 2);
    EXPECT_EQ(queue.pop(), 6);
    EXPECT_EQ(queue.overflows(), 3u);
}

TEST(FixedQueue, behaves_like_a_deque_with_a_limit) {
    std::mt19937 random{7};
    FixedQueue<unsigned, 5> queue;
    std::deque<unsigned> model;
    std::uint64_t dropped = 0;
    for (unsigned i = 0; i < 10'000; ++i) {
        if (random() % 2 == 0) {
            queue.push(i);
            if (model.size() < 5) model.push_back(i);
            else ++dropped;
        } else if (!model.empty()) {
            ASSERT_EQ(queue.front(), model.front());
            ASSERT_EQ(queue.pop(), model.front());
            model.pop_front();
        }
        ASSERT_EQ(queue.size(), model.size());
        ASSERT_EQ(queue.empty(), model.empty());
        ASSERT_EQ(queue.overflows(), dropped);
    }
    EXPECT_GT(dropped, 0u);
}

TEST(FixedQueue, works_in_constant_expressions) {
    static_assert([] {
        FixedQueue<int, 2> queue;
        queue.push(4);
        queue.push(5);
        return queue.pop() * 10 + queue.pop();
    }() == 45);
    SUCCEED();
}

}  // namespace
