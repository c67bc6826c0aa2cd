// SPDX-License-Identifier: Apache-2.0
// An 80286 with its word accesses: A0 goes nowhere, A1 is the chip's AB0, and only the low octet counts (figure 8-5, 8.1.2; APC3
// manual figure 6.3).
//
// Asynchronous Intel mode. A PAL (25 ns) makes XCS of A23..A12: 4 KB at E0000H, which are 2 KB of the chip two addresses apart. The
// ready logic gives XREADY, which is never high-resistance, to ARDY of the 82284 while XCS is low. The interrupt goes to an 8259,
// which wants it high: INT_Pol = 1. Figures of processor and bus controller at 8 MHz: i80286.hpp.
#include "board.hpp"
#include "i80286.hpp"

namespace boards {

// clang-format off
Plan board_80286() {
    return {
        .name = "80286", .processor = "80286", .figure = "word stride at E0000H (figure 8-5)",
        .wiring = join({data_bus({"D0", "D1", "D2", "D3", "D4", "D5", "D6", "D7"}),
                        address_bus(0, {"A1", "A2", "A3", "A4", "A5", "A6", "A7", "A8", "A9", "A10", "A11"}),
        {
            from("XCS", PinId::xcs_ab11), from("XMRDC", PinId::xrd_r_w), from("XMWTC", PinId::xwr_e_clock_ab11),
            pull_down("1 kOhm", PinId::ale_as_ab11),                                    // not used with 2 KB
            to("XREADY", PinId::xready_xdtack), to("IR3", PinId::x_int),
            on_gnd(PinId::mode), on_gnd(PinId::xint_mot),                               // asynchronous Intel
            on_gnd(PinId::divider),
            from("RESET", PinId::reset),
        }}),
        .crystal_hz = 8'000'000,
        .base = 0xE0000, .stride = 2, .selected = {0xE0000, 0xE0FFF}, .swept = {0x000000, 0xFFFFFF}, .step = 0x800,
        .interrupt_line = "IR3", .interrupt_level = PinLevel::high,
        .make = [](Circuit& c, Ticks period) {
            return std::make_unique<I80286>(c, period, Decoder{.mask = 0xFFF000, .value = 0x0E0000, .delay = 25_ns});
        },
        .int_polarity = driver::IntPolarity::high,
    };
}
// clang-format on

}  // namespace boards
