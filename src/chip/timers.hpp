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

/// The earliest deadline; kNever when no timer runs. Kept free of branches: it is asked for after every event.
constexpr Ticks soonest(const State& s) {
    Ticks first = s.timers[0];
    for (std::size_t i = 1; i < kTimers; ++i) first = std::min(first, s.timers[i]);
    return first;
}

/// The timer to serve at `at`, which is its deadline.
constexpr Timer due_at(const State& s, Ticks at) {
    std::size_t i = 0;
    while (s.timers[i] != at) ++i;
    return static_cast<Timer>(i);
}

}  // namespace dpchip::chip::timers
