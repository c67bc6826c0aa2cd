// SPDX-License-Identifier: Apache-2.0
// What hangs on a bit-level line: a chip behind its UART, or a station that speaks in telegrams behind a good transceiver.
//
// Line time outside, the chip's own ticks inside. A telegram station is what dpchip::segment calls a Station; pins/ may
// not know that layer, so the concept stands here again.
//
// Not modelled: the transceiver's delay and skew; BitLine distorts.
#pragma once

#include <algorithm>
#include <concepts>

#include <dpchip/core/clock.hpp>
#include <dpchip/fdl/telegram.hpp>
#include <dpchip/fdl/transmission.hpp>
#include <dpchip/pins/uart.hpp>

namespace dpchip::pins {

/// A station on a line of bits. run() does everything up to `to` but samples at `to` itself; sample() does these.
template <class S>
concept BitStation = requires(S& s, const S& c, Ticks t, PinLevel level) {
    { c.next() } -> std::same_as<Ticks>;
    s.run(t);
    s.sample();
    s.set_rxd(t, level);
    { c.txd() } -> std::same_as<PinLevel>;
};

/// A chip, or a slave around one, behind a UART; both stay the caller's.
template <UartHost Host>
class UartStation {
public:
    UartStation(Host& host, BasicUart<Host>& uart, const core::Clock& clock = core::Clock{}) : host_{&host}, uart_{&uart}, clock_{clock} {}

    Ticks next() const { return clock_.line(uart_->next(*host_)); }
    void run(Ticks to) {
        uart_->run(*host_, clock_.local(to));
        drain();
    }
    void sample() {
        uart_->sample(*host_);
        drain();
    }
    void set_rxd(Ticks at, PinLevel level) { uart_->set_rxd(*host_, clock_.local(at), level); }
    PinLevel txd() const { return uart_->txd(); }

private:
    /// The line looks at txd() after every step, so that nothing is lost with the queue.
    void drain() {
        while (!uart_->edges().empty()) static_cast<void>(uart_->edges().pop());
    }

    Host* host_;
    BasicUart<Host>* uart_;
    core::Clock clock_;
};

/// A station that sends and hears whole telegrams (dpchip::segment::Station).
template <class S>
concept TelegramStation = requires(S& s, const S& c, Ticks t, const fdl::Transmission& heard, fdl::Transmission& sent, const fdl::Character& ch) {
    { c.next() } -> std::same_as<Ticks>;
    s.advance(t);
    s.hear(heard);
    s.hear_character(ch);
    s.carrier(t);
    { s.take(sent) } -> std::same_as<bool>;
    { c.hears_all() } -> std::same_as<bool>;
    { c.address() } -> std::same_as<std::uint8_t>;
};

/// Puts a telegram station on a line of bits: its telegrams become edges, edges become its telegrams. The receiver is as
/// good as one can be: it knows the moment of every edge and looks at the middle of every bit, at the given rate.
template <TelegramStation S>
class TelegramAdapter {
public:
    /// `error_ppm`: how much too fast its bits are sent, -200'000 .. 200'000; received is with the nominal bit time.
    TelegramAdapter(S& station, fdl::BaudCode rate, std::int32_t error_ppm = 0)
        : station_{&station}, bit_{fdl::baud(rate).bit}, error_ppm_{error_ppm} {}

    Ticks next() const { return std::min({station_->next(), next_tx(), next_rx(), next_flush()}); }
    void run(Ticks to) {
        now_ = to;
        station_->advance(to);
        if (!sending_ && station_->take(out_)) {
            sending_ = true;
            slot_ = 0;
        }
        while (next_tx() <= to) send_bit();
    }
    void sample() {
        while (next_rx() <= now_) look();
        if (next_flush() <= now_) flush();
    }
    void set_rxd(Ticks at, PinLevel level) {
        if (at > now_) run(at);
        const bool fell = rxd_ && level == PinLevel::low;
        rxd_ = level != PinLevel::low;
        if (!fell || look_ != kHunting) return;
        start_ = at;
        look_ = 0;
    }
    PinLevel txd() const { return txd_; }

private:
    static constexpr std::int64_t kHunting = -1, kStopLook = 10, kHandOver = 11;

