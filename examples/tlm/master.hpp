// SPDX-License-Identifier: Apache-2.0
// A DP master as a SystemC thread: telegrams out, answers in.
#pragma once

#include <cstdio>
#include <sstream>

#include <dpchip/tlm/line_if.hpp>

struct Master : sc_core::sc_module {
    sc_core::sc_port<dpchip::tlm::LineMasterIf> line{"line"};
    dpchip::tlm::Telegram answer;  ///< the last one

    explicit Master(const sc_core::sc_module_name& name) : sc_module{name} {
        using SC_CURRENT_USER_MODULE = Master;
        SC_THREAD(run);
    }

private:
    void run() {
        wait(35, sc_core::SC_MS);  // the chip's search has come to 1.5 Mbit/s
        tell("FDL_Status", {0x10, 0x08, 0x02, 0x49, 0x53, 0x16});  // proves the rate; the first one is not answered
        tell("FDL_Status", {0x10, 0x08, 0x02, 0x49, 0x53, 0x16});
        tell("Set_Prm", {0x68, 12, 12, 0x68, 0x88, 0x82, 0x6D, 0x3D, 0x3E, 0x80, 0x01, 0x01, 0x0B, 0x47, 0x11, 0x00, 0xD7, 0x16});
        tell("Chk_Cfg", {0x68, 7, 7, 0x68, 0x88, 0x82, 0x5D, 0x3E, 0x3E, 0x11, 0x21, 0x15, 0x16});
        tell("Data_Exchange", {0x68, 5, 5, 0x68, 0x08, 0x02, 0x7D, 0x12, 0x34, 0xCD, 0x16});
        tell("Data_Exchange", {0x68, 5, 5, 0x68, 0x08, 0x02, 0x5D, 0x12, 0x34, 0xAD, 0x16});
    }
    void tell(const char* what, const dpchip::tlm::Octets& request) {
        std::ostringstream text;
        if (line->exchange(request, answer, {200, sc_core::SC_US})) text << answer;
        else text << "silence";
        std::printf("%-14s %s\n", what, text.str().c_str());
        wait(1, sc_core::SC_MS);
    }
};
