// SPDX-License-Identifier: Apache-2.0
// A line of bits against a segment of telegrams: the same master, the same slaves, the same behaviour (8.3).
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/gsd/parse.hpp>
#include <dpchip/master/from_gsd.hpp>
#include <dpchip/master/master.hpp>
#include <dpchip/pins/bit_line.hpp>
#include <dpchip/segment/port.hpp>
#include <dpchip/segment/segment.hpp>
#include <dpchip/slave/virtual_slave.hpp>

namespace dpchip::pins {
namespace {

using namespace core::literals;
using segment::Port;

/// A slave with its firmware where a UART wants a chip.
struct SlaveHost {
    std::unique_ptr<slave::VirtualSlave> slave;
    std::vector<core::TraceRecord> ring = std::vector<core::TraceRecord>(200'000);

    Ticks now() const { return slave->chip().now(); }
    Ticks next() const { return slave->next(); }
    const chip::State& state() const { return slave->chip().state(); }
    void advance(Ticks to) { slave->advance(to); }
    void hear_character(const fdl::Character& c) { slave->hear_character(c); }
    void carrier(Ticks at) { slave->carrier(at); }
    bool take(fdl::Transmission& t) { return slave->take(t); }
    void sent(Ticks at) { slave->sent(at); }
    void hold() { slave->chip().hold(); }
    void line_low(Ticks until) { slave->chip().line_low(until); }
    void set_xcts(chip::Level level) { slave->chip().set_xcts(level); }
};
static_assert(UartHost<SlaveHost>);

const gsd::Gsd& remote_io() {
    static const gsd::Gsd gsd = gsd::load(DPCHIP_SOURCE_DIR "/examples/remote_io.gsd");
    return gsd;
}

/// A master and two slaves, wherever they hang.
struct Members {
    master::Master master;
    std::vector<std::unique_ptr<SlaveHost>> hosts;

    explicit Members(fdl::BaudCode rate, regmap::Variant variant = regmap::Variant::vpc3c, bool dis_start = false) : master{{.baud = rate}} {
        for (const std::uint8_t address : {std::uint8_t{3}, std::uint8_t{4}}) {
            slave::SlaveSetup setup;
            setup.address = address;
            setup.variant = variant;
            setup.modules = address == 3 ? std::vector<std::string>{"16 DI / 16 DO"} : std::vector<std::string>{"8 DI"};
            setup.options.baud_probe_ms = {1, 1, 1, 1, 2, 4, 8, 16, 31, 59};
            if (dis_start) setup.options.start_window_samples = 2;
            hosts.push_back(std::make_unique<SlaveHost>());
            hosts.back()->slave = std::make_unique<slave::VirtualSlave>(remote_io(), setup);
            hosts.back()->slave->chip().trace().attach(hosts.back()->ring);
            EXPECT_TRUE(master.add(master::slave_config(remote_io(), gsd::configure(remote_io(), setup.modules), address)));
        }
    }
};

struct OnSegment : Members {
    segment::Segment line;
    template <class... A>
    explicit OnSegment(A... a) : Members{a...} {
        EXPECT_TRUE(line.attach(master, "master"));
        for (auto& h : hosts) EXPECT_TRUE(line.attach(*h->slave));
    }
    void run(Ticks to) {
        line.advance(to);
        line.settle();
    }
};

struct OnBits : Members {
    BitLine line;
    TelegramAdapter<master::Master> adapter;
    std::vector<std::unique_ptr<BasicUart<SlaveHost>>> uarts;
    std::vector<std::unique_ptr<UartStation<SlaveHost>>> stations;

