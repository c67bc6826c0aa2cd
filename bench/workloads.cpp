// SPDX-License-Identifier: Apache-2.0
// exchange: one Data_Exchange of 32 + 32 octets, the chip alone. segment: a master and 125 slaves at 12 Mbit/s in virtual
// time. registers: processor accesses through the C API.
#include "workloads.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <memory>
#include <stdexcept>

#include <dpchip/dpchip.h>
#include <dpchip/gsd/parse.hpp>
#include <dpchip/master/from_gsd.hpp>
#include <dpchip/master/master.hpp>
#include <dpchip/segment/segment.hpp>
#include <dpchip/slave/virtual_slave.hpp>

#include "exchange_chip.hpp"

namespace dpchip::bench {

namespace {

using Run = std::function<double(std::uint64_t)>;

/// Keeps the compiler from throwing a result away.
template <class T>
void keep(const T& value) { asm volatile("" : : "r,m"(value) : "memory"); }

constexpr std::uint8_t kOctets = 32;

Run exchange() {
    auto chip = std::make_shared<ExchangeChip<core::NoTrace>>(kOctets);
    return [chip](std::uint64_t n) {
        const auto from = chip->chip().now();
        for (std::uint64_t i = 0; i < n; ++i) keep(chip->exchange());
        return static_cast<double>(core::to_ns(chip->chip().now() - from));
    };
}

/// Parse and FCS of a request, its outputs copied; inputs copied and an answer built around them.
struct Floor {
    explicit Floor(std::uint8_t octets) {
        std::array<std::uint8_t, 244> data{};
        request_length = fdl::encode(request, 8, 2, 0x7D, {data.data(), octets});
    }
    std::size_t pair() {
        const auto t = fdl::decode({request.data(), request_length});
        if (!t) throw std::logic_error{"the floor's own request is bad"};
        std::memcpy(outputs.data(), t->unit.data(), t->unit.size());
        std::memcpy(answer.data() + 7, inputs.data(), t->unit.size());
        return fdl::finish_sd2(answer, 2, 8, 0x08, t->unit.size());
    }
    std::array<std::uint8_t, 255> request{}, answer{};
    std::array<std::uint8_t, 244> outputs{}, inputs{};
    std::size_t request_length{};
};

Run floor_of_pairs(std::uint64_t pairs) {
    auto floor = std::make_shared<Floor>(kOctets);
    return [floor, pairs](std::uint64_t n) {
        for (std::uint64_t i = 0; i < n * pairs; ++i) keep(floor->pair());
        return 0.0;
    };
}

/// 32 octets each way, in special format with consistency over the whole length.
constexpr std::string_view kStation = R"(#Profibus_DP
GSD_Revision = 1
Vendor_Name = "dpchip"
Model_Name = "Benchmark station"
Revision = "1"
Ident_Number = 0xFFF1
Protocol_Ident = 0
Station_Type = 0
12M_supp = 1
MaxTsdr_12M = 800
Max_Diag_Data_Len = 6
Module = "32 in, 32 out" 0x40,0x9F,0x80,0x9F
EndModule
)";

constexpr std::uint8_t kSlaves = 125;

/// The whole bus: the master's hook writes new outputs each cycle, every slave's firmware repeats them as inputs.
struct Bus {
    Bus() : master{{.address = 0, .baud = fdl::BaudCode::mbit_12}} {
        const auto parsed = gsd::parse(kStation, "benchmark.gsd");
        if (!parsed.ok()) throw std::logic_error{"the benchmark's station is bad"};
        const auto configuration = gsd::configure(parsed.gsd);
        static_cast<void>(line.attach(master, "master"));
        for (std::uint8_t a = 1; a <= kSlaves; ++a) {
            slave::SlaveSetup setup;
            setup.address = a;
            setup.io = "echo";
            slaves.push_back(std::make_unique<slave::VirtualSlave>(parsed.gsd, setup));
            static_cast<void>(line.attach(*slaves.back(), std::to_string(a)));
            auto config = master::slave_config(parsed.gsd, configuration, a);
            config.min_slave_interval = {};
            static_cast<void>(master.add(config));
        }
        if (!line.run_until([this] { return master.all_exchanging(); }, core::seconds(10)))
            throw std::logic_error{"the benchmark's slaves did not start"};
    }
    double cycles(std::uint64_t n) {
        const auto from = line.now();
        const std::uint64_t until = master.cycle().cycles + n;
        line.run_until([&] { return master.cycle().cycles >= until; }, core::seconds(1000));
        return static_cast<double>(core::to_ns(line.now() - from));
    }
    segment::Segment line;
    master::Master master;
    std::vector<std::unique_ptr<slave::VirtualSlave>> slaves;
};

Run segment_run() {
    auto bus = std::make_shared<Bus>();
    return [bus](std::uint64_t n) { return bus->cycles(n); };
}

Run registers() {
    std::shared_ptr<dpchip_chip> chip{dpchip_chip_create("vpc3+c"), dpchip_chip_destroy};
    return [chip](std::uint64_t n) {
        for (std::uint64_t i = 0; i < n; i += 2) {
            dpchip_chip_write(chip.get(), 0x100, static_cast<std::uint8_t>(i));
            keep(dpchip_chip_read(chip.get(), 0x04));
        }
        return 0.0;
    };
}

Run floor_of_registers() {
    auto ram = std::make_shared<std::array<std::uint8_t, 4096>>();
    return [ram](std::uint64_t n) {
        volatile std::uint8_t* cell = ram->data();
        for (std::uint64_t i = 0; i < n; i += 2) {
            cell[0x100] = static_cast<std::uint8_t>(i);
            keep(static_cast<std::uint8_t>(cell[0x04]));
        }
        return 0.0;
    };
}

const std::array<Workload, 3>& table() {
    static const std::array<Workload, 3> all{{
        {"exchange", "Data_Exchange, 32 + 32 octets", "parse + FCS + copy of the same octets",
         "request in, answer out, the chip alone", exchange, [] { return floor_of_pairs(1); }, 200'000},
        {"segment", "bus cycle, 125 slaves with 32 + 32 octets at 12 Mbit/s", "parse + FCS + copy of the same octets, 125 times",
         "master, segment, 125 chips with their firmware, in virtual time", segment_run, [] { return floor_of_pairs(kSlaves); }, 200},
        {"registers", "processor access through the C API", "one volatile RAM access",
         "dpchip_chip_write and dpchip_chip_read in turns", registers, floor_of_registers, 1'000'000},
    }};
    return all;
}

struct Sample {
    double ns{}, virtual_ns{};
};

Sample time(const Run& run, std::uint64_t n) {
    const auto from = std::chrono::steady_clock::now();
    const double virtual_ns = run(n);
    const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - from;
    return {spent.count(), virtual_ns};
}

double median(std::vector<double> v) {
    std::sort(v.begin(), v.end());
    return v[v.size() / 2];
}

}  // namespace

std::span<const Workload> workloads() { return table(); }

Result measure(const Workload& workload, std::uint64_t repetitions, double scale) {
    const auto n = std::max<std::uint64_t>(2, static_cast<std::uint64_t>(static_cast<double>(workload.operations) * scale));
    const Run run = workload.prepare(), floor = workload.prepare_floor();
    run(std::max<std::uint64_t>(2, n / 10));  // warm
    std::vector<double> ns, floor_ns, ratio;
    for (std::uint64_t i = 0; i < std::max<std::uint64_t>(1, repetitions); ++i) {
        const Sample s = time(run, n);
        ns.push_back(s.ns / static_cast<double>(n));
        if (s.virtual_ns > 0) ratio.push_back(s.virtual_ns / s.ns);
        floor_ns.push_back(time(floor, n).ns / static_cast<double>(n));
    }
    Result r;
    r.name = workload.name;
    r.operation = workload.operation;
    r.floor = workload.floor;
    r.operations = n;
    r.repetitions = ns.size();
    r.ns_min = *std::min_element(ns.begin(), ns.end());
    r.ns_max = *std::max_element(ns.begin(), ns.end());
    r.ns_median = median(ns);
    r.floor_ns = median(floor_ns);
    r.real_time = ratio.empty() ? 0 : median(ratio);
    return r;
}

}  // namespace dpchip::bench
