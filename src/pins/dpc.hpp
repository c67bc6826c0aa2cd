// SPDX-License-Identifier: Apache-2.0
// Dual-Port RAM controller: a single-port RAM that looks like two ports (8.2; hardware reference 2, rule 3).
//
// Published: both sides may come at once, and then the bus interface has priority. So an access of the processor never
// waits, and each one that meets the Micro Sequencer makes that one wait for the RAM cycle it takes.
// Decided here: a RAM cycle is one CLK for one octet, and the Micro Sequencer moves the octets of a buffer back to back. What
// the wait does to the chip is counted and traced but moves nothing: a character on the line lasts 44 CLK or more, a bus
// cycle steals one CLK in six at most, so the Micro Sequencer is never behind by as much as a character.
// Not known: the width of the RAM, how many cycles the Micro Sequencer spends per octet, what it does meanwhile.
#pragma once

#include <algorithm>
#include <cstdint>

#include <dpchip/pins/clk.hpp>

namespace dpchip::pins {

struct DpcCounters {
    std::uint64_t bus_accesses{};        ///< RAM cycles of the processor; none ever waited
    std::uint64_t sequencer_accesses{};  ///< RAM cycles of the Micro Sequencer
    std::uint64_t collisions{};          ///< CLK periods the Micro Sequencer has waited
    std::uint32_t longest_wait{};        ///< of them within one run of back-to-back cycles
};

class DualPortController {
public:
    /// The Micro Sequencer wants `octets` from `at` on.
    void sequencer(Ticks at, std::uint32_t octets, const Clk& clk) {
        const Ticks edge = clk.edge_from(at);
        if (edge >= busy_until_) wait_ = 0;
        busy_until_ = std::max(edge, busy_until_) + core::kClk * octets;
        counters_.sequencer_accesses += octets;
    }
    /// The processor's cycle at `at`, an edge of CLK. True when the Micro Sequencer had to wait for it.
    bool bus(Ticks at) {
        ++counters_.bus_accesses;
        if (at >= busy_until_) return false;
        busy_until_ += core::kClk;
        ++counters_.collisions;
        counters_.longest_wait = std::max(counters_.longest_wait, ++wait_);
        return true;
    }
    /// Until when the Micro Sequencer is busy with what it wanted so far.
    Ticks busy_until() const { return busy_until_; }
    const DpcCounters& counters() const { return counters_; }

private:
    Ticks busy_until_{};
    std::uint32_t wait_ = 0;
    DpcCounters counters_;
};

}  // namespace dpchip::pins
