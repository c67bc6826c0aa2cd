// SPDX-License-Identifier: Apache-2.0
// From power-up to data exchange, what may go wrong on the way, and the way back (reference 2.5, 3.2 to 3.9).
#include <algorithm>

#include "master/bus.hpp"

namespace {

using namespace dpchip;
using namespace dpchip::core::literals;
using core::Ticks;
using master::Mode;
using master::SlaveFault;
using master::SlaveState;
using test::Bus;
using test::ScriptedSlave;

TEST(Start, takes_the_telegrams_of_the_reference_in_their_order) {
    Bus bus;
    test::Recorder record;
    bus.line.observe(record);
    ScriptedSlave& slave = bus.plug({.own = 8});
    ASSERT_TRUE(bus.start());
    bus.cycles(3);
    std::vector<std::vector<std::uint8_t>> sent;
    for (const auto& e : record.entries)
        if (e.sender == 0 && e.octets[0] != fdl::kSd4) sent.push_back(e.octets);
    using Octets = std::vector<std::uint8_t>;
    const std::vector<Octets> expected{
        {0x10, 8, 2, 0x49, 0x53, 0x16},                                                       // FDL_Status
        {0x68, 7, 7, 0x68, 0xFF, 0x82, 0x46, 0x3A, 0x3E, 0, 0, 0x3F, 0x16},                     // Operate
        {0x68, 5, 5, 0x68, 0x88, 0x82, 0x6D, 0x3C, 0x3E, 0xF1, 0x16},                           // Slave_Diag, first
        {0x68, 12, 12, 0x68, 0x88, 0x82, 0x5D, 0x3D, 0x3E, 0x80, 1, 1, 11, 0x47, 0x11, 0, 0xC7, 0x16},  // Set_Prm
        {0x68, 7, 7, 0x68, 0x88, 0x82, 0x7D, 0x3E, 0x3E, 0x11, 0x21, 0x35, 0x16},               // Chk_Cfg
        {0x68, 5, 5, 0x68, 0x88, 0x82, 0x5D, 0x3C, 0x3E, 0xE1, 0x16},                           // Slave_Diag
        {0x68, 5, 5, 0x68, 8, 2, 0x7D, 0, 0, 0x87, 0x16},                                       // Data_Exchange
        {0x68, 5, 5, 0x68, 8, 2, 0x5D, 0, 0, 0x67, 0x16},
    };
    ASSERT_GE(sent.size(), expected.size());
    sent.resize(expected.size());
    EXPECT_EQ(sent, expected);
    EXPECT_EQ(slave.repeats, 0u);
}

TEST(Start, waits_until_the_bus_would_be_taken_by_nobody_else) {
    Bus bus{{.address = 5}};
    test::Recorder record;
    bus.line.observe(record);
    bus.cycles(1);
    EXPECT_EQ(record.entries[0].start, fdl::baud(fdl::BaudCode::mbit_12).bit * (1000 * 16));
    EXPECT_EQ(record.entries[0].octets, (std::vector<std::uint8_t>{0xDC, 5, 5}));
}

TEST(Start, keeps_quiet_while_it_hears_others) {
    Bus bus;
    test::Talker other;
    for (int i = 1; i < 20; ++i) other.plan.emplace_back(core::microseconds(100 * i), std::vector<std::uint8_t>{0xDC, 9, 9});
    ASSERT_TRUE(bus.line.attach(other));
    bus.line.advance(core::microseconds(1'950));
    EXPECT_EQ(bus.master.counters().foreign, 19u);
    EXPECT_EQ(bus.master.cycle().cycles, 0u);
    EXPECT_EQ(bus.line.counters().transmissions, 19u);
}

TEST(Start, sends_watchdog_group_sync_freeze_and_user_parameters) {
    Bus bus;
    ScriptedSlave slave{.own = 3};
    ASSERT_TRUE(bus.line.attach(slave));
    master::SlaveConfig config = test::config_of(slave);
    config.watchdog_ms = 300;
    config.group = 0x81;
    config.sync = config.freeze = true;
    config.min_tsdr = 0;
    config.user_prm = {0x00, 0x10, 0x00, 0xAB};
    ASSERT_TRUE(bus.master.add(config));
    ASSERT_TRUE(bus.start());
    ASSERT_EQ(slave.set_prm.size(), 11u);
    EXPECT_EQ(slave.set_prm[0], 0xB8);
    EXPECT_EQ(slave.set_prm[1] * slave.set_prm[2], 30);
    EXPECT_EQ(slave.set_prm[3], 0);
    EXPECT_EQ(slave.set_prm[6], 0x81);
    EXPECT_EQ(slave.set_prm[10], 0xAB);
    EXPECT_EQ(bus.master.slave(0).diagnosis()[1], 0x0C);
}

TEST(Start, waits_for_a_slave_that_takes_its_time_to_be_ready) {
    Bus bus;
    ScriptedSlave& slave = bus.plug({.own = 3, .not_ready_for = 20});
    ASSERT_TRUE(bus.start());
    EXPECT_EQ(slave.diagnoses_read, 22u);
}

struct Refusal {
    const char* test;
    SlaveFault fault;
    void (*spoil)(ScriptedSlave&);
    void (*mend)(ScriptedSlave&);
};
class Refused : public ::testing::TestWithParam<Refusal> {};

TEST_P(Refused, slave_says_why_and_is_taken_once_it_is_mended_while_the_other_goes_on) {
    Bus bus;
    ScriptedSlave& good = bus.plug({.own = 4});
    ScriptedSlave& bad = bus.plug({.own = 3});
    GetParam().spoil(bad);
    bus.line.run(20_ms);
    EXPECT_FALSE(bus.master.slave(1).exchanging());
    EXPECT_EQ(bus.master.slave(1).fault(), GetParam().fault) << name(bus.master.slave(1).fault());
    EXPECT_TRUE(bus.master.slave(0).exchanging());
    EXPECT_GT(good.exchanges, 20u);
    GetParam().mend(bad);
    EXPECT_TRUE(bus.start());
    EXPECT_EQ(bus.master.slave(1).fault(), SlaveFault::none);
}
INSTANTIATE_TEST_SUITE_P(
    Start, Refused,
    ::testing::Values(Refusal{"wrong_ident", SlaveFault::wrong_ident, [](ScriptedSlave& s) { s.ident = 1; },
                              [](ScriptedSlave& s) { s.ident = 0x4711; }},
                      Refusal{"locked", SlaveFault::locked, [](ScriptedSlave& s) { s.owner = 9; },
                              [](ScriptedSlave& s) { s.owner = 0xFF; }},
                      Refusal{"prm_fault", SlaveFault::prm_fault, [](ScriptedSlave& s) { s.refuse_prm = true; },
                              [](ScriptedSlave& s) { s.refuse_prm = false; }},
                      Refusal{"cfg_fault", SlaveFault::cfg_fault, [](ScriptedSlave& s) { s.cfg = {0x31}; },
                              [](ScriptedSlave& s) { s.cfg = {0x11, 0x21}; }},
                      Refusal{"invalid_answer", SlaveFault::invalid_answer, [](ScriptedSlave& s) { s.inputs = 3; },
                              [](ScriptedSlave& s) { s.inputs = 2; }}),
    [](const auto& refusal) { return std::string{refusal.param.test}; });

TEST(Slave, that_comes_late_is_found_and_does_not_stop_the_others) {
    Bus bus;
    bus.plug({.own = 4});
    ScriptedSlave& late = bus.plug({.own = 3, .offline = true});
    bus.line.run(20_ms);
    EXPECT_TRUE(bus.master.slave(0).exchanging());
    EXPECT_TRUE(bus.master.slave(1).given_up());
    late.offline = false;
    bus.line.touch(2);
    EXPECT_TRUE(bus.start());
}

TEST(Slave, that_falls_silent_is_given_up_after_the_retries_and_comes_back) {
    Bus bus{{.max_retry = 3}};
    ScriptedSlave& slave = bus.plug({.own = 3});
    ASSERT_TRUE(bus.start());
    bus.cycles(5);
    slave.mute = true;
    ASSERT_TRUE(bus.line.run_until([&] { return !bus.master.slave(0).exchanging(); }, 1_s));
    EXPECT_EQ(bus.master.slave(0).counters().retries, 3u);
    EXPECT_EQ(bus.master.slave(0).counters().lost, 1u);
    slave.mute = false;
    EXPECT_TRUE(bus.start());
}

TEST(Retry, carries_the_same_frame_count_bit_and_the_slave_sees_a_repetition) {
    Bus bus{{.max_retry = 2}};
    ScriptedSlave& slave = bus.plug({.own = 3, .log = true});
    ASSERT_TRUE(bus.start());
    bus.cycles(4);
    slave.fcs.clear();
    slave.mute_for = 1;
    bus.cycles(4);
    ASSERT_GE(slave.fcs.size(), 4u);
    EXPECT_EQ(slave.fcs[0], slave.fcs[1]);
    EXPECT_NE(slave.fcs[1], slave.fcs[2]);
    EXPECT_EQ(bus.master.slave(0).counters().retries, 1u);
    EXPECT_TRUE(bus.master.slave(0).exchanging());
    EXPECT_EQ(bus.master.counters().timeouts, 1u);
}

TEST(Retry, of_a_slave_whose_answer_was_lost_is_not_taken_twice) {
    Bus bus;
    ScriptedSlave& slave = bus.plug({.own = 3});
    ASSERT_TRUE(bus.start());
    bus.cycles(2);
    struct DropAnswer {
        bool armed = true;
        segment::Fault operator()(const fdl::Transmission&, segment::StationIndex sender, std::uint64_t) {
            if (sender != 1 || !armed) return {};
            armed = false;
            return {.kind = segment::FaultKind::drop};
        }
    } drop;
    bus.line.set_faults(segment::FaultRef{drop});
    const std::uint64_t exchanges = slave.exchanges;
    bus.cycles(5);
    EXPECT_EQ(slave.repeats, 1u);
    EXPECT_GE(slave.exchanges, exchanges + 4);
    EXPECT_TRUE(bus.master.slave(0).exchanging());
}

TEST(Lost, slave_that_forgot_its_parameters_answers_RS_and_is_parameterised_again) {
    Bus bus;
    ScriptedSlave& slave = bus.plug({.own = 3});
    ASSERT_TRUE(bus.start());
    slave.leave(0);
    bus.cycles(3);
    EXPECT_FALSE(bus.master.slave(0).exchanging());
    EXPECT_TRUE(bus.start());
    EXPECT_EQ(bus.master.slave(0).counters().lost, 1u);
    EXPECT_EQ(bus.master.slave(0).counters().negative, 1u);
}

TEST(Diagnosis, is_read_when_an_answer_is_DH_and_on_demand) {
    Bus bus;
    ScriptedSlave& slave = bus.plug({.own = 3});
    ASSERT_TRUE(bus.start());
    bus.cycles(3);
    const std::uint64_t read = slave.diagnoses_read;
    slave.diagnosis_waiting = true;
    bus.cycles(4);
    EXPECT_EQ(slave.diagnoses_read, read + 1);
    EXPECT_TRUE(bus.master.slave(0).exchanging());
    bus.master.slave(0).request_diagnosis();
    bus.cycles(3);
    EXPECT_EQ(slave.diagnoses_read, read + 2);
    EXPECT_EQ(bus.master.slave(0).diagnosis().size(), 6u);
}

TEST(Diagnosis, flag_of_a_slave_without_inputs_is_understood) {
    Bus bus;
    ScriptedSlave& slave = bus.plug({.own = 3, .inputs = 0, .cfg = {0x21}});
    ASSERT_TRUE(bus.start());
    const std::uint64_t read = slave.diagnoses_read;
    slave.diagnosis_waiting = true;
    bus.cycles(4);
    EXPECT_EQ(slave.diagnoses_read, read + 1);
    EXPECT_TRUE(bus.master.slave(0).exchanging());
    EXPECT_EQ(bus.master.slave(0).counters().invalid, 0u);
}

TEST(Modes, decide_about_outputs_and_are_announced_with_Global_Control) {
    Bus bus;
    ScriptedSlave& plain = bus.plug({.own = 3});
    ScriptedSlave safe{.own = 4};
    ASSERT_TRUE(bus.line.attach(safe));
    master::SlaveConfig config = test::config_of(safe);
    config.fail_safe = true;
    ASSERT_TRUE(bus.master.add(config));
    ASSERT_TRUE(bus.start());
    for (std::size_t n = 0; n < 2; ++n) std::ranges::fill(bus.master.slave(n).outputs(), std::uint8_t{0x5A});
    bus.cycles(2);
    EXPECT_EQ(plain.output_data, (std::vector<std::uint8_t>{0x5A, 0x5A}));
    EXPECT_EQ(safe.output_data, (std::vector<std::uint8_t>{0x5A, 0x5A}));

    bus.master.set_mode(Mode::clear);
    bus.cycles(3);
    EXPECT_EQ(plain.output_data, (std::vector<std::uint8_t>{0, 0}));
    EXPECT_TRUE(safe.output_data.empty());
    EXPECT_EQ(plain.commands, (std::vector<std::uint8_t>{0x02}));

    bus.master.set_mode(Mode::operate);
    bus.cycles(3);
    EXPECT_EQ(plain.output_data, (std::vector<std::uint8_t>{0x5A, 0x5A}));
    EXPECT_EQ(plain.commands, (std::vector<std::uint8_t>{0x02, 0x00}));

    const std::uint64_t exchanges = plain.exchanges;
    bus.master.set_mode(Mode::stop);
    bus.cycles(3);
    EXPECT_LE(plain.exchanges, exchanges + 1);

    bus.master.set_mode(Mode::offline);
    bus.line.touch(0);
    const std::uint64_t sent = bus.line.counters().transmissions;
    bus.line.run(10_ms);
    EXPECT_LE(bus.line.counters().transmissions, sent);
    bus.master.set_mode(Mode::operate);
    bus.line.touch(0);
    EXPECT_TRUE(bus.start());
    for (const Mode m : {Mode::offline, Mode::stop, Mode::clear, Mode::operate}) EXPECT_STRNE(name(m), "unknown");
}

TEST(GlobalControl, goes_to_everybody_after_the_cyclic_part) {
    Bus bus;
    ScriptedSlave& slave = bus.plug({.own = 3});
    ASSERT_TRUE(bus.start());
    ASSERT_TRUE(bus.master.global_control({dp::kGcSync, 0}));
    ASSERT_TRUE(bus.master.global_control({dp::kGcUnsync, 0}));
    bus.cycles(3);
    EXPECT_EQ(slave.commands, (std::vector<std::uint8_t>{dp::kGcSync, dp::kGcUnsync}));
    for (int i = 0; i < 8; ++i) EXPECT_TRUE(bus.master.global_control({dp::kGcSync, 0}));
    EXPECT_FALSE(bus.master.global_control({dp::kGcSync, 0}));
}

TEST(Answers, from_others_and_late_ones_are_not_taken) {
    Bus bus{{.max_retry = 0}};
    bus.judge_checked = false;
    ScriptedSlave& slave = bus.plug({.own = 3});
    ASSERT_TRUE(bus.start());
    const std::uint64_t good = bus.master.counters().answers;
    // somebody answers for slave 3 with another address before it does
    slave.mute_for = 1;
    test::Talker liar;
    Ticks at{};
    bus.line.run_until([&] { return slave.mute_for == 0; }, 1_s);
    at = bus.line.now() + fdl::baud(fdl::BaudCode::mbit_12).bit * 20;
    liar.plan.emplace_back(at, test::answer(2, 9, {1, 2}));
    ASSERT_TRUE(bus.line.attach(liar));
    bus.line.run_until([&] { return bus.master.counters().foreign == 1; }, 1_s);
    EXPECT_EQ(bus.master.counters().foreign, 1u);
    EXPECT_EQ(bus.master.counters().answers, good);
    EXPECT_TRUE(bus.start());
}

TEST(Answers, that_come_late_are_awaited_with_a_longer_slot_time) {
    const fdl::BusTimes patient{.tqui = 9, .tset = 16, .min_tsdr = 11, .max_tsdr = 100'000, .tsl = 1000};
    Bus bus{{.times = patient, .slot_time = 10_ms}};
    bus.judge_checked = false;
    bus.plug({.own = 3, .tsdr_bits = 60'000});  // 5 ms
    EXPECT_TRUE(bus.start());
    bus.cycles(10);
    EXPECT_EQ(bus.master.counters().retries, 0u);
}

TEST(Answers, that_are_damaged_are_asked_for_again_after_TSYN) {
    Bus bus;
    bus.judge_checked = false;
    bus.plug({.own = 3});
    ASSERT_TRUE(bus.start());
    struct Damage {
        int left = 5, answers = 0;
        segment::Fault operator()(const fdl::Transmission&, segment::StationIndex sender, std::uint64_t) {
            if (sender != 1 || ++answers % 3 != 0 || left == 0) return {};
            --left;
            return {.kind = segment::FaultKind::parity, .octet = 4};
        }
    } damage;
    bus.line.set_faults(segment::FaultRef{damage});
    bus.cycles(40);
    EXPECT_EQ(damage.left, 0);
    EXPECT_EQ(bus.master.counters().damaged, 5u);
    EXPECT_TRUE(bus.master.slave(0).exchanging());
}

class Storm : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(Storm, of_random_faults_is_survived_and_all_exchange_data_again_afterwards) {
    Bus bus{{.max_retry = 2}};
    bus.judge_checked = false;
    for (std::uint8_t i = 0; i < 10; ++i) bus.plug({.own = static_cast<std::uint8_t>(3 + i)});
    ASSERT_TRUE(bus.start());
    segment::RandomFaults faults{GetParam(), {0, 20'000, 10'000, 10'000, 10'000, 10'000, 10'000, 10'000, 10'000}};
    bus.line.set_faults(segment::FaultRef{faults});
    bus.line.run(200_ms);
    EXPECT_GT(bus.master.counters().retries, 50u);
    bus.line.set_faults({});
    bus.line.run(2_ms);
    EXPECT_TRUE(bus.start());
    for (std::size_t n = 0; n < 10; ++n) std::ranges::fill(bus.master.slave(n).outputs(), static_cast<std::uint8_t>(n + 1));
    bus.cycles(3);
    for (std::size_t n = 0; n < 10; ++n) EXPECT_TRUE(std::ranges::equal(bus.master.slave(n).inputs(), bus.master.slave(n).outputs()));
    bus.judge.clear();
    bus.cycles(20);
    EXPECT_TRUE(bus.judge.clean());
}
INSTANTIATE_TEST_SUITE_P(Seeds, Storm, ::testing::Range(std::uint64_t{1}, std::uint64_t{9}));

TEST(Configuration, is_refused_by_name) {
    using master::ConfigError;
    master::Master m{{.address = 2}};
    master::SlaveConfig good;
    good.address = 3;
    good.cfg = {0x11};
    const auto with = [&](auto change) {
        master::SlaveConfig c = good;
        change(c);
        return m.add(c).error();
    };
    EXPECT_EQ(with([](auto& c) { c.address = 126; }), ConfigError::address);
    EXPECT_EQ(with([](auto& c) { c.address = 2; }), ConfigError::address_taken);
    EXPECT_EQ(with([](auto& c) { c.cfg.clear(); }), ConfigError::no_cfg);
    EXPECT_EQ(with([](auto& c) { c.cfg.resize(245); }), ConfigError::too_long);
    EXPECT_EQ(with([](auto& c) { c.user_prm.resize(238); }), ConfigError::too_long);
    EXPECT_EQ(with([](auto& c) { c.input_octets = 245; }), ConfigError::too_long);
    EXPECT_EQ(with([](auto& c) { c.output_octets = 245; }), ConfigError::too_long);
    EXPECT_EQ(with([](auto& c) { c.watchdog_ms = 700'000; }), ConfigError::watchdog);
    ASSERT_TRUE(m.add(good));
    EXPECT_EQ(m.add(good).error(), ConfigError::address_taken);
    EXPECT_EQ(m.find(3), &m.slave(0));
    EXPECT_EQ(m.find(4), nullptr);
    EXPECT_EQ(m.find(200), nullptr);
    for (int e = 0; e <= static_cast<int>(ConfigError::watchdog); ++e) EXPECT_STRNE(name(static_cast<ConfigError>(e)), "unknown");
    for (int s = 0; s <= 5; ++s) EXPECT_STRNE(name(static_cast<SlaveState>(s)), "unknown");
    for (int f = 0; f <= 6; ++f) EXPECT_STRNE(name(static_cast<SlaveFault>(f)), "unknown");
}

}  // namespace
