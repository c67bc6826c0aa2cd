// SPDX-License-Identifier: Apache-2.0
// 68HC16Z1: asynchronous bus cycles of at least three clocks, S0 to S5; DSACK is looked at at the end of S2 and each clock from
// there on, the data are taken one clock after it was seen. An 8-bit port lies on D15..D8 and answers with DSACK0.
//
// Its own chip selects fall together with AS, and the chip wants XCS 5 ns before AS (parameter 47): so a fast decoder makes XCS
// of the address, which comes 15 ns before AS.
#pragma once

#include "processor.hpp"

namespace boards {

/// Nanoseconds at 16.78 MHz, with the data sheet's numbers of them.
struct Hc16Figures {
    Ticks address_to_as = 15_ns;      ///< 11
    Ticks clock_to_as = 25_ns;        ///< 9, its maximum
    Ticks as_width = 100_ns;          ///< 14, without wait states
    Ticks r_w_high_to_as = 15_ns;     ///< 21
    Ticks r_w_low_to_as = 10.4_ns;    ///< 22 less a clock of 59.6 ns: 70 ns before DS, which falls a clock after AS in a write
    Ticks address_hold = 15_ns;       ///< 13
    Ticks r_w_hold = 15_ns;           ///< 17
    Ticks data_delay = 29_ns;         ///< 23, from S2
    Ticks data_hold = 15_ns;          ///< 25
    Ticks read_setup = 5_ns;          ///< 27
    Ticks asynchronous_setup = 5_ns;  ///< 47A
};

/// Where XCS comes from.
enum class SelectFrom : std::uint8_t { decoder, chip_select_pin };

class Hc16 final : public Processor {
public:
    Hc16(Circuit& circuit, Ticks period, const Decoder& decoder, SelectFrom select = SelectFrom::decoder)
        : Processor{circuit, period}, decoder_{decoder}, select_{select}, d_{signals("D", 8, 15)}, a_{signals("A", 0, 11)}, as_{signal("XAS")},
          r_w_{signal("R/W")}, cs_{signal("XCS")}, dsack_{signal("XDSACK0")} {}

    void power_up() override {
        for (const Signal* s : {&as_, &r_w_, &cs_}) circuit().plan(circuit().now(), *s);
        circuit().plan(circuit().now(), a_, 0);
    }
    std::uint8_t read(std::uint32_t address) override {
        const Ticks falls = begin(address, true), waits = wait(address);
        const std::uint8_t value = take(s0_ + period() * 2 + half() + waits - f_.read_setup, d_);
        end(falls + f_.as_width + waits);
        return value;
    }
    void write(std::uint32_t address, std::uint8_t value) override {
        const Ticks falls = begin(address, false);
        circuit().plan(s0_ + period() + f_.data_delay, d_, value);
        const Ticks rises = falls + f_.as_width + wait(address);
        circuit().plan_release(rises + f_.data_hold, d_);
        end(rises);
    }

private:
    Ticks half() const { return Ticks{period().n / 2}; }
    Ticks begin(std::uint32_t address, bool read) {
        s0_ = edge(std::max(circuit().now(), free_));
        const Ticks falls = s0_ + half() + f_.clock_to_as, valid = falls - f_.address_to_as;
        circuit().plan(valid, a_, address);
        circuit().plan(read ? falls - f_.r_w_high_to_as : falls - f_.r_w_low_to_as, r_w_, read ? 1 : 0);
        circuit().plan(select_ == SelectFrom::decoder ? valid + decoder_.delay : falls, cs_, decoder_.selects(address) ? 0 : 1);
        circuit().plan(falls, as_, 0);
        return falls;
    }
    /// Other addresses answer at once.
    Ticks wait(std::uint32_t address) {
        return decoder_.selects(address) ? period() * wait_for(dsack_, s0_ + period() + half() - f_.asynchronous_setup) : Ticks{};
    }
    void end(Ticks rises) {
        circuit().plan(rises, as_);
        circuit().plan(rises + f_.r_w_hold, r_w_);
        circuit().plan(rises + f_.address_hold, cs_);
        finish(rises);
        free_ = rises + f_.address_hold;
    }

    Hc16Figures f_{};
    Decoder decoder_;
    SelectFrom select_;
    Signal d_, a_, as_, r_w_, cs_, dsack_;
    Ticks s0_{}, free_{};
};

}  // namespace boards
