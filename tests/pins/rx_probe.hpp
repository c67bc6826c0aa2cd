// SPDX-License-Identifier: Apache-2.0
// A UART host that only writes down what it is told, and a hand on RXD.
#pragma once

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/pins/uart.hpp>

namespace dpchip::pins {

using namespace core::literals;

/// Takes the place of the chip.
struct Probe {
    chip::State s{};
    std::vector<fdl::Character> characters;
    std::vector<Ticks> handed_over, carriers, lows, ends;
    int holds = 0;

    Ticks now() const { return s.now; }
    Ticks next() const { return core::kNever; }
    const chip::State& state() const { return s; }
    void advance(Ticks to) { s.now = to; }
    void hear_character(const fdl::Character& c) {
        characters.push_back(c);
        handed_over.push_back(s.now);
    }
    void carrier(Ticks at) { carriers.push_back(at); }
    bool take(fdl::Transmission& t) {
        s.answer_ready = 0;
        t.assign(s.now, s.answer_bit, {s.tx.data(), s.tx_count});
        return true;
    }
    void sent(Ticks at) { ends.push_back(at); }
    void hold() { ++holds; }
    void line_low(Ticks until) { lows.push_back(until); }
    void set_xcts(chip::Level level) { s.xcts_high = level == chip::Level::high ? 1 : 0; }
};
static_assert(UartHost<Probe>);

/// A receiver at one rate that the test drives level by level.
struct Rig {
    Probe host;
    BasicUart<Probe> uart;
    Ticks bit;

    explicit Rig(fdl::BaudCode rate, Ticks clk_phase = {}) : uart{clk_phase}, bit{fdl::baud(rate).bit} {
        for (auto& t : host.s.timers) t = core::kNever;
        host.s.probe = rate;
        uart.reset(host);
    }
    Ticks quarter() const { return {bit.n / 4}; }
    void level(Ticks at, bool high) { uart.set_rxd(host, at, to_level(high)); }
    /// The eleven bits of a character, whatever they are; slot 0 is the lowest bit.
    void frame(Ticks start, unsigned bits, Ticks bit_time) {
        for (unsigned n = 0; n < 11; ++n) level(start + bit_time * n, ((bits >> n) & 1u) != 0);
        level(start + bit_time * 11, true);
    }
    void character(Ticks start, std::uint8_t octet) { frame(start, transmitter::frame(octet), bit); }
    void finish(Ticks at) { uart.advance(host, at); }
};

}  // namespace dpchip::pins
