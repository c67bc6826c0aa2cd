// SPDX-License-Identifier: Apache-2.0
// A 68HC11 clocked by the chip: CLKOUT2/4 = 12 MHz is four times E = 3 MHz (8.1.2). The manual has no drawing; this board is ours.
//
// Synchronous Motorola mode, E is the strobe. The bus is multiplexed: a 74AC373, open while AS is high, makes A7..A0. A 74AC138
// makes XCS of A15..A11: 2 KB at 2000H. Figures of the processor: the formulas for the E series, which are a little worse at
// 3 MHz than its 3 MHz column (hc11.hpp).
#include "board.hpp"
#include "hc11.hpp"

namespace boards {

// clang-format off
Plan board_hc11() {
    return {
        .name = "hc11", .processor = "68HC11E, E = 3 MHz", .figure = "2 KB at 2000H",
        .wiring = join({data_bus({"AD0", "AD1", "AD2", "AD3", "AD4", "AD5", "AD6", "AD7"}),
                        address_bus(0, {"A0", "A1", "A2", "A3", "A4", "A5", "A6", "A7", "A8", "A9", "A10"}),
        {
            from("XCS", PinId::xcs_ab11), from("E", PinId::xwr_e_clock_ab11), from("R/W", PinId::xrd_r_w),
            pull_down("1 kOhm", PinId::ale_as_ab11),                                    // not used with 2 KB
            to("IRQ", PinId::x_int),
            on_vdd(PinId::mode), on_vdd(PinId::xint_mot),                               // synchronous Motorola
            on_gnd(PinId::divider), to("EXTAL", PinId::clkout),                         // 12 MHz
            from("RESET", PinId::reset),
        }}),
        .clock_line = "EXTAL",
        .base = 0x2000, .selected = {0x2000, 0x27FF}, .swept = {0x0000, 0xFFFF},
        .interrupt_line = "IRQ",
        .make = [](Circuit& c, Ticks period) { return std::make_unique<Hc11>(c, period, Decoder{.mask = 0xF800, .value = 0x2000, .delay = 10_ns}); },
        .bus_mode = driver::BusMode::motorola,
    };
}
// clang-format on

}  // namespace boards
