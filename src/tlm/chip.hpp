// SPDX-License-Identifier: Apache-2.0
// A chip on a TLM-2.0 bus: a loosely timed target socket in front of the registers and the Dual-Port RAM, X/INT and
// XDATAEXCH/SYNC as signals, a telegram-level line behind (VPC3+C chapters 4, 5.3, 8.1; APC3 chapters 3, 4).
//
// Each enabled byte of a transaction is one 8-bit processor cycle, in ascending order. It acts where the initiator's local
// time says, and its cycle time is added to the annotated delay. Reads are commands on this chip, so there is no DMI, and
// debug reads peek.
//
// Not modelled here: strobes, XREADY and bits; see package.hpp.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <systemc>
#include <tlm>
#include <tlm_utils/simple_target_socket.h>

#include <dpchip/dpchip.h>
#include <dpchip/tlm/bus_window.hpp>
#include <dpchip/tlm/line.hpp>

namespace dpchip::tlm {

/// What an access does when its initiator is ahead of the kernel (temporal decoupling).
enum class Synchronisation {
    exact,      ///< waits until the kernel is there: the quantum changes nothing that anybody sees
    run_ahead,  ///< never waits, takes the line along. For a chip whose line nobody else acts on: masters, inputs and other
                ///< processors reach a line that is ahead only at its own present, up to a quantum late
};

/// Data format of the processor, pin XINT/MOT.
enum class DataFormat { intel, motorola };

struct ChipSettings {
    std::string variant = "vpc3+c";  ///< as dpchip_chip_create() takes it
    BusWindow window{};
    DataFormat format = DataFormat::intel;
    sc_core::sc_time access_time{125, sc_core::SC_NS};  ///< one 8-bit cycle
    Synchronisation synchronisation = Synchronisation::exact;
    std::vector<std::pair<std::string, std::string>> options{};  ///< dpchip_chip_set_option(): name, value
};

class Chip : public sc_core::sc_module, private LineStation {
public:
    /// The processor's bus. No DMI; transport_dbg reads by peek and refuses writes.
    tlm_utils::simple_target_socket<Chip> bus{"bus"};
    /// The line; left unbound, the chip has one to itself.
    sc_core::sc_port<LineChipIf, 1, sc_core::SC_ZERO_OR_MORE_BOUND> line{"line"};
    /// Pin levels: X/INT is active low until INT_Pol says otherwise, XDATAEXCH is low in DATA-EXCH. Both are 1 after RESET:
    /// give their signals that as initial value, or they rise at time 0.
    sc_core::sc_out<bool> x_int{"x_int"}, xdataexch_sync{"xdataexch_sync"};
    /// RESET, active high, and XCTS, low lets the chip send; both may stay unbound.
    sc_core::sc_port<sc_core::sc_signal_in_if<bool>, 1, sc_core::SC_ZERO_OR_MORE_BOUND> reset{"reset"}, xcts{"xcts"};

    explicit Chip(const sc_core::sc_module_name& name, const ChipSettings& settings = {});
    ~Chip() override;

    /// What the processor would read, without side effects.
    std::uint8_t peek(std::uint16_t chip_address) const { return dpchip_chip_peek(chip_.get(), chip_address); }
    /// What a test wants to know at a glance.
    dpchip_chip_info info() const;
    /// The chip of the C API, for options and snapshots. After it has been changed through this, call changed().
    dpchip_chip* handle() { return chip_.get(); }
    void changed();

private:
    struct Destroy {
        void operator()(dpchip_chip* chip) const { dpchip_chip_destroy(chip); }
    };
    struct Edge {
        sc_core::sc_time at;
        int output = 0;
        bool level = false;
    };
    using Payload = ::tlm::tlm_generic_payload;

    void before_end_of_elaboration() override;
    void end_of_elaboration() override;

    void b_transport(Payload& payload, sc_core::sc_time& delay);
    unsigned transport_dbg(Payload& payload);
    bool get_direct_mem_ptr(Payload& payload, ::tlm::tlm_dmi& dmi);
    ::tlm::tlm_response_status judge(const Payload& payload) const;
    void access(Payload& payload, unsigned i, sc_core::sc_time& delay);

    void line_moved() override;
    void plan_outputs();
    void drive_outputs();
    void follow_reset();
    void follow_xcts();
    bool held() const { return reset.size() != 0 && reset[0]->read(); }

    const ChipSettings settings_;
    std::unique_ptr<dpchip_chip, Destroy> chip_;
    std::unique_ptr<Line> own_line_;
    std::deque<Edge> edges_;  ///< not yet at the kernel's time
    sc_core::sc_event output_due_{"output_due"};
};

}  // namespace dpchip::tlm
