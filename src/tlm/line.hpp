// SPDX-License-Identifier: Apache-2.0
// An RS-485 line between SystemC modules: chips, packages behind transceivers and one master exchange telegrams in simulated time. Bus timing, collisions
// and who hears what are the model's (a "sim:" line of dpchip.h); this channel moves it with the kernel.
//
// The line is at most as far as the kernel, unless a chip is allowed to run ahead (Synchronisation::run_ahead): then it is
// as far as that chip's processor, what happens until there is shown to the others at its own time, and what they do
// meanwhile reaches the line late.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include <systemc>
#include <tlm>

#include <dpchip/dpchip.h>
#include <dpchip/tlm/line_if.hpp>

namespace dpchip::tlm {

class Line : public sc_core::sc_module, public LineMasterIf, public LineChipIf, public LineWireIf {
public:
    /// Every telegram as it ends, for monitors and traces.
    ::tlm::tlm_analysis_port<Telegram> telegrams{"telegrams"};

    /// baud: one of the ten PROFIBUS rates in bit/s, at which the master sends; chips find it.
    explicit Line(const sc_core::sc_module_name& name, std::uint32_t baud = 1'500'000);
    ~Line() override;

    bool send(const Octets& octets) override;
    bool send_now(const Octets& octets) override;
    const sc_core::sc_event& sent_event() const override { return sent_; }
    bool receive(Telegram& telegram) override;
    const sc_core::sc_event& received_event() const override { return received_; }
    bool exchange(const Octets& request, Telegram& answer, const sc_core::sc_time& timeout) override;

    void attach(dpchip_chip& chip, LineStation& station) override;
    void advance(Ticks to) override;
    void touched() override;

    int join(LineWire& wire, std::uint32_t baud) override;
    void drive(int station, bool level) override;
    void begins(int station) override;
    void sent(int station, const Octets& octets, const Octets& faults, Ticks start) override;

    /// The line of the C API, for what this class does not offer: dpchip_line_record and the like. Do not move its time.
    dpchip_line* handle() { return line_.get(); }

private:
    struct Close {
        void operator()(dpchip_line* line) const { dpchip_line_close(line); }
    };

    struct Wire {
        int station;
        LineWire* wire;
        bool level = true;
    };
    struct Begun {
        sc_core::sc_time at;
        Octets octets;
        Ticks start, bit;
    };

    void end_of_elaboration() override;
    void step();
    void collect();
    void deliver();
    void plan();
    bool post(const Octets& octets, Ticks at);
    void check(int code);

    std::unique_ptr<dpchip_line, Close> line_;
    std::vector<LineStation*> stations_;
    std::vector<Wire> wires_;
    std::deque<Begun> begun_;     ///< for the wires, not yet at the kernel's time
    std::deque<Telegram> seen_;   ///< ended on the line, not yet at the kernel's time
    std::deque<Telegram> inbox_;  ///< of the master
    sc_core::sc_event wake_{"wake"}, sent_{"sent"}, received_{"received"};
    sc_core::sc_time planned_ = sc_core::sc_max_time();
};

}  // namespace dpchip::tlm
