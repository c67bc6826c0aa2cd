// SPDX-License-Identifier: Apache-2.0
// Slave to slave: 29 publishers heard by one subscriber, and one publisher heard by 29. Every sample is checked.
#include <cstdio>
#include <cstdlib>
#include <deque>

#include <dpchip/gsd/parse.hpp>
#include <dpchip/master/from_gsd.hpp>
#include <dpchip/master/master.hpp>
#include <dpchip/master/prm_blocks.hpp>
#include <dpchip/segment/segment.hpp>
#include <dpchip/slave/virtual_slave.hpp>

using namespace dpchip;
using Octets = std::array<std::uint8_t, 8>;

/// What station `address` is given in a cycle and publishes in its answer.
Octets pattern(std::uint8_t address, std::uint32_t cycle) {
    Octets out{};
    for (unsigned i = 0; i < 8; ++i) out[i] = static_cast<std::uint8_t>(cycle >> (8 * (i % 4)) ^ address ^ (17 * i));
    return out;
}

struct Station : slave::Dpv2Handler {
    Station(const gsd::Gsd& gsd, std::uint8_t address, const std::uint32_t& now) : slave{gsd, {.address = address}}, cycle{now} { slave.set_dpv2_handler(this); }
    void sample(const driver::DxbSample& s) override {  // octets 1 to 7, of this very cycle
        const Octets right = pattern(s.publisher, cycle);
        ++samples;
        if (!std::ranges::equal(s.octets, std::span{right}.subspan(1))) ++wrong;
    }
    slave::VirtualSlave slave;
    const std::uint32_t& cycle;
    std::uint64_t samples = 0, wrong = 0;
};

bool run(const gsd::Gsd& gsd, std::uint8_t publishers, std::uint8_t subscribers, std::uint32_t cycles) {
    std::uint32_t cycle = 0;
    std::deque<Station> stations;
    master::Master master;
    segment::Segment line;
    std::vector<dp::DxbLink> links;
    for (std::uint8_t n = 0; n < publishers; ++n) links.push_back({static_cast<std::uint8_t>(10 + n), 8, 1, 7});
    bool good = static_cast<bool>(line.attach(master, "master"));
    for (std::uint8_t n = 0; n < publishers + subscribers; ++n) {
        Station& s = stations.emplace_back(gsd, static_cast<std::uint8_t>(10 + n), cycle);
        master::SlaveConfig config = master::slave_config(gsd, s.slave.plan().configuration, s.slave.address());
        config.watchdog_ms = 200;
        config.publisher = n < publishers;
        good = good && (config.publisher || master::add_links(config, links)) && master.add(config) && line.attach(s.slave);
    }
    auto hook = [&](master::Master& m) {
        ++cycle;
        for (std::size_t n = 0; n < m.size(); ++n) std::ranges::copy(pattern(m.slave(n).config().address, cycle), m.slave(n).outputs().begin());
    };
    master.on_cycle(hook);
    good = good && line.run_until([&] { return master.all_exchanging(); }, core::seconds(30));
    const auto pass = [&](std::uint32_t n) { good = good && line.run_until([&, end = cycle + n] { return cycle >= end; }, core::seconds(100'000)); };
    pass(3);
    for (Station& s : stations) s.samples = s.wrong = 0;
    pass(cycles);
    unsigned long long samples = 0, wrong = 0;
    for (const Station& s : stations) samples += s.samples, wrong += s.wrong;
    std::printf("%u publishers, %u subscribers, %u cycles: %llu samples, %llu wrong or too old\n", publishers, subscribers, cycles, samples, wrong);
    return good && wrong == 0 && samples == std::uint64_t{cycles} * publishers * subscribers;
}

int main(int argc, char** argv) {
    const gsd::Gsd gsd = gsd::load(argc > 1 ? argv[1] : "examples/dxb_station.gsd");
    const auto cycles = static_cast<std::uint32_t>(argc > 2 ? std::atoi(argv[2]) : 1000);
    return run(gsd, 29, 1, cycles) && run(gsd, 1, 29, cycles) ? 0 : 1;
}
