// SPDX-License-Identifier: Apache-2.0
// The package: 44 pins around a chip (VPC3+C manual 3, 8, 10; APC3 manual 2, 6; hardware reference 1 to 8).
//
// A board moves inputs with set_pin() at now() and time with advance(); outputs leave their edges in a queue. The package
// calls nobody and allocates nothing; a copy is a snapshot.
//
// Order within one tick: the chip's timers, the processor interface, CLKOUT, samples of RXD; then what the board does at
// that tick, in the order of its calls. (A line that couples stations without delay brings its edges before the samples.)
//
// Not modelled: volts, currents and slopes, undefined levels, the test modes of XTEST1, a stopped clock.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <dpchip/chip/chip.hpp>
#include <dpchip/core/fixed_queue.hpp>
#include <dpchip/pins/biu.hpp>
#include <dpchip/pins/clk.hpp>
#include <dpchip/pins/dpc.hpp>
#include <dpchip/pins/pin.hpp>
#include <dpchip/pins/timing_check.hpp>
#include <dpchip/pins/uart.hpp>
#include <dpchip/regmap/pin_rules.hpp>

namespace dpchip::pins {

using regmap::Variant;

/// Where the line is: at RXD, TXD and XCTS, bit by bit; or in hear() and take(), a telegram at a time, and TXD stays Z.
enum class LineSide : std::uint8_t { pins, telegrams };

struct PackageOptions {
    bool txd_pull_up = true;   ///< the board has it: TXD reads 1 where the chip leaves it Z
    bool check_timing = true;  ///< findings about section 10.7
    bool fatal = false;        ///< a timing violation makes the package fail
    LineSide line = LineSide::pins;
};

/// APC3 works at 3.3 V, VPC3+ (step A) at 5 V, the others at both (10.2; APC3 2.1).
constexpr bool works_at(Variant v, Supply s) {
    if (v == Variant::apc3) return s == Supply::v3_3;
    if (v == Variant::vpc3a) return s == Supply::v5;
    return true;
}

template <class Trace = core::RingTrace>
class Package {
public:
    using Chip = chip::Chip<Trace>;

    /// Powered up at time 0, before any RESET, with the inputs of an idle board: RESET 0, XCS, XRD, XWR, XTEST0, XTEST1 and
    /// RXD 1, all others 0, DB let go. works_at(variant, supply) must hold.
    explicit Package(Variant variant = Variant::vpc3c, Supply supply = Supply::v3_3, const regmap::Options& chip_options = {},
                     const PackageOptions& options = {});

    // ---- time -------------------------------------------------------------------------------------------------
    Ticks now() const { return now_; }
    /// When something happens at the pins or inside; kNever when only an input can cause it.
    Ticks next() const;
    /// Runs everything up to and including `to`, which is not before now().
    void advance(Ticks to);

    // ---- pins -------------------------------------------------------------------------------------------------
    /// The board drives an input or a DB pin at now(), or lets go of it.
    void set_pin(PinId pin, PinLevel level);
    /// What a probe shows at now().
    PinLevel pin(PinId pin) const;
    /// Edges of the outputs that are watched, oldest first: all but CLKOUT2/4 at first. Whoever advances by next() and
    /// drains it every time loses none.
    core::FixedQueue<PinEdge, 256>& edges() { return edges_; }
    void watch(PinId pin, bool on);
    /// Rising edges of CLK lie at `phase` (0 .. kClk - 1) and every kClk from there on. Before the first RESET: the UART
    /// begins anew.
    void set_clock_phase(Ticks phase);
    /// The board drives CLK at now(); the edge lasts `slope`. A rising edge sets the phase of bus and CLKOUT2/4; the UART
    /// keeps its grid.
    void clock_edge(PinLevel level, Ticks slope = {});
    const Clk& clk() const { return clk_; }