    // ---- sending: slot n is the n-th bit of the transmission
    Ticks slot_at(std::int64_t slot) const { return out_.start + Ticks{slot * out_.bit.n * 1'000'000 / (1'000'000 + error_ppm_)}; }
    Ticks next_tx() const { return sending_ ? slot_at(slot_) : core::kNever; }
    bool bit_of(std::int64_t slot) const {
        const fdl::Character c = out_.character(static_cast<std::size_t>(slot / fdl::kCharacterBits));
        const auto n = static_cast<unsigned>(slot % fdl::kCharacterBits);
        if (n == 9) return fdl::even_parity(c.octet) != ((c.faults & fdl::fault_parity) != 0);
        if (n == 10) return (c.faults & fdl::fault_stop) == 0;
        return ((static_cast<unsigned>(c.octet) << 1 >> n) & 1u) != 0;
    }
    void send_bit() {
        const std::int64_t slots = fdl::kCharacterBits * out_.length;
        if (slot_ == slots) {
            sending_ = false;
            txd_ = PinLevel::z;
            return;
        }
        txd_ = to_level(bit_of(slot_));
        ++slot_;
    }

    // ---- hearing
    Ticks next_rx() const {
        if (look_ == kHunting) return handing_ ? heard_.end() : core::kNever;
        const Ticks at = start_ + bit_ * look_ + Ticks{bit_.n / 2};
        return handing_ ? std::min(at, heard_.end()) : at;
    }
    /// Where a telegram that stopped in the middle is given up.
    Ticks next_flush() const { return in_.length != 0 && look_ == kHunting && !handing_ ? in_.end() + bit_ * 2 : core::kNever; }

    void look() {
        if (handing_ && heard_.end() <= now_) return hand_over();
        if (look_ == 0) return check_start();
        if (look_ <= 8) octet_ = static_cast<std::uint8_t>(octet_ | (rxd_ ? 1u << (look_ - 1) : 0u));
        else if (look_ == 9) faults_ = rxd_ == fdl::even_parity(octet_) ? std::uint8_t{0} : std::uint8_t{fdl::fault_parity};
        else if (!rxd_) faults_ = static_cast<std::uint8_t>(faults_ | fdl::fault_stop);
        if (look_++ < kStopLook) return;
        look_ = kHunting;
        heard_ = {start_, bit_, octet_, faults_};
        handing_ = true;
    }
    void check_start() {
        look_ = kHunting;
        if (rxd_ || sending_) return;
        if (!follows(start_)) station_->carrier(start_);
        look_ = 1;
        octet_ = faults_ = 0;
    }
    /// A character that begins at `start` belongs to what came before.
    bool follows(Ticks start) const { return (in_.length != 0 || damaged_) && (start - end_) * 4 <= bit_; }
    void hand_over() {
        handing_ = false;
        const fdl::Character c = heard_;
        if (!follows(c.start)) flush();
        end_ = c.end();
        if (damaged_) return station_->hear_character(c);
        if (in_.length == 0) in_.start = c.start;
        in_.bit = bit_;
        in_.damaged = in_.synchronised = false;
        in_.octets[in_.length] = c.octet;
        in_.faults[in_.length++] = c.faults;
        const auto telegram = fdl::decode(in_.bytes());
        if (c.faults == 0 && telegram) return deliver(*telegram, c.end());
        if (c.faults != 0 || telegram.error() != fdl::Reject::need_more) {
            flush();
            damaged_ = true;
        }
    }
    void deliver(const fdl::Telegram& telegram, Ticks end) {
        in_.start = end - bit_ * (fdl::kCharacterBits * in_.length);
        const bool mine = station_->hears_all() || (telegram.has_fc() && (telegram.destination() == fdl::kBroadcast ||
                                                                         telegram.destination() == station_->address()));
        if (mine) station_->hear(in_);
        in_.length = 0;
        damaged_ = false;
    }
    /// What was collected is no telegram: its characters are handed over now, with their own times.
    void flush() {
        in_.damaged = true;
        for (std::size_t i = 0; i < in_.length; ++i) station_->hear_character(in_.character(i));
        in_.length = 0;
        damaged_ = false;
    }

    S* station_;
    Ticks bit_;
    std::int64_t error_ppm_;
    Ticks now_{};
    fdl::Transmission out_{};
    std::int64_t slot_ = 0;
    bool sending_ = false;
    PinLevel txd_ = PinLevel::z;

    bool rxd_ = true;
    std::int64_t look_ = kHunting;  ///< bit looked at next, 0 the start bit
    Ticks start_{};
    std::uint8_t octet_ = 0, faults_ = 0;
    fdl::Character heard_{};        ///< complete, waits for its end
    bool handing_ = false;
    fdl::Transmission in_{};        ///< characters that may become a telegram
    bool damaged_ = false;          ///< what comes in now will not
    Ticks end_{};
};

}  // namespace dpchip::pins
