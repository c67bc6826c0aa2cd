// SPDX-License-Identifier: Apache-2.0
// The 14 times that the chip owes, over all 1250 phases of CLK against the strobe, at both supplies; extremes are printed.
#include <gtest/gtest.h>

#include <algorithm>
#include <bitset>
#include <cstdio>
#include <map>
#include <string>

#include <dpchip/pins/bus_cycles.hpp>

namespace {

using namespace dpchip;
using namespace dpchip::core::literals;
using core::Ticks;
using pins::PinId;
using pins::PinLevel;
using regmap::BusEvent;
using regmap::Cycle;
using regmap::ProcessorMode;
using regmap::Supply;
using regmap::TimingKind;

struct Extremes {
    Ticks least = core::kNever, most{-1};
    void add(Ticks t) { least = std::min(least, t); most = std::max(most, t); }
};

/// What the outputs do in one cycle: the time of the strobe's edge to the output's.
struct Answer {
    Ticks data_valid{-1}, data_z{-1}, ready_falls{-1}, ready_rises{-1};
};

class Bench {
public:
    Bench(ProcessorMode mode, Supply supply) : package_{regmap::Variant::vpc3c, supply}, bus_{package_, mode} {
        bus_.power_up();
        bus_.write(0x155, 0x0F);
        bus_.times() = pins::BusTimes::at_limits(mode, supply);
        // Long enough that ready comes before a write strobe is over.
        for (const unsigned n : {12u, 29u, 59u}) bus_.times().of[n] = 140_ns;
        for (const unsigned n : {6u, 18u, 45u, 31u}) bus_.times().of[n] = std::max(bus_.times().of[n], 140_ns);
    }
    void set_early_ready(bool on) {
        const auto motorola = regmap::motorola(bus_.mode());
        bus_.write(motorola ? 0x07 : 0x06, on ? 0x20 : 0x00);
        bus_.settle();
    }
    /// One cycle whose strobe begins `phase` after a multiple of CLK.
    Answer cycle(Cycle kind, Ticks phase) {
        const Ticks lead = 1_us;
        bus_.advance(Ticks{(package_.now().n / 1250 + 2) * 1250});
        drain();
        const Ticks start = package_.now();
        // The strobe keeps its distance to the start of the cycle; found once, it is aimed at.
        bus_.advance(start + lead + phase - distance_);
        if (kind == Cycle::read) bus_.read(0x155);
        else bus_.write(0x156, 0x33);
        bus_.settle();
        const Ticks hit = (bus_.strobe_began() - phase) % core::kClk;
        if (hit != Ticks{}) {
            distance_ = (distance_ + hit) % core::kClk;
            return cycle(kind, phase);
        }
        return answer();
    }
    pins::BusCycles<>& bus() { return bus_; }
    pins::Package<>& package() { return package_; }

private:
    void drain() { while (!package_.edges().empty()) package_.edges().pop(); }
    Answer answer() {
        Answer a;
        while (!package_.edges().empty()) {
            const pins::PinEdge e = package_.edges().pop();
            const bool low = e.level == PinLevel::low;
            if (e.pin == PinId::xready_xdtack) (low ? a.ready_falls : a.ready_rises) = e.at - (low ? bus_.strobe_began() : bus_.strobe_ended());
            if (e.pin == PinId::db0 && e.level == PinLevel::z) a.data_z = e.at - bus_.strobe_ended();
            if (e.pin == PinId::db0 && e.level != PinLevel::z) a.data_valid = e.at - bus_.strobe_began();
        }
        return a;
    }

