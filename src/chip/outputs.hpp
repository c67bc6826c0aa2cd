// SPDX-License-Identifier: Apache-2.0
// Output pins: levels follow from the state, edges go to the queue of the owner (3.1, 5.3, 8.3; reference 1.5).
#pragma once

#include <dpchip/chip/context.hpp>

namespace dpchip::chip::outputs {

constexpr Level to_level(bool high) { return high ? Level::high : Level::low; }

/// The level of a pin as it follows from the state; never stored, so it is right after a restore too.
constexpr Level level(const State& s, Pin pin) {
    switch (pin) {
    case Pin::x_int: return to_level(((s.mode0 & regmap::mode0::int_pol) != 0) == (s.x_int_active != 0));
    case Pin::rts: return to_level(s.rts != 0);
    case Pin::xdataexch_sync:
        if ((s.mode2 & (regmap::mode2::sync_ena | regmap::mode2::dx_int_port)) == 0) return to_level(s.dp_state != DpState::data_exch);
        return to_level((s.sync_active != 0) == ((s.mode2 & regmap::mode2::sync_pol) != 0));
    }
    return Level::low;
}

/// Tells the owner and the trace that `pin` has changed just now.
template <class C>
void changed(C& c, Fact what, Pin pin) {
    const Level now = level(c.s, pin);
    if (core::bit(c.s.watched_pins, core::to_underlying(pin))) c.edges.push({c.s.now, pin, now});
    c.fact(what, core::to_underlying(now));
}

}  // namespace dpchip::chip::outputs
