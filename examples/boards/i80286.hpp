// SPDX-License-Identifier: Apache-2.0
// 80286 with 82288 bus controller and 82284 clock generator: a bus cycle is T_S and as many T_C as the ready logic wants. A
// latch holds the address, a PAL makes XCS of it, a transceiver carries the low octet of the data bus.
//
// The processor is told to move words; A0 goes nowhere and the high octet is dropped, so that the chip's addresses lie two
// apart (8.1.2).
#pragma once

#include "processor.hpp"

namespace boards {

/// At 8 MHz. Delays of the 82288's ALE and commands, of a 74ALS573 latch and of a 74ALS245 transceiver.
struct I80286Figures {
    Ticks ale_delay = 20_ns, latch_delay = 18_ns, command_active = 20_ns, command_inactive = 5_ns;
    Ticks write_data_delay = 50_ns, transceiver = 12_ns, read_setup = 10_ns, ready_gate = 10_ns;
};

class I80286 final : public Processor {
public:
    I80286(Circuit& circuit, Ticks period, const Decoder& decoder)
        : Processor{circuit, period}, decoder_{decoder}, d_{signals("D", 0, 7)}, a_{signals("A", 1, 12)}, rd_{signal("XMRDC")}, wr_{signal("XMWTC")},
          cs_{signal("XCS")}, ready_{signal("XREADY")} {}

    void power_up() override {
        for (const Signal* s : {&rd_, &wr_, &cs_}) circuit().plan(circuit().now(), *s);
        circuit().plan(circuit().now(), a_, 0);
    }
    /// The low octet of the word.
    std::uint8_t read(std::uint32_t address) override {
        const Ticks began = begin(address, rd_), ends = wait(address, began);
        const std::uint8_t value = take(ends - f_.read_setup - f_.transceiver, d_);
        end(ends, rd_);
        return value;
    }
    void write(std::uint32_t address, std::uint8_t value) override {
        const Ticks began = begin(address, wr_);
        circuit().plan(began + half() + f_.write_data_delay + f_.transceiver, d_, value);
        const Ticks ends = wait(address, began);
        circuit().plan_release(ends + half(), d_);
        end(ends, wr_);
    }

private:
    Ticks half() const { return Ticks{period().n / 2}; }
    /// Returns when T_S begins.
    Ticks begin(std::uint32_t address, const Signal& command) {
        const Ticks began = edge(std::max(circuit().now(), free_)), valid = began + half() + f_.ale_delay + f_.latch_delay;
        circuit().plan(valid, a_, address >> 1);
        circuit().plan(valid + decoder_.delay, cs_, decoder_.selects(address) ? 0 : 1);
        circuit().plan(began + period() + f_.command_active, command, 0);
        return began;
    }
    /// When the last T_C ends. The 82284 looks at its ARDY in the middle of each; other addresses need no wait.
    Ticks wait(std::uint32_t address, Ticks began) {
        const Ticks first = began + period() * 2;
        if (!decoder_.selects(address)) return first;
        return first + period() * wait_for(ready_, began + period() + half() - f_.ready_gate);
    }
    void end(Ticks ends, const Signal& command) {
        circuit().plan(ends + f_.command_inactive, command);
        finish(ends + f_.command_inactive);
        free_ = ends;
    }

    I80286Figures f_{};
    Decoder decoder_;
    Signal d_, a_, rd_, wr_, cs_, ready_;
    Ticks free_{};
};

}  // namespace boards
