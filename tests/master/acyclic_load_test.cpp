// SPDX-License-Identifier: Apache-2.0
// A hundred class-2 connections over 32 slaves beside the cyclic exchange: every answer is checked, none may be lost,
// doubled or mixed up. DPCHIP_LONG=1 in the environment: a million bus cycles instead of a few thousand.
#include <cstdio>
#include <cstdlib>

#include "master/acyclic_plant.hpp"
#include "master/allocations.hpp"

namespace {

using namespace dpchip;
using namespace dpchip::core::literals;
using test::AcyclicPlant;
using test::Octets;

constexpr std::size_t kSlaves = 32;
constexpr std::size_t kConnections = 100;

bool long_run() {
    const char* const wanted = std::getenv("DPCHIP_LONG");
    return wanted != nullptr && *wanted == '1';
}

/// One tool at the end of one connection: writes a record of its own, reads it back, reads what no one changes, asks for
/// what there is not, and so on. `kOwnIndex` + its number on the slave is its record.
class Tool {
public:
    static constexpr std::uint8_t kOwnIndex = 10;
    static constexpr std::size_t kOwnOctets = 24;

    Tool(std::uint8_t address, unsigned number, unsigned of_slave)
        : ms2{{.address = address}}, number_{number}, index_{static_cast<std::uint8_t>(kOwnIndex + of_slave)} {}
    void step() {
        if (ms2.busy()) return;
        if (!ms2.is_open()) {
            if (opened_) ++lost;
            if (ms2.open()) opened_ = true;
            asked_ = false;
            return;
        }
        if (asked_) check();
        ask();
    }
    master::Ms2 ms2;
    std::uint64_t answers = 0, wrong = 0, lost = 0;

private:
    std::uint8_t octet(std::size_t i) const { return static_cast<std::uint8_t>(number_ * 41 + round_ / 4 * 13 + i * 7); }
    void ask() {
        asked_ = true;
        ++round_;
        std::array<std::uint8_t, kOwnOctets> own{};
        for (std::size_t i = 0; i < own.size(); ++i) own[i] = octet(i);
        switch (round_ % 4) {
        case 0: ms2.write(1, index_, own); break;
        case 1: ms2.read(1, index_); break;
        case 2: ms2.read(1, 2); break;
        default: ms2.read(1, static_cast<std::uint8_t>(200 + number_ % 50)); break;
        }
    }
    bool right() const {
        const auto& result = ms2.result();
        switch (round_ % 4) {
        case 0: return result.done() && ms2.accepted() == kOwnOctets;
        case 1:
            if (round_ < 4) return result.done();
            for (std::size_t i = 0; i < kOwnOctets; ++i)
                if (ms2.data().size() != kOwnOctets || ms2.data()[i] != octet(i)) return false;
            return result.done();
        case 2: return result.done() && std::ranges::equal(ms2.data(), constant_);
        default: return result.kind == master::ServiceResult::Kind::refused && result.error == dp::RecordError{dp::ErrorCode1::invalid_index};
        }
    }
    void check() {
        ++answers;
        if (!right()) ++wrong;
    }
    Octets constant_ = test::pattern(4, 2);
    unsigned number_;
    std::uint8_t index_;
    bool opened_ = false, asked_ = false;
    unsigned round_ = 0;
};

/// The cyclic side: outputs change every cycle, inputs must follow.
struct Everything {
    std::vector<std::unique_ptr<Tool>>* tools;
    std::uint64_t round = 0, wrong = 0;
    void operator()(master::Master& m) {
        for (std::size_t n = 0; n < m.size(); ++n) {
            auto& s = m.slave(n);
            if (round > 1 && s.inputs()[0] != static_cast<std::uint8_t>((round - 1) * 3 + n)) ++wrong;
            s.outputs()[0] = static_cast<std::uint8_t>(round * 3 + n);
        }
        ++round;
        for (auto& tool : *tools) tool->step();
    }
};

TEST(AcyclicLoad, a_hundred_connections_over_32_slaves_read_and_write_beside_the_cycle) {
    AcyclicPlant plant{{.acyclic_per_cycle = 2}};
    std::vector<std::unique_ptr<Tool>> tools;
    for (std::size_t n = 0; n < kSlaves; ++n) plant.plug(static_cast<std::uint8_t>(3 + n));
    for (unsigned n = 0; n < kConnections; ++n) {
        tools.push_back(std::make_unique<Tool>(static_cast<std::uint8_t>(3 + n % kSlaves), n, n / kSlaves));
        plant.master.attach(tools.back()->ms2);
    }
    ASSERT_TRUE(plant.start());
    Everything everything{&tools};
    plant.master.on_cycle(everything);
    const std::uint64_t cycles = long_run() ? 1'000'000 : 6'000;
    std::printf("%llu cycles%s\n", static_cast<unsigned long long>(cycles), long_run() ? "" : "; DPCHIP_LONG=1 makes it a million");
    const std::uint64_t end = plant.master.cycle().cycles + cycles;
    ASSERT_TRUE(plant.until([&] { return std::ranges::all_of(tools, [](const auto& t) { return t->ms2.is_open() && t->answers > 3; }); }, 60_s));
    const std::uint64_t timeouts = plant.master.counters().timeouts;
    const std::uint64_t allocations = test::allocations();
    ASSERT_TRUE(plant.until([&] { return plant.master.cycle().cycles >= end; }, core::seconds(100'000)));
    EXPECT_EQ(test::allocations() - allocations, 0u);
    std::uint64_t answers = 0, least = UINT64_MAX, served = 0, polls = 0, services = 0;
    for (const auto& t : tools) {
        EXPECT_EQ(t->wrong, 0u);
        EXPECT_EQ(t->lost, 0u) << master::text(t->ms2.ending());
        EXPECT_EQ(t->ms2.counters().stale, 0u);
        answers += t->answers;
        least = std::min(least, t->answers);
        polls += t->ms2.counters().polls;
        services += t->ms2.counters().services;
    }
    for (const auto& s : plant.slaves) {
        const auto& c = s->acyclic_counters();
        served += c.reads + c.writes;
        EXPECT_EQ(c.connections_closed, 0u);
        EXPECT_EQ(c.requests_dropped, 0u);
    }
    // Every service was served once: what is asked now may be served already, and its answer still be on its way.
    const std::uint64_t asked = services - kConnections;  // each connection's Initiate is a service, too
    EXPECT_LE(served, asked);
    EXPECT_GE(served + kConnections, asked);
    EXPECT_LE(answers, served);
    EXPECT_GE(least, cycles / 250);
    EXPECT_EQ(everything.wrong, 0u);
    EXPECT_EQ(plant.master.counters().timeouts, timeouts);
    for (std::size_t n = 0; n < plant.master.size(); ++n) EXPECT_EQ(plant.master.slave(n).counters().lost, 0u);
    std::printf("%llu answers, %llu polls\n", static_cast<unsigned long long>(answers), static_cast<unsigned long long>(polls));
}

}  // namespace
