// SPDX-License-Identifier: Apache-2.0
// Where a live line gets its time from: the monotonic clock, or a test's hand.
#pragma once

#include <ctime>

#include <dpchip/core/ticks.hpp>

namespace dpchip::live {

using core::Ticks;

class TimeSource {
public:
    virtual ~TimeSource() = default;
    /// Never runs backwards.
    virtual Ticks now() const = 0;
};

/// CLOCK_MONOTONIC.
class MonotonicTime final : public TimeSource {
public:
    Ticks now() const override {
        timespec t{};
        clock_gettime(CLOCK_MONOTONIC, &t);
        return core::seconds(t.tv_sec) + core::nanoseconds(t.tv_nsec);
    }
};

/// Nanoseconds since 1970 at line time 0 of a line whose time is `line_now` at this moment; for captures.
inline std::int64_t epoch_ns(Ticks line_now) {
    timespec t{};
    clock_gettime(CLOCK_REALTIME, &t);
    return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec - core::to_ns(line_now);
}

}  // namespace dpchip::live
