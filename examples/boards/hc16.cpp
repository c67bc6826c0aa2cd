// SPDX-License-Identifier: Apache-2.0
// A 68HC16Z1 with AS as strobe and XDTACK as its DSACK0. The manual has no drawing; this board is ours.
//
// Asynchronous Motorola mode. An 8-bit port lies on D15..D8. A 74AC138 (at most 9.5 ns) makes XCS of A19..A14: 16 KB at 84000H, in
// which the 2 KB appear eight times. XDTACK is never high-resistance, so DSACK0 belongs to the chip alone. 16.78 MHz; figures of
// the processor: hc16.hpp.
#include "board.hpp"
#include "hc16.hpp"

namespace boards {

// clang-format off
Plan board_hc16() {
    return {
        .name = "hc16", .processor = "68HC16Z1", .figure = "16 KB decoded at 84000H",
        .wiring = join({data_bus({"D8", "D9", "D10", "D11", "D12", "D13", "D14", "D15"}),
                        address_bus(0, {"A0", "A1", "A2", "A3", "A4", "A5", "A6", "A7", "A8", "A9", "A10"}),
        {
            from("XCS", PinId::xcs_ab11), from("XAS", PinId::ale_as_ab11), from("R/W", PinId::xrd_r_w),
            pull_down("1 kOhm", PinId::xwr_e_clock_ab11),                               // not used with 2 KB
            to("XDSACK0", PinId::xready_xdtack), to("IRQ6", PinId::x_int),
            on_gnd(PinId::mode), on_vdd(PinId::xint_mot),                               // asynchronous Motorola
            on_gnd(PinId::divider),
            from("RESET", PinId::reset),
        }}),
        .crystal_hz = 16'777'216,
        .base = 0x84000, .selected = {0x84000, 0x87FFF}, .swept = {0x00000, 0xFFFFF}, .step = 0x800,
        .interrupt_line = "IRQ6",
        .make = [](Circuit& c, Ticks period) { return std::make_unique<Hc16>(c, period, Decoder{.mask = 0xFC000, .value = 0x84000, .delay = 9.5_ns}); },
        .bus_mode = driver::BusMode::motorola,
    };
}
// clang-format on

}  // namespace boards
