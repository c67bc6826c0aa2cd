// SPDX-License-Identifier: Apache-2.0
// A DP slave as a virtual platform: a processor, the chip on its bus, a line, and a master that takes the slave to data
// exchange. The firmware is C++20 and SystemC is C++17, so they meet at three C functions.
#include <cstdio>

#include <dpchip/tlm/chip.hpp>

#include "cpu.hpp"
#include "master.hpp"

using namespace dpchip::tlm;

static Cpu* cpu;
uint8_t bus_read(uint16_t address) { return cpu->access(::tlm::TLM_READ_COMMAND, address); }
void bus_write(uint16_t address, uint8_t value) { cpu->access(::tlm::TLM_WRITE_COMMAND, address, value); }

int sc_main(int, char*[]) {
    tlm_utils::tlm_quantumkeeper::set_global_quantum({10, sc_core::SC_US});
    ChipSettings settings;
    settings.variant = "vpc3+c";
    settings.options = {{"baud_probe_ms", "10"}};  // the search for the baud rate tries each for 10 ms

    Line line{"line", 1'500'000};
    Chip chip{"chip", settings};
    Cpu processor{"cpu"};
    Master master{"master"};
    sc_core::sc_signal<bool> x_int{"x_int", true}, xdataexch{"xdataexch", true};

    cpu = &processor;
    processor.bus.bind(chip.bus);
    processor.x_int(x_int);
    chip.x_int(x_int);
    chip.xdataexch_sync(xdataexch);
    chip.line(line);
    master.line(line);

    sc_core::sc_start(50, sc_core::SC_MS);
    std::printf("XDATAEXCH is %s\n", xdataexch.read() ? "high" : "low: data exchange");
    const Octets inputs_are_the_outputs{0x68, 5, 5, 0x68, 0x02, 0x08, 0x08, 0x12, 0x34, 0x58, 0x16};
    return master.answer.octets == inputs_are_the_outputs && !xdataexch.read() ? 0 : 1;
}
