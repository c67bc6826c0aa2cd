// SPDX-License-Identifier: Apache-2.0
// SystemC allows one simulation a process: each test runs its own in a child process, which reports with its exit code.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <systemc>
#include <tlm>
#include <tlm_utils/simple_initiator_socket.h>
#include <tlm_utils/tlm_quantumkeeper.h>

#include <dpchip/tlm/chip.hpp>
#include <dpchip/tlm/line.hpp>
#include <dpchip/tlm/report.hpp>

namespace dpchip::tlm::test {

using sc_core::sc_time;

/// Runs `body` in a child process as sc_main(): it elaborates, simulates and checks. The test fails when a check in it did.
void simulate(const std::function<void()>& body);

/// A chip with its processor, on a line or not; `program` is the processor's.
struct Board : sc_core::sc_module {
    Board(const sc_core::sc_module_name& name, const ChipSettings& settings, LineChipIf* line = nullptr);
    ~Board() override;

    /// One transaction, with what this initiator has annotated so far.
    ::tlm::tlm_response_status transport(::tlm::tlm_command command, std::uint64_t address, std::uint8_t* data, unsigned length);
    std::uint8_t read(std::uint64_t address);
    void write(std::uint64_t address, std::uint8_t value);
    /// Station 8, ident 4711H, 2 octets each way, watchdog off; X/INT as `masks` (IntMask 04H, 05H) let it. Started.
    void set_up(std::uint8_t mask_low = 0xFF, std::uint8_t mask_high = 0xFF, std::uint8_t station = 8);
    std::vector<std::uint8_t> memory() const;

    tlm_utils::simple_initiator_socket<Board> cpu{"cpu"};
    sc_core::sc_signal<bool> x_int{"x_int", true}, xdataexch{"xdataexch", true}, reset{"reset"}, xcts{"xcts"};
    Chip chip;
    sc_time delay;  ///< annotated, not yet waited for
    std::function<void()> program;

private:
    void run();
};

/// A thread of its own for a master or a stimulus.
struct Actor : sc_core::sc_module {
    Actor(const sc_core::sc_module_name& name, std::function<void()> role);

private:
    void run() { role_(); }
    std::function<void()> role_;
};

/// Keeps every telegram of a line.
struct Monitor : sc_core::sc_module, ::tlm::tlm_analysis_if<Telegram> {
    Monitor(const sc_core::sc_module_name& name, Line& line);
    void write(const Telegram& t) override;

    std::vector<Telegram> seen;
};

/// From its construction on, keeps the reports of one message type instead of printing them.
class Reports {
public:
    explicit Reports(const char* type);
    /// Their texts, a line each.
    static const std::string& text();
};

/// Waits until `time` of the simulation.
void until(const sc_time& time);
inline sc_time ns(std::uint64_t n) { return sc_time::from_value(n * 1000); }
inline sc_time us(std::uint64_t n) { return ns(n * 1000); }
inline sc_time ms(std::uint64_t n) { return us(n * 1000); }

}  // namespace dpchip::tlm::test
