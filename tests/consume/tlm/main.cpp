// SPDX-License-Identifier: Apache-2.0
// A SystemC platform of somebody else that uses the installed modules.
#include <dpchip/tlm/chip.hpp>

#include <tlm_utils/simple_initiator_socket.h>

struct Cpu : sc_core::sc_module {
    explicit Cpu(const sc_core::sc_module_name& name) : sc_module{name} {}
    tlm_utils::simple_initiator_socket<Cpu> bus{"bus"};
};

int sc_main(int, char*[]) {
    Cpu cpu{"cpu"};
    dpchip::tlm::Chip chip{"chip"};
    sc_core::sc_signal<bool> x_int{"x_int", true}, xdataexch{"xdataexch", true};
    cpu.bus.bind(chip.bus);
    chip.x_int(x_int);
    chip.xdataexch_sync(xdataexch);
    sc_core::sc_start(1, sc_core::SC_MS);
    return chip.info().online == 0 && x_int.read() ? 0 : 1;
}
