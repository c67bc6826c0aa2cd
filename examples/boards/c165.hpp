// SPDX-License-Identifier: Apache-2.0
// 80C165 (C166 family): 8-bit demultiplexed bus with read/write delay, a chip select of its own, and READY.
//
// The bus controller counts in TCL, half a period of the CPU clock. Asynchronous READY is looked at once each CPU clock after
// the programmed wait states; the cycle ends with the clock after the one that saw it. Addresses outside the chip select are
// another bus window without READY.
#pragma once

#include "processor.hpp"

namespace boards {

/// In TCL, as the data sheet prints them without wait states: t80 (address and unlatched CS to command), t12, t14, t22, t24,
/// t28.
struct C165Figures {
    Figure address_to_strobe{2 * kT - 10_ns}, strobe_width{2 * kT - 10_ns}, data_due{2 * kT - 20_ns}, data_to_write_end{2 * kT - 20_ns};
    Figure data_hold{1 * kT - 10_ns}, address_hold{0 * kT};
};

class C165 final : public Processor {
public:
    /// `wait_states`: programmed in BUSCON, before READY counts. A tristate wait state follows each cycle.
    C165(Circuit& circuit, Ticks period, const Decoder& chip_select, unsigned wait_states)
        : Processor{circuit, period}, tcl_{Ticks{period.n / 2}}, select_{chip_select}, waits_{period * wait_states}, d_{signals("D", 0, 7)},
          a_{signals("A", 0, 11)}, rd_{signal("XRD")}, wr_{signal("XWRL")}, cs_{signal("XCS1")}, ready_{signal("XREADY")} {}

    void power_up() override {
        for (const Signal* s : {&rd_, &wr_, &cs_}) circuit().plan(circuit().now(), *s);
        circuit().plan(circuit().now(), a_, 0);
    }
    std::uint8_t read(std::uint32_t address) override {
        const Ticks falls = begin(address, rd_), waits = wait(address, falls), rises = falls + f_.strobe_width.at(tcl_) + waits;
        const std::uint8_t value = take(falls + f_.data_due.at(tcl_) + waits, d_);
        end(rises, rd_);
        return value;
    }
    void write(std::uint32_t address, std::uint8_t value) override {
        const Ticks falls = begin(address, wr_);
        circuit().plan(falls + f_.strobe_width.at(tcl_) - f_.data_to_write_end.at(tcl_), d_, value);
        const Ticks rises = falls + f_.strobe_width.at(tcl_) + wait(address, falls);
        circuit().plan_release(rises + f_.data_hold.at(tcl_) + period(), d_);
        end(rises, wr_);
    }

private:
    Ticks begin(std::uint32_t address, const Signal& strobe) {
        const Ticks falls = edge(std::max(circuit().now(), free_)) + period(), valid = falls - f_.address_to_strobe.at(tcl_);
        circuit().plan(valid, a_, address);
        circuit().plan(valid + select_.delay, cs_, select_.selects(address) ? 0 : 1);
        circuit().plan(falls, strobe, 0);
        return falls;
    }
    Ticks wait(std::uint32_t address, Ticks falls) {
        if (!select_.selects(address)) return waits_;
        return waits_ + period() * (wait_for(ready_, falls + waits_) + 1);
    }
    void end(Ticks rises, const Signal& strobe) {
        circuit().plan(rises, strobe);
        circuit().plan(rises + f_.address_hold.at(tcl_) + select_.delay, cs_);
        finish(rises);
        free_ = rises + period();
    }

    C165Figures f_{};
    Ticks tcl_;
    Decoder select_;
    Ticks waits_;
    Signal d_, a_, rd_, wr_, cs_, ready_;
    Ticks free_{};
};

}  // namespace boards
