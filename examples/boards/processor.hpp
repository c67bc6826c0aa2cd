// SPDX-License-Identifier: Apache-2.0
// A processor, as far as its bus goes: cycles with the edges that its data sheet promises, computed from its clock. No
// instruction set is simulated; the firmware is compiled for the host and its accesses become cycles.
//
// A data sheet gives each time as a multiple of the clock and some nanoseconds, at its worst. The cycles here take all of
// them at once, each at the end that is worse for the chip.
#pragma once

#include <cstdint>
#include <string_view>

#include "circuit.hpp"

namespace boards {

/// A line of a data sheet's table: so many periods (of whatever the table counts in) and so many nanoseconds.
struct Figure {
    int periods = 0;
    Ticks more{};
    constexpr Ticks at(Ticks period) const { return period * periods + more; }
};
constexpr Figure operator*(int n, Figure f) { return {f.periods * n, f.more * n}; }
constexpr Figure operator+(Figure f, Ticks t) { return {f.periods, f.more + t}; }
constexpr Figure operator-(Figure f, Ticks t) { return {f.periods, f.more - t}; }
/// One period: a data sheet's 2T - 40 is 2 * kT - 40_ns.
inline constexpr Figure kT{1, {}};

/// Address decoder: which addresses it selects, and how long it takes to say so.
struct Decoder {
    std::uint32_t mask = 0, value = 0;
    Ticks delay{};
    constexpr bool selects(std::uint32_t address) const { return (address & mask) == value; }
};

class Processor {
public:
    Processor(Circuit& circuit, Ticks period) : circuit_{&circuit}, period_{period} {}
    virtual ~Processor() = default;
    Processor(const Processor&) = delete;
    Processor& operator=(const Processor&) = delete;

    /// Levels of the lines while RESET is active.
    virtual void power_up() = 0;
    /// One cycle on the processor's data bus.
    virtual std::uint8_t read(std::uint32_t address) = 0;
    virtual void write(std::uint32_t address, std::uint8_t value) = 0;
    /// No cycle on the bus until `to`.
    virtual void idle(Ticks to) { circuit_->run(to); }

    Ticks period() const { return period_; }
    std::uint64_t accesses() const { return accesses_; }
    /// The last cycle selected the chip.
    bool selected() const { return selected_; }
    /// Reads that found no data on the bus when the processor took them; cycles that never became ready.
    std::uint64_t late_reads() const { return late_reads_; }
    std::uint64_t never_ready() const { return never_ready_; }

protected:
    Circuit& circuit() { return *circuit_; }
    Signal signal(std::string_view name) const { return {circuit_->wiring(), name}; }
    Signal signals(const std::string& name, unsigned first, unsigned last) const { return {circuit_->wiring(), name, first, last}; }
    /// The first edge of the processor's clock at or after `at`.
    Ticks edge(Ticks at) const { return Ticks{(at.n + period_.n - 1) / period_.n * period_.n}; }
    /// What the processor takes from the bus at `due`.
    std::uint8_t take(Ticks due, const Signal& data) {
        circuit_->run(due);
        if (circuit_->package().biu().busy() && circuit_->floats(data)) ++late_reads_;
        return static_cast<std::uint8_t>(circuit_->value(data));
    }
    /// Ends the cycle whose strobe ends at `end`.
    void finish(Ticks end) {
        circuit_->run(end - Ticks{1});
        selected_ = circuit_->package().biu().busy();
        circuit_->run(end);
        ++accesses_;
    }
    /// How many periods after `first` the ready line is seen low; kPatience when it never is.
    std::int64_t wait_for(const Signal& ready, Ticks first) {
        for (std::int64_t n = 0; n < kPatience; ++n) {
            circuit_->run(first + period_ * n);
            if (circuit_->value(ready) == 0) return n;
        }
        ++never_ready_;
        return kPatience;
    }

private:
    static constexpr std::int64_t kPatience = 64;

    Circuit* circuit_;
    Ticks period_;
    std::uint64_t accesses_ = 0, late_reads_ = 0, never_ready_ = 0;
    bool selected_ = false;
};

}  // namespace boards
