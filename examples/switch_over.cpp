// SPDX-License-Identifier: Apache-2.0
// A primary master dies in the middle of a cycle and its backup goes on: no output is cleared, no slave notices.
#include <cstdio>
#include <deque>

#include <dpchip/gsd/parse.hpp>
#include <dpchip/master/from_gsd.hpp>
#include <dpchip/master/master.hpp>
#include <dpchip/segment/segment.hpp>
#include <dpchip/slave/virtual_slave.hpp>

using namespace dpchip;
using namespace dpchip::core::literals;

int main(int argc, char** argv) {
    const gsd::Gsd gsd = gsd::load(argc > 1 ? argv[1] : "examples/dxb_station.gsd");
    std::deque<slave::VirtualSlave> slaves;
    master::Master primary, backup{{.mode = master::Mode::offline}};
    segment::Segment line;
    const auto primary_tap = line.attach(primary, "primary"), backup_tap = line.attach(backup, "backup");
    bool good = primary_tap && backup_tap;
    for (std::uint8_t address = 10; address < 15; ++address) {
        slave::VirtualSlave& s = slaves.emplace_back(gsd, slave::SlaveSetup{.address = address});
        master::SlaveConfig config = master::slave_config(gsd, s.plan().configuration, address);
        config.watchdog_ms = 20;  // what the switch-over must not take
        good = good && primary.add(config) && backup.add(config) && line.attach(s, "slave");
    }
    good = good && line.run_until([&] { return primary.all_exchanging(); }, 10_s);
    for (std::size_t n = 0; n < primary.size(); ++n) primary.slave(n).outputs()[0] = static_cast<std::uint8_t>(0xA0 + n);
    line.run(50_ms + 123_us);

    const core::Ticks died = line.now();
    const std::uint64_t exchanges = slaves[0].counters().exchanges, cleared = slaves[0].counters().outputs_cleared;
    line.detach(*primary_tap);
    good = good && backup.take_over(primary);
    line.touch(*backup_tap);
    good = good && line.run_until([&] { return slaves[0].counters().exchanges > exchanges; }, 1_s);
    const core::Ticks gap = line.now() - died;
    line.run(1_s);
    good = good && backup.all_exchanging();
    for (std::size_t n = 0; n < slaves.size(); ++n) {
        const slave::Counters& c = slaves[n].counters();
        good = good && c.outputs_cleared == cleared && c.data_exch_left == 0 && slaves[n].outputs_valid() && slaves[n].outputs()[0] == 0xA0 + n;
    }
    std::printf("the backup's first exchange came %lld us after the primary master died; %s\n", static_cast<long long>(core::to_ns(gap) / 1000),
                good ? "all outputs held" : "outputs were lost");
    return good ? 0 : 1;
}
