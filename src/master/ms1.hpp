// SPDX-License-Identifier: Apache-2.0
// MS1: acyclic services of the class-1 master that exchanges data with the slave: DS_Read, DS_Write and Alarm_Ack on
// SAP 51, or Alarm_Ack on SAP 50 (reference 5.3). The slave's Set_Prm must enable DP-V1.
//
// The slave has one buffer: a request is answered RR as long as an older answer lies there. Such an answer, of a request
// that was given up, is fetched and thrown away before the request is repeated.
#pragma once

#include <cstdint>

#include <dpchip/core/fixed_queue.hpp>
#include <dpchip/master/relation.hpp>

namespace dpchip::master {

struct Ms1Config {
    std::uint8_t address{};                      ///< the slave's
    Ticks response_timeout = core::seconds(10);  ///< C1_Response_Timeout: from the request to its answer
    Ticks poll_interval{};                       ///< least time between two polls
    bool alarm_sap = false;                      ///< acknowledge alarms on SAP 50
};

class Ms1 : public Relation {
public:
    explicit Ms1(const Ms1Config& config) : Relation{config.address}, config_{config} {}

    /// Sends Alarm_Ack, taking turns with services. False when 32 are waiting.
    bool acknowledge(const dp::AlarmAck& alarm);
    std::size_t acknowledgements_waiting() const { return acks_.size() + (acknowledging_ ? 1u : 0u); }
    /// Of the last Alarm_Ack.
    const ServiceResult& acknowledgement() const { return ack_result_; }
    std::uint64_t acknowledged() const { return acknowledged_; }

    Job* next_job(Ticks now) override;
    void job_done(Ticks now) override;

private:
    enum class State : std::uint8_t {
        idle,
        request,   ///< to be sent
        polling,
        draining,  ///< another answer is in the way
    };

    bool usable(ServiceResult&) const override { return true; }
    void begun() override { wanted_ = true; }
    void start(Ticks now);
    void answered_without_data(Ticks now);
    void take_data(Ticks now);
    void end(const ServiceResult& result);
    std::uint8_t sap() const { return acknowledging_ && config_.alarm_sap ? dp::kSapAlarm : dp::kSapMs1; }

    Ms1Config config_;
    State state_ = State::idle;
    bool wanted_ = false;         ///< a service waits for its turn, its PDU is in request_
    bool acknowledging_ = false;  ///< what is under way is an Alarm_Ack
    bool service_next_ = false;   ///< an Alarm_Ack had its turn
    dp::AlarmAck ack_{};
    std::array<std::uint8_t, dp::kRecordHeader> ack_pdu_{};
    core::FixedQueue<dp::AlarmAck, 32> acks_;
    ServiceResult ack_result_{};
    std::uint64_t acknowledged_ = 0;
    Ticks again_{};               ///< not before
    Ticks deadline_{};
};

}  // namespace dpchip::master
