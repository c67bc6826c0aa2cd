// SPDX-License-Identifier: Apache-2.0
// A package and what tests ask of it: its findings in words, the edges of a pin, a trace of the accesses inside.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <dpchip/pins/bus_cycles.hpp>
#include <dpchip/regmap/fact.hpp>
#include <dpchip/trace/pin_finding_text.hpp>

namespace dpchip::test {

using core::Ticks;
using pins::PinId;
using pins::PinLevel;
using regmap::ProcessorMode;
using regmap::Supply;

inline constexpr std::array<ProcessorMode, 4> kModes{ProcessorMode::async_intel, ProcessorMode::sync_intel, ProcessorMode::async_motorola,
                                                     ProcessorMode::sync_motorola};

/// The names of the rules, oldest first, with the pin or the number of the parameter: "timing 6, floating_input 30".
inline std::string findings(pins::Package<>& package) {
    std::string all;
    while (!package.findings().empty()) {
        const core::Finding f = package.findings().pop();
        const auto rule = static_cast<regmap::PinRule>(f.rule);
        const bool timing = rule == regmap::PinRule::timing || rule == regmap::PinRule::system_timing;
        const std::uint32_t which = timing ? regmap::unpack_violation(f.detail).number : f.detail;
        all += (all.empty() ? "" : ", ") + std::string{regmap::info(rule).name} + (which == 0 && !timing ? "" : ' ' + std::to_string(which));
    }
    return all;
}

/// A package that remembers what its chip was asked.
struct Part {
    explicit Part(ProcessorMode mode, bool with_ab11 = false, Supply supply = Supply::v5, regmap::Variant variant = regmap::Variant::vpc3c,
                  const pins::PackageOptions& options = {})
        : package{variant, supply, {}, options}, bus{package, mode, with_ab11} {
        package.chip().trace().attach(ring);
        bus.power_up();
        bus.settle();
    }
    Part(const Part&) = delete;
    Part& operator=(const Part&) = delete;

    void set(PinId pin, int level) { package.set_pin(pin, level != 0 ? PinLevel::high : PinLevel::low); }
    void wait(Ticks t) { bus.advance(package.now() + t); }
    PinLevel pin(PinId p) const { return package.pin(p); }

    /// Accesses of the chip inside since the last call.
    std::vector<core::TraceRecord> accesses() {
        std::vector<core::TraceRecord> found;
        const std::uint64_t count = package.chip().trace().count;
        for (std::uint64_t i = std::max(seen, count > ring.size() ? count - ring.size() : 0); i < count; ++i) {
            const core::TraceRecord& r = ring[i % ring.size()];
            if (r.what == static_cast<std::uint16_t>(regmap::Fact::cpu_read) || r.what == static_cast<std::uint16_t>(regmap::Fact::cpu_write)) found.push_back(r);
        }
        seen = count;
        return found;
    }
    /// Levels that `p` has taken since the last call, with their times.
    std::vector<pins::PinEdge> edges(PinId p) {
        std::vector<pins::PinEdge> found;
        while (!package.edges().empty()) {
            const pins::PinEdge e = package.edges().pop();
            if (e.pin == p) found.push_back(e);
        }
        return found;
    }
    std::string findings() { return test::findings(package); }

    std::vector<core::TraceRecord> ring = std::vector<core::TraceRecord>(1024);
    std::uint64_t seen = 0;
    pins::Package<> package;
    pins::BusCycles<> bus;
};

}  // namespace dpchip::test
