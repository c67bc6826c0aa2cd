// SPDX-License-Identifier: Apache-2.0
// An 80C165 on its demultiplexed 8-bit bus, with one of its chip selects and READY (figure 8-10; APC3 manual figure 6.6).
//
// Asynchronous Intel mode. The chip select has 4 KB at 200000H, its smallest size, so that the 2 KB appear twice. 20 MHz CPU
// clock, one programmed wait state, then READY decides. Figures of the processor: c165.hpp.
#include "board.hpp"
#include "c165.hpp"

namespace boards {

// clang-format off
Plan board_80c165() {
    return {
        .name = "80c165", .processor = "80C165", .figure = "chip select of 4 KB at 200000H (figure 8-10)",
        .wiring = join({data_bus({"D0", "D1", "D2", "D3", "D4", "D5", "D6", "D7"}),
                        address_bus(0, {"A0", "A1", "A2", "A3", "A4", "A5", "A6", "A7", "A8", "A9", "A10"}),
        {
            from("XCS1", PinId::xcs_ab11), from("XRD", PinId::xrd_r_w), from("XWRL", PinId::xwr_e_clock_ab11),
            pull_down("1 kOhm", PinId::ale_as_ab11),                                    // not used with 2 KB
            to("XREADY", PinId::xready_xdtack), to("EX0IN", PinId::x_int),
            pull_down("1 kOhm", PinId::mode), pull_down("1 kOhm", PinId::xint_mot),     // asynchronous Intel
            on_gnd(PinId::divider),
            from("RESET", PinId::reset),
        }}),
        .crystal_hz = 20'000'000,
        .base = 0x200000, .selected = {0x200000, 0x200FFF}, .swept = {0x000000, 0xFFFFFF}, .step = 0x800,
        .interrupt_line = "EX0IN",
        .make = [](Circuit& c, Ticks period) { return std::make_unique<C165>(c, period, Decoder{.mask = 0xFFF000, .value = 0x200000}, 1); },
    };
}
// clang-format on

}  // namespace boards
