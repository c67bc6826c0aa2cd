// SPDX-License-Identifier: Apache-2.0
// A board: processor, wiring, chip and line, and the same firmware on each of them. run() powers it up, looks where the
// chip answers, brings it into DATA-EXCH with a DP master at 12 Mbit/s on a line of bits, and has one exchange echoed.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <dpchip/driver/config.hpp>

#include "circuit.hpp"
#include "processor.hpp"

namespace boards {

using pins::both_ways;
using pins::from;
using pins::from_inverted;
using pins::on_gnd;
using pins::on_vdd;
using pins::pull_down;
using pins::pull_up;
using pins::to;
using pins::to_inverted;

/// Addresses of the processor, both ends included.
struct Range {
    std::uint32_t first = 0, last = 0;
    bool operator==(const Range&) const = default;
};

/// Everything that makes a board.
struct Plan {
    std::string_view name, processor, figure;
    std::vector<pins::Connection> wiring;     ///< without what kEveryBoard has
    std::int64_t crystal_hz = 0;              ///< the processor's own; 0: its clock comes from CLKOUT2/4
    std::string_view clock_line = "XTAL1";    ///< where it takes that
    std::uint32_t base = 0;                   ///< where the firmware expects the chip
    std::uint32_t stride = 1;                 ///< between two addresses of the chip
    Range selected;                           ///< where the chip answers
    Range swept;                              ///< where that is looked for, every `step`
    std::uint32_t step = 0x100;
    std::optional<Range> memory{};            ///< of the board, which must not notice the chip
    std::string_view interrupt_line = "INT0";
    PinLevel interrupt_level = PinLevel::low; ///< that interrupts the processor
    std::function<std::unique_ptr<Processor>(Circuit&, Ticks period)> make;
    pins::Variant variant = pins::Variant::vpc3c;
    pins::Supply supply = pins::Supply::v5;
    driver::RamSize ram = driver::RamSize::bytes_2048;
    driver::BusMode bus_mode = driver::BusMode::intel;
    driver::IntPolarity int_polarity = driver::IntPolarity::low;
    bool test_ram = true;                     ///< the firmware writes and reads all of it first: four fifths of its accesses
};

struct Report {
    std::vector<std::string> wiring;      ///< faults in words
    std::vector<std::string> findings;    ///< what the package did not like, in words, each once
    std::vector<unsigned> violated;       ///< numbers of timing parameters, as the package counts them
    std::vector<unsigned> without_slack;  ///< the same, as the pins have shown it
    bool clocked = false;                 ///< the processor has a clock
    pins::ProcessorMode mode{};           ///< that the chip is in
    std::vector<Range> selected;          ///< where it answers
    driver::ConfigError config = driver::ConfigError::none;
    bool exchanging = false, echoed = false;
    bool memory_works = true;
    Ticks period{}, up_after{}, exchange_after{};
    std::uint64_t accesses = 0, late_reads = 0, never_ready = 0, spurious_interrupts = 0;
    Ticks shortest_cycle{};
    std::optional<Slack> tightest;

    /// Nothing is wrong and the chip answers where the plan says.
    bool good(const Plan& plan) const;
};

Report run(const Plan& plan);
void print(std::ostream& out, const Plan& plan, const Report& report);
/// All 44 pins and what is on them.
void print_wiring(std::ostream& out, const Plan& plan);

/// What does not depend on the processor: supply, clock, RS-485, test pins, the LED.
extern const std::vector<pins::Connection> kEveryBoard;
/// DB0..DB7 on NAMEs.
std::vector<pins::Connection> data_bus(const std::vector<std::string_view>& names);
/// Some of AB0..AB10 on lines, upwards from `first_pin`.
std::vector<pins::Connection> address_bus(unsigned first_pin, const std::vector<std::string_view>& names);
/// Tables one behind the other.
std::vector<pins::Connection> join(std::initializer_list<std::vector<pins::Connection>> tables);

// The boards; each has a file of its own.
Plan board_80c32_2k();
Plan board_80c32_4k();
Plan board_80c32_memory();
Plan board_80c165();
Plan board_80286();
Plan board_hc11();
Plan board_hc16();
std::vector<Plan> all_boards();

}  // namespace boards