    template <class... A>
    explicit OnBits(fdl::BaudCode rate, A... a) : Members{rate, a...}, adapter{master, rate} {
        EXPECT_NE(line.attach(adapter), BitLine::kNobody);
        for (auto& h : hosts) {
            uarts.push_back(std::make_unique<BasicUart<SlaveHost>>());
            stations.push_back(std::make_unique<UartStation<SlaveHost>>(*h, *uarts.back()));
            EXPECT_NE(line.attach(*stations.back()), BitLine::kNobody);
        }
    }
    void run(Ticks to) { line.advance(to); }
    /// Runs until all slaves exchange data; how long it took, or nothing within the limit.
    bool start(Ticks limit) {
        while (!master.all_exchanging() && line.now() < limit) line.advance(line.now() + 1_ms);
        return master.all_exchanging();
    }
};

bool timer_fact(const core::TraceRecord& r) {
    const bool irr = r.what == static_cast<std::uint16_t>(regmap::Fact::irr);
    return irr && ((r.a ^ r.b) & ~unsigned{regmap::interrupt::user_timer_clock}) == 0;
}
std::vector<core::TraceRecord> facts(const SlaveHost& h) {
    const std::uint64_t count = h.slave->chip().trace().count;
    EXPECT_LE(count, h.ring.size());
    std::vector<core::TraceRecord> out;
    bool found = false;  // the search before the rate is found meets garbage, whose faults depend on the way of looking
    for (std::uint64_t i = 0; i < count; ++i) {
        found = found || h.ring[i].what == static_cast<std::uint16_t>(regmap::Fact::proof);
        if (found && !timer_fact(h.ring[i])) out.push_back(h.ring[i]);
    }
    return out;
}

void expect_same_memory(const SlaveHost& a, const SlaveHost& b) {
    for (unsigned n = 0; n < a.slave->chip().ram_bytes(); ++n) {
        const auto address = static_cast<std::uint16_t>(n);
        ASSERT_EQ(a.slave->chip().peek(address), b.slave->chip().peek(address)) << "address " << n;
    }
}

// proves: VPC3C 8.3-02
TEST(BitLineAndSegment, behave_alike_to_the_tick_at_12_Mbit_s_where_every_edge_lies_on_the_grid) {
    for (const regmap::Traits& t : regmap::kTraits) {
        SCOPED_TRACE(t.name);
        OnSegment telegrams{fdl::BaudCode::mbit_12, t.variant};
        OnBits bits{fdl::BaudCode::mbit_12, t.variant};
        telegrams.run(8_ms);
        bits.run(8_ms);
        ASSERT_TRUE(telegrams.master.all_exchanging());
        ASSERT_TRUE(bits.master.all_exchanging());
        EXPECT_EQ(telegrams.master.counters().requests, bits.master.counters().requests);
        EXPECT_EQ(telegrams.master.counters().answers, bits.master.counters().answers);
        EXPECT_EQ(bits.master.counters().damaged, 0u);
        EXPECT_EQ(telegrams.master.cycle().last, bits.master.cycle().last);
        for (std::size_t i = 0; i < telegrams.hosts.size(); ++i) {
            const auto a = facts(*telegrams.hosts[i]), b = facts(*bits.hosts[i]);
            EXPECT_GT(a.size(), 300u);
            EXPECT_EQ(a, b) << "the same facts at the same ticks";
            expect_same_memory(*telegrams.hosts[i], *bits.hosts[i]);
        }
    }
}

TEST(BitLineAndSegment, behave_alike_at_every_rate_and_differ_by_less_than_a_quarter_of_a_bit_per_message) {
    for (const fdl::Baud& baud : fdl::kBaud) {
        SCOPED_TRACE(baud.name);
        const Ticks span = 130_ms + baud.bit * 30'000;
        OnSegment telegrams{baud.code};
        OnBits bits{baud.code};
        telegrams.run(span);
        bits.run(span);
        ASSERT_TRUE(telegrams.master.all_exchanging());
        ASSERT_TRUE(bits.master.all_exchanging());
        EXPECT_EQ(bits.master.counters().damaged, 0u);
        for (std::size_t i = 0; i < telegrams.hosts.size(); ++i) {
            const auto a = facts(*telegrams.hosts[i]), b = facts(*bits.hosts[i]);
            const std::size_t both = std::min(a.size(), b.size());
            EXPECT_GT(both, 100u);
            EXPECT_LE(std::max(a.size(), b.size()) - both, 40u) << "messages come a little later, one cycle may be missing at the end";
            std::int64_t messages = 0;
            for (std::size_t n = 0; n < both; ++n) {
                ASSERT_EQ(a[n].what, b[n].what) << n;
                ASSERT_EQ(a[n].a, b[n].a) << n;
                ASSERT_EQ(a[n].b, b[n].b) << n;
                messages += a[n].what == static_cast<std::uint16_t>(regmap::Fact::heard) ? 1 : 0;
            }
            const Ticks first = b[0].at - a[0].at;
            for (std::size_t n = 1; n < both; ++n) {
                const Ticks late = b[n].at - a[n].at - first;
                ASSERT_GE(late * 4, Ticks{} - baud.bit * (4 * (messages + 2)));
                ASSERT_LE(late * 4, baud.bit * (4 * (messages + 2)));
                const bool answer = a[n].what == static_cast<std::uint16_t>(regmap::Fact::answer);
                if (!answer) continue;
                std::size_t heard = n;
                while (heard > 0 && a[heard].what != static_cast<std::uint16_t>(regmap::Fact::heard)) --heard;
                ASSERT_EQ(a[n].at - a[heard].at, b[n].at - b[heard].at) << "the time between request and answer is the chip's own";
            }
        }
    }
}

TEST(BitLine, distortion_up_to_nearly_a_quarter_of_a_bit_does_no_harm_and_three_quarters_let_nothing_through) {
    for (const fdl::BaudCode rate : {fdl::BaudCode::mbit_12, fdl::BaudCode::mbit_1_5, fdl::BaudCode::kbit_187_5}) {
        for (const std::int32_t percent : {-75, -24, -10, 10, 24, 75}) {
            SCOPED_TRACE(std::string{fdl::baud(rate).name} + ", low levels longer by " + std::to_string(percent) + " %");
            OnBits bits{rate};
            bits.line.set_distortion({fdl::baud(rate).bit, percent, 0, 1});
            const bool good = bits.start(60_ms);
            EXPECT_EQ(good, percent > -30 && percent < 30);
            if (good) {
                EXPECT_EQ(bits.master.counters().damaged, 0u);
            }
        }
    }
}

TEST(BitLine, jitter_of_a_fifth_of_a_bit_does_no_harm) {
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        OnBits bits{fdl::BaudCode::mbit_12};
        bits.line.set_distortion({fdl::baud(fdl::BaudCode::mbit_12).bit, 0, 20, seed});
        EXPECT_TRUE(bits.start(20_ms)) << "seed " << seed;
        EXPECT_EQ(bits.master.counters().damaged, 0u) << "seed " << seed;
    }
}

/// Spikes at random: whatever they do, the master gets its slaves back, and nobody answers who was not asked.
TEST(BitLine, noise_is_survived) {
    const char* const more = std::getenv("DPCHIP_LONG");
    const unsigned rounds = more != nullptr ? 40 : 4;
    for (unsigned seed = 1; seed <= rounds; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 random{seed};
        OnBits bits{fdl::BaudCode::mbit_12};
        ASSERT_TRUE(bits.start(20_ms));
        const Ticks until = bits.line.now() + 10_ms;
        while (bits.line.now() < until) {
            const Ticks at = bits.line.now() + Ticks{static_cast<std::int64_t>(random() % 4'000'000)};
            const auto length = static_cast<std::int64_t>(1 + random() % (seed % 2 == 0 ? 3'000 : 60'000));
            bits.line.disturb({at, Ticks{length}, random() % 3 == 0 ? PinLevel::high : PinLevel::low});
            bits.line.advance(at + Ticks{length + 1});
        }
        for (int n = 0; n < 40 && !bits.master.all_exchanging(); ++n) bits.line.advance(bits.line.now() + 5_ms);
        EXPECT_TRUE(bits.master.all_exchanging());
        EXPECT_EQ(bits.master.counters().foreign, 0u);
        EXPECT_EQ(bits.line.overruns(), 0u);
    }
}

TEST(BitLine, two_slaves_that_answer_alike_at_one_address_are_heard_as_one) {
    Port asker{fdl::BaudCode::mbit_1_5};
    TelegramAdapter<Port> adapter{asker, fdl::BaudCode::mbit_1_5};
    BitLine line;
    line.attach(adapter);
    Members members{fdl::BaudCode::mbit_1_5};
    std::vector<std::unique_ptr<BasicUart<SlaveHost>>> uarts;
    std::vector<std::unique_ptr<UartStation<SlaveHost>>> stations;
    Members again{fdl::BaudCode::mbit_1_5};
    for (SlaveHost* h : {members.hosts[0].get(), again.hosts[0].get()}) {
        uarts.push_back(std::make_unique<BasicUart<SlaveHost>>());
        stations.push_back(std::make_unique<UartStation<SlaveHost>>(*h, *uarts.back()));
        line.attach(*stations.back());
    }
    const std::vector<std::uint8_t> status{0x10, 0x03, 0x02, 0x49, 0x4E, 0x16};
    for (int n = 0; n < 60; ++n) {
        asker.send(status);
        line.advance(line.now() + 300_us);
    }
    ASSERT_TRUE(asker.pending());
    EXPECT_GT(line.collisions(), 0u);
    EXPECT_FALSE(asker.receive().damaged);
}

TEST(BitLine, stations_hear_each_other_after_the_time_the_signal_takes) {
    Port a{fdl::BaudCode::mbit_12}, b{fdl::BaudCode::mbit_12};
    TelegramAdapter<Port> left{a, fdl::BaudCode::mbit_12}, right{b, fdl::BaudCode::mbit_12};
    BitLine line;
    line.attach(left);
    line.attach(right, 500_ns);
    const std::vector<std::uint8_t> token{0xDC, 0x01, 0x02};
    ASSERT_TRUE(a.send_at(10_us, token));
    line.advance(1_ms);
    ASSERT_TRUE(b.pending());
    const auto heard = b.receive();
    EXPECT_EQ(heard.start, 10_us + 500_ns);
    EXPECT_FALSE(heard.damaged);
    EXPECT_TRUE(std::equal(token.begin(), token.end(), heard.bytes().begin(), heard.bytes().end()));
    EXPECT_FALSE(a.pending()) << "nobody hears himself";
}

TEST(TelegramAdapter, hands_over_what_is_damaged_character_by_character) {
    for (const std::uint8_t fault : {std::uint8_t{fdl::fault_parity}, std::uint8_t{fdl::fault_stop}, std::uint8_t{0}}) {
        Port a{fdl::BaudCode::kbit_500}, b{fdl::BaudCode::kbit_500};
        TelegramAdapter<Port> left{a, fdl::BaudCode::kbit_500}, right{b, fdl::BaudCode::kbit_500};
        BitLine line;
        line.attach(left);
        line.attach(right);
        std::vector<std::uint8_t> octets{0x10, 0x08, 0x02, 0x49, 0x53, 0x16};
        std::vector<std::uint8_t> faults(6);
        if (fault == 0) octets[4] = 0x54;  // a wrong FCS
        faults[3] = fault;
        if (fault == fdl::fault_stop) {  // without a stop bit the next start bit has no edge: leave nothing behind it
            octets.resize(4);
            faults.resize(4);
        }
        ASSERT_TRUE(a.send_at(1_ms, octets, faults));
        line.advance(3_ms);
        ASSERT_TRUE(b.pending());
        const auto heard = b.receive();
        EXPECT_TRUE(heard.damaged);
        EXPECT_EQ(heard.start, 1_ms);
        EXPECT_TRUE(std::equal(octets.begin(), octets.end(), heard.bytes().begin(), heard.bytes().end()));
        EXPECT_EQ(heard.faults[3], fault);
    }
}

TEST(TelegramAdapter, a_telegram_that_stops_in_the_middle_is_handed_over_and_the_next_one_is_whole) {
    Port a{fdl::BaudCode::mbit_3}, b{fdl::BaudCode::mbit_3};
    TelegramAdapter<Port> left{a, fdl::BaudCode::mbit_3}, right{b, fdl::BaudCode::mbit_3};
    BitLine line;
    line.attach(left);
    line.attach(right);
    ASSERT_TRUE(a.send_at(1_ms, std::vector<std::uint8_t>{0x68, 0x05, 0x05}));
    line.advance(2_ms);
    ASSERT_TRUE(a.send_at(2_ms, std::vector<std::uint8_t>{0xDC, 0x01, 0x02}));
    line.advance(3_ms);
    ASSERT_TRUE(b.pending());
    EXPECT_EQ(b.receive().length, 3);
    ASSERT_TRUE(b.pending());
    const auto token = b.receive();
    EXPECT_FALSE(token.damaged);
    EXPECT_EQ(token.start, 2_ms);
}

TEST(BitLine, it_makes_no_difference_in_how_many_steps_time_goes_by) {
    std::vector<core::TraceRecord> first;
    for (const std::int64_t step : {6'000'000, 77'777, 1'250}) {
        OnBits bits{fdl::BaudCode::mbit_12};
        while (bits.line.now() < 3_ms) bits.line.advance(bits.line.now() + Ticks{step});
        bits.line.advance(3_ms + 1_us);
        std::vector<core::TraceRecord> all = facts(*bits.hosts[0]);
        std::erase_if(all, [](const core::TraceRecord& r) { return r.at > 3_ms; });
        if (first.empty()) first = all;
        ASSERT_GT(first.size(), 50u);
        EXPECT_EQ(all, first) << step;
    }
}

}  // namespace
}  // namespace dpchip::pins
