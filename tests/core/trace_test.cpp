// SPDX-License-Identifier: Apache-2.0
// Trace sinks: the ring keeps the newest records, and no sink costs anything it does not have to.

#include <array>

#include <dpchip/core/trace.hpp>
#include <gtest/gtest.h>

namespace {

using namespace dpchip::core;

TEST(Trace, without_a_sink_the_record_is_not_even_made) {
    int made = 0;
    NoTrace::emit([&] { ++made; return TraceRecord{}; });
    RingTrace detached;
    detached.emit([&] { ++made; return TraceRecord{}; });
    RingTrace empty;
    empty.attach({});
    empty.emit([&] { ++made; return TraceRecord{}; });
    EXPECT_EQ(made, 0);
    EXPECT_EQ(detached.count + empty.count, 0u);
}

TEST(Trace, the_ring_keeps_the_newest_and_counts_all) {
    std::array<TraceRecord, 4> memory{};
    RingTrace trace;
    trace.attach(memory);
    for (std::uint16_t i = 0; i < 10; ++i) trace.emit([&] { return TraceRecord{{i}, i, 0, 0}; });
    EXPECT_EQ(trace.count, 10u);
    for (std::uint64_t i = trace.count - memory.size(); i < trace.count; ++i)
        EXPECT_EQ(memory[i % memory.size()].what, i);
}

TEST(Trace, attaching_starts_anew) {
    std::array<TraceRecord, 2> first{}, second{};
    RingTrace trace;
    trace.attach(first);
    trace.emit([] { return TraceRecord{{1}, 1, 0, 0}; });
    trace.attach(second);
    EXPECT_EQ(trace.count, 0u);
    trace.emit([] { return TraceRecord{{2}, 2, 0, 0}; });
    EXPECT_EQ(first[0].what, 1);
    EXPECT_EQ(second[0], (TraceRecord{{2}, 2, 0, 0}));
}

}  // namespace
