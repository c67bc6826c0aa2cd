// SPDX-License-Identifier: Apache-2.0
// Between the serial pins of a package and a telegram-level line: TXD while RTS is high becomes telegrams, telegrams of the
// others become levels on RXD, both with their own times (VPC3+C 8.3, 9.1: UART character, RTS, the RS-485 driver).
//
// RXD shows a foreign telegram from the tick it begins, at its sender's bit time: start bit, 8 data bits from the lowest on,
// even parity, stop bit. Other transceivers on the line are seen level by level. What overlaps is ANDed: 0 wins. While RTS
// is high the receiver is off and RXD is 1.
//
// On TXD the transceiver samples each bit in its middle. The line is told when the first start bit falls, so that planned
// answers are given up and collisions are found; it has the telegram when its last stop bit has passed, with its true start.
// Each telegram says how long it is, so nobody waits for that. Octets that are no telegram end when no start bit follows
// within half a bit. Wrong parity, stop or start bits damage the telegram and are a warning of type report::kTransceiver.
//
// Not modelled: delays of driver and cable, bias, what RS-485 levels really become when two drivers disagree.
#pragma once

#include <cstdint>
#include <vector>

#include <systemc>

#include <dpchip/tlm/line_if.hpp>
#include <dpchip/tlm/time.hpp>

namespace dpchip::tlm {

class Transceiver : public sc_core::sc_module, private LineWire {
public:
    /// To the package's pins of the same names. Z and X on TXD are idle, Z and X on RTS do not send.
    sc_core::sc_in<sc_dt::sc_logic> txd{"TXD"}, rts{"RTS"};
    sc_core::sc_out<sc_dt::sc_logic> rxd{"RXD"};
    sc_core::sc_port<LineWireIf> line{"line"};

    /// baud: one of the ten PROFIBUS rates in bit/s, at which TXD is read; what comes in has the rate of who sends it.
    explicit Transceiver(const sc_core::sc_module_name& name, std::uint32_t baud = 1'500'000);
    ~Transceiver() override;

private:
    /// A telegram on its way to RXD.
    struct Incoming {
        Octets octets;
        Ticks start, bit;

        Ticks end() const;
        bool level(Ticks at) const;
        Ticks next_edge(Ticks after) const;
    };

    void end_of_elaboration() override;
    void telegram_begins(const Octets& octets, Ticks start, Ticks bit) override;
    void others_drive(bool level) override;

    void step();
    void read_txd(Ticks now);
    void sample();
    void start_bit(Ticks now);
    void hand_over();
    Ticks next_sample() const;
    Ticks telegram_over() const;
    void show(Ticks now);
    void plan(Ticks now);

    std::uint32_t baud_;
    Ticks bit_;
    int station_ = -1;

    // out
    bool sends_ = false;           ///< RTS is high
    bool level_ = true;            ///< what the driver puts on the line
    int samples_ = -1;             ///< of the present character; -1: there is none
    unsigned frame_ = 0;           ///< them, first lowest
    Ticks character_ = 0;          ///< start of the present character, or the last one
    Ticks start_ = 0;              ///< of the first one
    Octets octets_, faults_;       ///< characters that have come

    // in
    std::vector<Incoming> incoming_;
    bool others_ = true;

    sc_core::sc_event wake_{"wake"};
};

}  // namespace dpchip::tlm
