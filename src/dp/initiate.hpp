// SPDX-License-Identifier: Apache-2.0
// Opening and ending an MS2 connection: Initiate with its two address parts, Abort, Send_Timeout (reference 5.4).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/dp/acyclic.hpp>
#include <dpchip/dp/acyclic_error.hpp>

namespace dpchip::dp {

// ---- Send_Timeout -------------------------------------------------------------------------------------------------

inline constexpr std::uint16_t kMaxSendTimeout = 0x7FFF;  ///< 10 ms
inline constexpr std::uint32_t kSendTimeoutUnit = 10;     ///< ms

/// The least Send_Timeout a slave grants, in 10 ms, by the chip's baud code (0 = 12 Mbit/s .. 9 = 9.6 kbit/s). While the
/// rate is not known, the slowest one's.
constexpr std::uint16_t min_send_timeout(std::uint8_t baud_code) {
    if (baud_code <= 3) return 0x0064;
    return baud_code == 4 ? 0x00C8 : 0x0190;
}

/// What is used: the longer of the two, 1..7FFFH.
constexpr std::uint16_t agreed_send_timeout(std::uint16_t own, std::uint16_t requested) {
    return std::clamp(std::max(own, requested), std::uint16_t{1}, kMaxSendTimeout);
}

// ---- Initiate -----------------------------------------------------------------------------------------------------

inline constexpr std::uint8_t kFeatureReadWrite = 0x01;  ///< Features_Supported_1: DS_Read and DS_Write
inline constexpr std::size_t kInitiateReqHeader = 16;
inline constexpr std::size_t kInitiateResHeader = 12;
inline constexpr std::size_t kMinAddressPart = 2;        ///< API and SCL
inline constexpr std::size_t kMinInitiateReq = kInitiateReqHeader + 2 * kMinAddressPart;
/// Both addresses as long as their length octets can say and a telegram holds.
inline constexpr std::size_t kMaxInitiatePdu = kMaxAcyclicPdu;

/// One end of a connection: API, SCL and, with `type` not 0, a network address.
struct ConnectionAddress {
    std::uint8_t type{};
    Octets octets{};  ///< at least two: API, SCL

    constexpr std::uint8_t api() const { return octets.empty() ? std::uint8_t{0} : octets[0]; }
    constexpr std::uint8_t scl() const { return octets.size() < 2 ? std::uint8_t{0} : octets[1]; }
};

/// What both sides tell each other about themselves.
struct InitiateFeatures {
    std::uint8_t features_1{kFeatureReadWrite};
    std::uint8_t features_2{};
    std::uint8_t profile_features_1{};
    std::uint8_t profile_features_2{};
    std::uint16_t profile_ident{};

