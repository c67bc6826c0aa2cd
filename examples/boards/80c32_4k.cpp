// SPDX-License-Identifier: Apache-2.0
// An 80C32 and the chip with 4 KB at 2000H (figures 8-8, 8-9).
//
// With 4 KB pin 1 is AB11 and carries A11; AB3 has no line left and lies on GND. The inverter in A13 makes the start address
// 2000H. The processor runs with 24 MHz of CLKOUT2/4 (DIVIDER on VDD). Figures of the processor: a 24 MHz type (mcs51.hpp);
// those of a standard type would miss parameters 3, 4, 7, 14 and 15 here.
#include "board.hpp"
#include "mcs51.hpp"

namespace boards {

// clang-format off
Plan board_80c32_4k() {
    return {
        .name = "80c32_4k", .processor = "80C32 for 24 MHz", .figure = "4 KB at 2000H (figure 8-8)",
        .wiring = join({data_bus({"AD0", "AD1", "AD2", "AD3", "AD4", "AD5", "AD6", "AD7"}),
        {
            from("A8",  PinId::ab0), from("A9", PinId::ab1), from("A10", PinId::ab2),  // the page in the window
            from("A11", PinId::xcs_ab11),                                              // AB11
            on_gnd(PinId::ab3),
            from("A12", PinId::ab4),
            from_inverted("A13", PinId::ab5),                                          // 2000H
            from("A14", PinId::ab6), from("A15", PinId::ab7),
            pull_down("1 kOhm", PinId::ab8), pull_down("1 kOhm", PinId::ab9), pull_down("1 kOhm", PinId::ab10),
            from("ALE", PinId::ale_as_ab11), from("XRD", PinId::xrd_r_w), from("XWR", PinId::xwr_e_clock_ab11),
            to("INT0", PinId::x_int),
            pull_up("3.3 kOhm", PinId::mode), on_gnd(PinId::xint_mot),                 // synchronous Intel
            on_vdd(PinId::divider), to("XTAL1", PinId::clkout),                        // 24 MHz
            from("RESET", PinId::reset),
        }}),
        .base = 0x2000, .selected = {0x2000, 0x2FFF}, .swept = {0x0000, 0xFFFF},
        .make = [](Circuit& c, Ticks period) { return std::make_unique<Mcs51>(c, period, kMcs51Fast); },
        .ram = driver::RamSize::bytes_4096,
    };
}
// clang-format on

}  // namespace boards
