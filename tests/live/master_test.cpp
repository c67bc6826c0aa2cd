// SPDX-License-Identifier: Apache-2.0
// The built-in master on one live line, virtual slaves on another, a wire of our own making in between: in a fake time,
// and once over a real pty.
#include <gtest/gtest.h>

#include <dpchip/gsd/parse.hpp>
#include <dpchip/live/open_line.hpp>
#include <dpchip/master/from_gsd.hpp>
#include <dpchip/master/master.hpp>
#include <dpchip/slave/virtual_slave.hpp>

#include "fakes.hpp"

namespace dpchip::live {
namespace {

const gsd::Gsd& remote_io() {
    static const gsd::Gsd gsd = gsd::load(DPCHIP_SOURCE_DIR "/examples/remote_io.gsd");
    return gsd;
}

master::MasterConfig config() {
    master::MasterConfig c;
    c.baud = fdl::BaudCode::kbit_19_2;
    c.slot_time = 200_ms;
    return c;
}

/// Slaves on one line, their master on the other.
struct Plant {
    Plant(LiveLine& served, LiveLine& visiting) : slaves_line{served}, master_line{visiting} {
        EXPECT_TRUE(master_line.segment().attach(master, "master"));
    }
    void plug(std::uint8_t address, std::uint32_t watchdog_ms) {
        slave::SlaveSetup setup;
        setup.address = address;
        setup.modules = {"16 DI / 16 DO"};
        setup.options.baud_probe_ms.fill(7);
        slaves.push_back(std::make_unique<slave::VirtualSlave>(remote_io(), setup));
        ASSERT_TRUE(slaves_line.segment().attach(*slaves.back()));
        auto slave = master::slave_config(remote_io(), gsd::configure(remote_io(), setup.modules), address);
        slave.watchdog_ms = watchdog_ms;
        ASSERT_TRUE(master.add(slave));
    }
    /// Lets both lines live in turn, `step` each, until `done`.
    template <class Done>
    bool live(Ticks step, int steps, Done&& done) {
        for (int i = 0; i < steps && !done(); ++i) {
            master_line.run(step);
            slaves_line.run(step);
        }
        return done();
    }
    LiveLine& slaves_line;
    LiveLine& master_line;
    master::Master master{config()};
    std::vector<std::unique_ptr<slave::VirtualSlave>> slaves;
};

/// Whatever one of the two sends arrives at the other `latency` later.
struct Wire {
    explicit Wire(Ticks latency) {
        here.on_send = [this, latency] { there.arrive(time.now_ + latency, here.sent.back().octets); };
        there.on_send = [this, latency] { here.arrive(time.now_ + latency, there.sent.back().octets); };
    }
    FakeTime time;
    FakePort here{time}, there{time};
    LiveLine slaves{here, time}, master{there, time};
};

TEST(MasterOnALiveLine, ExchangesDataWithSlavesOnAnother) {
    Wire wire{80_us};
    Plant plant{wire.slaves, wire.master};
    for (const std::uint8_t address : std::initializer_list<std::uint8_t>{3, 7, 8, 125}) plant.plug(address, 2000);
    ASSERT_TRUE(plant.live(50_us, 1'000'000, [&] { return plant.master.all_exchanging(); }));
    plant.master.clear_statistics();
    ASSERT_TRUE(plant.live(50_us, 200'000, [&] { return plant.master.cycle().cycles >= 100; }));
    EXPECT_EQ(plant.master.counters().retries, 0u);
    EXPECT_EQ(plant.master.exchanging(), 4u);
    for (const auto& slave : plant.slaves) {
        EXPECT_EQ(slave->counters().watchdog_timeouts, 0u);
        EXPECT_GE(slave->counters().exchanges, 100u);
    }
    EXPECT_EQ(wire.slaves.counters().late, 0u);
    EXPECT_EQ(wire.slaves.counters().damaged, 0u);
}

TEST(MasterOnALiveLine, SurvivesNoiseBetweenItsTelegrams) {
    Wire wire{80_us};
    Plant plant{wire.slaves, wire.master};
    plant.plug(8, 0);
    ASSERT_TRUE(plant.live(50_us, 1'000'000, [&] { return plant.master.all_exchanging(); }));
    int noise = 0;
    wire.there.on_send = [&] {  // noise in front of every third telegram of the master
        Octets octets = wire.there.sent.back().octets;
        if (++noise % 3 == 0) octets.insert(octets.begin(), {0x68, 0x05, 0x05, 0x68, 0x00});
        wire.here.arrive(wire.time.now_ + 80_us, octets);
    };
    plant.master.clear_statistics();
    ASSERT_TRUE(plant.live(50_us, 1'000'000, [&] { return plant.master.cycle().cycles >= 100; }));
    EXPECT_EQ(plant.master.exchanging(), 1u);
    EXPECT_EQ(plant.master.counters().retries, 0u);
    EXPECT_GT(wire.slaves.counters().damaged, 10u);
}

TEST(MasterOnALiveLine, LosesASlaveWhoseWatchdogRunsOutWhenTheWireIsCut) {
    Wire wire{80_us};
    Plant plant{wire.slaves, wire.master};
    plant.plug(8, 100);
    ASSERT_TRUE(plant.live(50_us, 1'000'000, [&] { return plant.master.all_exchanging(); }));
    wire.there.on_send = {};
    plant.live(1_ms, 300, [] { return false; });
    EXPECT_EQ(plant.slaves[0]->counters().watchdog_timeouts, 1u) << "chip time follows the wall";
}

TEST(MasterOnALiveLine, VisitsTheSlavesOfAPty) {
    OpenLine served{"pty", Role::serve};
    OpenLine visiting{"tty:" + served.port().place(), Role::visit};
    Plant plant{served.line(), visiting.line()};
    plant.plug(8, 0);
    ASSERT_TRUE(plant.live(200_us, 300'000, [&] { return plant.master.all_exchanging() && plant.slaves[0]->counters().exchanges >= 5; }));
}

}  // namespace
}  // namespace dpchip::live
