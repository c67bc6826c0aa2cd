// SPDX-License-Identifier: Apache-2.0
// Alarms and status messages of one slave as its class-1 master gets them: found in the diagnosis, queued for the
// application, acknowledged over MS1 (reference 5.5).
//
// Call look() once a cycle, from the hook: then no diagnosis is missed, however fast they follow each other.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include <dpchip/core/fixed_queue.hpp>
#include <dpchip/dp/alarm.hpp>
#include <dpchip/master/ms1.hpp>
#include <dpchip/master/slave_handler.hpp>

namespace dpchip::master {

/// An alarm or a status message, with its user data.
struct ReceivedAlarm {
    bool status{};
    std::uint8_t type{};
    std::uint8_t slot{};
    std::uint8_t seq_nr{};
    bool add_ack{};
    std::uint8_t specifier{};
    std::uint8_t size{};
    std::array<std::uint8_t, dp::kMaxDeviceBlock> octets{};  ///< `size` octets of user data

    std::span<const std::uint8_t> data() const { return std::span{octets}.first(size); }
};

class AlarmReceiver {
public:
    /// Both must outlive the receiver. `ms1`: attached to the same master.
    AlarmReceiver(const SlaveHandler& slave, Ms1& ms1) : slave_{&slave}, ms1_{&ms1} {}

    /// Looks into a diagnosis that has come since the last call. Every new alarm is queued and acknowledged.
    void look();
    /// The oldest alarm or status message; nothing when there is none. 32 wait at most: see lost().
    std::optional<ReceivedAlarm> take() {
        if (received_.empty()) return std::nullopt;
        return received_.pop();
    }
    std::uint64_t alarms() const { return alarms_; }
    std::uint64_t status_messages() const { return status_messages_; }
    /// Alarms that the queue had no room for; they were acknowledged all the same.
    std::uint64_t lost() const { return received_.overflows(); }

private:
    void receive(const dp::AlarmStatus& alarm);

    const SlaveHandler* slave_;
    Ms1* ms1_;
    std::uint64_t diagnoses_ = 0;  ///< seen
    std::uint64_t lost_exchange_ = 0;
    bool known_ = false;           ///< `last_` was in the diagnosis before this one
    dp::AlarmAck last_{};
    std::uint64_t alarms_ = 0, status_messages_ = 0;
    core::FixedQueue<ReceivedAlarm, 32> received_;
};

}  // namespace dpchip::master
