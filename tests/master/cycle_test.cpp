// SPDX-License-Identifier: Apache-2.0
// The bus cycle to the tick: n * T_MC + 33 + TID1, T_MC = T_req + T_SDR + T_rsp + TID1, for every rate and size.
#include <vector>

#include "master/allocations.hpp"
#include "master/bus.hpp"

namespace {

using namespace dpchip;
using core::Ticks;
using test::Bus;
using test::ScriptedSlave;

/// Bit times of a cycle of `n` equal slaves.
std::int64_t formula(std::int64_t n, std::int64_t outputs, std::int64_t inputs, std::int64_t tsdr, std::int64_t tid1) {
    const std::int64_t request = outputs == 0 ? 66 : 11 * (9 + outputs);
    const std::int64_t response = inputs == 0 ? 11 : 11 * (9 + inputs);
    return n * (request + tsdr + response + tid1) + 33 + tid1;
}

struct Load {
    std::uint16_t outputs, inputs;
};
constexpr Load kLoads[]{{0, 0}, {1, 0}, {0, 1}, {1, 1}, {32, 32}, {244, 244}};

class CycleTime : public ::testing::TestWithParam<fdl::BaudCode> {};

TEST_P(CycleTime, equals_the_formula_to_the_tick_for_every_load) {
    for (const Load& load : kLoads) {
        for (const int n : {1, 2, 8, 32}) {
            Bus bus{{.baud = GetParam()}};
            const std::int64_t tsdr = GetParam() == fdl::BaudCode::mbit_12 ? 36 : GetParam() == fdl::BaudCode::mbit_6 ? 18 : 11;
            for (int i = 0; i < n; ++i)
                bus.plug({.own = static_cast<std::uint8_t>(3 + i), .tsdr_bits = tsdr, .inputs = load.inputs, .outputs = load.outputs});
            ASSERT_TRUE(bus.start());
            bus.cycles(2);
            bus.master.clear_statistics();
            bus.cycles(10);
            const std::int64_t tid1 = fdl::bus_times(GetParam()).tid1();
            const Ticks expected = fdl::baud(GetParam()).bit * formula(n, load.outputs, load.inputs, tsdr, tid1);
            EXPECT_EQ(bus.master.cycle().min, expected);
            EXPECT_EQ(bus.master.cycle().max, expected);
            EXPECT_EQ(bus.master.cycle().last, expected);
        }
    }
}
INSTANTIATE_TEST_SUITE_P(Rates, CycleTime, ::testing::ValuesIn([] { std::vector<fdl::BaudCode> all; for (const auto& b : fdl::kBaud) all.push_back(b.code); return all; }()),
                         [](const auto& rate) { return "code_" + std::to_string(static_cast<int>(rate.param)); });

TEST(CycleFormula, gives_the_figures_of_the_reference_at_12_Mbit_s) {
    EXPECT_EQ(formula(125, 1, 1, 11, 76) * 1000 / 12, 3'207'000);
    EXPECT_EQ(formula(32, 32, 32, 11, 76) * 1000 / 12, 2'646'416);
    EXPECT_EQ(formula(1, 0, 0, 11, 76), 164 + 109);
}

TEST(CycleTime125, of_125_slaves_and_1000_cycles_with_data_changing_every_cycle) {
    Bus bus;
    for (std::uint8_t i = 0; i < 125; ++i)
        bus.plug({.own = static_cast<std::uint8_t>(i < 2 ? i : i + 1), .tsdr_bits = 36, .inputs = 32, .outputs = 32});
    ASSERT_TRUE(bus.start());
    bus.cycles(1);
    std::uint64_t wrong = 0, checked = 0, round = 0;
    auto application = [&](master::Master& m) {
        for (std::size_t n = 0; n < m.size(); ++n) {
            auto& slave = m.slave(n);
            if (round != 0) {
                wrong += std::ranges::equal(slave.inputs(), slave.outputs()) ? 0u : 1u;
                ++checked;
            }
            for (std::size_t i = 0; i < 32; ++i) slave.outputs()[i] = static_cast<std::uint8_t>(round * 7 + n + i);
        }
        ++round;
    };
    bus.master.on_cycle(application);
    bus.cycles(1);
    bus.master.clear_statistics();
    const std::uint64_t before = test::allocations();
    bus.cycles(1000);
    EXPECT_EQ(test::allocations() - before, 0u) << "the cycle must not allocate";
    EXPECT_EQ(wrong, 0u);
    EXPECT_GE(checked, 125u * 1000u);
    const Ticks expected = fdl::baud(fdl::BaudCode::mbit_12).bit * formula(125, 32, 32, 36, 76);
    EXPECT_EQ(bus.master.cycle().min, expected);
    EXPECT_EQ(bus.master.cycle().max, expected);
    EXPECT_EQ(bus.master.cycle().cycles, 1000u);
    EXPECT_EQ(bus.master.counters().retries, 0u);
}

TEST(GapPoll, of_an_absent_station_costs_66_bit_times_and_a_slot_time) {
    Bus bus{{.gap_factor = 3}};
    bus.plug({.own = 3});
    ASSERT_TRUE(bus.start());
    bus.cycles(4);
    bus.master.clear_statistics();
    bus.cycles(3 * 130);
    const Ticks bit = fdl::baud(fdl::BaudCode::mbit_12).bit;
    const std::int64_t plain = formula(1, 2, 2, 11, 76);
    EXPECT_EQ(bus.master.cycle().min, bit * plain);
    EXPECT_EQ(bus.master.cycle().max, bit * (plain + 66 + 1000));
}

TEST(MinCycle, stretches_the_cycle_exactly) {
    Bus bus{{.min_cycle = core::microseconds(250)}};
    bus.plug({.own = 3});
    ASSERT_TRUE(bus.start());
    bus.master.clear_statistics();
    bus.cycles(20);
    EXPECT_EQ(bus.master.cycle().min, core::microseconds(250));
    EXPECT_EQ(bus.master.cycle().max, core::microseconds(250));
}

TEST(MinCycle, follows_the_slowest_slave) {
    Bus bus;
    ScriptedSlave slow{.own = 3};
    ASSERT_TRUE(bus.line.attach(slow));
    master::SlaveConfig config = test::config_of(slow);
    config.min_slave_interval = core::microseconds(600);
    ASSERT_TRUE(bus.master.add(config));
    ASSERT_TRUE(bus.start());
    bus.master.clear_statistics();
    bus.cycles(20);
    EXPECT_EQ(bus.master.cycle().min, core::microseconds(600));
}

TEST(EmptyMaster, passes_the_token_to_itself) {
    Bus bus;
    bus.cycles(3);
    EXPECT_EQ(bus.master.cycle().min, fdl::baud(fdl::BaudCode::mbit_12).bit * (33 + 76));
}

}  // namespace
