// SPDX-License-Identifier: Apache-2.0
// The package's pins and the first cycles on them.
#include <gtest/gtest.h>

#include <dpchip/pins/bus_cycles.hpp>

namespace {

using namespace dpchip;
using namespace dpchip::core::literals;
using pins::PinId;
using pins::PinLevel;

TEST(Cycles, write_and_read_back_in_every_mode) {
    for (const auto mode : {regmap::ProcessorMode::async_intel, regmap::ProcessorMode::sync_intel, regmap::ProcessorMode::async_motorola, regmap::ProcessorMode::sync_motorola}) {
        pins::Package<> p;
        pins::BusCycles<> bus{p, mode};
        bus.power_up();
        for (unsigned a = 0x16; a < 0x800; a += 7) bus.write(static_cast<std::uint16_t>(a), static_cast<std::uint8_t>(a * 5));
        for (unsigned a = 0x16; a < 0x800; a += 7) ASSERT_EQ(bus.read(static_cast<std::uint16_t>(a)), static_cast<std::uint8_t>(a * 5 )) << a << ' ' << regmap::name(mode);
        EXPECT_TRUE(p.findings().empty());
        while (!p.findings().empty()) { auto f = p.findings().pop(); std::printf("%u %x\n", f.rule, f.detail); }
    }
}
}  // namespace
