// SPDX-License-Identifier: Apache-2.0
// A processor on the bus pins: read and write cycles of the four modes, edge by edge (8.1.2, 10.7.2 to 10.7.5).
//
// It moves time while its cycles last: the package's own, or that of a whole board through set_mover(). Lines that hold
// beyond a strobe move in the next cycle or in settle(), each at its own time.
//
// Not modelled: a particular processor. AB11 is moved on boards that use it; the decoder inputs of the synchronous Intel
// mode are 0.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/pins/bus_times.hpp>
#include <dpchip/pins/package.hpp>

namespace dpchip::pins {

template <class Trace = core::RingTrace>
class BusCycles {
public:
    /// `with_ab11`: a 4 KB board. Times are comfortable ones.
    BusCycles(Package<Trace>& package, ProcessorMode mode, bool with_ab11 = false);
    BusCycles(const BusCycles&) = delete;
    BusCycles& operator=(const BusCycles&) = delete;

    /// Sets straps and idle levels and holds RESET for `reset`.
    void power_up(Ticks reset = core::nanoseconds(300));

    /// One cycle; returns when the strobe ends. What DB shows then; a bit that nobody drives reads 1.
    std::uint8_t read(std::uint16_t address);
    void write(std::uint16_t address, std::uint8_t value);
    void read_block(std::uint16_t address, std::span<std::uint8_t> out);
    void write_block(std::uint16_t address, std::span<const std::uint8_t> in);
    /// Lets the last cycle's hold times pass, and the chip take what was written.
    void settle();
    /// Lets time pass up to `to`; the last cycle's lines move meanwhile.
    void advance(Ticks to);

    /// Who lets time pass: `mover(context, to)` must bring the package to `to`. At first the package itself.
    void set_mover(void (*mover)(void* context, Ticks to), void* context) {
        mover_ = mover;
        mover_context_ = context;
    }
    BusTimes& times() { return times_; }
    Package<Trace>& package() { return *package_; }
    ProcessorMode mode() const { return mode_; }
    /// When the strobe of the last cycle began and ended.
    Ticks strobe_began() const { return fell_; }
    Ticks strobe_ended() const { return rose_; }
    /// When the last cycle saw ready; only with wait_for_ready.
    Ticks ready_seen() const { return ready_; }

    /// A driver::BusPort: a handle, cheap to copy.
    struct Port {
        BusCycles* bus;
        std::uint8_t read(std::uint16_t address) { return bus->read(address); }
        void write(std::uint16_t address, std::uint8_t value) { bus->write(address, value); }
        void read_block(std::uint16_t address, std::span<std::uint8_t> out) { bus->read_block(address, out); }
        void write_block(std::uint16_t address, std::span<const std::uint8_t> in) { bus->write_block(address, in); }
    };
    Port port() { return {this}; }

private:
    enum class Line : std::uint8_t { address, data, release_data, pin };
    struct Action {
        Ticks at{};
        Line line{};
        PinId pin{};
        PinLevel level{};
        std::uint16_t value{};
    };

    Ticks time(std::uint8_t number) const { return times_.of[number]; }
    void plan(Action action);
    void plan_pin(Ticks at, PinId pin, bool high) { plan({at, Line::pin, pin, to_level(high), 0}); }
    void run(Ticks to);
    void move_to(Ticks to);
    void apply(const Action& action);
    void move_address(std::uint16_t lines);
    PinId strobe_pin(Cycle cycle) const;
    std::uint16_t lines_of(std::uint16_t address) const;
    Ticks earliest_strobe(const CycleNumbers& n, Cycle cycle, std::uint16_t lines) const;
    void begin(Cycle cycle, std::uint16_t address);
    void finish(Cycle cycle, std::uint8_t value);
    void after_strobe(const CycleNumbers& n);
    Ticks wait_for_end(const CycleNumbers& n);

    Package<Trace>* package_;
    void (*mover_)(void*, Ticks) = nullptr;
    void* mover_context_ = nullptr;
    ProcessorMode mode_;
    bool with_ab11_;
    BusTimes times_;
    std::uint16_t address_lines_ = 0;  ///< planned level of AB, bit 11: AB11
    bool r_w_high_ = true;             ///< planned
    Ticks fell_, rose_, ready_{};
    Ticks select_until_, lines_until_, r_w_until_;
    std::array<Action, 32> planned_{};
    std::size_t planned_count_ = 0;
};

extern template class BusCycles<core::NoTrace>;
extern template class BusCycles<core::RingTrace>;

}  // namespace dpchip::pins
