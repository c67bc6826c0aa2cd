// SPDX-License-Identifier: Apache-2.0
// Every abort reason, every timeout and every negative answer of the acyclic services, each caused from the master's side
// (reference 5.3, 5.4). What is caused where:
//
//   reasons of MSAC_C2   SE FE TO IV IA RES from the slave, RE STO OC from the master: kReasons below, held against
//                        dp::abort_reason_name() by AbortReasons.of_MSAC_C2_are_all_caused
//   reasons of FDL       UE RR RS NR NA: FdlReasons; DH, RDL and RDH carry data and end nothing: the same place. LR and DS
//                        are of stations that lack their own resources or have left the ring: this master has neither
//   reasons of the user  0..15: Ms2Test.an_application_refuses_and_ends_connections_with_any_reason,
//                        Ms2Test.an_abort_gets_through_while_a_request_is_worked_on
//   negative answers     every Error_Code_1 under every Error_Decode for DE, DF and D1: Ms2Test.hears_every_negative_answer;
//                        the driver's own B3: Ms2Test.records_of_every_bad_length_are_refused_with_B3; DC:
//                        AlarmTest.that_is_not_outstanding_cannot_be_acknowledged
//   no answer PDU        RS: Ms1Test.is_closed_while_there_is_no_data_exchange; RR: driver Ms1.ASecondRequestFindsNoBuffer
//   unknown on MS1       the slave leaves its master: Ms1Break
//   timeouts             the user works (U): Ms2Test.the_slave_aborts_when_its_application_works_longer_than_Send_Timeout;
//                        the user decides about a connection: Timeouts; nobody fetches (F) and once more:
//                        Ms2Test.the_slave_aborts_when_nobody_fetches_its_answer, ..closes_when_nobody_fetches_the_abort_either;
//                        nobody asks (I): Ms2Test.the_slave_aborts_after_twice_Send_Timeout_without_a_request;
//                        the master's own: Ms2Test.the_master_aborts_when_its_own_time_is_over,
//                        Ms1Test.gives_up_after_its_timeout_and_throws_the_late_answer_away; Send_Timeout by rate and by
//                        request: Timeouts
#include "master/ms2_fixture.hpp"
#include "master/scripted_slave.hpp"

namespace {

using namespace dpchip;
using namespace dpchip::core::literals;
using dp::AbortInstance;
using dp::AbortReason;
using dp::AbortSubnet;
using dp::FdlReason;
using master::Job;
using master::Ms2State;
using Kind = master::ServiceResult::Kind;
using test::Ms2Test;
using test::Octets;
using test::octets_of;

/// A station that opens a connection as it should, and then answers as it is told to.
struct Liar {
    explicit Liar(Octets lie, std::optional<fdl::Response> refusal = {}) : answer{std::move(lie)}, code{refusal} {
        station.acyclic = [this](const fdl::Telegram& r) { return serve(r); };
        EXPECT_TRUE(plant.line.attach(station));
        plant.master.attach(ms2);
    }
    bool serve(const fdl::Telegram& r) {
        if (r.dsap() == dp::kSapResourceManager) return station.data(r, rm), true;
        if (r.dsap() != 48) return false;
        if (!r.data().empty()) {
            asked = true;
            if (r.data()[0] == 0x58) abort = octets_of(r.data());
            return station.sc(), true;
        }
        if (!asked) return station.data(r, initiate_res), true;
        if (code && answer.empty()) return station.negative(r, *code), true;
        return station.data(r, answer, code.value_or(fdl::Response::dl)), true;
    }
    const master::ServiceResult& read() {
        EXPECT_TRUE(ms2.open());
        EXPECT_TRUE(plant.finish(ms2).done()) << master::text(ms2.result());
        EXPECT_TRUE(ms2.read(1, 2, 4));
        plant.finish(ms2);
        EXPECT_TRUE(plant.until([&] { return ms2.state() == Ms2State::closed || ms2.state() == Ms2State::open; }));
        return ms2.result();
    }

