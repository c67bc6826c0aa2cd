// SPDX-License-Identifier: Apache-2.0
// MS2 from the master's side: connections, each abort reason, each timeout, races (reference 5.4).
#include "master/ms2_fixture.hpp"

namespace {

using namespace dpchip;
using namespace dpchip::core::literals;
using dp::AbortInstance;
using dp::AbortReason;
using dp::ErrorCode1;
using master::Job;
using master::Ms2State;
using Kind = master::ServiceResult::Kind;
using test::AcyclicPlant;
using test::Doorkeeper;
using test::Ms2Test;
using test::Octets;
using test::Sleeper;
using test::octets_of;
using test::pattern;

TEST_F(Ms2Test, opens_reads_writes_and_closes_without_data_exchange) {
    open(ms2);
    EXPECT_EQ(ms2.sap(), 48);
    EXPECT_EQ(ms2.send_timeout(), 0x64);
    EXPECT_EQ(ms2.max_length(), 240);
    EXPECT_EQ(ms2.features().features_1, dp::kFeatureReadWrite);
    ASSERT_TRUE(read(1, 1).done());
    EXPECT_EQ(octets_of(ms2.data()), pattern(32, 1));
    ASSERT_TRUE(ms2.write(1, 4, pattern(240, 77)));
    ASSERT_TRUE(plant.finish(ms2).done());
    ASSERT_TRUE(read(1, 4).done());
    EXPECT_EQ(octets_of(ms2.data()), pattern(240, 77));
    EXPECT_EQ(slave.dp_state(), chip::DpState::wait_prm);
    ms2.close(3);
    ASSERT_TRUE(plant.until([&] { return ms2.state() == Ms2State::closed; }));
    EXPECT_EQ(ms2.ending().kind, Kind::ended);
    plant.run(2_ms);
    const auto told = events();
    ASSERT_EQ(told.size(), 2u);
    EXPECT_EQ(slave::text(told[0]), "connection on SAP 48 open for master 2");
    EXPECT_EQ(slave::text(told[1]), "connection on SAP 48 closed by the master: user reason 3");
    EXPECT_EQ(poll(48).outcome, Job::Outcome::refused);
}

TEST_F(Ms2Test, hears_negative_answers_and_goes_on) {
    open(ms2);
    EXPECT_EQ(read(1, 99).error, dp::RecordError{ErrorCode1::invalid_index});
    EXPECT_EQ(read(9, 1).error, dp::RecordError{ErrorCode1::invalid_slot});
    ASSERT_TRUE(ms2.write(1, 2, Octets{1}));
    EXPECT_EQ(plant.finish(ms2).error, dp::RecordError{ErrorCode1::access_denied});
    ASSERT_TRUE(ms2.transport(1, 1, Octets{1, 2}));
    EXPECT_EQ(plant.finish(ms2).error, dp::RecordError{ErrorCode1::feature_not_supported});
    EXPECT_TRUE(read(1, 1).done());
}

TEST_F(Ms2Test, transports_data_both_ways) {
    struct Mirror : slave::RecordHandler {
        Answer transport(const driver::RecordCall&, std::span<const std::uint8_t> data, std::span<std::uint8_t> out) override {
            std::ranges::reverse_copy(data, out.begin());
            return driver::answered(data.size());
        }
    } mirror;
    slave.set_handler(&mirror);
    open(ms2);
    for (const std::size_t size : {0u, 1u, 7u, 240u}) {
        Octets data = pattern(size, 3);
        ASSERT_TRUE(ms2.transport(0, 1, data));
        ASSERT_TRUE(plant.finish(ms2).done()) << master::text(ms2.result());
        std::ranges::reverse(data);
        EXPECT_EQ(octets_of(ms2.data()), data);
    }
}

TEST_F(Ms2Test, idle_keeps_a_connection_for_as_long_as_nobody_asks_anything) {
    open(ms2);
    plant.run(20_s);
    EXPECT_TRUE(ms2.is_open());
    EXPECT_GE(ms2.idles(), 15u);
    EXPECT_TRUE(read(1, 1).done());
}

TEST_F(Ms2Test, has_four_connections_and_refuses_the_fifth_with_RS) {
    std::vector<std::unique_ptr<master::Ms2>> all;
    for (int i = 0; i < 4; ++i) {
        all.push_back(std::make_unique<master::Ms2>(master::Ms2Config{.address = 5}));
        plant.master.attach(*all.back());
        open(*all.back());
        EXPECT_EQ(all.back()->sap(), 48 - i);
    }
    ASSERT_TRUE(ms2.open());
    EXPECT_EQ(plant.finish(ms2).kind, Kind::not_taken);
    EXPECT_EQ(ms2.result().response, fdl::Response::rs);
    all[2]->close();
    ASSERT_TRUE(plant.until([&] { return all[2]->state() == Ms2State::closed; }));
    open(ms2);
    EXPECT_EQ(ms2.sap(), 46);
}

// ---- timeouts ------------------------------------------------------------------------------------------------------

TEST_F(Ms2Test, the_slave_aborts_when_its_application_works_longer_than_Send_Timeout) {
    Sleeper sleeper;
    slave.set_handler(&sleeper);
    open(ms2);
    const core::Ticks asked = plant.line.now();
    const auto& r = read(1, 1);
    ASSERT_EQ(r.kind, Kind::aborted) << master::text(r);
    EXPECT_EQ(r.abort, dp::Abort{AbortReason::timeout});
    EXPECT_EQ(master::text(r), "the slave has ended the connection: timeout (TO) of MSAC_C2 (58H 00H 13H)");
    EXPECT_GE(plant.line.now() - asked, 990_ms);
    EXPECT_LT(plant.line.now() - asked, 1100_ms);
    EXPECT_EQ(sleeper.dropped_requests, 1);
    EXPECT_FALSE(slave.complete(sleeper.handle, driver::answered()));
    EXPECT_EQ(ms2.state(), Ms2State::closed);
    slave.set_handler(nullptr);
    open(ms2);
}

TEST_F(Ms2Test, the_slave_aborts_when_nobody_fetches_its_answer) {
    const std::uint8_t sap = initiate_by_hand();
    plant.run(1100_ms);
    expect_abort(poll(sap), AbortReason::timeout);
    EXPECT_EQ(poll(sap).outcome, Job::Outcome::refused);
}

TEST_F(Ms2Test, the_slave_closes_when_nobody_fetches_the_abort_either) {
    const std::uint8_t sap = initiate_by_hand();
    plant.run(2100_ms);
    EXPECT_EQ(poll(sap).outcome, Job::Outcome::refused);
}

TEST_F(Ms2Test, the_slave_aborts_after_twice_Send_Timeout_without_a_request) {
    const std::uint8_t sap = initiate_by_hand();
    ASSERT_EQ(poll(sap).outcome, Job::Outcome::data);
    plant.run(1900_ms);
    ASSERT_EQ(ask({0x48, 0x00}, sap).outcome, Job::Outcome::acknowledged);
    ASSERT_EQ(octets_of(poll(sap).data()), (Octets{0x48, 0x00}));
    plant.run(2100_ms);
    expect_abort(poll(sap), AbortReason::timeout);
    const auto told = events();
    ASSERT_EQ(told.size(), 2u);
    EXPECT_EQ(slave::text(told[1]), "connection on SAP 48 closed by the slave: timeout (TO)");
}

TEST_F(Ms2Test, the_master_aborts_when_its_own_time_is_over) {
    master::Ms2 hasty{{.address = 5, .response_timeout = 100_ms}};
    plant.master.attach(hasty);
    Sleeper sleeper;
    slave.set_handler(&sleeper);
    open(hasty);
    ASSERT_TRUE(hasty.read(1, 1));
    EXPECT_EQ(plant.finish(hasty).kind, Kind::timeout);
    ASSERT_TRUE(plant.until([&] { return hasty.state() == Ms2State::closed; }));
    plant.run(2_ms);
    const auto told = events();
    ASSERT_FALSE(told.empty());
    EXPECT_EQ(slave::text(told.back()), "connection on SAP 48 closed by the master: timeout (TO)");
    EXPECT_EQ(sleeper.dropped_requests, 1);
    plant.master.detach(hasty);
}

TEST_F(Ms2Test, a_master_that_vanishes_in_mid_request_leaves_nothing_behind) {
    Sleeper sleeper;
    slave.set_handler(&sleeper);
    open(ms2);
    ASSERT_TRUE(ms2.read(1, 1));
    plant.run(20_ms);
    ASSERT_TRUE(ms2.busy());
    plant.master.set_mode(master::Mode::offline);
    EXPECT_TRUE(plant.until([&] { return slave.acyclic_counters().connections_closed == 1; }, 3_s));
    EXPECT_EQ(sleeper.dropped_requests, 1);
    plant.run(1500_ms);  // the Abort that nobody fetches
    slave.set_handler(nullptr);
    plant.master.set_mode(master::Mode::stop);
    plant.line.touch(0);
    ASSERT_TRUE(plant.until([&] { return ms2.state() == Ms2State::closed; }));
    std::vector<std::unique_ptr<master::Ms2>> all;
    for (int i = 0; i < 4; ++i) {  // every connection is free again
        all.push_back(std::make_unique<master::Ms2>(master::Ms2Config{.address = 5}));
        plant.master.attach(*all.back());
        open(*all.back());
    }
}

TEST_F(Ms2Test, a_slave_that_is_switched_off_ends_the_connection) {
    open(ms2);
    plant.line.detach(plant.stations[0]);
    EXPECT_EQ(read(1, 1).kind, Kind::unanswered);
    EXPECT_EQ(ms2.state(), Ms2State::closed);
    EXPECT_EQ(ms2.ending().kind, Kind::unanswered);
    ASSERT_TRUE(ms2.open());
    EXPECT_EQ(plant.finish(ms2).kind, Kind::unanswered);
}

// ---- abort reasons -------------------------------------------------------------------------------------------------

TEST_F(Ms2Test, an_Initiate_that_is_too_short_is_aborted_with_IA_one_with_bad_lengths_with_FE) {
    for (std::size_t size = 1; size < 20; ++size) {
        const std::uint8_t sap = initiate_by_hand(Octets(std::begin(kInitiate), std::begin(kInitiate) + size));
        expect_abort(poll(sap), AbortReason::invalid_address);
        EXPECT_EQ(poll(sap).outcome, Job::Outcome::refused);
    }
    for (const std::uint8_t length : {std::uint8_t{0}, std::uint8_t{1}, std::uint8_t{3}, std::uint8_t{200}}) {
        Octets request(std::begin(kInitiate), std::end(kInitiate));
        request[13] = length;
        expect_abort(poll(initiate_by_hand(request)), AbortReason::invalid_request);
    }
}

TEST_F(Ms2Test, every_unknown_function_and_every_length_of_it_is_aborted_with_FE) {
    for (unsigned function = 0; function < 256; ++function) {
        const auto f = static_cast<dp::AcyclicFunction>(function);
        if (f == dp::AcyclicFunction::ds_read || f == dp::AcyclicFunction::ds_write || f == dp::AcyclicFunction::data_transport ||
            f == dp::AcyclicFunction::abort)
            continue;
        const std::uint8_t sap = initiate_by_hand();
        ASSERT_EQ(poll(sap).outcome, Job::Outcome::data);
        Octets pdu(1 + function % 5, 0);
        pdu[0] = static_cast<std::uint8_t>(function);
        if (f == dp::AcyclicFunction::idle) pdu.resize(3);  // two octets are the good one
        ASSERT_EQ(ask(pdu, sap).outcome, Job::Outcome::acknowledged);
        expect_abort(poll(sap), AbortReason::invalid_request);
    }
}

TEST_F(Ms2Test, records_of_every_bad_length_are_refused_with_B3) {
    const std::uint8_t sap = initiate_by_hand();
    ASSERT_EQ(poll(sap).outcome, Job::Outcome::data);
    for (const std::uint8_t function : {std::uint8_t{0x5E}, std::uint8_t{0x5F}}) {
        for (const Octets& tail : {Octets{}, Octets{1}, Octets{1, 1}, Octets{1, 1, 0}, Octets{1, 1, 241}, Octets{1, 1, 5, 0xAA}, Octets{1, 1, 0, 1}}) {
            Octets pdu{function};
            pdu.insert(pdu.end(), tail.begin(), tail.end());
            ASSERT_EQ(ask(pdu, sap).outcome, Job::Outcome::acknowledged);
            EXPECT_EQ(octets_of(poll(sap).data()), (Octets{static_cast<std::uint8_t>(function | 0x80), 0x80, 0xB3, 0x00})) << tail.size();
        }
    }
}

TEST_F(Ms2Test, a_request_while_another_is_worked_on_is_a_sequence_error) {
    Sleeper sleeper;
    slave.set_handler(&sleeper);
    const std::uint8_t sap = initiate_by_hand();
    ASSERT_EQ(poll(sap).outcome, Job::Outcome::data);
    ASSERT_EQ(ask({0x5E, 1, 1, 4}, sap).outcome, Job::Outcome::acknowledged);
    ASSERT_EQ(ask({0x48, 0x00}, sap).outcome, Job::Outcome::acknowledged);
    expect_abort(poll(sap), AbortReason::sequence_error);
    EXPECT_EQ(sleeper.dropped_requests, 1);
}

TEST_F(Ms2Test, an_abort_gets_through_while_a_request_is_worked_on) {
    Sleeper sleeper;
    slave.set_handler(&sleeper);
    open(ms2);
    ASSERT_TRUE(ms2.read(1, 1));
    plant.run(10_ms);
    ms2.close(9);
    EXPECT_EQ(plant.finish(ms2).kind, Kind::ended);
    ASSERT_TRUE(plant.until([&] { return slave.acyclic_counters().connections_closed == 1; }));
    EXPECT_EQ(sleeper.dropped_requests, 1);
}

TEST_F(Ms2Test, an_application_refuses_and_ends_connections_with_any_reason) {
    Doorkeeper doorkeeper;
    for (std::uint8_t reason = 0; reason < 16; ++reason) {
        doorkeeper.reason = reason;
        slave.set_handler(&doorkeeper);
        ASSERT_TRUE(ms2.open());
        const dp::Abort expected{dp::AbortSubnet::none, AbortInstance::user, reason};
        ASSERT_EQ(plant.finish(ms2).kind, Kind::aborted) << master::text(ms2.result());
        EXPECT_EQ(ms2.result().abort, expected);
        slave.set_handler(nullptr);
        open(ms2);
        ASSERT_TRUE(slave.abort_connection(ms2.sap(), reason));
        plant.line.touch(plant.stations[0]);
        ASSERT_EQ(reason % 2 == 0 ? read(1, 1).kind : write(1, 4, pattern(240, 1)).kind, Kind::aborted) << master::text(ms2.result());
        EXPECT_EQ(ms2.ending().abort, expected);
    }
}

TEST_F(Ms2Test, every_abort_has_words) {
    for (unsigned instance = 0; instance < 4; ++instance)
        for (unsigned reason = 0; reason < 16; ++reason) {
            dp::Abort abort{};
            abort.instance = static_cast<AbortInstance>(instance);
            abort.reason = static_cast<std::uint8_t>(reason);
            EXPECT_NE(master::text(abort).find("(58H 00H"), std::string::npos);
        }
}

TEST_F(Ms2Test, what_is_not_open_cannot_be_asked) {
    ASSERT_TRUE(ms2.read(1, 1));
    EXPECT_EQ(ms2.result().kind, Kind::closed);
    EXPECT_EQ(slave.acyclic_counters().reads, 0u);
}

// ---- two masters ---------------------------------------------------------------------------------------------------

TEST(Ms2Race, of_eight_for_four_connections_four_win_and_the_others_hear_RS) {
    AcyclicPlant plant{{.gap_factor = 1, .acyclic_per_cycle = 4, .mode = master::Mode::stop}};
    slave::VirtualSlave& slave = plant.plug(5, false);
    ASSERT_TRUE(plant.until([&] { return slave.baud().has_value(); }));
    std::vector<std::unique_ptr<master::Ms2>> all;
    for (int i = 0; i < 8; ++i) {
        all.push_back(std::make_unique<master::Ms2>(master::Ms2Config{.address = 5}));
        plant.master.attach(*all.back());
    }
    for (int round = 0; round < 20; ++round) {
        for (auto& c : all) ASSERT_TRUE(c->open());
        ASSERT_TRUE(plant.until([&] { return std::ranges::none_of(all, [](const auto& c) { return c->busy(); }); }));
        int won = 0;
        for (const auto& c : all) {
            if (c->is_open()) ++won;
            else EXPECT_EQ(c->result().kind, Kind::not_taken) << master::text(c->result());
        }
        EXPECT_EQ(won, 4);
        for (auto& c : all) c->close();
        ASSERT_TRUE(plant.until([&] { return std::ranges::all_of(all, [](const auto& c) { return c->state() == Ms2State::closed; }); }));
        plant.run(1_ms);
    }
    EXPECT_EQ(slave.acyclic_counters().connections_opened, 80u);
    EXPECT_EQ(slave.acyclic_counters().connections_closed, 80u);
}

TEST(Ms2Race, of_two_masters_for_the_last_connection_the_first_wins_although_the_other_asks_before_it_is_open) {
    AcyclicPlant plant{{.gap_factor = 1, .mode = master::Mode::stop}};
    slave::VirtualSlave& slave = plant.plug(5, false);
    master::Master other{{.address = 3, .mode = master::Mode::offline}};
    const auto other_station = plant.line.attach(other, "other master");
    ASSERT_TRUE(other_station);
    const auto hand_over = [&](master::Master& from, master::Master& to) {  // one at a time has the bus
        from.set_mode(master::Mode::offline);
        to.set_mode(master::Mode::stop);
        plant.line.touch(0);
        plant.line.touch(*other_station);
    };
    ASSERT_TRUE(plant.until([&] { return slave.baud().has_value(); }));
    std::vector<std::unique_ptr<master::Ms2>> first;
    for (int i = 0; i < 3; ++i) {
        first.push_back(std::make_unique<master::Ms2>(master::Ms2Config{.address = 5}));
        plant.master.attach(*first.back());
        ASSERT_TRUE(first.back()->open());
        ASSERT_TRUE(plant.finish(*first.back()).done());
    }
    master::Ms2 last{{.address = 5, .settle = 20_ms}}, rival{{.address = 5}};
    plant.master.attach(last);
    other.attach(rival);
    ASSERT_TRUE(last.open());
    ASSERT_TRUE(plant.until([&] { return last.state() == Ms2State::connecting; }));
    plant.run(10_ms);
    hand_over(plant.master, other);
    ASSERT_TRUE(rival.open());
    EXPECT_EQ(plant.finish(rival).response, fdl::Response::rs) << master::text(rival.result());
    hand_over(other, plant.master);
    ASSERT_TRUE(plant.finish(last).done()) << master::text(last.result());
    last.close();
    ASSERT_TRUE(plant.until([&] { return last.state() == Ms2State::closed; }));
    hand_over(plant.master, other);
    ASSERT_TRUE(rival.open());
    ASSERT_TRUE(plant.finish(rival).done()) << master::text(rival.result());
    EXPECT_TRUE(rival.read(1, 2));
    EXPECT_TRUE(plant.finish(rival).done());
    std::string log;
    while (const auto e = slave.take_event()) log = slave::text(*e);
    EXPECT_EQ(log, "connection on SAP 45 open for master 3");
}

}  // namespace
