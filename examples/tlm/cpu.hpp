// SPDX-License-Identifier: Apache-2.0
// A processor as small as can be: it runs the firmware, reaches the bus by TLM transactions, and sleeps until X/INT.
#pragma once

#include <cstdint>

#include <systemc>
#include <tlm>
#include <tlm_utils/simple_initiator_socket.h>
#include <tlm_utils/tlm_quantumkeeper.h>

extern "C" {
#include "../firmware.h"
}

struct Cpu : sc_core::sc_module {
    tlm_utils::simple_initiator_socket<Cpu> bus{"bus"};
    sc_core::sc_in<bool> x_int{"x_int"};

    explicit Cpu(const sc_core::sc_module_name& name) : sc_module{name} {
        using SC_CURRENT_USER_MODULE = Cpu;
        SC_THREAD(run);
    }

    std::uint8_t access(tlm::tlm_command command, std::uint16_t address, std::uint8_t octet = 0) {
        tlm::tlm_generic_payload payload;
        payload.set_command(command);
        payload.set_address(address);
        payload.set_data_ptr(&octet);
        payload.set_data_length(1);
        payload.set_streaming_width(1);
        sc_core::sc_time ahead = time_.get_local_time();
        bus->b_transport(payload, ahead);
        if (payload.is_response_error()) SC_REPORT_ERROR("/cpu", payload.get_response_string().c_str());
        time_.set(ahead);
        return octet;
    }

private:
    void run() {
        time_.reset();
        firmware_init(8, 0x4711);
        for (;;) {
            time_.sync();
            if (x_int.read()) sc_core::wait(x_int.negedge_event());
            firmware_isr();
            firmware_main_loop();
        }
    }
    tlm_utils::tlm_quantumkeeper time_;
};
