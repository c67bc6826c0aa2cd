// SPDX-License-Identifier: Apache-2.0
// Two isochronous drives at a 1 ms cycle, the second one a publisher that the first one listens to: DP-V2 in virtual time.
#include <cstdio>

#include <dpchip/dp/dxb_prm.hpp>
#include <dpchip/dp/isom_prm.hpp>
#include <dpchip/gsd/parse.hpp>
#include <dpchip/master/from_gsd.hpp>
#include <dpchip/master/master.hpp>
#include <dpchip/segment/segment.hpp>
#include <dpchip/slave/virtual_slave.hpp>

using namespace dpchip;
using namespace dpchip::core::literals;

struct Drive : slave::Dpv2Handler {
    core::Ticks synch_at{};
    unsigned speed_of_the_other = 0;
    void synch(core::Ticks at) override { synch_at = at; }
    void sample(const driver::DxbSample& s) override { speed_of_the_other = s.octets[0]; }
};

int main(int argc, char** argv) {
    const gsd::Gsd gsd = gsd::load(argc > 1 ? argv[1] : "examples/drive.gsd");
    Drive one, two;
    slave::VirtualSlave first{gsd, {.address = 5}}, second{gsd, {.address = 6, .io = "echo"}};
    first.set_dpv2_handler(&one);
    second.set_dpv2_handler(&two);

    // Both get the times of the cycle; the first one also a link: octet 0 of the two that station 6 publishes.
    std::uint8_t blocks[64];
    const std::size_t isom = *dp::encode(dp::IsoMPrm{.version = 1, .tbase_dp = 1500, .t_dp = 8, .t_mapc = 1, .tbase_io = 1500, .t_pll_w = 12}, blocks);
    const dp::DxbLink link[]{{6, 2, 0, 1}};
    const std::size_t all = isom + *dp::encode_dxb(dp::PrmBlockType::dxb_linktable, link, std::span{blocks}.subspan(isom));

    master::MasterConfig config;
    config.isochron.cycle = 1_ms;
    master::Master master{config};
    for (const std::uint8_t address : {std::uint8_t{5}, std::uint8_t{6}}) {
        master::SlaveConfig slave = master::slave_config(gsd, first.plan().configuration, address);
        slave.user_prm.insert(slave.user_prm.end(), blocks, blocks + (address == 5 ? all : isom));
        slave.watchdog_ms = 100;
        slave.publisher = address == 6;
        if (!master.add(slave)) return 1;
    }
    segment::Segment line;
    if (!line.attach(master, "master") || !line.attach(first, "drive 5") || !line.attach(second, "drive 6")) return 1;
    if (!line.run_until([&] { return master.all_exchanging(); }, 10_s)) return 1;
    master.slave(1).outputs()[0] = 0x2A;
    line.run(10_ms);
    std::printf("SYNC edges %lld ns apart, jitter %llu ticks; drive 5 heard 2AH as %02XH\n",
                static_cast<long long>(core::to_ns(one.synch_at - two.synch_at)),
                static_cast<unsigned long long>(first.synch_meter().jitter()), one.speed_of_the_other);
    return one.synch_at == two.synch_at && one.speed_of_the_other == 0x2A ? 0 : 1;
}
