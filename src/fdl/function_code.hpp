// SPDX-License-Identifier: Apache-2.0
// The FC octet of requests and responses (reference 2.2, 2.3).
#pragma once

#include <cstdint>

namespace dpchip::fdl {

/// Function of a request, FC bits 3..0.
enum class Request : std::uint8_t {
    time_event = 0,   ///< TE; with FC bit 7: CV Clock_Value
    sda_low = 3,
    sdn_low = 4,
    sda_high = 5,
    sdn_high = 6,
    msrd = 7,         ///< send and request data with multicast reply
    fdl_status = 9,
    srd_low = 12,
    srd_high = 13,
    ident = 14,
    lsap_status = 15,
};

/// Function of a response, FC bits 3..0.
enum class Response : std::uint8_t {
    ok = 0,    ///< positive, no data
    ue = 1,    ///< user error
    rr = 2,    ///< no resource
    rs = 3,    ///< service or SAP not activated
    dl = 8,    ///< data, low priority
    nr = 9,    ///< no reply data ready
    dh = 10,   ///< data, high priority: a diagnosis is waiting
    rdl = 12,  ///< data low, request not accepted
    rdh = 13,  ///< data high, request not accepted
};

/// Station type in a response, FC bits 5..4.
enum class StationType : std::uint8_t { slave = 0, master_not_ready = 1, master_ready = 2, master_in_ring = 3 };

/// The FC octet, taken apart.
struct FunctionCode {
    std::uint8_t octet{};

    constexpr bool is_request() const { return (octet & 0x40u) != 0; }
    constexpr bool fcb() const { return (octet & 0x20u) != 0; }
    constexpr bool fcv() const { return (octet & 0x10u) != 0; }
    /// CV: bits 5 and 4 should be 0 and are not looked at.
    constexpr bool clock_value() const { return (octet & 0xCFu) == 0xC0u; }
    constexpr std::uint8_t function() const { return octet & 0x0Fu; }
    constexpr Request request() const { return static_cast<Request>(function()); }
    constexpr Response response() const { return static_cast<Response>(function()); }
    constexpr StationType station_type() const { return static_cast<StationType>((octet >> 4) & 3u); }
};

constexpr std::uint8_t request_fc(Request r, bool fcb, bool fcv) {
    return static_cast<std::uint8_t>(0x40u | (fcb ? 0x20u : 0u) | (fcv ? 0x10u : 0u) | static_cast<unsigned>(r));
}
constexpr std::uint8_t response_fc(Response r, StationType t = StationType::slave) {
    return static_cast<std::uint8_t>(static_cast<unsigned>(t) << 4 | static_cast<unsigned>(r));
}

/// Requests whose frame count bit means something and that expect an answer (reference 2.5).
constexpr bool uses_frame_count(Request r) {
    return r == Request::sda_low || r == Request::sda_high || r == Request::msrd || r == Request::srd_low ||
           r == Request::srd_high;
}
constexpr bool is_srd(Request r) { return r == Request::srd_low || r == Request::srd_high; }
constexpr bool is_sda(Request r) { return r == Request::sda_low || r == Request::sda_high; }
constexpr bool is_sdn(Request r) { return r == Request::sdn_low || r == Request::sdn_high; }

/// "SRD low", "FDL_Status", ...; "reserved" where the standard has none.
constexpr const char* name(Request r) {
    switch (r) {
    case Request::time_event: return "Time_Event";
    case Request::sda_low: return "SDA low";
    case Request::sdn_low: return "SDN low";
    case Request::sda_high: return "SDA high";
    case Request::sdn_high: return "SDN high";
    case Request::msrd: return "MSRD";
    case Request::fdl_status: return "FDL_Status";
    case Request::srd_low: return "SRD low";
    case Request::srd_high: return "SRD high";
    case Request::ident: return "Ident";
    case Request::lsap_status: return "LSAP status";
    }
    return "reserved";
}
constexpr const char* name(Response r) {
    switch (r) {
    case Response::ok: return "OK";
    case Response::ue: return "UE";
    case Response::rr: return "RR";
    case Response::rs: return "RS";
    case Response::dl: return "DL";
    case Response::nr: return "NR";
    case Response::dh: return "DH";
    case Response::rdl: return "RDL";
    case Response::rdh: return "RDH";
    }
    return "reserved";
}

}  // namespace dpchip::fdl
