// SPDX-License-Identifier: Apache-2.0
// The UART: what stands between the pins TXD, RXD, RTS, XCTS and the chip's characters, bit by bit (8.3; reference 1.3, 1.5).
//
// It owns no chip; whoever owns both hands the chip in. Chip and UART move together: run() and advance() of the UART move
// the chip too, event by event. Order within one tick: the chip's timers, TXD, edges on RXD, samples. Who couples
// several stations without delay calls run() on all, brings the edges, then sample() on all; advance() is both.
//
// A start bit counts from the sample that sees it, up to a quarter of a bit after the edge; an answer that is planned is
// given up only when the start bit has been found low in its middle (chip::Chip::carrier).
#pragma once

#include <algorithm>
#include <concepts>

#include <dpchip/chip/chip.hpp>
#include <dpchip/core/fixed_queue.hpp>
#include <dpchip/pins/uart_receiver.hpp>
#include <dpchip/pins/uart_transmitter.hpp>

namespace dpchip::pins {

/// What the UART needs of a chip, or of whatever moves one (a slave with its firmware).
template <class H>
concept UartHost = requires(H& h, const H& c, Ticks t, const fdl::Character& ch, fdl::Transmission& sent) {
    { c.now() } -> std::same_as<Ticks>;
    { c.next() } -> std::same_as<Ticks>;
    { c.state() } -> std::same_as<const chip::State&>;
    h.advance(t);
    h.hear_character(ch);
    h.carrier(t);
    { h.take(sent) } -> std::same_as<bool>;
    h.sent(t);
    h.hold();
    h.line_low(t);
    h.set_xcts(chip::Level::low);
};

template <class Host>
class BasicUart {
public:
    /// `clk_phase`: when CLK rises, 0 .. kClk - 1; the grid lies on these edges. As after RESET at time 0.
    explicit BasicUart(Ticks clk_phase = {}) : clk_phase_{clk_phase} { s_.grid_origin = clk_phase; s_.rate = fdl::BaudCode::mbit_12; }

    // ---- time ---------------------------------------------------------------------------------------------------
    /// When chip or UART want to be moved next.
    Ticks next(const Host& host) const {
        return std::max(host.now(), std::min({host.next(), transmitter::next(s_), receiver::next(s_)}));
    }
    /// Moves both to `to`: everything before it, and at `to` everything but samples of RXD.
    void run(Host& host, Ticks to) {
        for (;;) {
            const Ticks at = std::min(next(host), to);
            host.advance(at);
            follow(host);
            if (at == to) return;
            sample(host);
        }
    }
    /// Takes the samples that are due now.
    void sample(Host& host) {
        if (receiver::next(s_) > host.now()) return;
        while (receiver::next(s_) <= host.now()) receiver::take(s_, host, receiver::next_sample(s_));
        follow(host);
    }
    /// run(), then sample().
    void advance(Host& host, Ticks to) {
        run(host, to);
        sample(host);
    }

    // ---- pins ---------------------------------------------------------------------------------------------------
    /// RXD takes a level at `at` (not before now); Z reads as high. A sample at `at` sees it unless it has been taken.
    void set_rxd(Host& host, Ticks at, PinLevel level) {
        run(host, at);
        receiver::edge(s_, at, level);
    }
    /// XCTS takes a level at `at`; the chip is told.
    void set_xcts(Host& host, Ticks at, PinLevel level) {
        run(host, at);
        const bool low = level == PinLevel::low;
        host.set_xcts(low ? chip::Level::low : chip::Level::high);
        if (low) transmitter::release(s_, host, host.now());
        follow(host);
    }
    /// After a RESET of the chip: TXD is high-resistance, the grid starts again. RXD keeps its level.
    void reset(Host& host) {
        receiver::restart(s_, host.state().probe, host.now(), clk_phase_);
        follow(host);
    }
    PinLevel txd() const { return s_.txd; }
    PinLevel rxd() const { return s_.rxd; }
    /// Changes of TXD, oldest first. Whoever does not look every 64 changes loses some, and overflows() counts them.
    core::FixedQueue<PinEdge, 64>& edges() { return edges_; }

    // ---- inspection, snapshots ----------------------------------------------------------------------------------
    const UartState& state() const { return s_; }
    /// A state taken from a UART, together with the chip's. The queue of edges is not part of it.
    void restore(const UartState& state) { s_ = state; }
    Ticks clk_phase() const { return clk_phase_; }
    /// A quarter of a bit at the present rate.
    Ticks quarter() const { return receiver::quarter(s_); }
    /// The first sample at or after `at`.
    Ticks next_sample_from(Ticks at) const { return receiver::time_of(s_, receiver::sample_from(s_, at)); }

private:
    void drive(Ticks at, PinLevel level) {
        if (s_.txd == level) return;
        s_.txd = level;
        edges_.push({at, PinId::txd, level});
    }
    /// What the chip has done up to now shows at the UART: its rate, RTS, an answer that begins, bits that are due.
    void follow(Host& host) {
        const auto on_txd = [this](Ticks at, PinLevel level) { drive(at, level); };
        const chip::State& c = host.state();
        if (c.probe != s_.rate) receiver::restart(s_, c.probe, host.now(), clk_phase_);
        transmitter::follow_rts(s_, c.rts != 0, host.now(), on_txd);
        if (c.answer_ready != 0) {
            fdl::Transmission t;
            if (host.take(t)) transmitter::begin(s_, host, t);
        }
        while (transmitter::next(s_) <= host.now()) transmitter::step(s_, host, transmitter::next(s_), on_txd);
    }

    UartState s_{};
    Ticks clk_phase_;
    core::FixedQueue<PinEdge, 64> edges_;
};

/// The UART of a chip.
template <class Trace>
using Uart = BasicUart<chip::Chip<Trace>>;
static_assert(UartHost<chip::Chip<core::RingTrace>>);

extern template class BasicUart<chip::Chip<core::NoTrace>>;
extern template class BasicUart<chip::Chip<core::RingTrace>>;

}  // namespace dpchip::pins
