// SPDX-License-Identifier: Apache-2.0
// The package's pins as waveforms: trace/ draws what pins/ says, neither knows the other.
#include <algorithm>
#include <sstream>

#include <gtest/gtest.h>

#include <dpchip/pins/bus_cycles.hpp>
#include <dpchip/pins/package.hpp>
#include <dpchip/trace/vcd_pins.hpp>

namespace dpchip::pins {
namespace {

using namespace core::literals;

TEST(PinsAsWaveforms, every_pin_but_the_supply_has_a_signal_of_its_name) {
    std::ostringstream out;
    trace::VcdWriter vcd{out, {.timescale = {1'000'000}}};
    trace::VcdPins<kPins> pins{vcd, "chip", kPinTable};
    EXPECT_EQ(vcd.signals(), kPins - 6);
    pins.edge(PinEdge{10_ns, PinId::txd, PinLevel::z});
    pins.edge(PinEdge{20_ns, PinId::txd, PinLevel::high});
    pins.edge(PinEdge{30_ns, PinId::xready_xdtack, PinLevel::low});
    pins.edge(PinEdge{40_ns, PinId::vdd_18, PinLevel::low});
    vcd.finish(50_ns);
    const std::string text = out.str();
    for (const char* name : {" X_INT ", " XREADY_XDTACK ", " TXD ", " DB7 ", " CLKOUT2_4 ", " AB0 "}) EXPECT_NE(text.find(name), std::string::npos) << name;
    EXPECT_EQ(text.find("VSS"), std::string::npos);
    const std::size_t body = text.find("#10\n");
    ASSERT_NE(body, std::string::npos);
    const std::string changes = text.substr(body);
    EXPECT_EQ(std::count(changes.begin(), changes.end(), '\n'), 7) << changes;
    EXPECT_EQ(changes.substr(4, 1), "z");
}

TEST(PinsAsWaveforms, a_package_that_is_powered_up_and_clocked_draws_its_clock_output) {
    using Part = Package<core::NoTrace>;
    Part package{regmap::Variant::vpc3c, Supply::v5};
    BusCycles<core::NoTrace> board{package, ProcessorMode::async_intel, false};
    package.watch(PinId::clkout, true);
    package.watch(PinId::x_int, true);
    board.power_up(1_us);
    std::ostringstream out;
    trace::VcdWriter vcd{out};
    trace::VcdPins<kPins> pins{vcd, "chip", kPinTable};
    std::size_t edges = 0;
    for (int n = 0; n < 40; ++n) {
        board.advance(package.now() + 100_ns);
        for (; !package.edges().empty(); ++edges) pins.edge(package.edges().pop());
    }
    vcd.finish(package.now());
    EXPECT_GT(edges, 50u);
    EXPECT_EQ(vcd.late(), 0u);
    EXPECT_GE(vcd.changes() + 2, edges);
}

}  // namespace
}  // namespace dpchip::pins
