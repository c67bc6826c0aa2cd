// SPDX-License-Identifier: Apache-2.0
// A processor whose write strobe is 1 ns too short, at the pins of the chip: what the data sheet says about it.
#include <cstdio>

#include <dpchip/pins/bus_cycles.hpp>
#include <dpchip/trace/pin_finding_text.hpp>

using namespace dpchip;
using namespace dpchip::core::literals;

int main() {
    pins::Package<> part{regmap::Variant::vpc3c, regmap::Supply::v5};
    pins::BusCycles<> bus{part, regmap::ProcessorMode::async_intel};
    bus.power_up();
    bus.times().of[29] = 82_ns;  // XWR pulse width
    bus.times().wait_for_ready = false;
    bus.write(0x40, 0x5A);
    bus.settle();

    while (!part.findings().empty()) {
        const core::Finding f = part.findings().pop();
        std::printf("%s\n", trace::pin_finding_text(f.rule, f.detail).c_str());
    }
    std::printf("40H reads %02X all the same\n", bus.read(0x40));
    return part.violations(29) == 1 && part.violations(0) == 1 ? 0 : 1;
}
