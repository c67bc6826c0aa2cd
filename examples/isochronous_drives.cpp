// SPDX-License-Identifier: Apache-2.0
// Eight isochronous drives at a 1 ms cycle and 12 Mbit/s: how far apart their SYNC edges are, in virtual time.
#include <algorithm>
#include <cstdio>
#include <deque>

#include <dpchip/gsd/parse.hpp>
#include <dpchip/master/from_gsd.hpp>
#include <dpchip/master/master.hpp>
#include <dpchip/master/prm_blocks.hpp>
#include <dpchip/segment/segment.hpp>
#include <dpchip/slave/virtual_slave.hpp>

using namespace dpchip;
using namespace dpchip::core::literals;

struct Drive : slave::Dpv2Handler {
    Drive(const gsd::Gsd& gsd, std::uint8_t address, core::Clock crystal) : slave{gsd, {.address = address, .clock = crystal}} { slave.set_dpv2_handler(this); }
    void synch(core::Ticks local) override { edges.push_back(slave.crystal().line(local)); }
    slave::VirtualSlave slave;
    std::vector<core::Ticks> edges;
};

/// Greatest distance of the edges of one cycle, over half a second; kNever when something went wrong.
core::Ticks spread(const gsd::Gsd& gsd, std::int32_t ppm, core::Ticks phase) {
    std::deque<Drive> drives;
    master::Master master{{.isochron = {.cycle = 1_ms}}};
    segment::Segment line;
    bool good = static_cast<bool>(line.attach(master, "master"));
    for (std::uint8_t n = 0; n < 8; ++n) {  // half of them too fast, half too slow; each a little farther from the master
        Drive& d = drives.emplace_back(gsd, static_cast<std::uint8_t>(10 + n), core::Clock{(n % 2 != 0 ? ppm : -ppm) * 1000});
        master::SlaveConfig config = master::slave_config(gsd, d.slave.plan().configuration, d.slave.address());
        config.watchdog_ms = 100;
        good = good && master::add_isochron(config, master::isochron_times(gsd.dpv2, 1_ms)) && master.add(config) &&
               line.attach(d.slave, "drive", {.position = core::Ticks{phase.n * n / 7}});
    }
    good = good && line.run_until([&] { return master.all_exchanging(); }, 30_s);
    line.run(5_ms);
    for (Drive& d : drives) d.edges.clear();
    line.run(500_ms);
    line.settle();
    core::Ticks widest{};
    for (std::size_t cycle = 0; cycle < 499; ++cycle) {
        core::Ticks first = core::kNever, last{};
        for (const Drive& d : drives) {
            if (!good || d.edges.size() < 499 || d.slave.synch_meter().missing() != 0) return core::kNever;
            first = std::min(first, d.edges[cycle]);
            last = std::max(last, d.edges[cycle]);
        }
        widest = std::max(widest, last - first);
    }
    return widest;
}

int main(int argc, char** argv) {
    const gsd::Gsd gsd = gsd::load(argc > 1 ? argv[1] : "examples/drive.gsd");
    const core::Ticks exact = spread(gsd, 0, {}), drifting = spread(gsd, 100, {}), apart = spread(gsd, 0, 40_ns);
    const auto ns = [](core::Ticks t) { return static_cast<double>(t.n) / core::kTicksPerNs; };
    std::printf("SYNC edges of eight drives within %.3f ns; with crystals 100 ppm off %.3f ns; spread over 40 ns of cable %.3f ns\n", ns(exact), ns(drifting), ns(apart));
    return exact == core::Ticks{} && drifting < 1_ns && apart == 40_ns ? 0 : 1;
}
