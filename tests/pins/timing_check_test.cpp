// SPDX-License-Identifier: Apache-2.0
// The 45 times that the processor owes, each at its limit and one tick beyond it, at both supplies.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "pins/part.hpp"

namespace {

using namespace dpchip;
using namespace dpchip::core::literals;
using core::Ticks;
using pins::BusTimes;
using regmap::Cycle;
using regmap::ProcessorMode;
using regmap::Supply;
using regmap::TimingKind;
using regmap::TimingViolation;

constexpr Ticks kTick{1};

/// All times at their limits, and what it takes to bring parameter `n` itself to its limit: where the sum of others keeps it
/// away from there, one of these is stretched. `beyond`: by how much n is missed.
BusTimes times_for(unsigned n, ProcessorMode mode, Supply supply, Ticks beyond) {
    BusTimes t = BusTimes::at_limits(mode, supply);
    t.busy_bus = n != 54;  // R_W may not move in 10 ns
    t.of[n] -= beyond;
    switch (n) {
    case 7: t.of[1] += beyond; break;           // ALE rises earlier
    case 14: t.of[1] = 42_ns + beyond; break;
    case 25: t.of[29] = 115_ns + beyond; break;          // else the cycle time decides
    case 50: t.of[47] = 32_ns + beyond; break;  // select long before AS
    case 54: t.of[59] = 115_ns + beyond; break;
    default: break;
    }
    return t;
}

std::vector<TimingViolation> violations(pins::Package<>& package) {
    std::vector<TimingViolation> found;
    while (!package.findings().empty()) {
        const core::Finding f = package.findings().pop();
        EXPECT_EQ(f.rule, core::to_underlying(regmap::PinRule::timing)) << "rule " << f.rule;
        EXPECT_EQ(f.kind, core::FindingKind::timing_violation);
        found.push_back(regmap::unpack_violation(f.detail));
    }
    return found;
}

struct Outcome {
    std::vector<TimingViolation> found;
    std::vector<std::uint8_t> values;  ///< what was read, or what stands in RAM after writing
};

/// Three cycles back to back at three addresses of RAM that hold 5AH, A5H and 3CH, or get these octets; at one address when
/// nothing is to move between the strobes.
Outcome three_cycles(ProcessorMode mode, Supply supply, Cycle cycle, const BusTimes& times) {
    const std::vector<std::uint16_t> addresses = times.busy_bus ? std::vector<std::uint16_t>{0x155, 0x2AA, 0x456} : std::vector<std::uint16_t>(3, 0x155);
    const std::vector<std::uint8_t> octets = times.busy_bus ? std::vector<std::uint8_t>{0x5A, 0xA5, 0x3C} : std::vector<std::uint8_t>(3, 0x5A);
    pins::Package<> package{regmap::Variant::vpc3c, supply};
    pins::BusCycles<> bus{package, mode};
    bus.power_up();
    if (cycle == Cycle::read)
        for (std::size_t i = 0; i < 3; ++i) bus.write(addresses[i], octets[i]);
    bus.settle();
    EXPECT_TRUE(package.findings().empty());
    bus.times() = times;
    Outcome run;
    for (std::size_t i = 0; i < 3; ++i) {
        if (cycle == Cycle::read) run.values.push_back(bus.read(addresses[i]));
        else bus.write(addresses[i], octets[i]);
    }
    bus.settle();
    if (cycle == Cycle::write)
        for (const std::uint16_t a : addresses) run.values.push_back(package.chip().peek(a));
    EXPECT_EQ(run.values, octets) << "an access is carried out ideally all the same";
    run.found = violations(package);
    return run;
}

std::string text(const std::vector<TimingViolation>& found) {
    std::string all;
    for (const TimingViolation& v : found) all += std::to_string(v.number) + " (" + std::to_string(v.found.n) + " ticks) ";
    return all;
}

struct Case {
    unsigned number;
    Supply supply;
};

std::vector<Case> every_check() {
    std::vector<Case> cases;
    for (const regmap::TimingParameter& p : regmap::kBusTiming)
        for (const Supply s : {Supply::v3_3, Supply::v5})
            if (p.kind == TimingKind::check) cases.push_back({p.number, s});
    return cases;
}

/// In read cycles these are sums of others at their limits (reference 4.5): none of them can be missed alone.
constexpr bool is_sum_in_reads(unsigned n) { return n == 10 || n == 22 || n == 25 || n == 50 || n == 51 || n == 54; }

class EveryCheck : public testing::TestWithParam<Case> {
protected:
    const regmap::TimingParameter& p = regmap::timing(GetParam().number);
    const Supply supply = GetParam().supply;

