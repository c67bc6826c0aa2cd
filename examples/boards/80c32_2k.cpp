// SPDX-License-Identifier: Apache-2.0
// The smallest system: an 80C32 with program memory of its own and the chip, at 1000H with 2 KB (figures 8-3, 8-6, 8-7; APC3
// manual figures 6.1, 6.4, 6.5).
//
// Synchronous Intel mode: the chip latches A7..A0 with ALE and selects itself when AB10..AB3 are 0. The inverter in A12 makes
// that 1000H; which line has it follows from the start address. CLK has the 48 MHz oscillator, the processor gets 12 MHz of it.
// Figures of the processor: the standard 12 MHz type (mcs51.hpp).
#include "board.hpp"
#include "mcs51.hpp"

namespace boards {

// clang-format off
Plan board_80c32_2k() {
    return {
        .name = "80c32_2k", .processor = "80C32", .figure = "2 KB at 1000H (figures 8-3, 8-6)",
        .wiring = join({data_bus({"AD0", "AD1", "AD2", "AD3", "AD4", "AD5", "AD6", "AD7"}),
        {
            from("A8",  PinId::ab0), from("A9", PinId::ab1), from("A10", PinId::ab2),  // the page in the window
            from("A11", PinId::ab3),
            from_inverted("A12", PinId::ab4),                                          // 1000H
            from("A13", PinId::ab5), from("A14", PinId::ab6), from("A15", PinId::ab7),
            pull_down("1 kOhm", PinId::ab8), pull_down("1 kOhm", PinId::ab9), pull_down("1 kOhm", PinId::ab10),
            pull_up("3.3 kOhm", PinId::xcs_ab11),                                      // not used with 2 KB
            from("ALE", PinId::ale_as_ab11), from("XRD", PinId::xrd_r_w), from("XWR", PinId::xwr_e_clock_ab11),
            to("INT0", PinId::x_int),
            pull_up("3.3 kOhm", PinId::mode), on_gnd(PinId::xint_mot),                 // synchronous Intel
            on_gnd(PinId::divider), to("XTAL1", PinId::clkout),                        // 12 MHz
            from("RESET", PinId::reset),
        }}),
        .base = 0x1000, .selected = {0x1000, 0x17FF}, .swept = {0x0000, 0xFFFF},
        .make = [](Circuit& c, Ticks period) { return std::make_unique<Mcs51>(c, period, kMcs51Standard); },
    };
}
// clang-format on

}  // namespace boards
