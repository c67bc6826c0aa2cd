// SPDX-License-Identifier: Apache-2.0
// MS1 from the master's side: records, each negative answer, timeouts, alarms, I&M (reference 5.3, 5.5, 5.6).
#include "master/acyclic_plant.hpp"

namespace {

using namespace dpchip;
using namespace dpchip::core::literals;
using driver::AlarmResult;
using dp::ErrorCode1;
using Kind = master::ServiceResult::Kind;
using test::AcyclicPlant;
using test::Octets;
using test::octets_of;
using test::pattern;

struct Ms1Test : ::testing::Test {
    AcyclicPlant plant;
    slave::VirtualSlave& slave = plant.plug(5);
    master::Ms1 ms1{{.address = 5}};

    void SetUp() override {
        plant.master.attach(ms1);
        ASSERT_TRUE(plant.start());
        plant.run(2_ms);
    }
    const master::ServiceResult& read(std::uint8_t slot, std::uint8_t index, std::size_t length = 240) {
        EXPECT_TRUE(ms1.read(slot, index, length));
        return plant.finish(ms1);
    }
    const master::ServiceResult& write(std::uint8_t slot, std::uint8_t index, const Octets& data) {
        EXPECT_TRUE(ms1.write(slot, index, data));
        return plant.finish(ms1);
    }
    void expect_refused(const master::ServiceResult& r, ErrorCode1 code) {
        EXPECT_EQ(r.kind, Kind::refused) << master::text(r);
        EXPECT_EQ(r.error, dp::RecordError{code}) << master::text(r);
    }
};

TEST_F(Ms1Test, reads_a_record_whole_or_in_part) {
    ASSERT_TRUE(read(1, 1).done()) << master::text(ms1.result());
    EXPECT_EQ(octets_of(ms1.data()), pattern(32, 1));
    ASSERT_TRUE(read(1, 1, 5).done());
    EXPECT_EQ(octets_of(ms1.data()), pattern(5, 1));  // the pattern's beginning
    EXPECT_EQ(slave.acyclic_counters().reads, 2u);
    EXPECT_TRUE(plant.master.all_exchanging());
}

TEST_F(Ms1Test, moves_240_octets_both_ways) {
    ASSERT_TRUE(read(1, 4).done());
    EXPECT_EQ(octets_of(ms1.data()), pattern(240, 4));
    ASSERT_TRUE(write(1, 4, pattern(240, 9)).done());
    EXPECT_EQ(ms1.accepted(), 240);
    EXPECT_EQ(octets_of(slave.records().octets(1, 4)), pattern(240, 9));
    ASSERT_TRUE(read(1, 4).done());
    EXPECT_EQ(octets_of(ms1.data()), pattern(240, 9));
}

TEST_F(Ms1Test, is_told_why_a_record_cannot_be_had) {
    expect_refused(read(1, 99), ErrorCode1::invalid_index);
    expect_refused(read(0, 1), ErrorCode1::invalid_index);
    expect_refused(read(7, 1), ErrorCode1::invalid_slot);
    expect_refused(read(1, 3), ErrorCode1::access_denied);
    expect_refused(write(1, 2, {1}), ErrorCode1::access_denied);
    expect_refused(write(1, 1, Octets(33)), ErrorCode1::write_length_error);
    expect_refused(write(7, 1, {1}), ErrorCode1::invalid_slot);
    EXPECT_EQ(master::text(read(7, 1)), "refused: invalid slot (access; 80H B2H 00H)");
    EXPECT_EQ(ms1.counters().refused, 8u);
    EXPECT_EQ(slave.acyclic_counters().refused, 8u);
}

TEST_F(Ms1Test, refuses_to_ask_what_no_PDU_can_say) {
    EXPECT_EQ(read(1, 1, 0).rule, dp::AcyclicError::length_zero);
    EXPECT_EQ(read(1, 1, 241).kind, Kind::invalid);
    EXPECT_EQ(write(1, 1, {}).kind, Kind::invalid);
    EXPECT_EQ(write(1, 1, Octets(241)).rule, dp::AcyclicError::length_range);
    EXPECT_EQ(slave.acyclic_counters().reads + slave.acyclic_counters().writes, 0u);
}

/// Says what it is told to, now or later.
struct Handler : slave::RecordHandler {
    Answer answer{};
    driver::Handle handle{};
    int dropped_requests = 0;
    Answer read(const driver::RecordCall& call, std::span<std::uint8_t>) override {
        handle = call.handle;
        return answer;
    }
    Answer write(const driver::RecordCall&, std::span<const std::uint8_t>) override { return answer; }
    void dropped(const driver::Handle&) override { ++dropped_requests; }
};

TEST_F(Ms1Test, hears_every_error_code_that_an_application_can_give) {
    Handler handler;
    slave.set_handler(&handler);
    for (unsigned code = 0; code < 256; ++code) {
        const dp::RecordError error{static_cast<std::uint8_t>(code % 3 == 0 ? 0x80 : code % 3 == 1 ? 0xFE : 0xFF), static_cast<std::uint8_t>(code), 0x5A};
        handler.answer = driver::refused(error);
        const auto& r = code % 2 == 0 ? read(1, 1) : write(1, 1, {1});
        ASSERT_EQ(r.kind, Kind::refused);
        ASSERT_EQ(r.error, error);
        ASSERT_FALSE(master::text(r).empty());
    }
}

TEST_F(Ms1Test, polls_until_an_answer_that_takes_its_time) {
    Handler handler;
    handler.answer = driver::answer_later();
    slave.set_handler(&handler);
    ASSERT_TRUE(ms1.read(1, 1, 3));
    plant.run(50_ms);
    ASSERT_TRUE(ms1.busy());
    EXPECT_GT(ms1.counters().polls, 10u);
    EXPECT_FALSE(ms1.read(1, 2));  // one at a time
    ASSERT_TRUE(slave.complete(handler.handle, driver::answered(2), Octets{7, 8}));
    plant.line.touch(plant.stations[0]);
    ASSERT_TRUE(plant.finish(ms1).done());
    EXPECT_EQ(octets_of(ms1.data()), (Octets{7, 8}));
}

TEST_F(Ms1Test, gives_up_after_its_timeout_and_throws_the_late_answer_away) {
    master::Ms1 hasty{{.address = 5, .response_timeout = 20_ms}};
    plant.master.attach(hasty);
    Handler handler;
    handler.answer = driver::answer_later();
    slave.set_handler(&handler);
    ASSERT_TRUE(hasty.read(1, 1, 3));
    EXPECT_EQ(plant.finish(hasty).kind, Kind::timeout);
    slave.set_handler(nullptr);
    // The buffer is still taken: the next request waits for it.
    ASSERT_TRUE(hasty.read(1, 2));
    plant.run(5_ms);
    ASSERT_TRUE(hasty.busy());
    ASSERT_TRUE(slave.complete(handler.handle, driver::answered(1), Octets{0xEE}));
    plant.line.touch(plant.stations[0]);
    ASSERT_TRUE(plant.finish(hasty).done()) << master::text(hasty.result());
    EXPECT_EQ(octets_of(hasty.data()), pattern(4, 2));
    EXPECT_EQ(hasty.counters().stale, 1u);
    EXPECT_GT(hasty.counters().busy, 0u);
    plant.master.detach(hasty);
}

TEST_F(Ms1Test, is_closed_while_there_is_no_data_exchange) {
    plant.master.set_mode(master::Mode::stop);
    ASSERT_TRUE(plant.until([&] { return slave.dp_state() == chip::DpState::wait_prm; }));  // the watchdog
    const auto& r = read(1, 1);
    EXPECT_EQ(r.kind, Kind::not_taken);
    EXPECT_EQ(r.response, fdl::Response::rs);
}

TEST_F(Ms1Test, ends_when_the_slave_is_switched_off_in_mid_request) {
    Handler handler;
    handler.answer = driver::answer_later();
    slave.set_handler(&handler);
    ASSERT_TRUE(ms1.read(1, 1));
    plant.run(2_ms);
    plant.line.detach(plant.stations[0]);
    EXPECT_EQ(plant.finish(ms1).kind, Kind::unanswered);
}

TEST_F(Ms1Test, drops_the_request_of_a_master_that_vanishes) {
    Handler handler;
    handler.answer = driver::answer_later();
    slave.set_handler(&handler);
    ASSERT_TRUE(ms1.read(1, 1));
    plant.run(2_ms);
    plant.master.set_mode(master::Mode::offline);
    ASSERT_TRUE(plant.until([&] { return slave.dp_state() == chip::DpState::wait_prm; }));
    EXPECT_EQ(handler.dropped_requests, 1);
    EXPECT_EQ(ms1.result().kind, Kind::unanswered);
    EXPECT_FALSE(slave.complete(handler.handle, driver::answered()));
    slave.set_handler(nullptr);
    plant.master.set_mode(master::Mode::operate);
    plant.line.touch(0);
    ASSERT_TRUE(plant.until([&] { return slave.dp_state() == chip::DpState::data_exch; }));
    ASSERT_TRUE(read(1, 1).done()) << master::text(ms1.result());
    std::vector<slave::AcyclicEvent::Kind> kinds;
    while (const auto e = slave.take_event()) kinds.push_back(e->kind);
    using K = slave::AcyclicEvent::Kind;
    EXPECT_EQ(kinds, (std::vector{K::ms1_opened, K::request_dropped, K::ms1_closed, K::ms1_opened}));
}

TEST_F(Ms1Test, reads_and_writes_identification) {
    master::ImReader im{ms1};
    const auto get = [&](std::uint16_t index) {
        EXPECT_TRUE(im.start(index));
        EXPECT_TRUE(plant.until([&] { im.step(); return im.finished(); }));
        return im.result();
    };
    ASSERT_TRUE(get(dp::kIm0).done()) << master::text(im.result());
    const auto im0 = dp::decode_im0(im.record());
    ASSERT_TRUE(im0);
    EXPECT_EQ(std::string(im0->order_id.data(), 9), "DPCHIP-V1");
    EXPECT_EQ(im0->hardware_revision, 3);
    EXPECT_EQ(im0->software_revision, (std::array<char, 4>{'V', 1, 2, 3}));
    EXPECT_EQ(im0->im_supported, 0x1E);
    dp::Im1 tag{};
    tag.tag_function = dp::im_text<32>(std::string_view{"pump 7"});
    Octets whole(dp::kImAnswer);
    ASSERT_TRUE(dp::encode(dp::ImCall{dp::kIm0 + 1, dp::encode(tag)}, whole));
    ASSERT_TRUE(write(0, 255, whole).done());
    ASSERT_TRUE(get(dp::kIm0 + 1).done());
    EXPECT_EQ(dp::decode_im1(im.record())->tag_function, tag.tag_function);
    expect_refused(get(0xFE4C), ErrorCode1::invalid_index);
    expect_refused(read(0, 255, 68), ErrorCode1::state_conflict);  // without a call
}

// ---- alarms --------------------------------------------------------------------------------------------------------

struct AlarmTest : Ms1Test {
    master::AlarmReceiver receiver{plant.master.slave(0), ms1};
    struct Look {
        master::AlarmReceiver* receiver;
        void operator()(master::Master&) { receiver->look(); }
    } look{&receiver};
    void SetUp() override {
        Ms1Test::SetUp();
        plant.master.on_cycle(look);
    }
    driver::AlarmRaised raise(const dp::AlarmStatus& a) {
        const auto raised = slave.raise(a);
        plant.line.touch(plant.stations[0]);
        return raised;
    }
    dp::AlarmStatus alarm(dp::AlarmType type, std::uint8_t slot, std::uint8_t specifier, std::span<const std::uint8_t> data = {}) {
        dp::AlarmStatus a{};
        a.type = core::to_underlying(type);
        a.slot = slot;
        a.specifier = specifier;
        a.data = data;
        return a;
    }
};

TEST_F(AlarmTest, come_and_go_and_are_acknowledged) {
    const Octets data{1, 2, 3};
    ASSERT_EQ(raise(alarm(dp::AlarmType::diagnostic, 1, 1, data)).result, AlarmResult::queued);
    ASSERT_TRUE(plant.until([&] { return slave.acyclic_counters().alarms_acknowledged == 1; }));
    const auto first = receiver.take();
    ASSERT_TRUE(first);
    EXPECT_EQ(first->type, 1);
    EXPECT_EQ(first->slot, 1);
    EXPECT_EQ(first->specifier, 1);
    EXPECT_EQ(octets_of(first->data()), data);
    ASSERT_EQ(raise(alarm(dp::AlarmType::diagnostic, 1, 2)).result, AlarmResult::queued);
    ASSERT_TRUE(plant.until([&] { return slave.acyclic_counters().alarms_acknowledged == 2; }));
    EXPECT_EQ(receiver.take()->specifier, 2);
    plant.run(10_ms);
    EXPECT_FALSE(receiver.take());
    EXPECT_EQ(receiver.alarms(), 2u);
    EXPECT_EQ(ms1.acknowledged(), 2u);
    EXPECT_TRUE(plant.master.all_exchanging());
}

TEST_F(AlarmTest, of_every_type_and_status_messages_pass_in_heavy_traffic_and_in_order) {
    const dp::AlarmType types[]{dp::AlarmType::diagnostic, dp::AlarmType::process, dp::AlarmType::pull,
                                dp::AlarmType::plug, dp::AlarmType::status, dp::AlarmType::update};
    unsigned raised = 0, told = 0, reads = 0, wrong = 0;
    std::vector<unsigned> next(7);
    std::array<std::uint8_t, 2> number{};
    const bool done = plant.until(
        [&] {
            if (!ms1.busy()) {
                wrong += ms1.result().done() || reads == 0 ? 0u : 1u;
                ms1.read(1, 4);
                ++reads;
            }
            if (raised < 300) {
                const auto type = types[raised % 6];
                number = {static_cast<std::uint8_t>(raised >> 8), static_cast<std::uint8_t>(raised)};
                if (raise(alarm(type, 1, 1, number)).result == AlarmResult::queued) ++raised;
            }
            while (const auto a = receiver.take()) {
                const unsigned n = unsigned{a->octets[0]} << 8 | a->octets[1];
                wrong += a->type == core::to_underlying(types[n % 6]) && n >= next[a->type] ? 0u : 1u;
                next[a->type] = n + 1;
                ++told;
            }
            return told == 300 && slave.acyclic_counters().alarms_acknowledged == 300;
        },
        20_s);
    EXPECT_TRUE(done) << raised << " raised, " << told << " told";
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(reads, 50u);
    EXPECT_EQ(receiver.alarms(), 300u);
    EXPECT_EQ(receiver.lost(), 0u);
    EXPECT_EQ(slave.acyclic_counters().alarms_dropped, 0u);
    EXPECT_TRUE(plant.master.all_exchanging());
    EXPECT_EQ(plant.master.slave(0).counters().lost, 0u);
}

TEST_F(AlarmTest, nobody_has_enabled_are_not_told) {
    AcyclicPlant other;
    slave::VirtualSlave& quiet = other.plug(9, true, dp::kEnableProcessAlarm);
    ASSERT_TRUE(other.start());
    other.run(2_ms);
    EXPECT_EQ(quiet.raise(alarm(dp::AlarmType::diagnostic, 1, 1)).result, AlarmResult::not_enabled);
    EXPECT_EQ(quiet.raise(alarm(dp::AlarmType::process, 1, 1)).result, AlarmResult::queued);
}

TEST_F(AlarmTest, that_is_not_outstanding_cannot_be_acknowledged) {
    ASSERT_TRUE(ms1.acknowledge({1, 1, 0x08}));
    ASSERT_TRUE(plant.until([&] { return ms1.acknowledgements_waiting() == 0; }));
    EXPECT_EQ(ms1.acknowledgement().kind, Kind::refused);
    EXPECT_EQ(ms1.acknowledgement().error, dp::RecordError{ErrorCode1::state_conflict});
}

TEST_F(AlarmTest, status_messages_need_no_acknowledgement) {
    dp::AlarmStatus status{};
    status.status = true;
    status.type = core::to_underlying(dp::StatusType::status_message);
    status.slot = 1;
    ASSERT_EQ(raise(status).result, AlarmResult::queued);
    ASSERT_TRUE(plant.until([&] { return receiver.status_messages() == 1; }));
    plant.run(5_ms);
    EXPECT_EQ(receiver.status_messages(), 1u);
    EXPECT_EQ(ms1.acknowledged(), 0u);
    EXPECT_EQ(plant.master.slave(0).diagnosis().size(), 6u);
}

TEST_F(AlarmTest, can_be_acknowledged_on_SAP_50) {
    master::Ms1 beside{{.address = 5, .alarm_sap = true}};
    plant.master.attach(beside);
    master::AlarmReceiver by_sap_50{plant.master.slave(0), beside};
    Look look_50{&by_sap_50};
    plant.master.on_cycle(look_50);
    ASSERT_EQ(raise(alarm(dp::AlarmType::process, 2, 0)).result, AlarmResult::queued);
    ASSERT_TRUE(plant.until([&] { return slave.acyclic_counters().alarms_acknowledged == 1; }));
    plant.master.on_cycle(look);
    plant.master.detach(beside);
}

}  // namespace
