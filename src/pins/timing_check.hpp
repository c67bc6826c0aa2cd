// SPDX-License-Identifier: Apache-2.0
// What the processor owes the chip: the 45 checked parameters of 10.7, evaluated from their table (hardware reference 4).
//
// For every kind of edge the time of the latest one is kept; when an edge occurs, each parameter that ends with it is
// looked at. Only accesses to this chip count, so ALE and the address that belongs to it are judged when the strobe shows
// whom they were for. A line that must be stable changes inside a strobe: that is a set-up or a hold time below zero, of
// the edge that is nearer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <dpchip/core/fixed_queue.hpp>
#include <dpchip/regmap/bus_timing.hpp>

namespace dpchip::pins {

using core::Ticks;
using regmap::BusEvent;
using regmap::Cycle;
using regmap::ProcessorMode;
using regmap::Supply;

/// A parameter that was not met.
struct Violation {
    Ticks at{};            ///< of the edge that completed it
    std::uint8_t number{};
    Ticks found{};         ///< below zero: in the wrong order
    bool operator==(const Violation&) const = default;
};

class TimingCheck {
public:
    /// Forgets all edges.
    void configure(ProcessorMode mode, Supply supply);

    /// An edge outside the strobes: ALE, XCS, R_W, an address line, a data line that the processor moves.
    void event(BusEvent e, Ticks at);
    /// The strobe of a selected access is active. `fell`: its edge; before `now` when the select came late.
    void open(Cycle cycle, Ticks fell);
    /// The strobe that open() told of is over.
    void close(Ticks at);
    /// It is not worth looking at: the access came to nothing.
    void abandon() { open_ = false; }

    /// What was found since, oldest first.
    core::FixedQueue<Violation, 16>& violations() { return violations_; }

private:
    /// First and last change of a line during the strobe.
    struct Inside {
        BusEvent event{};
        bool seen = false;
        Ticks first{}, last{};
    };
    static constexpr Ticks kLongAgo{-(std::int64_t{1} << 61)};

    Ticks& last(BusEvent e) { return last_[static_cast<std::size_t>(e)]; }
    Ticks latest(regmap::BusEvents events) const;
    void evaluate(BusEvent e, Ticks at, Cycle cycle);
    void judge(const regmap::TimingParameter& p, Ticks found, Ticks from, Ticks at);
    void ale(BusEvent e, Ticks at);
    void emit_ale_phase();
    void changed_inside(const Inside& line, Ticks change, Ticks rose);
    template <class F>
    void each_check(F&& visit);

    ProcessorMode mode_{};
    Supply supply_{};
    std::size_t first_ = 0, end_ = 0;  ///< the mode's rows of kBusTiming
    bool open_ = false;
    Cycle cycle_{};
    Ticks fell_{};
    Ticks xcs_rose_inside_{};
    std::array<Inside, 2> inside_{{{BusEvent::address_changes}, {BusEvent::r_w_changes}}};
    bool ale_phase_ = false;           ///< ALE has fallen; its violations wait for the strobe
    Ticks late_address_{};             ///< last change of an AB pin after ALE fell
    core::FixedQueue<Violation, 8> waiting_;
    std::array<Ticks, regmap::kBusEvents> last_{};
    std::array<Ticks, regmap::kTimingParameters> reported_{};  ///< the `from` of the last report: one line is enough of a bus
    core::FixedQueue<Violation, 16> violations_;
};

}  // namespace dpchip::pins
