// SPDX-License-Identifier: Apache-2.0
// The times of a processor's bus cycles, named by the parameters of 10.7 that they have to meet.
#pragma once

#include <array>
#include <cstdint>

#include <dpchip/regmap/bus_timing.hpp>

namespace dpchip::pins {

using core::Ticks;
using regmap::Cycle;
using regmap::ProcessorMode;
using regmap::Supply;

/// `of[n]` is the time that a cycle gives parameter n. A set-up or hold time below zero is in the wrong order.
struct BusTimes {
    std::array<Ticks, 61> of{};
    /// Asynchronous modes: the strobe lasts until ready, and no less than its pulse width.
    bool wait_for_ready = false;
    /// Other traffic: address and R_W change as soon as they need not hold any longer.
    bool busy_bus = false;

    /// Every time exactly at its limit.
    static constexpr BusTimes at_limits(ProcessorMode mode, Supply supply) {
        BusTimes t;
        for (const regmap::TimingParameter& p : regmap::kBusTiming)
            if (p.mode == mode && p.kind == regmap::TimingKind::check) t.of[p.number] = p.at(supply).min;
        return t;
    }
    /// As a board does it: 5 ns more than every limit, and the asynchronous modes wait for ready.
    static constexpr BusTimes comfortable(ProcessorMode mode, Supply supply) {
        BusTimes t = at_limits(mode, supply);
        for (const regmap::TimingParameter& p : regmap::kBusTiming)
            if (p.mode == mode && p.kind == regmap::TimingKind::check) t.of[p.number] += core::nanoseconds(5);
        t.wait_for_ready = !regmap::synchronous(mode);
        return t;
    }
};

/// Which parameters shape a cycle of a mode; 0: no such line or limit.
struct CycleNumbers {
    std::uint8_t width, cycle, inactive;
    std::uint8_t address_setup, address_hold;
    std::uint8_t select_setup, select_hold, last_strobe_to_select;
    std::uint8_t r_w_setup, r_w_hold;
    std::uint8_t data_setup, data_hold;
    std::uint8_t ale_width, ale_to_strobe, address_to_ale, address_after_ale, strobe_to_ale;
};

constexpr CycleNumbers cycle_numbers(ProcessorMode mode, Cycle cycle) {
    const bool read = cycle == Cycle::read;
    const auto either = [read](int of_read, int of_write) { return static_cast<std::uint8_t>(read ? of_read : of_write); };
    CycleNumbers n{};
    switch (mode) {
    case ProcessorMode::sync_intel:
        n = {either(6, 12), 10, 0, 0, 8, 0, 0, 0, 0, 0, 13, 15, 1, either(2, 11), 3, 4, either(7, 14)};
        break;
    case ProcessorMode::async_intel: n = {either(18, 29), 22, 25, 16, 23, 19, 26, 0, 0, 0, 28, 30, 0, 0, 0, 0, 0}; break;
    case ProcessorMode::sync_motorola: n = {31, 0, 0, 33, 37, 36, 40, 0, 35, 39, 41, 42, 0, 0, 0, 0, 0}; break;
    case ProcessorMode::async_motorola: n = {either(45, 59), 51, 54, 43, 52, 47, 56, 50, 46, 55, 58, 60, 0, 0, 0, 0, 0}; break;
    }
    return n;
}

}  // namespace dpchip::pins
