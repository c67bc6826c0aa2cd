// SPDX-License-Identifier: Apache-2.0
// CLKOUT2/4: CLK divided by 2 (DIVIDER = 1) or 4 (DIVIDER = 0) for the processor (8.1.1; hardware reference 6).
//
// A chain of two toggles on rising edges of CLK; it starts low and also runs during RESET and Offline, which nobody has
// published. Levels are computed, so a CLKOUT that nobody watches costs nothing.
#pragma once

#include <dpchip/pins/clk.hpp>

namespace dpchip::pins::clock_out {

constexpr std::int64_t edges_per_level(bool divider) { return divider ? 1 : 2; }

/// The level at `t`, edge included.
inline PinLevel level(const Clk& clk, bool divider, Ticks t) {
    const std::int64_t edges = clk.edges_until(t);
    return to_level((edges & edges_per_level(divider)) != 0);
}

/// The first change after `t`.
inline Ticks next(const Clk& clk, bool divider, Ticks t) {
    const Ticks edge = clk.edge_after(t);
    return !divider && level(clk, divider, edge) == level(clk, divider, t) ? edge + core::kClk : edge;
}

}  // namespace dpchip::pins::clock_out
