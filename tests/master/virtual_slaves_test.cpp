// SPDX-License-Identifier: Apache-2.0
// The master against real virtual slaves: chip, firmware and GSD, on one simulated segment with a judge.
#include <algorithm>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/gsd/parse.hpp>
#include <dpchip/master/from_gsd.hpp>
#include <dpchip/master/master.hpp>
#include <dpchip/segment/judge.hpp>
#include <dpchip/segment/segment.hpp>
#include <dpchip/slave/virtual_slave.hpp>

#include "master/allocations.hpp"

namespace {

using namespace dpchip;
using namespace dpchip::core::literals;
using core::Ticks;

const gsd::Gsd& remote_io() {
    static const gsd::Gsd gsd = gsd::load(DPCHIP_SOURCE_DIR "/examples/remote_io.gsd");
    return gsd;
}

/// A line with a master and virtual slaves that repeat their outputs as inputs.
struct Plant {
    explicit Plant(const master::MasterConfig& config = {}) : master{config} {
        EXPECT_TRUE(line.attach(master, "master"));
        line.observe(judge);
    }
    void plug(std::uint8_t address, const std::vector<std::string>& modules, std::uint32_t watchdog_ms = 0) {
        slave::SlaveSetup setup;
        setup.address = address;
        setup.modules = modules;
        setup.options.baud_probe_ms.fill(master.config().baud < fdl::BaudCode::kbit_187_5 ? 2 : 100);
        slaves.push_back(std::make_unique<slave::VirtualSlave>(remote_io(), setup));
        ASSERT_TRUE(line.attach(*slaves.back()));
        master::SlaveConfig config = master::slave_config(remote_io(), gsd::configure(remote_io(), modules), address);
        config.watchdog_ms = watchdog_ms;
        ASSERT_TRUE(master.add(config));
    }
    bool start() { return line.run_until([&] { return master.all_exchanging(); }, 60_s); }
    void cycles(std::uint64_t n) {
        const std::uint64_t end = master.cycle().cycles + n;
        ASSERT_TRUE(line.run_until([&] { return master.cycle().cycles >= end; }, 1'000_s));
    }
    void expect_clean() const {
        for (const segment::Violated& v : judge.violations())
            ADD_FAILURE() << segment::name(v.rule) << " at " << core::to_ns(v.at) << " ns: " << v.bits << " bits, " << (v.sender == segment::kNobody ? "noise" : line.name(v.sender));
    }

    segment::Segment line;
    master::Master master;
    std::vector<std::unique_ptr<slave::VirtualSlave>> slaves;
    segment::Judge judge;
};

TEST(FromGsd, fills_in_what_the_master_sends) {
    const std::vector<std::string> modules{"16 DI / 16 DO", "2 AI, consistent"};
    const master::SlaveConfig c = master::slave_config(remote_io(), gsd::configure(remote_io(), modules), 7);
    EXPECT_EQ(c.name, "DPCHIP Remote I/O");
    EXPECT_EQ(c.address, 7);
    EXPECT_EQ(c.ident, 0xFFF0);
    EXPECT_EQ(c.cfg, (std::vector<std::uint8_t>{0x31, 0xD1}));
    EXPECT_EQ(c.input_octets, 2 + 4);
    EXPECT_EQ(c.output_octets, 2);
    EXPECT_EQ(c.user_prm.size(), 6u + 1u + 4u);
    EXPECT_EQ(c.min_slave_interval, 100_us);
    EXPECT_FALSE(c.fail_safe);
}

class EveryRate : public ::testing::TestWithParam<fdl::BaudCode> {};

TEST_P(EveryRate, is_found_by_the_slaves_and_the_cycle_is_the_formula_to_the_tick) {
    Plant plant{{.baud = GetParam()}};
    plant.plug(3, {"16 DI / 16 DO"});
    plant.plug(4, {"8 DI"});
    plant.plug(5, {"32 DO"});
    ASSERT_TRUE(plant.start());
    plant.cycles(2);
    plant.master.clear_statistics();
    plant.cycles(20);
    const std::int64_t tsdr = GetParam() == fdl::BaudCode::mbit_12 ? 36 : GetParam() == fdl::BaudCode::mbit_6 ? 18 : 11;
    const std::int64_t tid1 = fdl::bus_times(GetParam()).tid1();
    const std::int64_t bits = (121 + tsdr + 121 + tid1) + (66 + tsdr + 110 + tid1) + (143 + tsdr + 11 + tid1) + 33 + tid1;
    const Ticks cycle = std::max<Ticks>(fdl::baud(GetParam()).bit * bits, 100_us);
    EXPECT_EQ(plant.master.cycle().min, cycle);
    EXPECT_EQ(plant.master.cycle().max, cycle);
    EXPECT_EQ(plant.master.counters().retries, 0u);
    plant.expect_clean();
}
INSTANTIATE_TEST_SUITE_P(Rates, EveryRate, ::testing::ValuesIn([] {
                             std::vector<fdl::BaudCode> all;
                             for (const fdl::Baud& b : fdl::kBaud) all.push_back(b.code);
                             return all;
                         }()),
                         [](const auto& rate) { return "code_" + std::to_string(static_cast<int>(rate.param)); });

/// Changes the outputs each cycle and wants to see them as inputs of that cycle: the firmware runs between request and
/// answer.
struct Application {
    std::uint64_t round = 0, wrong = 0, checked = 0;
    void operator()(master::Master& m) {
        for (std::size_t n = 0; n < m.size(); ++n) {
            auto& s = m.slave(n);
            for (std::size_t i = 0; i < s.inputs().size() && round >= 1; ++i) {
                wrong += s.inputs()[i] == value(round - 1, n, i) ? 0u : 1u;
                ++checked;
            }
            for (std::size_t i = 0; i < s.outputs().size(); ++i) s.outputs()[i] = value(round, n, i);
        }
        ++round;
    }
    static std::uint8_t value(std::uint64_t round, std::size_t n, std::size_t i) { return static_cast<std::uint8_t>(round * 31 + n * 7 + i); }
};

TEST(Segment125, of_virtual_slaves_runs_1000_cycles_at_12_Mbit_s_with_the_cycle_time_of_the_formula) {
    Plant plant;
    for (std::uint8_t i = 0; i < 125; ++i) plant.plug(static_cast<std::uint8_t>(i < 2 ? i : i + 1), {"16 DI / 16 DO"}, 500);
    ASSERT_TRUE(plant.start());
    plant.cycles(2);
    Application application;
    plant.master.on_cycle(application);
    plant.cycles(1);
    plant.master.clear_statistics();
    const std::uint64_t before = test::allocations();
    plant.cycles(1000);
    EXPECT_EQ(test::allocations() - before, 0u);
    EXPECT_EQ(application.wrong, 0u);
    EXPECT_GE(application.checked, 125u * 2u * 999u);
    const Ticks cycle = fdl::baud(fdl::BaudCode::mbit_12).bit * (125 * (121 + 36 + 121 + 76) + 33 + 76);
    EXPECT_EQ(plant.master.cycle().min, cycle);
    EXPECT_EQ(plant.master.cycle().max, cycle);
    EXPECT_EQ(plant.master.counters().retries, 0u);
    plant.expect_clean();
}

TEST(Faults, on_the_line_are_survived_by_virtual_slaves) {
    Plant plant{{.baud = fdl::BaudCode::mbit_1_5, .max_retry = 2}};
    for (std::uint8_t a = 3; a < 11; ++a) plant.plug(a, {"64 octets in / 64 out"}, 1000);
    ASSERT_TRUE(plant.start());
    segment::RandomFaults faults{2024, {0, 10'000, 10'000, 5'000, 5'000, 5'000, 5'000, 5'000, 5'000}};
    plant.line.set_faults(segment::FaultRef{faults});
    plant.line.run(2_s);
    EXPECT_GT(plant.master.counters().retries, 20u);
    plant.line.set_faults({});
    ASSERT_TRUE(plant.start());
    plant.cycles(3);
    Application application;
    plant.master.on_cycle(application);
    plant.judge.clear();
    plant.master.clear_statistics();
    plant.cycles(50);
    EXPECT_EQ(application.wrong, 0u);
    EXPECT_GT(application.checked, 0u);
    EXPECT_EQ(plant.master.counters().retries, 0u);
    plant.expect_clean();
}

TEST(Watchdog, of_a_virtual_slave_clears_its_outputs_when_the_master_falls_silent) {
    Plant plant;
    plant.plug(3, {"16 DI / 16 DO"}, 100);
    ASSERT_TRUE(plant.start());
    std::ranges::fill(plant.master.slave(0).outputs(), std::uint8_t{0x55});
    plant.cycles(3);
    EXPECT_EQ(plant.slaves[0]->outputs()[0], 0x55);
    plant.master.set_mode(master::Mode::offline);
    plant.line.touch(0);
    plant.line.run(90_ms);
    EXPECT_EQ(plant.slaves[0]->dp_state(), chip::DpState::data_exch);
    plant.line.run(20_ms);
    EXPECT_EQ(plant.slaves[0]->dp_state(), chip::DpState::wait_prm);
    EXPECT_EQ(plant.slaves[0]->outputs()[0], 0);
    plant.master.set_mode(master::Mode::operate);
    plant.line.touch(0);
    EXPECT_TRUE(plant.start());
    plant.expect_clean();
}

TEST(SetSlaveAdd, moves_a_virtual_slave_that_the_master_then_finds_and_uses) {
    Plant plant;
    slave::SlaveSetup setup;
    setup.address = 126;
    setup.modules = {"8 DO"};
    setup.options.baud_probe_ms.fill(2);
    slave::VirtualSlave fresh{remote_io(), setup};
    ASSERT_TRUE(plant.line.attach(fresh));
    ASSERT_TRUE(plant.master.add(master::slave_config(remote_io(), gsd::configure(remote_io(), setup.modules), 40)));
    plant.line.run(100_ms);
    EXPECT_TRUE(plant.master.slave(0).given_up());
    master::Job change = master::Job::set_slave_add(126, {.address = 40, .ident = 0xFFF0, .no_add_chg = false, .rem_data = {}});
    ASSERT_TRUE(plant.master.submit(change));
    ASSERT_TRUE(plant.line.run_until([&] { return change.finished(); }, 1_s));
    EXPECT_EQ(change.outcome, master::Job::Outcome::acknowledged);
    EXPECT_TRUE(plant.start());
    EXPECT_EQ(plant.line.find(40), 1);
    EXPECT_EQ(plant.line.find(126), segment::kNobody);
}

TEST(Scan, finds_virtual_slaves) {
    Plant plant;
    plant.plug(3, {"8 DI"});
    plant.plug(99, {"8 DO"});
    ASSERT_TRUE(plant.start());
    plant.master.start_scan();
    ASSERT_TRUE(plant.line.run_until([&] { return !plant.master.scanning(); }, 10_s));
    for (std::uint8_t a = 0; a < 127; ++a) EXPECT_EQ(plant.master.found()[a].ident, a == 3 || a == 99 ? 0xFFF0 : 0) << int{a};
}

}  // namespace
