// SPDX-License-Identifier: Apache-2.0
// The part itself: 44 pins as SystemC ports, bus cycles by strobes with the timing of the data sheet, the line bit by bit
// (VPC3+C chapters 3, 8, 10; APC3 chapters 2, 6). Ports bear the names of the package drawing; XTEST0 low makes every
// output high-resistance, as on the part.
//
// Pins that are left unbound are tied: inputs as an idle board holds them (XCS, XRD, XWR, XTEST0, XTEST1, RXD and VDD 1,
// the others 0), outputs and DB to nothing. CLK unbound means that the part has a 48 MHz clock of its own with the phase
// of the settings, which is exact and costs no events; CLK bound means that rising edges there set the phase.
//
// Z at an input is Z; X is taken for Z, because nobody drives a defined level, except that a signal which has been X since
// the start counts as idle. Inputs that change in one delta cycle change at the same time.
//
// Not modelled: volts, currents, slopes, test modes behind XTEST1.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <systemc>

#include <dpchip/dpchip_pins.h>
#include <dpchip/tlm/time.hpp>

namespace dpchip::tlm {

struct PackageSettings {
    std::string variant = "vpc3+c";  ///< as dpchip_pins_create() takes it
    int millivolts = 3300;           ///< VDD: 3300 or 5000
    Ticks clock_phase = 0;           ///< of the part's own clock: rising edges there and every 1250 ticks; 0 .. 1249
    std::vector<std::pair<std::string, std::string>> options{};  ///< dpchip_pins_set_option(): name, value
};

class Package : public sc_core::sc_module {
public:
    using In = sc_core::sc_in<sc_dt::sc_logic>;
    using Out = sc_core::sc_out<sc_dt::sc_logic>;

    // processor
    sc_core::sc_vector<In> ab{"AB", 11};
    sc_core::sc_vector<sc_core::sc_inout_resolved> db{"DB", 8};
    In xcs_ab11{"XCS_AB11"}, xwr_e_clock_ab11{"XWR_E_CLOCK_AB11"}, xrd_r_w{"XRD_R_W"}, ale_as_ab11{"ALE_AS_AB11"};
    Out xready_xdtack{"XREADY_XDTACK"}, x_int{"X_INT"}, xdataexch_sync{"XDATAEXCH_SYNC"};
    // straps, clock, reset, test
    In xint_mot{"XINT_MOT"}, mode{"MODE"}, divider{"DIVIDER"}, clk{"CLK"}, reset{"RESET"}, xtest0{"XTEST0"}, xtest1{"XTEST1"};
    Out clkout{"CLKOUT2_4"};
    // line
    In rxd{"RXD"}, xcts{"XCTS"};
    Out txd{"TXD"}, rts{"RTS"};
    // supply
    sc_core::sc_vector<In> vss{"VSS", 4}, vdd{"VDD", 2};

    explicit Package(const sc_core::sc_module_name& name, const PackageSettings& settings = {});
    ~Package() override;

    /// What the processor would read, without side effects and without a cycle.
    std::uint8_t peek(std::uint16_t chip_address) const { return dpchip_pins_peek(part_.get(), chip_address); }
    /// How often timing parameter `number` (1 to 60) was violated; 0: all of them.
    std::int64_t violations(int number = 0) const { return dpchip_pins_violations(part_.get(), number); }
    /// The part of the C API, for what this class does not offer. Do not move its pins or its time.
    dpchip_pins* handle() { return part_.get(); }

private:
    struct Destroy {
        void operator()(dpchip_pins* part) const { dpchip_pins_destroy(part); }
    };
    struct Input {
        int pin;
        In* port;
        int level;            ///< as the part was told last; at first as an idle board holds it
        bool driven = false;  ///< somebody has written the signal: until then it is X
    };
    struct Output {
        int pin;
        Out* port;
    };
    struct Data {
        int pin;
        sc_core::sc_inout_resolved* port;
        int driven;  ///< by the part, as it is on the signal now
        int level;   ///< by the board, as the part was told last
    };

    void before_end_of_elaboration() override;
    void start_of_simulation() override;

    void list_pins();
    void step();
    void check(int code);
    void plan();
    void take_inputs();
    static int from_board(const sc_dt::sc_logic& resolved, const Data& data);
    void show_outputs();
    void show(int pin, int level);

    std::unique_ptr<dpchip_pins, Destroy> part_;
    std::vector<Input> inputs_;
    std::vector<Output> outputs_;
    std::vector<Data> data_;
    std::vector<std::unique_ptr<sc_core::sc_interface>> ties_;  ///< signals of pins that were left unbound
    sc_core::sc_event wake_{"wake"};
    bool shown_ = false;    ///< outputs have been written
    bool stopped_ = false;  ///< a violation was fatal
};

}  // namespace dpchip::tlm