    test::AcyclicPlant plant{{.gap_factor = 1, .mode = master::Mode::stop}};
    test::ScriptedSlave station;
    master::Ms2 ms2{{.address = 3}};
    Octets rm{0x56, 48, 0, 100}, initiate_res{0x57, 240, 1, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 0, 0, 0};
    Octets answer;
    std::optional<fdl::Response> code;
    Octets abort;  ///< what the master sent
    bool asked = false;
};

// ---- reasons of MSAC_C2 --------------------------------------------------------------------------------------------

struct AbortReasons : Ms2Test {
    dp::Abort fetched(std::uint8_t sap) {
        const Job job = poll(sap);
        const auto abort = dp::decode_abort(job.data());
        EXPECT_TRUE(abort) << name(job.outcome);
        return abort ? *abort : dp::Abort{};
    }
    /// By hand, and its Initiate.res has been fetched.
    std::uint8_t opened() {
        const std::uint8_t sap = initiate_by_hand();
        EXPECT_EQ(poll(sap).outcome, Job::Outcome::data);
        return sap;
    }

    dp::Abort se() {
        test::Sleeper sleeper;
        slave.set_handler(&sleeper);
        const std::uint8_t sap = opened();
        ask({0x5E, 1, 1, 4}, sap);
        ask({0x5E, 1, 1, 4}, sap);
        return fetched(sap);
    }
    dp::Abort fe() {
        const std::uint8_t sap = opened();
        ask({0x60, 1, 1, 4}, sap);
        return fetched(sap);
    }
    dp::Abort to() {
        const std::uint8_t sap = opened();
        plant.run(2100_ms);
        return fetched(sap);
    }
    dp::Abort re() {
        Liar liar{{0x5E, 9, 9, 1, 0}};  // another slot and index than asked for
        EXPECT_EQ(liar.read().kind, Kind::bad_answer);
        const auto sent = dp::decode_abort(liar.abort);
        EXPECT_TRUE(sent);
        return sent ? *sent : dp::Abort{};
    }
    /// The slave's application answers a read with the decision about a connection.
    dp::Abort iv() {
        test::Sleeper sleeper;
        slave.set_handler(&sleeper);
        const std::uint8_t sap = opened();
        ask({0x5E, 1, 1, 4}, sap);
        EXPECT_FALSE(slave.complete(sleeper.handle, driver::accept_connection()));
        plant.line.touch(plant.stations[0]);
        EXPECT_EQ(sleeper.dropped_requests, 1);
        return fetched(sap);
    }
    dp::Abort sto() {
        master::Ms2 hasty{{.address = 5, .longest_send_timeout = 0x63}};
        plant.master.attach(hasty);
        EXPECT_TRUE(hasty.open());
        EXPECT_EQ(plant.finish(hasty).kind, Kind::ended) << master::text(hasty.result());
        EXPECT_TRUE(plant.until([&] { return hasty.state() == Ms2State::closed && slave.acyclic_counters().connections_closed == 1; }));
        plant.master.detach(hasty);
        std::string log;
        while (const auto e = slave.take_event()) log = slave::text(*e);
        EXPECT_EQ(log, "connection on SAP 48 closed by the master: Send_Timeout too small (STO)");
        return hasty.result().abort;
    }
    dp::Abort ia() { return fetched(initiate_by_hand({0x57, 0, 0, 0, 0, 1})); }
    dp::Abort oc() {
        open(ms2);
        ms2.close();
        EXPECT_TRUE(ms2.open());  // its Abort is not out yet
        EXPECT_EQ(ms2.result().kind, Kind::ended);
        return ms2.result().abort;
    }
    dp::Abort res() {
        struct Full : slave::RecordHandler {
            std::optional<driver::InitiateAnswer> initiate(const driver::InitiateCall&) override {
                return driver::refuse_connection(AbortReason::resource_error);
            }
        } full;
        slave.set_handler(&full);
        EXPECT_TRUE(ms2.open());
        EXPECT_EQ(plant.finish(ms2).kind, Kind::aborted);
        return ms2.result().abort;
    }
};

struct Cause {
    AbortReason reason;
    AbortSubnet subnet;  ///< local: this master's own
    dp::Abort (AbortReasons::*cause)();
};
constexpr Cause kReasons[]{
    {AbortReason::sequence_error, AbortSubnet::none, &AbortReasons::se},
    {AbortReason::invalid_request, AbortSubnet::none, &AbortReasons::fe},
    {AbortReason::timeout, AbortSubnet::none, &AbortReasons::to},
    {AbortReason::invalid_response, AbortSubnet::local, &AbortReasons::re},
    {AbortReason::invalid_service, AbortSubnet::none, &AbortReasons::iv},
    {AbortReason::send_timeout_too_small, AbortSubnet::local, &AbortReasons::sto},
    {AbortReason::invalid_address, AbortSubnet::none, &AbortReasons::ia},
    {AbortReason::waiting_for_confirmation, AbortSubnet::local, &AbortReasons::oc},
    {AbortReason::resource_error, AbortSubnet::none, &AbortReasons::res},
};

struct AbortReasonsOfMsac : AbortReasons, ::testing::WithParamInterface<Cause> {};

TEST_P(AbortReasonsOfMsac, is_caused_and_told_as_it_is) {
    const dp::Abort expected{GetParam().subnet, AbortInstance::msac_c2, core::to_underlying(GetParam().reason)};
    const dp::Abort seen = (this->*GetParam().cause)();
    EXPECT_EQ(seen, expected) << master::text(seen);
    slave.set_handler(nullptr);
    plant.run(1_s);
    open(ms2);  // and nothing is left behind
}

INSTANTIATE_TEST_SUITE_P(All, AbortReasonsOfMsac, ::testing::ValuesIn(kReasons), [](const auto& c) {
    const std::string words = dp::abort_reason_name(core::to_underlying(c.param.reason));
    const std::size_t open = words.rfind('(');
    return words.substr(open + 1, words.size() - open - 2);
});

TEST(AbortReasonsAll, of_MSAC_C2_stand_in_the_table_above) {
    for (std::uint8_t reason = 0; reason < 16; ++reason) {
        const bool exists = std::string{dp::abort_reason_name(reason)} != "reserved";
        const auto stands = std::ranges::count_if(kReasons, [&](const Cause& c) { return core::to_underlying(c.reason) == reason; });
        EXPECT_EQ(stands, exists ? 1 : 0) << unsigned{reason};
    }
}

// ---- reasons of FDL ------------------------------------------------------------------------------------------------

TEST(FdlReasons, UE_RR_RS_and_NR_to_a_poll_end_the_connection) {
    const std::pair<fdl::Response, FdlReason> cases[]{
        {fdl::Response::ue, FdlReason::ue}, {fdl::Response::rr, FdlReason::rr}, {fdl::Response::rs, FdlReason::rs}, {fdl::Response::nr, FdlReason::nr}};
    for (const auto& [response, reason] : cases) {
        Liar liar{{}, response};
        const auto& r = liar.read();
        EXPECT_EQ(r.kind, Kind::not_taken) << master::text(r);
        EXPECT_EQ(r.response, response);
        EXPECT_EQ(r.abort, (dp::Abort{AbortSubnet::local, AbortInstance::fdl, core::to_underlying(reason)}));
        EXPECT_EQ(liar.ms2.state(), Ms2State::closed);
        EXPECT_EQ(liar.ms2.ending().abort, r.abort);
        EXPECT_TRUE(liar.abort.empty()) << "nobody is left to be told";
    }
}

TEST(FdlReasons, answers_with_data_are_taken_whatever_their_priority) {
    for (const fdl::Response response : {fdl::Response::dl, fdl::Response::dh, fdl::Response::rdl, fdl::Response::rdh}) {
        Liar liar{{0x5E, 1, 2, 2, 0xAA, 0xBB}, response};
        EXPECT_TRUE(liar.read().done()) << master::text(liar.ms2.result());
        EXPECT_EQ(octets_of(liar.ms2.data()), (Octets{0xAA, 0xBB}));
    }
}

TEST_F(AbortReasons, a_station_that_falls_silent_is_NA) {
    open(ms2);
    plant.line.detach(plant.stations[0]);
    EXPECT_EQ(read(1, 1).kind, Kind::unanswered);
    EXPECT_EQ(ms2.ending().abort, (dp::Abort{AbortSubnet::local, AbortInstance::fdl, core::to_underlying(FdlReason::na)}));
}

TEST_F(AbortReasons, a_locked_SAP_is_RS) {
    open(ms2);
    const std::uint8_t sap = ms2.sap();
    ask({0x58, 0, 0x20}, sap);  // somebody else's Abort, past the connection
    EXPECT_EQ(read(1, 1).kind, Kind::not_taken);
    EXPECT_EQ(ms2.ending().abort, (dp::Abort{AbortSubnet::local, AbortInstance::fdl, core::to_underlying(FdlReason::rs)}));
    EXPECT_EQ(master::text(ms2.ending().abort), "SAP not activated (RS) of FDL (58H 01H 03H)");
}

TEST(FdlReasons, each_has_words) {
    for (const FdlReason r : {FdlReason::ue, FdlReason::rr, FdlReason::rs, FdlReason::nr, FdlReason::dh, FdlReason::lr, FdlReason::rdl, FdlReason::rdh,
                              FdlReason::ds, FdlReason::na})
        EXPECT_STRNE(dp::abort_reason_name(AbortInstance::fdl, core::to_underlying(r)), "reserved");
}

// ---- answers that do not fit ---------------------------------------------------------------------------------------

TEST(LyingSlave, is_told_RE_whatever_is_wrong_with_its_answer) {
    const Octets lies[]{
        {0x5F, 1, 2, 4},               // a write's answer
        {0x5E, 1, 2},                  // too short
        {0x5E, 1, 2, 5, 1, 2, 3, 4, 5},// more than asked for
        {0x5E, 1, 2, 4, 1, 2, 3},      // less than announced
        {0x5E, 1, 2, 2, 1, 2, 3},      // more than announced
        {0x5E, 2, 2, 1, 1},            // another slot
        {0x5E, 1, 3, 1, 1},            // another index
        {0xDF, 0x80, 0xB0, 0},         // refuses a write
        {0xDE, 0x80, 0xB0},            // a refusal cut short
        {0xDE, 0x80, 0xB0, 0, 0},      // and too long
        {0x48, 0x00},                  // Idle
        {0x00},
        {0x57, 240, 1},
    };
    for (const Octets& lie : lies) {
        Liar liar{lie};
        EXPECT_EQ(liar.read().kind, Kind::bad_answer) << master::text(liar.ms2.result());
        EXPECT_EQ(liar.abort, (Octets{0x58, 0x01, 0x14}));
        EXPECT_EQ(liar.ms2.state(), Ms2State::closed);
    }
}

TEST(LyingSlave, whose_resource_manager_or_Initiate_answer_is_none_gets_no_connection) {
    for (const Octets& rm : {Octets{0x56, 48, 0}, Octets{0x56, 49, 0, 100}, Octets{0x57, 48, 0, 100}, Octets{0x56, 48, 0, 100, 0}}) {
        Liar liar{{}};
        liar.rm = rm;
        ASSERT_TRUE(liar.ms2.open());
        EXPECT_EQ(liar.plant.finish(liar.ms2).kind, Kind::bad_answer) << master::text(liar.ms2.result());
        EXPECT_EQ(liar.ms2.state(), Ms2State::closed);
    }
    for (const Octets& res : {Octets{0x57, 240, 1}, Octets{0x57, 240, 1, 0, 0, 0, 0, 0, 0, 2, 0, 3, 0, 0, 0, 0}, Octets{0x5E, 1, 2, 0}}) {
        Liar liar{{}};
        liar.initiate_res = res;
        ASSERT_TRUE(liar.ms2.open());
        EXPECT_EQ(liar.plant.finish(liar.ms2).kind, Kind::bad_answer) << master::text(liar.ms2.result());
        EXPECT_TRUE(liar.plant.until([&] { return liar.ms2.state() == Ms2State::closed; }));
        EXPECT_EQ(liar.abort, (Octets{0x58, 0x01, 0x14}));
    }
}

// ---- negative answers ----------------------------------------------------------------------------------------------

TEST_F(Ms2Test, hears_every_negative_answer) {
    struct Refuser : slave::RecordHandler {
        dp::RecordError error{};
        Answer read(const driver::RecordCall&, std::span<std::uint8_t>) override { return driver::refused(error); }
        Answer write(const driver::RecordCall&, std::span<const std::uint8_t>) override { return driver::refused(error); }
        Answer transport(const driver::RecordCall&, std::span<const std::uint8_t>, std::span<std::uint8_t>) override { return driver::refused(error); }
    } refuser;
    slave.set_handler(&refuser);
    open(ms2);
    for (const std::uint8_t decode : {std::uint8_t{0x80}, std::uint8_t{0xFE}, std::uint8_t{0xFF}})
        for (unsigned code = 0; code < 256; ++code) {
            refuser.error = {decode, static_cast<std::uint8_t>(code), static_cast<std::uint8_t>(code ^ 0x5Au)};
            for (int service = 0; service < 3; ++service) {
                const bool begun = service == 0 ? ms2.read(1, 1) : service == 1 ? ms2.write(1, 1, Octets{1}) : ms2.transport(1, 1, Octets{1});
                ASSERT_TRUE(begun);
                ASSERT_EQ(plant.finish(ms2).kind, Kind::refused) << code;
                EXPECT_EQ(ms2.result().error, refuser.error);
            }
        }
    EXPECT_TRUE(ms2.is_open());
}

TEST(Ms1Break, an_unknown_function_on_SAP_51_or_50_costs_the_master_its_slave) {
    for (const std::uint8_t sap : {dp::kSapMs1, dp::kSapAlarm}) {
        test::AcyclicPlant plant;
        slave::VirtualSlave& slave = plant.plug(5);
        ASSERT_TRUE(plant.start());
        plant.run(5_ms);
        Job job = Job::service(5, sap, Octets{0x60, 1, 1, 4});
        job.ssap = dp::kMasterSapMs1;
        ASSERT_TRUE(plant.master.submit(job));
        EXPECT_TRUE(plant.until([&] { return plant.master.slave(0).counters().lost == 1; }));
        EXPECT_EQ(slave.counters().data_exch_left, 1u);
        EXPECT_TRUE(plant.start()) << "it comes back";
    }
}

// ---- timeouts ------------------------------------------------------------------------------------------------------

TEST_F(Ms2Test, the_slave_aborts_when_its_application_does_not_decide_about_a_connection) {
    struct Ponderer : slave::RecordHandler {
        std::optional<driver::InitiateAnswer> initiate(const driver::InitiateCall&) override { return driver::decide_later(); }
    } ponderer;
    slave.set_handler(&ponderer);
    const core::Ticks asked = plant.line.now();
    ASSERT_TRUE(ms2.open());
    EXPECT_EQ(plant.finish(ms2).kind, Kind::aborted) << master::text(ms2.result());
    EXPECT_EQ(ms2.result().abort, dp::Abort{AbortReason::timeout});
    EXPECT_GE(plant.line.now() - asked, 990_ms);
    EXPECT_LT(plant.line.now() - asked, 1100_ms);
    slave.set_handler(nullptr);
}

TEST_F(Ms2Test, a_longer_Send_Timeout_of_the_master_holds) {
    master::Ms2 patient{{.address = 5, .send_timeout = 300}};
    plant.master.attach(patient);
    open(patient);
    EXPECT_EQ(patient.send_timeout(), 300);
    test::Sleeper sleeper;
    slave.set_handler(&sleeper);
    const core::Ticks asked = plant.line.now();
    ASSERT_TRUE(patient.read(1, 1));
    EXPECT_EQ(plant.finish(patient).abort, dp::Abort{AbortReason::timeout});
    EXPECT_GE(plant.line.now() - asked, 2990_ms);
    EXPECT_LT(plant.line.now() - asked, 3100_ms);
    plant.master.detach(patient);
}

TEST(Timeouts, the_least_Send_Timeout_depends_on_the_rate) {
    const std::pair<fdl::BaudCode, int> cases[]{{fdl::BaudCode::mbit_12, 0x64},   {fdl::BaudCode::mbit_1_5, 0x64},  {fdl::BaudCode::kbit_500, 0xC8},
                                                {fdl::BaudCode::kbit_187_5, 0x190}, {fdl::BaudCode::kbit_19_2, 0x190}};
    for (const auto& [rate, least] : cases) {
        test::AcyclicPlant plant{{.baud = rate, .gap_factor = 1, .mode = master::Mode::stop}};
        slave::VirtualSlave& slave = plant.plug(5, false);
        ASSERT_TRUE(plant.until([&] { return slave.baud().has_value(); }, 60_s));
        master::Ms2 ms2{{.address = 5}};
        plant.master.attach(ms2);
        ASSERT_TRUE(ms2.open());
        ASSERT_TRUE(plant.finish(ms2).done()) << master::text(ms2.result());
        EXPECT_EQ(ms2.send_timeout(), least);
        plant.master.detach(ms2);
    }
}

}  // namespace
