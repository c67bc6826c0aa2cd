// SPDX-License-Identifier: Apache-2.0
// A slave clock follows its time master for 30 virtual minutes, over the end of the NTP era in 2036: its error, with a
// crystal that is exact and with one that is 100 ppm off, with and without correction of its rate.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include <dpchip/gsd/parse.hpp>
#include <dpchip/master/from_gsd.hpp>
#include <dpchip/master/master.hpp>
#include <dpchip/master/prm_blocks.hpp>
#include <dpchip/segment/segment.hpp>
#include <dpchip/slave/virtual_slave.hpp>

using namespace dpchip;
using namespace dpchip::core::literals;

/// Greatest error in nanoseconds, looked at ten times a second from the third setting on; -1 when there is no time.
std::int64_t error(const gsd::Gsd& gsd, std::int32_t ppb, bool rate, int minutes) {
    const core::Ticks interval = 10_s;
    slave::VirtualSlave slave{gsd, {.address = 10, .clock = core::Clock{ppb}, .clock_rate = rate}};
    master::Master master{{.min_cycle = 10_ms, .time = {interval, dp::NetworkTime::from_wire(0xFFFFFFFF - 900, 0)}}};
    master::SlaveConfig config = master::slave_config(gsd, slave.plan().configuration, 10);
    if (!master::add_clock(config, {.interval = 1000}) || !master.add(config)) return -1;  // in units of 10 ms
    segment::Segment line;
    if (!line.attach(master, "master") || !line.attach(slave, "slave 10")) return -1;
    if (!line.run_until([&] { return slave.dpv2_counters().times_set == 3; }, 60_s)) return -1;
    std::int64_t worst = 0;
    for (int i = 0; i < minutes * 600; ++i) {
        line.run(100_ms);
        line.settle();
        const dp::NetworkTime right = master.config().time.start.plus_ns(core::to_ns(line.now()));
        worst = std::max(worst, std::abs(slave.time()->minus_ns(right)));
    }
    return slave.dpv2_counters().clock_violations == 0 ? worst : -1;
}

int main(int argc, char** argv) {
    const gsd::Gsd gsd = gsd::load(argc > 1 ? argv[1] : "examples/dxb_station.gsd");
    const int minutes = argc > 2 ? std::atoi(argv[2]) : 30;
    const std::int64_t exact = error(gsd, 0, true, minutes), drifting = error(gsd, 100'000, false, minutes), corrected = error(gsd, 100'000, true, minutes);
    std::printf("%d minutes, Clock_Sync_Interval 10 s: error up to %.3f us; with a crystal 100 ppm off %.3f us, with its rate corrected %.3f us\n", minutes,
                static_cast<double>(exact) / 1e3, static_cast<double>(drifting) / 1e3, static_cast<double>(corrected) / 1e3);
    const bool known = exact >= 0 && drifting >= 0 && corrected >= 0;
    return known && exact < 2'000 && drifting < 2'000 + 1'000'000 && corrected < 4'000 ? 0 : 1;
}
