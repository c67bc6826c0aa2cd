// SPDX-License-Identifier: Apache-2.0
// Acyclic requests beside the cycle, and the scan of the bus.
#include <algorithm>

#include "master/bus.hpp"

namespace {

using namespace dpchip;
using namespace dpchip::core::literals;
using master::Job;
using test::Bus;
using test::ScriptedSlave;

struct JobTest : ::testing::Test {
    Bus bus;
    ScriptedSlave& slave = bus.plug({.own = 3, .tsdr_bits = 36, .log = true});

    void SetUp() override { ASSERT_TRUE(bus.start()); }
    Job& ask(Job& job) {
        EXPECT_TRUE(bus.master.submit(job));
        EXPECT_TRUE(bus.line.run_until([&] { return job.finished(); }, 1_s));
        return job;
    }
};

TEST_F(JobTest, reads_configuration_outputs_and_diagnosis_while_the_cycle_goes_on) {
    std::ranges::copy(std::vector<std::uint8_t>{7, 9}, bus.master.slave(0).outputs().begin());
    bus.cycles(2);
    Job cfg = Job::get_cfg(3), outputs = Job::rd_output(3), diagnosis = Job::slave_diag(3);
    EXPECT_EQ(ask(cfg).outcome, Job::Outcome::data);
    EXPECT_TRUE(std::ranges::equal(cfg.data(), slave.cfg));
    EXPECT_TRUE(std::ranges::equal(ask(outputs).data(), std::vector<std::uint8_t>{7, 9}));
    EXPECT_EQ(ask(diagnosis).answer_size, 6u);
    EXPECT_EQ(slave.repeats, 0u);  // jobs and cycle share the frame count
    EXPECT_TRUE(bus.master.slave(0).exchanging());
}

TEST_F(JobTest, tells_a_refusal_and_silence_apart) {
    Job refused = Job::rd_input(3), silence = Job::get_cfg(77);
    EXPECT_EQ(ask(refused).outcome, Job::Outcome::refused);
    EXPECT_EQ(refused.response.response(), fdl::Response::rs);
    EXPECT_EQ(ask(silence).outcome, Job::Outcome::unanswered);
    EXPECT_FALSE(silence.good());
    EXPECT_EQ(bus.master.counters().retries, 1u);
}

TEST_F(JobTest, changes_the_address_of_a_slave_that_is_free) {
    ScriptedSlave& fresh = bus.plug({.own = 126}, false);
    Job change = Job::set_slave_add(126, {.address = 40, .ident = 0x4711, .no_add_chg = false, .rem_data = {}});
    EXPECT_EQ(ask(change).outcome, Job::Outcome::acknowledged);
    EXPECT_EQ(fresh.moved_to, 40);
}

TEST_F(JobTest, can_be_taken_back_and_is_refused_when_too_many_wait) {
    std::vector<Job> jobs(17, Job::get_cfg(3));
    for (std::size_t i = 0; i < 16; ++i) EXPECT_TRUE(bus.master.submit(jobs[i]));
    EXPECT_FALSE(bus.master.submit(jobs[16]));
    for (std::size_t i = 0; i < 16; i += 2) bus.master.cancel(jobs[i]);
    bus.cycles(20);
    for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(jobs[i].finished(), i % 2 == 1) << i;
    Job nonsense = Job::get_cfg(128);
    EXPECT_FALSE(bus.master.submit(nonsense));
    EXPECT_EQ(jobs[0].outcome, Job::Outcome::idle);
}

TEST_F(JobTest, taken_back_in_the_middle_does_not_touch_its_owner_again) {
    slave.fcs.clear();
    auto job = std::make_unique<Job>(Job::get_cfg(3));
    ASSERT_TRUE(bus.master.submit(*job));
    // run until the request is out
    ASSERT_TRUE(bus.line.run_until([&] { return bus.line.busy() && slave.fcs.size() >= 2; }, 1_s));
    bus.master.cancel(*job);
    job.reset();
    bus.cycles(10);
    EXPECT_TRUE(bus.master.slave(0).exchanging());
    EXPECT_EQ(slave.repeats, 0u);
}

TEST_F(JobTest, without_an_answer_waits_TID2_and_is_done) {
    Job command = Job::service(127, dp::kSapGlobalControl, std::vector<std::uint8_t>{dp::kGcFreeze, 0});
    command.function = fdl::Request::sdn_high;
    EXPECT_EQ(ask(command).outcome, Job::Outcome::acknowledged);
    bus.cycles(2);
    EXPECT_EQ(slave.commands, (std::vector<std::uint8_t>{dp::kGcFreeze}));
}

TEST_F(JobTest, has_words_for_its_outcome) {
    for (int i = 0; i <= static_cast<int>(Job::Outcome::unanswered); ++i) EXPECT_STRNE(name(static_cast<Job::Outcome>(i)), "unknown");
}

TEST(Scan, finds_every_station_and_who_it_is_without_disturbing_the_cycle) {
    Bus bus;
    bus.plug({.own = 3});
    bus.plug({.own = 0, .ident = 0x1234}, false);
    bus.plug({.own = 126, .ident = 0xBEEF}, false);
    ASSERT_TRUE(bus.start());
    bus.master.start_scan();
    EXPECT_TRUE(bus.line.run_until([&] { return !bus.master.scanning(); }, 10_s));
    const auto& found = bus.master.found();
    for (std::uint8_t a = 0; a < 127; ++a) EXPECT_EQ(found[a].present, a == 0 || a == 3 || a == 126) << int{a};
    EXPECT_EQ(found[0].ident, 0x1234);
    EXPECT_EQ(found[126].ident, 0xBEEF);
    EXPECT_EQ(found[3].master_add, 2);
    EXPECT_EQ(found[0].master_add, 0xFF);
    EXPECT_TRUE(found[3].diagnosed);
    EXPECT_TRUE(bus.master.slave(0).exchanging());
    EXPECT_EQ(bus.slaves[0]->repeats, 0u);
}

TEST(Scan, works_in_stop_without_any_slave_configured) {
    Bus bus{{.mode = master::Mode::stop}};
    ScriptedSlave& slave = bus.plug({.own = 9}, false);
    bus.master.start_scan();
    EXPECT_TRUE(bus.line.run_until([&] { return !bus.master.scanning(); }, 10_s));
    EXPECT_TRUE(bus.master.found()[9].diagnosed);
    EXPECT_EQ(slave.exchanges, 0u);
}

}  // namespace