    std::vector<Cycle> cycles() const {
        std::vector<Cycle> all;
        if (regmap::covers(p.cycle, Cycle::write)) all.push_back(Cycle::write);
        if (regmap::covers(p.cycle, Cycle::read) && !is_sum_in_reads(p.number)) all.push_back(Cycle::read);
        return all;
    }
};

// proves: VPC3C 10.7.2-02, VPC3C 10.7.2-04..07, VPC3C 10.7.2-09..11, VPC3C 10.7.2-13..18,
// VPC3C 10.7.3-02, VPC3C 10.7.3-04, VPC3C 10.7.3-06, VPC3C 10.7.3-07, VPC3C 10.7.3-10, VPC3C 10.7.3-11, VPC3C 10.7.3-13,
// VPC3C 10.7.3-14, VPC3C 10.7.3-16..18, VPC3C 10.7.4-02, VPC3C 10.7.4-04, VPC3C 10.7.4-06..09, VPC3C 10.7.4-11..14,
// VPC3C 10.7.5-02, VPC3C 10.7.5-04, VPC3C 10.7.5-06..08, VPC3C 10.7.5-11..13, VPC3C 10.7.5-15..17, VPC3C 10.7.5-19..21
TEST_P(EveryCheck, Passes_at_its_limit) {
    for (const Cycle cycle : cycles()) {
        const Outcome run = three_cycles(p.mode, supply, cycle, times_for(p.number, p.mode, supply, Ticks{}));
        EXPECT_EQ(text(run.found), "") << p.name;
    }
}

// proves: VPC3C 10.7.2-04..07, VPC3C 10.7.2-09..11, VPC3C 10.7.2-13..18,
// VPC3C 10.7.3-04, VPC3C 10.7.3-06, VPC3C 10.7.3-07, VPC3C 10.7.3-10, VPC3C 10.7.3-11, VPC3C 10.7.3-13,
// VPC3C 10.7.3-14, VPC3C 10.7.3-16..18, VPC3C 10.7.4-04, VPC3C 10.7.4-06..09, VPC3C 10.7.4-11..14,
// VPC3C 10.7.5-04, VPC3C 10.7.5-06..08, VPC3C 10.7.5-11..13, VPC3C 10.7.5-15..17, VPC3C 10.7.5-19..21
TEST_P(EveryCheck, Is_reported_by_its_number_and_alone_one_tick_beyond) {
    for (const Cycle cycle : cycles()) {
        const Outcome run = three_cycles(p.mode, supply, cycle, times_for(p.number, p.mode, supply, kTick));
        ASSERT_FALSE(run.found.empty()) << p.name;
        for (const TimingViolation& v : run.found)
            EXPECT_EQ(v, (TimingViolation{p.number, supply, p.at(supply).min - kTick})) << p.name << ": " << text(run.found);
    }
}

// proves: VPC3C 10.7.2-01, VPC3C 10.7.3-01, VPC3C 10.7.4-01, VPC3C 10.7.5-01
TEST(ReadCycles, With_everything_at_its_limit_deliver_and_are_not_complained_about) {
    for (const ProcessorMode mode : {ProcessorMode::async_intel, ProcessorMode::sync_intel, ProcessorMode::async_motorola, ProcessorMode::sync_motorola})
        for (const Supply s : {Supply::v3_3, Supply::v5})
            for (const bool busy : {false, true}) {
                BusTimes t = BusTimes::at_limits(mode, s);
                t.busy_bus = busy;
                EXPECT_EQ(text(three_cycles(mode, s, Cycle::read, t).found), "");
            }
}

TEST(ReadCycles, The_cycle_time_is_a_sum_and_breaks_with_a_part_of_it) {
    struct Pair { ProcessorMode mode; unsigned cycle, part; };
    for (const Pair c : {Pair{ProcessorMode::sync_intel, 10, 6}, Pair{ProcessorMode::async_intel, 22, 25}, Pair{ProcessorMode::async_motorola, 51, 45}}) {
        BusTimes t = BusTimes::at_limits(c.mode, Supply::v5);
        t.of[c.cycle] -= kTick;
        t.of[c.part] -= kTick;
        const std::string words = text(three_cycles(c.mode, Supply::v5, Cycle::read, t).found);
        EXPECT_NE(words.find(std::to_string(c.cycle) + " ("), std::string::npos) << words;
        EXPECT_NE(words.find(std::to_string(c.part) + " ("), std::string::npos) << words;
    }
}

// What goes to other devices on the bus is none of the chip's business.
TEST(OtherTraffic, Is_not_judged) {
    for (const ProcessorMode mode : test::kModes) {
        test::Part part{mode};
        const auto pulse = [&](test::PinId pin, int active) {
            part.set(pin, active);
            part.wait(2_ns);
            part.set(pin, 1 - active);
            part.wait(2_ns);
        };
        part.set(test::PinId::ab9, 1);  // another address, and in synchronous Intel mode no select
        for (int i = 0; i < 20; ++i) {
            if (mode == ProcessorMode::sync_intel) pulse(test::PinId::ale_as_ab11, 1);
            if (mode == ProcessorMode::async_motorola) pulse(test::PinId::ale_as_ab11, 0);
            if (mode == ProcessorMode::sync_motorola) pulse(test::PinId::xwr_e_clock_ab11, 1);
            if (!regmap::motorola(mode)) pulse(i % 2 == 0 ? test::PinId::xrd_r_w : test::PinId::xwr_e_clock_ab11, 0);
            pulse(test::PinId::db3, 1);
            pulse(test::PinId::ab2, 1);
        }
        part.wait(200_ns);
        EXPECT_EQ(part.findings(), "") << regmap::name(mode);
        part.set(test::PinId::ab9, 0);
        part.bus.write(0x155, 0x77);
        EXPECT_EQ(part.bus.read(0x155), 0x77);
        EXPECT_EQ(part.findings(), "") << "and nothing of it sticks to the next access";
    }
}

TEST(StableLines, That_move_inside_a_strobe_break_the_nearer_of_set_up_and_hold) {
    struct Move { Ticks at; unsigned number; Ticks found; };
    for (const Move m : {Move{10_ns, 16, Ticks{} - 10_ns}, Move{75_ns, 16, Ticks{} - 75_ns}, Move{80_ns, 23, Ticks{} - 70_ns}, Move{149_ns, 23, Ticks{} - 1_ns}}) {
        test::Part part{ProcessorMode::async_intel};
        part.set(test::PinId::xcs_ab11, 0);
        part.wait(20_ns);
        part.set(test::PinId::xrd_r_w, 0);
        part.wait(m.at);
        part.set(test::PinId::ab4, 1);
        part.wait(150_ns - m.at);
        part.set(test::PinId::xrd_r_w, 1);
        const std::vector<TimingViolation> found = violations(part.package);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_EQ(found[0], (TimingViolation{static_cast<std::uint8_t>(m.number), Supply::v5, m.found}));
    }
}

TEST(StableLines, An_address_that_comes_after_ALE_or_R_W_that_moves_in_the_strobe_is_reported) {
    test::Part part{ProcessorMode::sync_intel};
    part.set(test::PinId::ale_as_ab11, 1);
    part.wait(20_ns);
    part.set(test::PinId::ale_as_ab11, 0);
    part.wait(5_ns);
    part.set(test::PinId::ab1, 1);
    part.wait(20_ns);
    part.set(test::PinId::xrd_r_w, 0);
    part.wait(150_ns);
    part.set(test::PinId::xrd_r_w, 1);
    EXPECT_EQ(text(violations(part.package)), "3 (-300 ticks) ");

    test::Part other{ProcessorMode::async_motorola};
    other.set(test::PinId::xcs_ab11, 0);
    other.wait(20_ns);
    other.set(test::PinId::ale_as_ab11, 0);
    other.wait(140_ns);
    other.set(test::PinId::xrd_r_w, 0);
    other.wait(10_ns);
    other.set(test::PinId::ale_as_ab11, 1);
    EXPECT_EQ(text(violations(other.package)), "55 (-600 ticks) ");
}

INSTANTIATE_TEST_SUITE_P(Both, EveryCheck, testing::ValuesIn(every_check()), [](const testing::TestParamInfo<Case>& i) {
    return "parameter_" + std::to_string(i.param.number) + (i.param.supply == Supply::v5 ? "_5V" : "_3V3");
});

}  // namespace
