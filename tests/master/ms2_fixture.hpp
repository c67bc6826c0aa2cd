// SPDX-License-Identifier: Apache-2.0
// A class-2 master and a DP-V1 slave, and ways to go past the master's state machine, for tests of MS2.
#pragma once

#include "master/acyclic_plant.hpp"

namespace dpchip::test {

using namespace dpchip::core::literals;
using dp::AbortInstance;
using dp::AbortReason;
using master::Job;
using master::Ms2State;

/// A class-2 master without slaves of its own, and a slave that belongs to nobody.
struct Ms2Test : ::testing::Test {
    AcyclicPlant plant{{.baud = fdl::BaudCode::mbit_1_5, .gap_factor = 1, .mode = master::Mode::stop}};
    slave::VirtualSlave& slave = plant.plug(5, false);
    master::Ms2 ms2{{.address = 5}};

    void SetUp() override {
        plant.master.attach(ms2);
        ASSERT_TRUE(plant.until([&] { return slave.baud().has_value(); }));
    }
    void open(master::Ms2& c) {
        ASSERT_TRUE(c.open());
        ASSERT_TRUE(plant.finish(c).done()) << master::text(c.result());
        ASSERT_TRUE(c.is_open());
    }
    const master::ServiceResult& read(std::uint8_t slot, std::uint8_t index, std::size_t length = 240) {
        EXPECT_TRUE(ms2.read(slot, index, length));
        return plant.finish(ms2);
    }
    const master::ServiceResult& write(std::uint8_t slot, std::uint8_t index, const Octets& data) {
        EXPECT_TRUE(ms2.write(slot, index, data));
        return plant.finish(ms2);
    }
    /// A raw request on the connection's SAP, past the state machine.
    Job ask(const Octets& pdu, std::uint8_t sap) {
        Job job = Job::service(5, sap, pdu);
        job.ssap = dp::kMasterSapMs2;
        EXPECT_TRUE(plant.master.submit(job));
        EXPECT_TRUE(plant.until([&] { return job.finished(); }));
        return job;
    }
    /// Raw polls until there is data, or a refusal.
    Job poll(std::uint8_t sap) {
        for (int i = 0; i < 1000; ++i)
            if (Job job = ask({}, sap); job.outcome != Job::Outcome::acknowledged) return job;
        return {};
    }
    static constexpr std::uint8_t kInitiate[]{0x57, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 0, 0, 0};
    /// Opens a connection by hand; its SAP.
    std::uint8_t initiate_by_hand(const Octets& request = Octets(std::begin(kInitiate), std::end(kInitiate))) {
        const Job rm = ask(request, dp::kSapResourceManager);
        EXPECT_EQ(rm.outcome, Job::Outcome::data);
        const auto decoded = dp::decode_resource_manager(rm.data());
        EXPECT_TRUE(decoded);
        plant.run(3_ms);
        return decoded ? decoded->sap : std::uint8_t{0};
    }
    void expect_abort(const Job& job, AbortReason reason) {
        ASSERT_EQ(job.outcome, Job::Outcome::data) << name(job.outcome);
        EXPECT_EQ(octets_of(job.data()), (Octets{0x58, 0x00, static_cast<std::uint8_t>(0x10 | core::to_underlying(reason))}));
    }
    std::vector<slave::AcyclicEvent> events() {
        std::vector<slave::AcyclicEvent> all;
        while (const auto e = slave.take_event()) all.push_back(*e);
        return all;
    }
};

/// An application that never answers a read.
struct Sleeper : slave::RecordHandler {
    driver::Handle handle{};
    int dropped_requests = 0;
    Answer read(const driver::RecordCall& call, std::span<std::uint8_t>) override {
        handle = call.handle;
        return driver::answer_later();
    }
    void dropped(const driver::Handle&) override { ++dropped_requests; }
};

/// The application may refuse, or abort later, with any of its sixteen reasons.
struct Doorkeeper : slave::RecordHandler {
    std::uint8_t reason = 0;
    std::optional<driver::InitiateAnswer> initiate(const driver::InitiateCall&) override { return driver::refuse_connection(reason); }
};

}  // namespace dpchip::test