    // ---- what it did not like -----------------------------------------------------------------------------------
    /// rule: regmap::PinRule. The chip inside has a queue of its own.
    core::FixedQueue<core::Finding, 64>& findings() { return findings_; }
    const core::FixedQueue<core::Finding, 64>& findings() const { return findings_; }
    /// How often parameter `number` was violated since construction; 0: all of them, unnumbered ones too.
    std::uint32_t violations(unsigned number) const { return number < violations_.size() ? violations_[number] : 0u; }
    /// A violation with PackageOptions::fatal.
    bool failed() const { return failed_; }

    // ---- inside -------------------------------------------------------------------------------------------------
    const Chip& chip() const { return chip_; }
    /// For its options, findings and trace; accesses and telegrams go through the package.
    Chip& chip() { return chip_; }
    const Biu& biu() const { return biu_; }
    const DpcCounters& dpc() const { return dpc_.counters(); }
    const BasicUart<Chip>& uart() const { return uart_; }
    Variant variant() const { return chip_.variant(); }
    Supply supply() const { return supply_; }
    ProcessorMode mode() const { return biu_.mode(); }
    bool in_reset() const { return in_.is_high(PinId::reset); }
    const PackageOptions& options() const { return options_; }
    /// At any time; the pull-up shows at once.
    void set_options(const PackageOptions& options);

    // ---- LineSide::pins: a BitStation ------------------------------------------------------------------------------
    /// advance() in two steps, for stations that are coupled without delay: all but the samples of RXD at `to`,
    void run(Ticks to);
    /// and these.
    void sample();
    /// RXD takes a level at `at`, which is not before now().
    void set_rxd(Ticks at, PinLevel level);
    /// What the line driver sees.
    PinLevel txd() const { return pin(PinId::txd); }

    // ---- LineSide::telegrams: a segment::Station ------------------------------------------------------------------
    void hear(const fdl::Transmission& t);
    void hear_character(const fdl::Character& c);
    void carrier(Ticks at);
    bool take(fdl::Transmission& t);
    void sent(Ticks at);
    bool hears_all() const { return chip_.hears_all(); }
    std::uint8_t address() const { return chip_.address(); }

private:
    static constexpr std::size_t kSlots = kPins + 1;

    void run_to(Ticks at, bool samples);
    void move_chip(Ticks at, bool samples);
    void serve_bus();
    void drain_chip();
    void drain_uart();
    void update_bus_outputs();
    void update_clkout();
    void drive(PinId pin, PinLevel level, Ticks at);
    PinLevel visible(PinId pin) const;
    void refresh_all();

    void input_changed(PinId pin);
    void reset_changed();
    void strap_changed(PinId pin);
    void line_changed(PinId pin);
    void bus_pin_changed(PinId pin);
    void bus_event(regmap::BusEvent e);
    void note_bus_event(PinId pin);
    void check_contention();
    bool has_ab11() const { return chip_.traits().max_ram_bytes > 2048; }
    bool uses_ab11() const { return has_ab11() && chip_.ram_bytes() > 2048; }
    void drain_timing();
    void find(regmap::PinRule rule, std::uint32_t detail);
    void violated(regmap::PinRule rule, std::uint8_t number, Ticks found, Ticks at);

    Chip chip_;
    PackageOptions options_;
    Supply supply_;
    Ticks now_{};
    Clk clk_;
    InputLevels in_;
    std::uint64_t driven_ = 0;   ///< bit n: the board drives pin n
    std::uint64_t watched_ = 0;  ///< bit n: edges of pin n are queued
    std::array<PinLevel, kSlots> out_{};    ///< what the chip puts on the pin
    std::array<PinLevel, kSlots> shown_{};  ///< what a probe shows of it
    Biu biu_;
    TimingCheck timing_;
    DualPortController dpc_;
    BasicUart<Chip> uart_;
    Ticks reset_since_{};
    bool was_reset_ = false;      ///< RESET has been active once
    bool floats_noted_ = false, contention_noted_ = false, no_reset_noted_ = false;
    bool failed_ = false;
    std::array<std::uint32_t, 61> violations_{};
    core::FixedQueue<PinEdge, 256> edges_;
    core::FixedQueue<core::Finding, 64> findings_;
};

extern template class Package<core::NoTrace>;
extern template class Package<core::RingTrace>;

}  // namespace dpchip::pins