    friend constexpr bool operator==(const InitiateFeatures&, const InitiateFeatures&) = default;
};

struct InitiateReq {
    std::uint16_t send_timeout{};  ///< 10 ms
    InitiateFeatures features{};
    ConnectionAddress source{}, destination{};
};

struct InitiateRes {
    std::uint8_t max_length{};  ///< longest record in one PDU
    InitiateFeatures features{};
    ConnectionAddress source{}, destination{};
};

namespace detail {

constexpr InitiateFeatures features(Octets at) { return {at[0], at[1], at[2], at[3], core::word(at[4], at[5])}; }

constexpr void put(const InitiateFeatures& f, std::span<std::uint8_t> at) {
    at[0] = f.features_1;
    at[1] = f.features_2;
    at[2] = f.profile_features_1;
    at[3] = f.profile_features_2;
    at[4] = core::high(f.profile_ident);
    at[5] = core::low(f.profile_ident);
}

/// S_Type S_Len D_Type D_Len and what they announce. `from` is their place in the PDU.
constexpr AcyclicError addresses(Octets pdu, std::size_t from, ConnectionAddress& source, ConnectionAddress& destination) {
    const std::size_t s = pdu[from + 1], d = pdu[from + 3];
    if (s < kMinAddressPart || d < kMinAddressPart) return AcyclicError::address_length;
    const Octets both = pdu.subspan(from + 4);
    if (s + d != both.size()) return AcyclicError::address_mismatch;
    source = {pdu[from], both.first(s)};
    destination = {pdu[from + 2], both.last(d)};
    return AcyclicError::none;
}

constexpr AcyclicResult<std::size_t> put(const ConnectionAddress& source, const ConnectionAddress& destination,
                                         std::size_t from, std::span<std::uint8_t> out) {
    const std::size_t length = from + 4 + source.octets.size() + destination.octets.size();
    if (source.octets.size() < kMinAddressPart || destination.octets.size() < kMinAddressPart) return AcyclicError::address_length;
    if (length > kMaxInitiatePdu) return AcyclicError::too_long;
    if (length > out.size()) return AcyclicError::no_room;
    out[from] = source.type;
    out[from + 1] = static_cast<std::uint8_t>(source.octets.size());
    out[from + 2] = destination.type;
    out[from + 3] = static_cast<std::uint8_t>(destination.octets.size());
    std::size_t at = from + 4;
    for (const std::uint8_t o : source.octets) out[at++] = o;
    for (const std::uint8_t o : destination.octets) out[at++] = o;
    return length;
}

}  // namespace detail

/// 20 octets at least. The three octets behind the function are reserved and not looked at.
constexpr AcyclicResult<InitiateReq> decode_initiate_req(Octets pdu) {
    if (const AcyclicError e = detail::check_function(pdu, AcyclicFunction::initiate); e != AcyclicError::none) return e;
    if (pdu.size() < kMinInitiateReq) return AcyclicError::too_short;
    InitiateReq req{};
    req.send_timeout = core::word(pdu[4], pdu[5]);
    req.features = detail::features(pdu.subspan(6));
    const AcyclicError e = detail::addresses(pdu, 12, req.source, req.destination);
    if (e != AcyclicError::none) return e;
    return req;
}

constexpr AcyclicResult<InitiateRes> decode_initiate_res(Octets pdu) {
    if (const AcyclicError e = detail::check_function(pdu, AcyclicFunction::initiate); e != AcyclicError::none) return e;
    if (pdu.size() < kInitiateResHeader + 2 * kMinAddressPart) return AcyclicError::too_short;
    InitiateRes res{};
    res.max_length = pdu[1];
    res.features = detail::features(pdu.subspan(2));
    const AcyclicError e = detail::addresses(pdu, 8, res.source, res.destination);
    if (e != AcyclicError::none) return e;
    return res;
}

constexpr AcyclicResult<std::size_t> encode(const InitiateReq& req, std::span<std::uint8_t> out) {
    const auto length = detail::put(req.source, req.destination, 12, out);
    if (!length) return length;
    out[0] = core::to_underlying(AcyclicFunction::initiate);
    out[1] = out[2] = out[3] = 0;
    out[4] = core::high(req.send_timeout);
    out[5] = core::low(req.send_timeout);
    detail::put(req.features, out.subspan(6));
    return length;
}

constexpr AcyclicResult<std::size_t> encode(const InitiateRes& res, std::span<std::uint8_t> out) {
    const auto length = detail::put(res.source, res.destination, 8, out);
    if (!length) return length;
    out[0] = core::to_underlying(AcyclicFunction::initiate);
    out[1] = res.max_length;
    detail::put(res.features, out.subspan(2));
    return length;
}

// ---- Abort --------------------------------------------------------------------------------------------------------

enum class AbortSubnet : std::uint8_t { none = 0, local = 1, remote = 2 };
enum class AbortInstance : std::uint8_t { fdl = 0, msac_c2 = 1, user = 2, reserved = 3 };

/// Reasons of instance MSAC_C2.
enum class AbortReason : std::uint8_t {
    sequence_error = 1,             ///< SE
    invalid_request = 2,            ///< FE
    timeout = 3,                    ///< TO
    invalid_response = 4,           ///< RE
    invalid_service = 5,            ///< IV: from the user
    send_timeout_too_small = 6,     ///< STO
    invalid_address = 7,            ///< IA: additional address
    waiting_for_confirmation = 8,   ///< OC: of FDL
    resource_error = 15,            ///< RES
};

constexpr const char* abort_subnet_name(std::uint8_t subnet) {
    switch (subnet) {
    case 0: return "no subnet";
    case 1: return "local subnet";
    case 2: return "remote subnet";
    default: return "reserved";
    }
}
constexpr const char* name(AbortInstance i) {
    switch (i) {
    case AbortInstance::fdl: return "FDL";
    case AbortInstance::msac_c2: return "MSAC_C2";
    case AbortInstance::user: return "user";
    case AbortInstance::reserved: break;
    }
    return "reserved";
}
/// Words for a reason of instance MSAC_C2.
constexpr const char* abort_reason_name(std::uint8_t reason) {
    switch (static_cast<AbortReason>(reason)) {
    case AbortReason::sequence_error: return "sequence error (SE)";
    case AbortReason::invalid_request: return "invalid request PDU (FE)";
    case AbortReason::timeout: return "timeout (TO)";
    case AbortReason::invalid_response: return "invalid response PDU (RE)";
    case AbortReason::invalid_service: return "invalid service from the user (IV)";
    case AbortReason::send_timeout_too_small: return "Send_Timeout too small (STO)";
    case AbortReason::invalid_address: return "invalid additional address (IA)";
    case AbortReason::waiting_for_confirmation: return "waiting for the confirmation of FDL (OC)";
    case AbortReason::resource_error: return "resource error (RES)";
    }
    return "reserved";
}

/// Reasons of instance FDL: how the layer below ended a request.
enum class FdlReason : std::uint8_t {
    ue = 1,    ///< user error
    rr = 2,    ///< no resource
    rs = 3,    ///< SAP not activated
    nr = 9,    ///< no data
    dh = 10,   ///< data, high priority
    lr = 11,   ///< the own station has no resource
    rdl = 12,  ///< data, and no resource
    rdh = 13,  ///< the same, high priority
    ds = 14,   ///< the own station is not in the ring
    na = 15,   ///< no answer
};

/// Words for a reason; of instance user there are none: "reason of the user".
constexpr const char* abort_reason_name(AbortInstance instance, std::uint8_t reason) {
    if (instance == AbortInstance::msac_c2) return abort_reason_name(reason);
    if (instance == AbortInstance::user) return "reason of the user";
    if (instance != AbortInstance::fdl) return "reserved";
    switch (static_cast<FdlReason>(reason)) {
    case FdlReason::ue: return "user error (UE)";
    case FdlReason::rr: return "no resource (RR)";
    case FdlReason::rs: return "SAP not activated (RS)";
    case FdlReason::nr: return "no data (NR)";
    case FdlReason::dh: return "data of high priority (DH)";
    case FdlReason::lr: return "no local resource (LR)";
    case FdlReason::rdl: return "data, no resource (RDL)";
    case FdlReason::rdh: return "data of high priority, no resource (RDH)";
    case FdlReason::ds: return "not in the ring (DS)";
    case FdlReason::na: return "no answer (NA)";
    }
    return "reserved";
}

struct Abort {
    std::uint8_t subnet{};
    AbortInstance instance{AbortInstance::msac_c2};
    std::uint8_t reason{};  ///< 0..15: AbortReason, an FDL status, or the user's own

