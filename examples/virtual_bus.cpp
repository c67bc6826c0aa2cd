// SPDX-License-Identifier: Apache-2.0
// A DP slave from its GSD and a DP master on a simulated segment: from power-up to data exchange, in virtual time.
#include <cstdio>

#include <dpchip/gsd/parse.hpp>
#include <dpchip/master/from_gsd.hpp>
#include <dpchip/master/master.hpp>
#include <dpchip/segment/segment.hpp>
#include <dpchip/slave/virtual_slave.hpp>

int main(int argc, char** argv) {
    using namespace dpchip;
    using namespace dpchip::core::literals;

    const gsd::Gsd station = gsd::load(argc > 1 ? argv[1] : "examples/remote_io.gsd");
    slave::VirtualSlave slave{station, {.modules = {"16 DI / 16 DO"}, .address = 5, .io = "invert"}};
    master::Master master{{.baud = fdl::BaudCode::mbit_12}};
    if (!master.add(master::slave_config(station, slave.plan().configuration, 5))) return 1;

    segment::Segment line;
    if (!line.attach(master, "master") || !line.attach(slave, "slave 5")) return 1;
    if (!line.run_until([&] { return master.all_exchanging(); }, 10_s)) return 1;
    master.slave(0).outputs()[0] = 0x5A;
    line.run(1_ms);
    const unsigned input = master.slave(0).inputs()[0];
    std::printf("in data exchange; 5A went out, %02X came back, one cycle takes %lld ns\n", input,
                static_cast<long long>(core::to_ns(master.cycle().last)));
    return input == 0xA5 ? 0 : 1;
}
