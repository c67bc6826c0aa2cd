// SPDX-License-Identifier: Apache-2.0
// The chip: registers and Dual-Port RAM on one side, telegrams and characters on the other, time in between.
//
// A Chip is moved from outside: advance() runs everything that is due, read() and write() are one processor access
// each at now(), hear() and hear_character() bring what was received, take() fetches what it sends. It calls nobody,
// allocates nothing and holds no pointers into itself: a copy is a snapshot.
//
// Order within one tick: timers in the order of Timer, then the line, then the processor access.
// Thread rules: none inside; one thread at a time per chip.
//
// Not modelled here: bus cycle timing, XREADY, CLKOUT and bit-level sampling (layer pins/).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/chip/context.hpp>
#include <dpchip/core/archive.hpp>
#include <dpchip/core/result.hpp>
#include <dpchip/fdl/transmission.hpp>

namespace dpchip::chip {

using core::Ticks;
using regmap::Options;
using regmap::Traits;
using regmap::Variant;

/// One PROFIBUS DP slave controller. Trace: core::NoTrace or core::RingTrace; both are instantiated in chip.cpp.
template <class Trace = core::RingTrace>
class Chip {
public:
    /// In hardware reset state at time 0, Offline.
    explicit Chip(Variant variant = Variant::vpc3c, const Options& options = {}, BusMode bus_mode = BusMode::intel);

    /// A pulse on RESET at now() (8.1.2, reference 4.8). Time goes on.
    void reset();

    // ---- time -------------------------------------------------------------------------------------------------
    Ticks now() const { return c_.s.now; }
    /// The next moment at which the chip does something by itself; kNever when nothing is planned.
    Ticks next() const { return c_.s.next; }
    /// Runs everything due up to and including `to`. `to` must not be before now().
    void advance(Ticks to);

    // ---- processor side (4.2, 4.3) ----------------------------------------------------------------------------
    /// One read cycle, side effects included (commands 09H, 0BH, 0DH..11H, 13H, 14H act). Any address is legal.
    std::uint8_t read(std::uint16_t address);
    /// One write cycle.
    void write(std::uint16_t address, std::uint8_t value);
    /// What read() would return, without any side effect: for debuggers, views and snapshots.
    std::uint8_t peek(std::uint16_t address) const;
    void read_block(std::uint16_t address, std::span<std::uint8_t> out);
    void write_block(std::uint16_t address, std::span<const std::uint8_t> in);
    /// XINT/MOT: Motorola swaps the octets of the word registers (4.2).
    void set_bus_mode(BusMode mode) { c_.s.bus_mode = mode; }
    BusMode bus_mode() const { return c_.s.bus_mode; }

    // ---- line side: a segment::Station ------------------------------------------------------------------------
    /// An undamaged telegram ended now; advance(t.end()) first.
    void hear(const fdl::Transmission& t);
    /// One character ended now; advance(c.end()) first. Every octet of a telegram this way gives the same as hear().
    void hear_character(const fdl::Character& c);
    /// RXD fell at `at`: a transmission of somebody else begins. A planned answer that has not begun is given up.
    void carrier(Ticks at);
    /// True, and `t` filled, when an answer starts now.
    bool take(fdl::Transmission& t);
    /// What take() gave leaves, or has left, the line at `at` and not when its bit times are over: sending ends then. For
    /// whoever sends the bits (live lines, pins/). May be said again when it is known better, until then.
    void sent(Ticks at);
    /// XCTS holds a character in the middle of what take() gave (8.3): sending goes on until sent() says when it ends.
    void hold();
    /// RXD was low until `until`: TSYN counts from there on. For whoever looks at bits; characters say it by themselves.
    void line_low(Ticks until);
    /// True while searching the baud rate or out of synchronisation.
    bool hears_all() const;
    /// R_TS_Adr as latched at Start or changed by Set_Slave_Add; 255 while Offline.
    std::uint8_t address() const;

    // ---- pins -------------------------------------------------------------------------------------------------
    /// The present level of an output pin.
    Level level(Pin pin) const;
    /// 1 while X/INT is active, whatever its polarity.
    bool interrupt_active() const { return c_.s.x_int_active != 0; }
    /// XCTS (1.5): high holds the next character back.
    void set_xcts(Level level);
    /// Which output pins leave their edges in the queue; bit n is Pin n. None at first.
    void watch(std::uint8_t pin_mask) { c_.s.watched_pins = pin_mask; }
    core::FixedQueue<Edge, 64>& edges() { return c_.edges; }

    // ---- Dual-Port RAM (8.2) ------------------------------------------------------------------------------------
    /// Whether the Micro Sequencer's use of the RAM is queued in ram_uses(). Not at first.
    void watch_ram(bool on) { c_.ram_watched = on; }
    core::FixedQueue<RamUse, 32>& ram_uses() { return c_.ram_uses; }

    // ---- inspection -------------------------------------------------------------------------------------------
    Variant variant() const { return c_.traits->variant; }
    const Traits& traits() const { return *c_.traits; }
    DpState dp_state() const { return c_.s.dp_state; }
    WdState wd_state() const { return c_.s.wd_state; }
    fdl::BaudCode baud() const { return c_.s.baud; }
    bool online() const { return c_.s.passive_idle != 0; }
    /// Address of the master that owns the slave; 255: none.
    std::uint8_t owner() const { return c_.s.owner; }
    std::uint16_t user_wd_timer() const { return c_.s.user_wd_timer; }
    std::uint16_t ram_bytes() const;
    const Options& options() const { return c_.options; }
    /// Options may change at any time; they hold from the next event on.
    Options& options() { return c_.options; }
    core::FixedQueue<core::Finding, 64>& findings() { return c_.findings; }
    const core::FixedQueue<core::Finding, 64>& findings() const { return c_.findings; }
    Trace& trace() { return c_.trace; }

    // ---- snapshots --------------------------------------------------------------------------------------------
    /// All there is to know about the chip, RAM included.
    const State& state() const { return c_.s; }
    /// Puts the chip into a state taken from a chip of the same variant.
    void restore(const State& state);
    /// Octets that save() needs.
    static std::size_t snapshot_size();
    /// Writes magic, version, variant, every field by name and a CRC. Returns the octets written, or why not.
    core::Result<std::size_t, core::ArchiveError> save(std::span<std::uint8_t> out) const;
    /// Reads what save() wrote. On error the chip is unchanged.
    core::ArchiveError load(std::span<const std::uint8_t> in);

private:
    Context<Trace> c_;
};

extern template class Chip<core::NoTrace>;
extern template class Chip<core::RingTrace>;

}  // namespace dpchip::chip
