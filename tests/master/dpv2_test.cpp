// SPDX-License-Identifier: Apache-2.0
// The master's part of DP-V2, telegram by telegram: publishers, isochronous cycles, time master, taking over
// (VPC3+C 7.3; reference 6).
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/dp/clock.hpp>
#include <dpchip/fdl/telegram.hpp>
#include <dpchip/master/master.hpp>
#include <dpchip/segment/segment.hpp>

#include "master/dpv2_station.hpp"

namespace dpchip::test {
namespace {

using namespace core::literals;

/// Everything on the line, with its times.
struct Tape {
    struct Entry {
        Ticks start, end;
        Octets octets;
        segment::StationIndex sender;
    };
    std::vector<Entry> entries;
    void see(const segment::Sighting& s) { entries.push_back({s.sent.start, s.sent.end(), Octets(s.sent.bytes().begin(), s.sent.bytes().end()), s.sender}); }
    /// Those of the master with this function code.
    std::vector<Entry> with_fc(std::uint8_t fc) const {
        std::vector<Entry> out;
        for (const Entry& e : entries) {
            const auto t = fdl::decode(e.octets);
            if (t && t->has_fc() && t->fc.octet == fc) out.push_back(e);
        }
        return out;
    }
};

struct Rig {
    explicit Rig(const master::MasterConfig& config, bool publisher = false) : master{config} {
        EXPECT_TRUE(line.attach(master, "master"));
        EXPECT_TRUE(line.attach(station, "station"));
        master::SlaveConfig c = station.config();
        c.publisher = publisher;
        EXPECT_TRUE(master.add(c));
        EXPECT_TRUE(line.run_until([&] { return master.all_exchanging(); }, 10_s));
        line.observe(tape);
    }
    segment::Segment line;
    master::Master master;
    Dpv2Station station{{.address = 10}};
    Tape tape;
};

// proves: VPC3C 7.3.1-03, VPC3C 7.3.1-14
TEST(MasterDpv2, polls_a_publisher_with_function_code_7_and_takes_its_broadcast) {
    Rig r{{}, true};
    r.line.run(10_ms);
    EXPECT_FALSE(r.tape.with_fc(0x57).empty());
    EXPECT_FALSE(r.tape.with_fc(0x77).empty());
    EXPECT_TRUE(r.tape.with_fc(0x5D).empty());
    EXPECT_EQ(r.master.counters().foreign, 0u);
    EXPECT_EQ(r.master.slave(0).inputs()[0], 10);
    EXPECT_EQ(r.master.slave(0).config().min_tsdr, fdl::bus_times(fdl::BaudCode::mbit_12).publisher_min_tsdr());
    EXPECT_EQ(r.master.slave(0).config().user_prm[0] & dp::kPublisherEnable, dp::kPublisherEnable);
}

TEST(MasterDpv2, polls_other_slaves_as_ever) {
    Rig r{{}};
    r.line.run(10_ms);
    EXPECT_TRUE(r.tape.with_fc(0x57).empty());
    EXPECT_FALSE(r.tape.with_fc(0x5D).empty());
}

// proves: VPC3C 7.3.2-01, VPC3C 7.3.2-13
TEST(MasterDpv2, an_isochronous_cycle_is_SYNCH_cyclic_part_acyclic_part_token_and_spare_time) {
    master::MasterConfig config;
    config.isochron.cycle = 1_ms;
    Rig r{config};
    master::Job diag = master::Job::slave_diag(10);
    ASSERT_TRUE(r.master.submit(diag));
    r.line.run(20_ms);
    EXPECT_EQ(diag.outcome, master::Job::Outcome::data);
    const auto synchs = r.tape.with_fc(0x46);
    ASSERT_GE(synchs.size(), 19u);
    for (std::size_t i = 1; i < synchs.size(); ++i) EXPECT_EQ(synchs[i].start - synchs[i - 1].start, 1_ms);
    EXPECT_EQ(synchs[0].octets, (Octets{0x68, 0x07, 0x07, 0x68, 0xFF, 0x82, 0x46, 0x3A, 0x3E, 0x00, 0x80, 0xBF, 0x16}));
    // What stands between two SYNCHs: the exchange, perhaps the job, the token last.
    for (std::size_t i = 0; i + 1 < r.tape.entries.size(); ++i)
        if (r.tape.entries[i + 1].octets == synchs[0].octets) { EXPECT_EQ(r.tape.entries[i].octets[0], fdl::kSd4); }
    EXPECT_EQ(r.master.cycle().min, 1_ms);
    EXPECT_EQ(r.master.cycle().max, 1_ms);
}

TEST(MasterDpv2, a_cycle_that_is_too_long_leaves_SYNCHs_out_and_stays_on_the_grid) {
    master::MasterConfig config;
    config.isochron.cycle = 100_us;  // SYNCH and TID2 alone take 78 of them
    Rig r{config};
    r.line.run(20_ms);
    const auto synchs = r.tape.with_fc(0x46);
    ASSERT_GE(synchs.size(), 10u);
    EXPECT_GT(r.master.cycle().overruns, 0u);
    for (std::size_t i = 1; i < synchs.size(); ++i) {
        const Ticks period = synchs[i].start - synchs[i - 1].start;
        EXPECT_EQ(period.n % (100_us).n, 0);
        EXPECT_GT(period, 100_us);
    }
}

TEST(MasterDpv2, acyclic_work_waits_for_a_cycle_with_room_for_it) {
    master::MasterConfig config;
    config.isochron.cycle = 400_us;
    Rig r{config};
    r.master.start_scan();
    r.line.run(500_ms);
    EXPECT_EQ(r.master.cycle().overruns, 0u);
    EXPECT_TRUE(r.master.scanning()) << "the longest answer and its slot time do not fit into 400 us";
    EXPECT_EQ(r.master.cycle().max, 400_us);
}

TEST(MasterDpv2, the_same_seed_gives_the_same_jitter) {
    const auto times = [](std::uint64_t seed) {
        master::MasterConfig config;
        config.isochron = {.cycle = 1_ms, .jitter = 2_us, .seed = seed};
        Rig r{config};
        r.line.run(20_ms);
        std::vector<std::int64_t> out;
        for (const auto& e : r.tape.with_fc(0x46)) out.push_back(e.start.n);
        return out;
    };
    EXPECT_EQ(times(5), times(5));
    EXPECT_NE(times(5), times(9));
}

// proves: VPC3C 7.3.3-07..08, VPC3C 7.3.3-10
TEST(MasterDpv2, the_time_master_says_when_its_Time_Event_had_ended) {
    master::MasterConfig config;
    const dp::NetworkTime start = dp::NetworkTime::from_wire(0xC3000000, 0);
    config.time = {50_ms, start};
    config.min_cycle = 1_ms;
    Rig r{config};
    r.line.run(1_s);
    const auto events = r.tape.with_fc(0x40), values = r.tape.with_fc(0xC0);
    ASSERT_GE(events.size(), 19u);
    ASSERT_EQ(events.size(), values.size());
    for (std::size_t i = 0; i < events.size(); ++i) {
        EXPECT_EQ(events[i].octets, (Octets{0x10, 0x7F, 0x02, 0x40, 0xC1, 0x16}));
        const auto t = fdl::decode(values[i].octets);
        ASSERT_TRUE(t);
        const auto value = dp::decode_clock_value(t->data());
        ASSERT_TRUE(value);
        EXPECT_EQ(value->time_event, start.plus_ns(core::to_ns(events[i].end)));
        if (i != 0) { EXPECT_EQ(value->previous, start.plus_ns(core::to_ns(events[i - 1].end))); }
        EXPECT_LT(values[i].start - events[i].end, 1_ms);
    }
}

TEST(MasterDpv2, only_an_offline_backup_of_the_same_address_and_slaves_takes_over) {
    const Dpv2Station ten{{.address = 10}}, eleven{{.address = 11}};
    const auto backup = [&](std::uint8_t address, master::Mode mode, const Dpv2Station& slave) {
        auto m = std::make_unique<master::Master>(master::MasterConfig{.address = address, .mode = mode});
        EXPECT_TRUE(m->add(slave.config()));
        return m;
    };
    const auto primary = backup(2, master::Mode::operate, ten);
    EXPECT_FALSE(backup(3, master::Mode::offline, ten)->take_over(*primary));
    EXPECT_FALSE(backup(2, master::Mode::operate, ten)->take_over(*primary));
    EXPECT_FALSE(backup(2, master::Mode::offline, eleven)->take_over(*primary));
    EXPECT_TRUE(backup(2, master::Mode::offline, ten)->take_over(*primary));
}

}  // namespace
}  // namespace dpchip::test
