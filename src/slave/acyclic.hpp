// SPDX-License-Identifier: Apache-2.0
// DP-V1 of a virtual slave as its surroundings see it: a handler that may answer requests in place of the record table,
// and what has happened, for logs.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <dpchip/driver/acyclic_events.hpp>

namespace dpchip::slave {

/// Answers requests before the record table does. The functions return nothing for "not mine", and
/// driver::answer_later() for "VirtualSlave::complete() will follow".
class RecordHandler {
public:
    using Answer = std::optional<driver::RecordAnswer>;

    virtual ~RecordHandler() = default;
    virtual Answer read(const driver::RecordCall&, std::span<std::uint8_t> /*out*/) { return std::nullopt; }
    virtual Answer write(const driver::RecordCall&, std::span<const std::uint8_t> /*data*/) { return std::nullopt; }
    virtual Answer transport(const driver::RecordCall&, std::span<const std::uint8_t> /*data*/, std::span<std::uint8_t> /*out*/) {
        return std::nullopt;
    }
    virtual std::optional<driver::InitiateAnswer> initiate(const driver::InitiateCall&) { return std::nullopt; }
    /// A request that was put off is not waited for any more.
    virtual void dropped(const driver::Handle&) {}
};

/// Something that happened to a relation or an alarm.
struct AcyclicEvent {
    enum class Kind : std::uint8_t {
        ms1_opened, ms1_closed, connection_opened, connection_closed, request_dropped, alarm_acknowledged, alarm_dropped,
    };
    Kind kind{};
    std::uint8_t sap{};              ///< of connections and requests
    std::uint8_t master{};           ///< of what was opened
    driver::ClosedBy closed_by{};
    dp::Abort abort{};
    dp::AlarmAck alarm{};
};
/// "connection on SAP 48 closed by the driver: timeout (TO)".
std::string text(const AcyclicEvent& event);

/// DP-V1 traffic since power-up.
struct AcyclicCounters {
    std::uint64_t reads{}, writes{}, transports{};
    std::uint64_t refused{};                        ///< of these, answered negatively
    std::uint64_t connections_opened{}, connections_closed{};
    std::uint64_t requests_dropped{};
    std::uint64_t alarms_raised{}, alarms_acknowledged{}, alarms_dropped{};
};

}  // namespace dpchip::slave
