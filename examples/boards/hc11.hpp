// SPDX-License-Identifier: Apache-2.0
// 68HC11 with its multiplexed bus (E series): E is a quarter of its clock and never stops, each of its periods is a bus cycle.
// An external latch, open while AS is high, makes A7..A0; a decoder makes XCS of A15..A11.
#pragma once

#include "processor.hpp"

namespace boards {

/// In eighths of the E cycle, as the data sheet prints the formulas: PW_EH, t_AV, t_AVM, t_AH, t_DDW, t_DHW, t_DSR, t_ASD.
struct Hc11Figures {
    Figure e_high{4 * kT - 28_ns}, address_to_e{3 * kT - 93.5_ns}, muxed_address_to_e{3 * kT - 103.5_ns}, address_hold{1 * kT - 29.5_ns};
    Figure write_data_delay{1 * kT + 65.5_ns}, write_data_hold{1 * kT - 29.5_ns}, e_to_as{1 * kT - 9.5_ns};
    Ticks read_setup = 30_ns, latch_delay = 10_ns;  ///< latch: 74AC373
};

class Hc11 final : public Processor {
public:
    Hc11(Circuit& circuit, Ticks period, const Decoder& decoder)
        : Processor{circuit, period}, eighth_{Ticks{period.n / 2}}, decoder_{decoder}, d_{signals("AD", 0, 7)}, low_{signals("A", 0, 7)},
          high_{signals("A", 8, 15)}, e_{signal("E")}, r_w_{signal("R/W")}, cs_{signal("XCS")} {}

    void power_up() override {
        for (const Signal* s : {&r_w_, &cs_}) circuit().plan(circuit().now(), *s);
        for (const Signal* s : {&e_, &low_, &high_}) circuit().plan(circuit().now(), *s, 0);
    }
    std::uint8_t read(std::uint32_t address) override {
        const Ticks rises = begin(address, true), falls = rises + f_.e_high.at(eighth_);
        const std::uint8_t value = take(falls - f_.read_setup, d_);
        finish(falls);
        return value;
    }
    void write(std::uint32_t address, std::uint8_t value) override {
        const Ticks rises = begin(address, false), falls = rises + f_.e_high.at(eighth_);
        circuit().plan(rises + f_.write_data_delay.at(eighth_), d_, value);
        circuit().plan_release(falls + f_.write_data_hold.at(eighth_), d_);
        finish(falls);
    }
    /// Nothing but E.
    void idle(Ticks to) override {
        while (circuit().now() < to) circuit().run(begin(0xFFFF, true) + f_.e_high.at(eighth_));
    }

private:
    /// A cycle of E; returns when it rises.
    Ticks begin(std::uint32_t address, bool read) {
        const Ticks cycle = eighth_ * 8;
        rises_ = std::max(rises_ + cycle, Ticks{(circuit().now().n / cycle.n + 1) * cycle.n});
        const Ticks falls = rises_ + f_.e_high.at(eighth_), last = rises_ - cycle + f_.e_high.at(eighth_);
        const Ticks valid = std::max(rises_ - f_.address_to_e.at(eighth_), last + f_.address_hold.at(eighth_));
        const Ticks latched = std::max(rises_ - f_.muxed_address_to_e.at(eighth_), last + f_.e_to_as.at(eighth_)) + f_.latch_delay;
        circuit().plan(valid, high_, address >> 8);
        circuit().plan(valid, r_w_, read ? 1 : 0);
        circuit().plan(valid + decoder_.delay, cs_, decoder_.selects(address) ? 0 : 1);
        circuit().plan(latched, low_, address);
        circuit().plan(rises_, e_);
        circuit().plan(falls, e_, 0);
        circuit().plan(falls + f_.address_hold.at(eighth_) + Ticks{decoder_.delay.n / 4}, cs_);
        return rises_;
    }

    Hc11Figures f_{};
    Ticks eighth_;
    Decoder decoder_;
    Signal d_, low_, high_, e_, r_w_, cs_;
    Ticks rises_{};
};

}  // namespace boards
