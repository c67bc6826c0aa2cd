// SPDX-License-Identifier: Apache-2.0
// A board in time: the package, its wires, the RS-485 line behind it, and edges that processor and board have planned.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <dpchip/pins/bit_line.hpp>
#include <dpchip/pins/wiring.hpp>

#include "slack.hpp"

namespace boards {

using namespace dpchip;
using namespace dpchip::core::literals;
using core::Ticks;
using pins::PinId;
using pins::PinLevel;

/// Lines of the processor that move together, bit 0 first.
class Signal {
public:
    Signal() = default;
    Signal(const pins::Wiring& wiring, std::string_view name) : lines_{wiring.line(name)} {}
    /// NAMEfirst .. NAMElast; those that reach the package.
    Signal(const pins::Wiring& wiring, const std::string& name, unsigned first, unsigned last) {
        for (unsigned i = first; i <= last; ++i) lines_.push_back(wiring.line(name + std::to_string(i)));
    }
    const std::vector<pins::WiredLine>& lines() const { return lines_; }

private:
    std::vector<pins::WiredLine> lines_;
};

/// The package behind an RS-485 transceiver: RTS enables its driver, TXD and RXD are its ends.
class Transceiver {
public:
    Transceiver(pins::Package<>& package, const pins::Wiring& wiring)
        : package_{&package}, txd_{wiring.line("TxD")}, rxd_{wiring.line("RxD")}, rts_{wiring.line("RTS")} {}

    Ticks next() const { return package_->next(); }
    void run(Ticks to) { package_->run(to); }
    void sample() { package_->sample(); }
    void set_rxd(Ticks at, PinLevel level) {
        if (at > package_->now()) package_->run(at);
        rxd_.drive(*package_, level);
    }
    PinLevel txd() const { return rts_.level(*package_) == PinLevel::high ? txd_.level(*package_) : PinLevel::z; }

private:
    pins::Package<>* package_;
    pins::WiredLine txd_, rxd_, rts_;
};

class Circuit {
public:
    Circuit(pins::Package<>& package, const pins::Wiring& wiring);
    Circuit(const Circuit&) = delete;
    Circuit& operator=(const Circuit&) = delete;

    Ticks now() const { return line_.now(); }
    Ticks next() const;
    /// Does everything due up to and including `to`.
    void run(Ticks to);

    /// At `at`, the board drives `value` on the signal; or lets go of it.
    void plan(Ticks at, const Signal& signal, std::uint32_t value = 1) { insert({at, &signal, value, false}); }
    void plan_release(Ticks at, const Signal& signal) { insert({at, &signal, 0, true}); }
    /// What it reads there now; a line that nobody drives reads 1.
    std::uint32_t value(const Signal& signal) const;
    /// Nobody drives some of it.
    bool floats(const Signal& signal) const;

    const pins::Wiring& wiring() const { return *wiring_; }
    pins::Package<>& package() { return *package_; }
    const pins::Package<>& package() const { return *package_; }
    pins::BitLine& line() { return line_; }
    const SlackMeter& slack() const { return slack_; }

private:
    struct Action {
        Ticks at;
        const Signal* signal;
        std::uint32_t value;
        bool release;
    };
    void insert(const Action& action);
    void apply(const Action& action);

    pins::Package<>* package_;
    const pins::Wiring* wiring_;
    Transceiver transceiver_;
    pins::BitLine line_;
    SlackMeter slack_;
    std::vector<Action> planned_;  ///< by time; of the same time, in the order of planning
};

}  // namespace boards
