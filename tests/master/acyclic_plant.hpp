// SPDX-License-Identifier: Apache-2.0
// A line with virtual DP-V1 slaves and masters, for tests of acyclic services in virtual time.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/gsd/parse.hpp>
#include <dpchip/master/alarm_receiver.hpp>
#include <dpchip/master/from_gsd.hpp>
#include <dpchip/master/im_reader.hpp>
#include <dpchip/master/master.hpp>
#include <dpchip/master/ms1.hpp>
#include <dpchip/master/ms2.hpp>
#include <dpchip/segment/judge.hpp>
#include <dpchip/segment/segment.hpp>
#include <dpchip/slave/virtual_slave.hpp>

namespace dpchip::test {

using core::Ticks;
using Octets = std::vector<std::uint8_t>;

inline const gsd::Gsd& dpv1_io() {
    static const gsd::Gsd gsd = gsd::load(DPCHIP_SOURCE_DIR "/examples/dpv1_io.gsd");
    return gsd;
}

inline Octets octets_of(std::span<const std::uint8_t> s) { return {s.begin(), s.end()}; }

/// Octets that tell whose they are.
inline Octets pattern(std::size_t size, unsigned seed) {
    Octets o(size);
    for (std::size_t i = 0; i < size; ++i) o[i] = static_cast<std::uint8_t>(seed * 37 + i * 11 + (seed >> 8));
    return o;
}

/// slot 1: index 1 rw 32, 2 ro, 3 wo, 4 rw 240; 10 to 13 rw 24; slot 2: index 1 rw 8.
inline std::vector<slave::Record> records() {
    using slave::RecordAccess;
    return {{1, 1, RecordAccess::rw, pattern(32, 1), 0},
            {1, 2, RecordAccess::ro, pattern(4, 2), 0},
            {1, 3, RecordAccess::wo, {}, 16},
            {1, 4, RecordAccess::rw, pattern(240, 4), 0},
            {1, 10, RecordAccess::rw, pattern(24, 10), 0},
            {1, 11, RecordAccess::rw, pattern(24, 11), 0},
            {1, 12, RecordAccess::rw, pattern(24, 12), 0},
            {1, 13, RecordAccess::rw, pattern(24, 13), 0},
            {2, 1, RecordAccess::rw, pattern(8, 5), 0}};
}

struct AcyclicPlant {
    explicit AcyclicPlant(const master::MasterConfig& config = {}) : master{config} { EXPECT_TRUE(line.attach(master, "master")); }

    slave::VirtualSlave& plug(std::uint8_t address, bool configured = true, std::uint8_t alarms = 0xFE, std::uint8_t alarm_mode = 0) {
        slave::SlaveSetup setup;
        setup.address = address;
        setup.modules = {"8 DI / 8 DO"};
        setup.records = records();
        setup.options.baud_probe_ms.fill(master.config().baud < fdl::BaudCode::kbit_187_5 ? 2 : 100);
        slaves.push_back(std::make_unique<slave::VirtualSlave>(dpv1_io(), setup));
        const auto at = line.attach(*slaves.back());
        EXPECT_TRUE(at);
        stations.push_back(*at);
        if (!configured) return *slaves.back();
        master::SlaveConfig config = master::slave_config(dpv1_io(), gsd::configure(dpv1_io(), setup.modules), address);
        master::enable_dpv1(config, dpv1_io().dpv1, false, alarms, alarm_mode);
        config.watchdog_ms = 200;
        EXPECT_TRUE(master.add(config));
        return *slaves.back();
    }
    bool start() { return line.run_until([&] { return master.all_exchanging(); }, core::seconds(60)); }
    bool until(const std::function<bool()>& done, Ticks limit = core::seconds(10)) { return line.run_until(done, limit); }
    void run(Ticks duration) { line.run_until([] { return false; }, duration); }
    const master::ServiceResult& finish(master::Relation& r) {
        EXPECT_TRUE(until([&] { return !r.busy(); }, core::seconds(60))) << "still busy";
        return r.result();
    }

    segment::Segment line;
    master::Master master;
    std::vector<std::unique_ptr<slave::VirtualSlave>> slaves;
    std::vector<segment::StationIndex> stations;
};

}  // namespace dpchip::test
