// SPDX-License-Identifier: Apache-2.0
// A board around the package for tests: its wires, a processor with one of three buses, and a UART that plays the master
// bit by bit.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <dpchip/tlm/package.hpp>

#include "tlm/simulation.hpp"

namespace dpchip::tlm::test {

using sc_dt::sc_logic;

enum class Bus { async_intel, async_motorola, sync_motorola };

struct PinBoard : sc_core::sc_module {
    using Wire = sc_core::sc_signal<sc_logic>;

    explicit PinBoard(const sc_core::sc_module_name& name, const PackageSettings& settings = {}, Bus bus = Bus::async_intel);
    ~PinBoard() override;

    /// RESET for 200 ns.
    void power_up();
    /// One cycle each; the strobe lasts 140 ns, until XREADY is there. Where a set-up or hold time may be 0, both signals
    /// change in one delta cycle.
    std::uint8_t read(std::uint16_t address);
    void write(std::uint16_t address, std::uint8_t value);
    /// What is on DB; X where drivers disagree, Z where nobody drives.
    std::string data() const;
    void drive_data(const sc_logic& level, std::uint8_t value = 0xFF);

    sc_core::sc_vector<Wire> ab{"ab", 11};
    sc_core::sc_vector<sc_core::sc_signal_resolved> db{"db", 8};
    Wire xcs{"xcs", sc_dt::SC_LOGIC_1}, xrd{"xrd", sc_dt::SC_LOGIC_1}, xwr, as, reset{"reset", sc_dt::SC_LOGIC_0};
    Wire xint_mot, mode;
    Wire xready{"xready"}, x_int{"x_int", sc_dt::SC_LOGIC_1}, xdataexch{"xdataexch", sc_dt::SC_LOGIC_1};
    Wire rxd{"rxd", sc_dt::SC_LOGIC_1}, txd{"txd", sc_dt::SC_LOGIC_1}, rts{"rts", sc_dt::SC_LOGIC_0};
    Wire xcts{"xcts", sc_dt::SC_LOGIC_0};
    Package package;
    std::function<void()> program;

private:
    void run();
    void begin(std::uint16_t address, bool write, std::uint8_t value = 0);
    void end();

    Bus bus_;
};

/// Edges of a wire, for UARTs and for times.
struct Scope : sc_core::sc_module {
    struct Edge {
        Ticks at;
        bool high;
    };
    Scope(const sc_core::sc_module_name& name, const sc_core::sc_signal<sc_logic>& wire);
    /// The level just after `at`; high before the first edge.
    bool level(Ticks at) const;

    std::vector<Edge> edges;

private:
    void note();
    const sc_core::sc_signal<sc_logic>* wire_;
};

/// Puts octets on a wire as UART characters with even parity from `at` on; for an SC_THREAD.
void send_bits(PinBoard::Wire& wire, Ticks at, Ticks bit, const Octets& octets);

/// The octets of characters that begin at most a character apart, with the tick of the first start bit.
struct Burst {
    Ticks start;
    Octets octets;
};
/// Reads a scope as a UART does; parity and stop bits are checked with EXPECT.
std::vector<Burst> bursts(const Scope& scope, Ticks bit);

}  // namespace dpchip::tlm::test
