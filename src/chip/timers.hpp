// SPDX-License-Identifier: Apache-2.0
// The chip's deadlines: a fixed array, served in order of time and, within one tick, of their numbers.
#pragma once

#include <algorithm>

#include <dpchip/chip/context.hpp>

namespace dpchip::chip::timers {

constexpr Ticks& deadline(State& s, Timer t) { return s.timers[static_cast<std::size_t>(t)]; }
constexpr Ticks deadline(const State& s, Timer t) { return s.timers[static_cast<std::size_t>(t)]; }
constexpr bool running(const State& s, Timer t) { return deadline(s, t) != core::kNever; }
constexpr void start(State& s, Timer t, Ticks at) { deadline(s, t) = at; }
constexpr void stop(State& s, Timer t) { deadline(s, t) = core::kNever; }

/// The timer to serve first; its deadline may be kNever.
constexpr Timer earliest(const State& s) {
    std::size_t first = 0;
    for (std::size_t i = 1; i < kTimers; ++i)
        if (s.timers[i] < s.timers[first]) first = i;
    return static_cast<Timer>(first);
}

}  // namespace dpchip::chip::timers
