// SPDX-License-Identifier: Apache-2.0
// What the driver asks an application with DP-V1: records by slot and index, data transport, connections, alarms,
// identification (reference 5.3 to 5.6). Derive from AcyclicEvents and hide what you want to hear; nothing is virtual.
//
// A request is answered at once, or refused, or answered later: the function returns answer_later(), and the program
// calls the driver's complete() with the call's handle when it knows the answer. Until then the master polls.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/dp/acyclic.hpp>
#include <dpchip/dp/acyclic_error.hpp>
#include <dpchip/dp/identification.hpp>
#include <dpchip/dp/initiate.hpp>
#include <dpchip/driver/events.hpp>

namespace dpchip::driver {

/// Which kind of master asks.
enum class Relation : std::uint8_t { ms1, ms2 };

/// Names one request until it is answered. A value; the driver knows one that has become stale.
struct Handle {
    std::uint8_t sap{};     ///< 51, or the connection's
    std::uint8_t serial{};

    friend constexpr bool operator==(const Handle&, const Handle&) = default;
};

/// A request for a record.
struct RecordCall {
    Handle handle{};
    Relation relation{};
    std::uint8_t master{};  ///< its address
    std::uint8_t slot{};
    std::uint8_t index{};
    std::uint8_t length{};  ///< octets asked for, or written
};

/// What the application says to a RecordCall: answered(), refused(), answer_later().
struct RecordAnswer {
    enum class Kind : std::uint8_t { done, refused, later };
    static constexpr std::uint8_t kAll = 0xFF;

    Kind kind{};
    std::uint8_t octets{kAll};  ///< read or accepted; kAll: as many as were asked for
    dp::RecordError error{};
};

/// Done. `octets`: how many of a read are there, or how many of a write were taken; more than asked for count as all.
constexpr RecordAnswer answered(std::size_t octets = RecordAnswer::kAll) {
    return {.octets = static_cast<std::uint8_t>(octets < RecordAnswer::kAll ? octets : RecordAnswer::kAll)};
}
constexpr RecordAnswer refused(const dp::RecordError& error) { return {.kind = RecordAnswer::Kind::refused, .error = error}; }
constexpr RecordAnswer refused(dp::ErrorCode1 code, std::uint8_t code_2 = 0) { return refused(dp::RecordError{code, code_2}); }
constexpr RecordAnswer answer_later() { return {.kind = RecordAnswer::Kind::later}; }

/// A class-2 master wants a connection. The addresses in `request` are valid during the call.
struct InitiateCall {
    Handle handle{};
    std::uint8_t master{};
    std::uint16_t send_timeout{};  ///< 10 ms, what will be used
    dp::InitiateReq request{};
};

/// What the application says to an InitiateCall.
struct InitiateAnswer {
    enum class Kind : std::uint8_t { accepted, refused, later };

    Kind kind{};
    dp::InitiateFeatures features{};
    dp::Abort abort{};
};
constexpr InitiateAnswer accept_connection(const dp::InitiateFeatures& features = {}) { return {.features = features}; }
/// `reason`: the application's own, 0..15.
constexpr InitiateAnswer refuse_connection(std::uint8_t reason) {
    return {.kind = InitiateAnswer::Kind::refused, .abort = {dp::AbortSubnet::none, dp::AbortInstance::user, reason}};
}
/// A reason of MSAC_C2 that the application finds: IA for an additional address that it does not know, RES when it has no
/// room for another connection.
constexpr InitiateAnswer refuse_connection(dp::AbortReason reason) {
    return {.kind = InitiateAnswer::Kind::refused, .abort = dp::Abort{reason}};
}
constexpr InitiateAnswer decide_later() { return {.kind = InitiateAnswer::Kind::later}; }

/// Who ended a connection, with the Abort that was sent or received.
enum class ClosedBy : std::uint8_t {
    master,   ///< its Abort
    driver,   ///< timeout, a bad PDU, a request out of turn
    user,     ///< the application refused or aborted it
    offline,  ///< the chip went Offline: no Abort
};

/// As Events, called from within poll(), on_interrupt() and tick(). complete() must not be called from inside read(),
/// write(), data_transport() and initiate() for the request they are about.
struct AcyclicEvents : Events {
    /// Up to out.size() octets, which is what was asked for, at most what the configuration allows.
    RecordAnswer read(const RecordCall&, std::span<std::uint8_t> /*out*/) { return refused(dp::ErrorCode1::invalid_index); }
    RecordAnswer write(const RecordCall&, std::span<const std::uint8_t> /*data*/) { return refused(dp::ErrorCode1::invalid_index); }
    /// `out` and `data` do not overlap.
    RecordAnswer data_transport(const RecordCall&, std::span<const std::uint8_t> /*data*/, std::span<std::uint8_t> /*out*/) {
        return refused(dp::ErrorCode1::feature_not_supported);
    }
    /// A deferred request that nobody waits for any more: its handle is dead.
    void request_dropped(Handle) {}

    // ---- relations
    void ms1_opened(std::uint8_t /*master*/) {}
    void ms1_closed() {}
    InitiateAnswer initiate(const InitiateCall&) { return accept_connection(); }
    void connection_opened(std::uint8_t /*sap*/, std::uint8_t /*master*/) {}
    void connection_closed(std::uint8_t /*sap*/, ClosedBy, const dp::Abort&) {}

    // ---- alarms
    void alarm_acknowledged(const dp::AlarmAck&) {}
    /// The master left before it acknowledged, or before it was told.
    void alarm_dropped(const dp::AlarmAck&) {}

    // ---- identification: 64 octets each, see dp/identification.hpp. Answered at once.
    bool has_im(std::uint8_t /*slot*/, std::uint16_t /*im_index*/) { return false; }
    RecordAnswer read_im(std::uint8_t /*slot*/, std::uint16_t /*im_index*/, std::span<std::uint8_t, dp::kImRecord>) {
        return refused(dp::ErrorCode1::invalid_index);
    }
    RecordAnswer write_im(std::uint8_t /*slot*/, std::uint16_t /*im_index*/, std::span<const std::uint8_t, dp::kImRecord>) {
        return refused(dp::ErrorCode1::access_denied);
    }
};

template <class A>
concept AcyclicApplication = std::derived_from<A, AcyclicEvents>;

}  // namespace dpchip::driver
