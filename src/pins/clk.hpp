// SPDX-License-Identifier: Apache-2.0
// CLK: a running 48 MHz crystal with a phase, whose edges are computed and not simulated (6.1 of the hardware reference;
// 8.1.1, 10.7.1). Edges that the board drives are checked and set the phase.
//
// Not modelled: a clock that stops or has another frequency. Without driven edges the crystal runs on.
#pragma once

#include <dpchip/core/ticks.hpp>
#include <dpchip/pins/pin.hpp>
#include <dpchip/regmap/bus_timing.hpp>

namespace dpchip::pins {

class Clk {
public:
    /// A rising edge lies at `phase`, any tick of the first period.
    explicit Clk(Ticks phase = {}) : origin_{phase}, count_{phase > Ticks{} ? 1 : 0} {}

    /// Rising edges after time 0, up to and including `t`.
    std::int64_t edges_until(Ticks t) const { return count_ + floor_div(t - origin_); }
    /// The first rising edge at or after `t`.
    Ticks edge_from(Ticks t) const { return origin_ + core::kClk * -floor_div(origin_ - t); }
    /// The first rising edge after `t`.
    Ticks edge_after(Ticks t) const { return origin_ + core::kClk * (floor_div(t - origin_) + 1); }
    Ticks phase() const { return origin_ - core::kClk * floor_div(origin_); }

    /// The board drives an edge at `at` that lasts `slope`; `report(SystemTiming, found)` for each time out of its limits.
    template <class Report>
    void drive(PinLevel level, Ticks at, Ticks slope, Report&& report) {
        const bool rises = level == PinLevel::high;
        check(rises ? regmap::SystemTiming::clk_rise : regmap::SystemTiming::clk_fall, slope, report);
        Ticks& other = rises ? fell_ : rose_;
        if (other != kNone) check(rises ? regmap::SystemTiming::clk_low : regmap::SystemTiming::clk_high, at - other, report);
        if (!rises) {
            fell_ = at;
            return;
        }
        if (rose_ != kNone) check(regmap::SystemTiming::clk_period, at - rose_, report);
        rose_ = at;
        count_ += floor_div(at - origin_ + Ticks{core::kClk.n / 2});
        origin_ = at;
    }

private:
    static constexpr Ticks kNone{-1};

    static constexpr std::int64_t floor_div(Ticks t) {
        const std::int64_t q = t / core::kClk;
        return t.n % core::kClk.n < 0 ? q - 1 : q;
    }
    template <class Report>
    static void check(regmap::SystemTiming what, Ticks found, Report& report) {
        if (!regmap::timing(what).limits.meets(found)) report(what, found);
    }

    Ticks origin_{};          ///< a rising edge
    std::int64_t count_;      ///< its number
    Ticks rose_ = kNone, fell_ = kNone;
};

}  // namespace dpchip::pins