    constexpr Abort() = default;
    constexpr explicit Abort(AbortReason r) : reason{core::to_underlying(r)} {}
    constexpr Abort(AbortSubnet s, AbortInstance i, std::uint8_t r) : subnet{core::to_underlying(s)}, instance{i}, reason{r} {}
    friend constexpr bool operator==(const Abort&, const Abort&) = default;
};

inline constexpr std::size_t kAbortPdu = 3;
inline constexpr std::size_t kMaxAbortPdu = 4;  ///< with the reserved octet

constexpr AcyclicResult<Abort> decode_abort(Octets pdu) {
    if (const AcyclicError e = detail::check_function(pdu, AcyclicFunction::abort); e != AcyclicError::none) return e;
    if (pdu.size() < kAbortPdu) return AcyclicError::too_short;
    if (pdu.size() > kMaxAbortPdu) return AcyclicError::too_long;
    if ((pdu[2] & 0xC0u) != 0) return AcyclicError::reserved;
    Abort a{};
    a.subnet = pdu[1];
    a.instance = static_cast<AbortInstance>(core::slice(pdu[2], 4, 2));
    a.reason = core::slice(pdu[2], 0, 4);
    return a;
}

/// Three octets.
constexpr AcyclicResult<std::size_t> encode(const Abort& a, std::span<std::uint8_t> out) {
    if (out.size() < kAbortPdu) return AcyclicError::no_room;
    out[0] = core::to_underlying(AcyclicFunction::abort);
    out[1] = a.subnet;
    out[2] = static_cast<std::uint8_t>((core::to_underlying(a.instance) & 3u) << 4 | (a.reason & 0x0Fu));
    return kAbortPdu;
}

// ---- any PDU ------------------------------------------------------------------------------------------------------

enum class AcyclicDirection : std::uint8_t { request, answer };

/// The first rule that a PDU going this way breaks; AcyclicError::none for a good one.
constexpr AcyclicError check_pdu(AcyclicDirection way, Octets pdu) {
    const auto of = [](const auto& result) { return result ? AcyclicError::none : result.error(); };
    if (pdu.empty()) return AcyclicError::empty;
    const bool request = way == AcyclicDirection::request;
    switch (static_cast<AcyclicFunction>(pdu[0])) {
    case AcyclicFunction::idle: return of(decode_idle(pdu));
    case AcyclicFunction::data_transport: return of(decode_data_transport(pdu));
    case AcyclicFunction::resource_manager: return request ? AcyclicError::function : of(decode_resource_manager(pdu));
    case AcyclicFunction::initiate: return request ? of(decode_initiate_req(pdu)) : of(decode_initiate_res(pdu));
    case AcyclicFunction::abort: return of(decode_abort(pdu));
    case AcyclicFunction::alarm_ack: return of(decode_alarm_ack(pdu));
    case AcyclicFunction::ds_read: return request ? of(decode_ds_read_req(pdu)) : of(decode_ds_read_res(pdu));
    case AcyclicFunction::ds_write: return request ? of(decode_ds_write_req(pdu)) : of(decode_ds_write_res(pdu));
    }
    return request ? AcyclicError::function : of(decode_negative(pdu));
}

}  // namespace dpchip::dp
