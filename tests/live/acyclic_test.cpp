// SPDX-License-Identifier: Apache-2.0
// Class-2 connections over a real pty: four slaves, twelve connections, every answer checked. Both ends live in one thread,
// in turns: nothing depends on how fast the machine is but the time the test takes. DPCHIP_LONG=1 in the environment: ten
// thousand exchanges instead of a few hundred.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include <dpchip/gsd/parse.hpp>
#include <dpchip/live/open_line.hpp>
#include <dpchip/master/from_gsd.hpp>
#include <dpchip/master/master.hpp>
#include <dpchip/master/ms2.hpp>
#include <dpchip/slave/virtual_slave.hpp>

#include "fakes.hpp"

namespace dpchip::live {
namespace {

constexpr std::size_t kSlaves = 4, kConnections = 12, kRecord = 20;

const gsd::Gsd& dpv1_io() {
    static const gsd::Gsd gsd = gsd::load(DPCHIP_SOURCE_DIR "/examples/dpv1_io.gsd");
    return gsd;
}

std::uint64_t wanted_exchanges() {
    const char* const wanted = std::getenv("DPCHIP_LONG");
    const bool many = wanted != nullptr && *wanted == '1';
    std::printf("%s\n", many ? "10,000 exchanges" : "300 exchanges; DPCHIP_LONG=1 makes them 10,000");
    return many ? 10'000 : 300;
}

/// Writes its own record and reads it back, in turns.
struct Tool {
    Tool(std::uint8_t address, unsigned seed, std::uint8_t index) : ms2{{.address = address}}, number{seed}, own{index} {}
    void step() {
        if (ms2.busy()) return;
        if (!ms2.is_open()) {
            lost += opened ? 1u : 0u;
            opened = ms2.open();
            asked = false;
            return;
        }
        if (asked) {
            ++answers;
            if (!right()) ++wrong;
        }
        asked = true;
        ++round;
        if (round % 2 == 1) ms2.write(1, own, contents());
        else ms2.read(1, own);
    }
    Octets contents() const {
        Octets o(kRecord);
        for (std::size_t i = 0; i < o.size(); ++i) o[i] = static_cast<std::uint8_t>(number * 53 + (round + 1) / 2 * 17 + i);
        return o;
    }
    bool right() const {
        if (!ms2.result().done()) return false;
        return round % 2 == 1 ? ms2.accepted() == kRecord : std::ranges::equal(ms2.data(), contents());
    }
    master::Ms2 ms2;
    unsigned number;
    std::uint8_t own;
    unsigned round = 0;
    std::uint64_t answers = 0, wrong = 0, lost = 0;
    bool opened = false, asked = false;
};

std::unique_ptr<slave::VirtualSlave> make_slave(std::uint8_t address) {
    slave::SlaveSetup setup;
    setup.address = address;
    setup.modules = {"8 DI / 8 DO"};
    setup.options.baud_probe_ms.fill(1000);  // the line's rate is the first one that is tried
    for (std::uint8_t index = 1; index <= 3; ++index)
        setup.records.push_back({1, index, slave::RecordAccess::rw, Octets(kRecord), 0});
    return std::make_unique<slave::VirtualSlave>(dpv1_io(), setup);
}

TEST(AcyclicOverAPty, twelve_connections_to_four_slaves_lose_double_and_mix_up_nothing) {
    const std::uint64_t exchanges = wanted_exchanges();
    OpenLine served{"pty", Role::serve, {.baud = fdl::BaudCode::mbit_12, .slot_time = 1_s}};
    OpenLine visiting{"tty:" + served.port().place(), Role::visit, {.baud = fdl::BaudCode::mbit_12, .slot_time = 1_s}};
    master::Master master{{.baud = fdl::BaudCode::mbit_12, .slot_time = 1_s, .acyclic_per_cycle = 4}};
    ASSERT_TRUE(visiting.line().segment().attach(master, "master"));
    std::vector<std::unique_ptr<slave::VirtualSlave>> slaves;
    for (std::uint8_t n = 0; n < kSlaves; ++n) {
        slaves.push_back(make_slave(static_cast<std::uint8_t>(3 + n)));
        ASSERT_TRUE(served.line().segment().attach(*slaves.back()));
        auto config = master::slave_config(dpv1_io(), gsd::configure(dpv1_io(), std::vector<std::string>{"8 DI / 8 DO"}), static_cast<std::uint8_t>(3 + n));
        ASSERT_TRUE(master.add(config));
    }
    std::vector<std::unique_ptr<Tool>> tools;
    for (unsigned n = 0; n < kConnections; ++n) {
        tools.push_back(std::make_unique<Tool>(static_cast<std::uint8_t>(3 + n % kSlaves), n, static_cast<std::uint8_t>(1 + n / kSlaves)));
        master.attach(tools.back()->ms2);
    }
    std::uint64_t answers = 0;
    struct Steps {
        std::vector<std::unique_ptr<Tool>>& tools;
        std::uint64_t& answers;
        const master::Master& master;
        void operator()(master::Master&) {
            if (!master.all_exchanging()) return;
            answers = 0;
            for (auto& t : tools) {
                t->step();
                answers += t->answers;
            }
        }
    } steps{tools, answers, master};
    master.on_cycle(steps);
    const Ticks end = visiting.line().now() + core::seconds(3600);
    while (answers < exchanges && visiting.line().now() < end) {
        visiting.line().run(300_us);
        served.line().run(300_us);
    }
    EXPECT_GE(answers, exchanges);
    for (const auto& t : tools) {
        EXPECT_EQ(t->wrong, 0u);
        EXPECT_EQ(t->lost, 0u) << master::text(t->ms2.ending());
        EXPECT_GT(t->answers, exchanges / kConnections / 2);
    }
    for (std::size_t n = 0; n < kSlaves; ++n) EXPECT_EQ(master.slave(n).counters().lost, 0u);
    for (const auto& s : slaves) EXPECT_EQ(s->acyclic_counters().connections_closed, 0u);
}

}  // namespace
}  // namespace dpchip::live
