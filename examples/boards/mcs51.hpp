// SPDX-License-Identifier: Apache-2.0
// The 80C51 family (80C31, 80C32, C501) with twelve clocks a machine cycle: MOVX, two machine cycles, 24 periods of the
// oscillator. ALE falls at 2, 8 and 14 of them; the third latches the data address, the first two go with instruction fetches.
//
// Not simulated: instructions; external memory answers within its time.
#pragma once

#include <optional>

#include "processor.hpp"

namespace boards {

/// Data memory cycles as the data sheets print them, in periods of the oscillator. The names there: T_LHLL, T_AVLL, T_LLAX,
/// T_LLWL, T_RLRH, T_RLDV, T_QVWH, T_WHQX, T_WHLH.
struct Mcs51Figures {
    Figure ale_width, address_to_ale, address_hold, ale_to_strobe, strobe_width, data_due, data_to_write_end, data_hold, strobe_to_ale;
};
// clang-format off
/// Types for 12 and 16 MHz.
inline constexpr Mcs51Figures kMcs51Standard{2 * kT - 40_ns, 1 * kT - 40_ns, 1 * kT - 35_ns, 3 * kT - 50_ns, 6 * kT - 100_ns, 5 * kT - 165_ns, 7 * kT - 150_ns, 1 * kT - 50_ns, 1 * kT - 40_ns};
/// Types for 20 and 24 MHz.
inline constexpr Mcs51Figures kMcs51Fast    {2 * kT - 40_ns, 1 * kT - 13_ns, 1 * kT - 20_ns, 3 * kT - 50_ns, 6 * kT - 100_ns, 5 * kT - 90_ns, 7 * kT - 120_ns, 1 * kT - 20_ns, 1 * kT - 20_ns};
// clang-format on

/// EPROM behind PSEN and RAM behind an address decoder, both on the multiplexed bus by a latch (figure 8-4).
struct ExternalMemory {
    Decoder ram;  ///< of data addresses; the EPROM is program memory everywhere
};

class Mcs51 final : public Processor {
public:
    Mcs51(Circuit& circuit, Ticks period, const Mcs51Figures& figures, const std::optional<ExternalMemory>& memory = {})
        : Processor{circuit, period}, f_{figures}, memory_{memory}, ad_{signals("AD", 0, 7)}, a_{signals("A", 8, 15)},
          ale_{signal("ALE")}, rd_{signal("XRD")}, wr_{signal("XWR")} {
        if (memory_) ram_.resize(0x10000);
    }

    void power_up() override {
        for (const Signal* s : {&rd_, &wr_}) circuit().plan(circuit().now(), *s);
        circuit().plan(circuit().now(), ale_, 0);
        circuit().plan(circuit().now(), a_, 0xFF);
    }
    std::uint8_t read(std::uint32_t address) override {
        const Ticks t = period(), falls = begin(address), rises = falls + f_.strobe_width.at(t);
        circuit().plan(falls, rd_, 0);
        circuit().plan(rises, rd_);
        const bool from_ram = memory_ && memory_->ram.selects(address);
        if (from_ram) {
            circuit().plan(falls + 60_ns, ad_, ram_[address]);
            circuit().plan_release(rises + 10_ns, ad_);
        }
        const std::uint8_t value = take(falls + f_.data_due.at(t), ad_);
        end(rises);
        return value;
    }
    void write(std::uint32_t address, std::uint8_t value) override {
        const Ticks t = period(), falls = begin(address), rises = falls + f_.strobe_width.at(t);
        circuit().plan(falls, wr_, 0);
        circuit().plan(rises, wr_);
        circuit().plan(rises - f_.data_to_write_end.at(t), ad_, value);
        circuit().plan_release(rises + f_.data_hold.at(t), ad_);
        if (memory_ && memory_->ram.selects(address)) ram_[address] = value;
        end(rises);
    }

private:
    /// A fetch and the address phase; returns when the strobe falls.
    Ticks begin(std::uint32_t address) {
        const Ticks t = period();
        began_ = edge(std::max(circuit().now(), free_));
        fetch(began_ + t * 8 - f_.ale_width.at(t), began_ + t * 8);
        latch(began_ + t * 14 - f_.ale_width.at(t), began_ + t * 14, address);
        return began_ + t * 14 + f_.ale_to_strobe.at(t);
    }
    /// The next ALE, which belongs to a fetch again, comes as early as it may.
    void end(Ticks rises) {
        const Ticks t = period();
        free_ = began_ + t * 24;
        fetch(rises + f_.strobe_to_ale.at(t), free_ + t * 2);
        finish(rises);
    }
    void latch(Ticks rises, Ticks falls, std::uint32_t address) {
        const Ticks t = period(), valid = falls - f_.address_to_ale.at(t);
        circuit().plan(rises, ale_);
        circuit().plan(valid, a_, address >> 8);
        circuit().plan(valid, ad_, address);
        circuit().plan(falls, ale_, 0);
        circuit().plan_release(falls + f_.address_hold.at(t), ad_);
    }
    /// Program memory is inside, or it is the EPROM, which answers while PSEN is low (T_LLPL, T_PLPH).
    void fetch(Ticks rises, Ticks falls) {
        if (!memory_) {
            circuit().plan(rises, ale_);
            circuit().plan(falls, ale_, 0);
            return;
        }
        const Ticks t = period(), psen_falls = falls + t - 25_ns, psen_rises = psen_falls + t * 3 - 45_ns;
        latch(rises, falls, program_counter_++);
        circuit().plan(psen_falls + 50_ns, ad_, 0xE0);  // MOVX A,@DPTR
        circuit().plan_release(psen_rises + 10_ns, ad_);
    }

    Mcs51Figures f_;
    std::optional<ExternalMemory> memory_;
    Signal ad_, a_, ale_, rd_, wr_;
    std::vector<std::uint8_t> ram_;
    std::uint16_t program_counter_ = 0x0F00;
    Ticks began_{}, free_{};
};

}  // namespace boards
