// SPDX-License-Identifier: Apache-2.0
// An 80C32 with external memory: 64 KB EPROM behind PSEN, 32 KB RAM, and the chip at 0000H (figure 8-4; APC3 manual figure 6.2).
//
// A latch makes A7..A0 for the memories; the chip has its own. The address decoder gives the RAM the upper half, A15 = 1, and
// must leave the chip's 2 KB alone. Every access has instruction fetches before and after it: their ALEs and addresses pass the
// chip by. The processor has its own 16 MHz crystal; figures of the standard 16 MHz type (mcs51.hpp).
#include "board.hpp"
#include "mcs51.hpp"

namespace boards {

// clang-format off
Plan board_80c32_memory() {
    return {
        .name = "80c32_memory", .processor = "80C32 with EPROM and RAM", .figure = "2 KB at 0000H (figure 8-4)",
        .wiring = join({data_bus({"AD0", "AD1", "AD2", "AD3", "AD4", "AD5", "AD6", "AD7"}),
        {
            from("A8",  PinId::ab0), from("A9",  PinId::ab1), from("A10", PinId::ab2),  // the page in the window
            from("A11", PinId::ab3), from("A12", PinId::ab4), from("A13", PinId::ab5), from("A14", PinId::ab6), from("A15", PinId::ab7),
            pull_down("1 kOhm", PinId::ab8), pull_down("1 kOhm", PinId::ab9), pull_down("1 kOhm", PinId::ab10),
            pull_up("3.3 kOhm", PinId::xcs_ab11),                                       // not used with 2 KB
            from("ALE", PinId::ale_as_ab11), from("XRD", PinId::xrd_r_w), from("XWR", PinId::xwr_e_clock_ab11),
            to("INT0", PinId::x_int),
            pull_up("3.3 kOhm", PinId::mode), on_gnd(PinId::xint_mot),                  // synchronous Intel
            pull_down("1 kOhm", PinId::divider),                                        // CLKOUT2/4 is left open
            from("RESET", PinId::reset),
        }}),
        .crystal_hz = 16'000'000,
        .base = 0x0000, .selected = {0x0000, 0x07FF}, .swept = {0x0000, 0xFFFF},
        .memory = Range{0x8000, 0xFFFF},
        .make = [](Circuit& c, Ticks period) {
            return std::make_unique<Mcs51>(c, period, kMcs51Standard, ExternalMemory{.ram = {.mask = 0x8000, .value = 0x8000}});
        },
    };
}
// clang-format on

}  // namespace boards
