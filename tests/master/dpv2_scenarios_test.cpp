// SPDX-License-Identifier: Apache-2.0
// DP-V2 on a whole segment, chips and firmware included: publishers and subscribers, isochronous drives, a time master,
// a backup master (VPC3+C 7.3; reference 6). They print what they measured. DPCHIP_LONG=1: a million cycles.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include <dpchip/master/master.hpp>
#include <dpchip/segment/judge.hpp>
#include <dpchip/segment/segment.hpp>

#include "master/dpv2_station.hpp"

namespace dpchip::test {
namespace {

using namespace core::literals;

bool long_run() { return std::getenv("DPCHIP_LONG") != nullptr; }

/// A segment with a master, stations and a judge.
struct Plant {
    explicit Plant(const master::MasterConfig& config) : master{config} {
        EXPECT_TRUE(line.attach(master, "master"));
        line.observe(judge);
    }
    ~Plant() {
        for (const segment::Violated& v : judge.violations())
            ADD_FAILURE() << segment::name(v.rule) << " at " << core::to_ns(v.at) << " ns, " << v.bits << " bits, sender " << v.sender;
    }
    Plant(const Plant&) = delete;
    Plant& operator=(const Plant&) = delete;

    Dpv2Station& plug(const Dpv2Recipe& recipe, const Octets& blocks = {}, bool publisher = false, Ticks position = {}) {
        stations.push_back(std::make_unique<Dpv2Station>(recipe));
        Dpv2Station& s = *stations.back();
        EXPECT_TRUE(s.configured());
        EXPECT_TRUE(line.attach(s, {}, {.crystal_ppb = recipe.crystal_ppb, .position = position}));
        master::SlaveConfig c = s.config(blocks);
        c.publisher = publisher;
        EXPECT_TRUE(master.add(c));
        return s;
    }
    bool start() { return line.run_until([&] { return master.all_exchanging(); }, 30_s); }
    void cycles(std::uint64_t n) {
        const std::uint64_t end = master.cycle().cycles + n;
        ASSERT_TRUE(line.run_until([&] { return master.cycle().cycles >= end; }, 100'000_s));
    }

    segment::Segment line;
    master::Master master;
    std::vector<std::unique_ptr<Dpv2Station>> stations;
    segment::Judge judge;
};

Octets link_table(const std::vector<dp::DxbLink>& links) {
    Octets out(dp::kMaxSetPrm);
    const auto size = dp::encode_dxb(dp::PrmBlockType::dxb_linktable, links, out);
    EXPECT_TRUE(size);
    out.resize(size ? *size : 0);
    return out;
}

// ---- (a) publishers and subscribers -------------------------------------------------------------------------------

struct Heard {
    std::uint64_t samples = 0, misplaced = 0, lost = 0;
    void add(const Dpv2Station::Received& r) { samples += r.samples, misplaced += r.misplaced, lost += r.lost; }
};

// proves: VPC3C 7.3.1-01..02
TEST(DpV2Scenario, a_subscriber_with_29_links_hears_every_sample_of_29_publishers) {
    Plant plant{{}};
    std::vector<dp::DxbLink> links;
    for (std::uint8_t i = 0; i < 29; ++i) links.push_back({static_cast<std::uint8_t>(10 + i), 8, 1, 7});
    for (const dp::DxbLink& l : links) plant.plug({.address = l.publisher}, {}, true);
    Dpv2Station& subscriber = plant.plug({.address = 50, .dxb = {29, 8}}, link_table(links));
    ASSERT_TRUE(plant.start());
    plant.cycles(2);
    const std::uint64_t n = long_run() ? 1'000'000 : 2'000;
    plant.cycles(n);
    Heard heard;
    for (const dp::DxbLink& l : links) {
        const auto& r = subscriber.received[l.publisher];
        heard.add(r);
        EXPECT_GE(r.samples, n) << unsigned{l.publisher};
    }
    EXPECT_EQ(heard.misplaced, 0u);
    EXPECT_EQ(heard.lost, 0u);
    EXPECT_EQ(subscriber.link_errors, 0u);
    EXPECT_LT(subscriber.oldest, 2_us);
    std::printf("29 publishers, one subscriber: %llu cycles of %lld ns, %llu samples, %llu lost, %llu misplaced, the oldest %lld ns old\n",
                static_cast<unsigned long long>(n), static_cast<long long>(core::to_ns(plant.master.cycle().last)),
                static_cast<unsigned long long>(heard.samples), static_cast<unsigned long long>(heard.lost),
                static_cast<unsigned long long>(heard.misplaced), static_cast<long long>(core::to_ns(subscriber.oldest)));
}

// proves: VPC3C 7.3.1-01
TEST(DpV2Scenario, one_publisher_is_heard_by_29_subscribers) {
    Plant plant{{}};
    plant.plug({.address = 10}, {}, true);
    std::vector<Dpv2Station*> subscribers;
    for (std::uint8_t i = 0; i < 29; ++i)
        subscribers.push_back(&plant.plug({.address = static_cast<std::uint8_t>(20 + i), .dxb = {1, 8}},
                                          link_table({{10, 8, 1, static_cast<std::uint8_t>(4 + i % 4)}})));
    ASSERT_TRUE(plant.start());
    plant.cycles(2);
    const std::uint64_t n = long_run() ? 1'000'000 : 2'000;
    plant.cycles(n);
    Heard heard;
    for (const Dpv2Station* s : subscribers) {
        heard.add(s->received[10]);
        EXPECT_GE(s->received[10].samples, n);
        EXPECT_EQ(s->link_errors, 0u);
    }
    EXPECT_EQ(heard.misplaced, 0u);
    EXPECT_EQ(heard.lost, 0u);
    std::printf("one publisher, 29 subscribers: %llu cycles, %llu samples, %llu lost, %llu misplaced\n", static_cast<unsigned long long>(n),
                static_cast<unsigned long long>(heard.samples), static_cast<unsigned long long>(heard.lost),
                static_cast<unsigned long long>(heard.misplaced));
}

// ---- (b) isochronous drives -----------------------------------------------------------------------------------------

struct Spread {
    Ticks edges{};          ///< greatest distance of the SYNC edges of one cycle
    Ticks shortest = core::kNever, longest{};  ///< cycle as the first drive sees it
};

/// Eight drives; the first edges that all have are compared one by one.
Spread drives(const std::vector<std::int32_t>& ppb, const std::vector<Ticks>& position, std::uint64_t cycles, Ticks jitter = {}, std::int32_t master_ppb = 0) {
    master::MasterConfig config;
    config.isochron.cycle = 1_ms;
    config.isochron.jitter = jitter;
    segment::Segment line;
    master::Master master{config};
    EXPECT_TRUE(line.attach(master, "master", {.crystal_ppb = master_ppb}));
    std::vector<std::unique_ptr<Dpv2Station>> drives;
    Octets block(dp::kIsoMBlock);
    EXPECT_TRUE(dp::encode(dp::IsoMPrm{.version = 1, .tbase_dp = 1500, .t_dp = 8, .t_mapc = 1, .tbase_io = 1500, .t_i = 1, .t_o = 1, .t_dx = 6000, .t_pll_w = 12, .t_pll_d = 0}, block));
    for (std::uint8_t i = 0; i < 8; ++i) {
        drives.push_back(std::make_unique<Dpv2Station>(Dpv2Recipe{.address = static_cast<std::uint8_t>(10 + i), .isochron = true, .crystal_ppb = ppb[i]}));
        EXPECT_TRUE(drives.back()->configured());
        EXPECT_TRUE(line.attach(*drives.back(), {}, {.crystal_ppb = ppb[i], .position = position[i]}));
        EXPECT_TRUE(master.add(drives.back()->config(block)));
    }
    EXPECT_TRUE(line.run_until([&] { return master.all_exchanging(); }, 30_s));
    line.run(5_ms);
    for (const auto& d : drives) d->sync.clear();
    line.run(core::milliseconds(static_cast<std::int64_t>(cycles)));
    line.settle();
    Spread spread;
    for (std::size_t k = 0; k < drives[0]->sync.size(); ++k) {
        Ticks first = core::kNever, last{};
        for (const auto& d : drives) {
            EXPECT_GT(d->sync.size(), k);
            if (d->sync.size() <= k) return spread;
            first = std::min(first, d->sync[k]);
            last = std::max(last, d->sync[k]);
        }
        spread.edges = std::max(spread.edges, last - first);
        if (k == 0) continue;
        spread.shortest = std::min(spread.shortest, drives[0]->sync[k] - drives[0]->sync[k - 1]);
        spread.longest = std::max(spread.longest, drives[0]->sync[k] - drives[0]->sync[k - 1]);
    }
    EXPECT_GE(drives[0]->sync.size(), cycles - 1);
    EXPECT_EQ(master.cycle().overruns, 0u);
    for (const auto& d : drives) EXPECT_EQ(d->left, 0u);
    return spread;
}

void print(const char* what, const Spread& s) {
    const auto ns = [](Ticks t) { return static_cast<double>(t.n) / core::kTicksPerNs; };
    std::printf("eight drives, %s: SYNC edges within %.3f ns, cycle %.3f to %.3f ns\n", what, ns(s.edges), ns(s.shortest), ns(s.longest));
}

const std::vector<Ticks> kSamePlace(8);
const std::vector<std::int32_t> kNoDrift(8);

// proves: VPC3C 7.3.2-01..02
TEST(DpV2Scenario, without_drift_the_SYNC_edges_of_eight_drives_fall_on_the_same_tick) {
    const Spread s = drives(kNoDrift, kSamePlace, 500);
    print("no drift", s);
    EXPECT_EQ(s.edges, Ticks{});
    EXPECT_EQ(s.shortest, 1_ms);
    EXPECT_EQ(s.longest, 1_ms);
}

TEST(DpV2Scenario, crystals_100_ppm_off_hardly_spread_the_SYNC_edges) {
    const std::vector<std::int32_t> ppb{100'000, -100'000, 50'000, -50'000, 100'000, -100'000, 0, 25'000};
    const Spread s = drives(ppb, kSamePlace, 500, {}, 100'000);
    print("crystals up to 100 ppm off", s);
    EXPECT_LE(s.edges, 1_ns) << "the four clk of the pulse delay differ by ten millionths of a microsecond";
    EXPECT_NEAR(static_cast<double>(core::to_ns(s.longest)), 999'900.0, 2.0) << "the cycle is the master's millisecond";
}

TEST(DpV2Scenario, with_any_phase_the_SYNC_edges_stay_within_a_quarter_bit_and_a_clk) {
    // What a phase of the sampling clock does: the telegram is taken up to a quarter bit and one CLK later.
    std::mt19937 random{7};
    const Ticks limit = core::kClk + core::kClk;  // a bit is four CLK
    std::vector<Ticks> phase;
    for (int i = 0; i < 8; ++i) phase.push_back(Ticks{static_cast<std::int64_t>(random() % static_cast<unsigned>(limit.n))});
    const Spread s = drives(kNoDrift, phase, 500);
    print("random phases", s);
    EXPECT_LE(s.edges, limit);
    EXPECT_GT(s.edges, Ticks{});
}

TEST(DpV2Scenario, a_jitter_of_the_master_moves_all_drives_alike) {
    const Spread s = drives(kNoDrift, kSamePlace, 500, 1_us);
    print("a master with 1 us of jitter", s);
    EXPECT_EQ(s.edges, Ticks{});
    EXPECT_GE(s.shortest, 999_us);
    EXPECT_LE(s.longest, 1001_us);
    EXPECT_GT(s.longest - s.shortest, 1_us) << "it does jitter";
}

// ---- (c) clock synchronisation --------------------------------------------------------------------------------------

/// Greatest errors of the slave's clock in ns over 30 minutes, looked at ten times a second.
struct ClockError {
    std::int64_t worst = 0;    ///< from the first setting on
    std::int64_t settled = 0;  ///< from the third one on
};

ClockError clock_error(std::int32_t ppb, Ticks interval, bool rate) {
    master::MasterConfig config;
    config.min_cycle = 10_ms;
    // The era that began in 1900 ends in the middle.
    config.time = {interval, dp::NetworkTime::from_wire(0xFFFFFFFF - 900, 0)};
    Plant plant{config};
    Octets block(6);
    EXPECT_TRUE(dp::encode(dp::TimeAr{.interval = static_cast<std::uint16_t>(interval / 10_ms)}, block));
    Dpv2Station& slave = plant.plug({.address = 10, .clock = true, .clock_rate = rate, .crystal_ppb = ppb}, block);
    EXPECT_TRUE(plant.start());
    EXPECT_TRUE(plant.line.run_until([&] { return slave.clock().valid(); }, interval * 3));
    ClockError error;
    for (int i = 0; i < 30 * 60 * 10; ++i) {
        plant.line.run(100_ms);
        plant.line.settle();
        const dp::NetworkTime right = config.time.start.plus_ns(core::to_ns(plant.line.now()));
        const std::int64_t off = std::abs(slave.clock().now(slave.local_ns()).minus_ns(right));
        error.worst = std::max(error.worst, off);
        if (std::ranges::count(slave.clock_events, driver::ClockEvent::set) >= 3) error.settled = std::max(error.settled, off);
    }
    // The first Clock_Value names a time that this slave has not received: the check lets the ones after it pass.
    EXPECT_GE(static_cast<std::int64_t>(std::ranges::count(slave.clock_events, driver::ClockEvent::set)), 30_s * 60 / interval - 2);
    EXPECT_GT(slave.clock().now(slave.local_ns()).seconds, dp::NetworkTime::kEra) << "beyond 2036";
    return error;
}

// proves: VPC3C 7.3.3-01, VPC3C 7.3.3-49
TEST(DpV2Scenario, a_slave_clock_follows_the_time_master_for_30_minutes) {
    constexpr std::int32_t kDrift = 100'000;
    const Ticks interval = 10_s;
    const std::int64_t limit = 2'000, with_drift = limit + core::to_ns(interval) / 10'000;
    const ClockError still = clock_error(0, interval, true), drifting = clock_error(kDrift, interval, false), learnt = clock_error(kDrift, interval, true);
    const auto us = [](std::int64_t ns) { return static_cast<double>(ns) / 1000; };
    std::printf("clock synchronisation every 10 s over 30 minutes: error up to %.3f us; with a crystal 100 ppm off %.3f us, with its rate "
                "corrected %.3f us until the third setting and %.3f us from there on\n",
                us(still.worst), us(drifting.worst), us(learnt.worst), us(learnt.settled));
    EXPECT_LT(still.worst, limit);
    EXPECT_LT(drifting.worst, with_drift);
    EXPECT_LT(learnt.worst, with_drift) << "the rate is not known before the second setting";
    EXPECT_LT(learnt.settled, limit);
    EXPECT_GT(drifting.settled, 100 * learnt.settled) << "what the correction is good for";
}

// ---- (d) switch-over ------------------------------------------------------------------------------------------------

TEST(DpV2Scenario, a_backup_master_takes_over_and_no_output_is_cleared) {
    master::MasterConfig standby;
    standby.mode = master::Mode::offline;
    master::Master backup{standby};
    Plant plant{{}};
    for (std::uint8_t i = 0; i < 5; ++i) {
        Dpv2Station& s = plant.plug({.address = static_cast<std::uint8_t>(10 + i)});
        ASSERT_TRUE(backup.add(s.config()));
    }
    const auto index = plant.line.attach(backup, "backup");
    ASSERT_TRUE(index);
    ASSERT_TRUE(plant.start());
    for (std::size_t n = 0; n < plant.master.size(); ++n) plant.master.slave(n).outputs()[0] = static_cast<std::uint8_t>(0x80 + n);
    plant.cycles(100);
    // The primary master dies at a moment of its own, in the middle of a cycle.
    plant.line.run(123_us);
    const Ticks died = plant.line.now();
    plant.line.detach(0);
    ASSERT_TRUE(backup.take_over(plant.master));
    plant.line.touch(*index);
    EXPECT_FALSE(backup.take_over(plant.master)) << "it is on the bus already";
    const std::uint64_t before = plant.stations[0]->exchanges;
    ASSERT_TRUE(plant.line.run_until([&] { return plant.stations[0]->exchanges > before; }, 1_s));
    const Ticks gap = plant.line.now() - died;
    plant.line.run(1_s);
    EXPECT_TRUE(backup.all_exchanging());
    for (std::size_t n = 0; n < plant.stations.size(); ++n) {
        const Dpv2Station& s = *plant.stations[n];
        EXPECT_EQ(s.cleared, 0u);
        EXPECT_EQ(s.left, 0u);
        EXPECT_EQ(s.output, 0x80 + n);
        EXPECT_EQ(backup.slave(n).counters().lost, 0u);
    }
    std::printf("switch-over: the first exchange with the backup master came %.1f us after the primary one died, no output cleared\n",
                static_cast<double>(core::to_ns(gap)) / 1000);
}

}  // namespace
}  // namespace dpchip::test