    pins::Package<> package_;
    pins::BusCycles<> bus_;
    Ticks distance_{};
};

/// Extremes of every promise of a mode, by number.
std::map<unsigned, Extremes> measure(ProcessorMode mode, Supply supply) {
    std::map<unsigned, Extremes> found;
    Bench bench{mode, supply};
    for (const bool early : {false, true}) {
        bench.set_early_ready(early);
        for (std::int64_t phase = 0; phase < core::kClk.n; ++phase) {
            for (const Cycle kind : {Cycle::read, Cycle::write}) {
                const Answer a = bench.cycle(kind, Ticks{phase});
                for (const regmap::TimingParameter& p : regmap::kBusTiming) {
                    if (p.mode != mode || p.kind != TimingKind::promise || !regmap::covers(p.cycle, kind)) continue;
                    if (p.to.has(BusEvent::data_valid)) found[p.number].add(a.data_valid);
                    if (p.to.has(BusEvent::data_z)) found[p.number].add(a.data_z);
                    if (p.to.has(BusEvent::ready_rises)) found[p.number].add(a.ready_rises);
                    const bool is_early = p.number == 21 || p.number == 49;
                    if (p.to.has(BusEvent::ready_falls) && is_early == early) found[p.number].add(a.ready_falls);
                }
            }
        }
    }
    EXPECT_TRUE(bench.package().findings().empty());
    return found;
}

double ns(Ticks t) { return static_cast<double>(t.n) / 60.0; }

class EveryPromise : public testing::TestWithParam<std::tuple<ProcessorMode, Supply>> {};

// proves: VPC3C 10.7.2-01, VPC3C 10.7.2-08, VPC3C 10.7.2-12, VPC3C 10.7.3-01, VPC3C 10.7.3-05, VPC3C 10.7.3-08, VPC3C 10.7.3-09,
// VPC3C 10.7.3-12, VPC3C 10.7.3-15, VPC3C 10.7.4-01, VPC3C 10.7.4-05, VPC3C 10.7.4-10, VPC3C 10.7.5-01, VPC3C 10.7.5-05,
// VPC3C 10.7.5-09, VPC3C 10.7.5-10, VPC3C 10.7.5-14, VPC3C 10.7.5-18, VPC3C 5.1.1-08, VPC3C 5.1.1-09, APC3 4.1.1-11, E003
TEST_P(EveryPromise, Is_kept_at_every_phase_of_CLK) {
    const auto [mode, supply] = GetParam();
    std::map<unsigned, Extremes> found = measure(mode, supply);
    std::size_t promised = 0;
    for (const regmap::TimingParameter& p : regmap::kBusTiming) {
        if (p.mode != mode || p.kind != TimingKind::promise) continue;
        ++promised;
        const Extremes& e = found[p.number];
        const regmap::TimingLimits& limits = p.at(supply);
        EXPECT_TRUE(limits.meets(e.least) && limits.meets(e.most)) << p.number << ' ' << p.name;
        std::printf("  %2u %-42s %s  %7.3f .. %7.3f ns of %s .. %g ns\n", p.number, p.name.data(), regmap::name(supply).data(), ns(e.least), ns(e.most),
                    limits.min == regmap::kNoMin ? "-" : std::to_string(core::to_ns(limits.min)).c_str(), ns(limits.max));
    }
    EXPECT_EQ(found.size(), promised) << "each was measured";
}

INSTANTIATE_TEST_SUITE_P(Modes, EveryPromise, testing::Combine(
    testing::Values(ProcessorMode::async_intel, ProcessorMode::sync_intel, ProcessorMode::async_motorola, ProcessorMode::sync_motorola),
    testing::Values(Supply::v3_3, Supply::v5)), [](const auto& i) {
        std::string name{regmap::name(std::get<0>(i.param))};
        std::replace(name.begin(), name.end(), '-', '_');
        return name + (std::get<1>(i.param) == Supply::v5 ? "_5V" : "_3V3");
    });

// Reference 5: the internal times that were decided, to the tick.
TEST(InternalTiming, Events_follow_the_clock_edge_that_takes_the_strobe) {
    for (const Supply supply : {Supply::v3_3, Supply::v5}) {
        Bench bench{ProcessorMode::async_intel, supply};
        const Ticks data = supply == Supply::v5 ? 13_ns : 19_ns, ready = supply == Supply::v5 ? 21_ns : 27_ns;
        for (const std::int64_t phase : {0, 1, 624, 1249}) {
            const Ticks k = phase == 0 ? Ticks{} : core::kClk - Ticks{phase};
            const Answer a = bench.cycle(Cycle::read, Ticks{phase});
            EXPECT_EQ(a.data_valid, k + 3_clk + data);
            EXPECT_EQ(a.ready_falls, k + 4_clk + ready);
        }
        bench.set_early_ready(true);
        EXPECT_EQ(bench.cycle(Cycle::read, Ticks{}).ready_falls, 3_clk + ready) << "exactly one clock earlier";
        EXPECT_EQ(bench.cycle(Cycle::write, Ticks{}).ready_falls, 3_clk + ready);
    }
}

TEST(InternalTiming, The_synchronous_modes_leave_ready_at_1) {
    for (const ProcessorMode mode : {ProcessorMode::sync_intel, ProcessorMode::sync_motorola})
        for (const Cycle kind : {Cycle::read, Cycle::write}) EXPECT_EQ((Bench{mode, Supply::v5}.cycle(kind, Ticks{}).ready_falls), Ticks{-1});
}

}  // namespace
