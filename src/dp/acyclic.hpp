// SPDX-License-Identifier: Apache-2.0
// PDUs of the acyclic services, MS1 and MS2: function codes, reading and writing records, data transport, alarm
// acknowledgement, idle, the resource manager's answer (reference 5.3, 5.4). Initiate and Abort: initiate.hpp; what a
// negative answer says: acyclic_error.hpp.
//
// A decoded PDU is a view into its octets.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/core/bits.hpp>
#include <dpchip/core/result.hpp>

namespace dpchip::dp {

inline constexpr std::size_t kRecordHeader = 4;   ///< function, Slot, Index, Length
inline constexpr std::size_t kMaxRecord = 240;    ///< octets of a record in one PDU
inline constexpr std::size_t kMaxAcyclicPdu = kRecordHeader + kMaxRecord;
inline constexpr std::uint8_t kNegative = 0x80;   ///< in the first octet of a negative answer

/// The first octet of a PDU. Request and positive answer share it.
enum class AcyclicFunction : std::uint8_t {
    idle = 0x48,
    data_transport = 0x51,
    resource_manager = 0x56,  ///< the answer to an Initiate on SAP 49: which SAP
    initiate = 0x57,
    abort = 0x58,
    alarm_ack = 0x5C,
    ds_read = 0x5E,
    ds_write = 0x5F,
};

/// True for an octet that is one of the functions; `octet` without kNegative.
constexpr bool is_acyclic_function(std::uint8_t octet) {
    switch (static_cast<AcyclicFunction>(octet)) {
    case AcyclicFunction::idle:
    case AcyclicFunction::data_transport:
    case AcyclicFunction::resource_manager:
    case AcyclicFunction::initiate:
    case AcyclicFunction::abort:
    case AcyclicFunction::alarm_ack:
    case AcyclicFunction::ds_read:
    case AcyclicFunction::ds_write: return true;
    }
    return false;
}

/// The services that can be refused with Error_Decode and two error codes.
constexpr bool has_negative_answer(std::uint8_t octet) {
    const auto f = static_cast<AcyclicFunction>(octet);
    return f == AcyclicFunction::data_transport || f == AcyclicFunction::alarm_ack || f == AcyclicFunction::ds_read ||
           f == AcyclicFunction::ds_write;
}

constexpr const char* name(AcyclicFunction f) {
    switch (f) {
    case AcyclicFunction::idle: return "Idle";
    case AcyclicFunction::data_transport: return "Data_Transport";
    case AcyclicFunction::resource_manager: return "RM";
    case AcyclicFunction::initiate: return "Initiate";
    case AcyclicFunction::abort: return "Abort";
    case AcyclicFunction::alarm_ack: return "Alarm_Ack";
    case AcyclicFunction::ds_read: return "DS_Read";
    case AcyclicFunction::ds_write: return "DS_Write";
    }
    return "unknown function";
}

/// Which rule a PDU breaks.
enum class AcyclicError : std::uint8_t {
    none,
    empty,             ///< no octets: a poll, not a PDU
    function,          ///< the first octet is not the function that was asked for, or none at all
    too_short,         ///< fewer octets than the fixed part has
    too_long,          ///< octets behind the end
    length_zero,       ///< Length is 0 where a record is wanted
    length_range,      ///< Length is above 240
    length_mismatch,   ///< Length and the octets behind it differ
    address_length,    ///< Initiate: S_Len or D_Len below 2
    address_mismatch,  ///< Initiate: S_Len + D_Len and the octets behind them differ
    reserved,          ///< Abort: bits of Instance/Reason that must be 0
    no_room,           ///< the buffer to encode into is too small
};

constexpr const char* name(AcyclicError e) {
    switch (e) {
    case AcyclicError::none: return "no error";
    case AcyclicError::empty: return "no octets";
    case AcyclicError::function: return "another or an unknown function";
    case AcyclicError::too_short: return "too few octets";
    case AcyclicError::too_long: return "octets behind the end";
    case AcyclicError::length_zero: return "Length is 0";
    case AcyclicError::length_range: return "Length is above 240";
    case AcyclicError::length_mismatch: return "Length does not fit the octets";
    case AcyclicError::address_length: return "an address part is shorter than 2 octets";
    case AcyclicError::address_mismatch: return "address lengths do not fit the octets";
    case AcyclicError::reserved: return "reserved bits are set";
    case AcyclicError::no_room: return "no room";
    }
    return "no error";
}

template <class T>
using AcyclicResult = core::Result<T, AcyclicError>;
using Octets = std::span<const std::uint8_t>;

// ---- records ------------------------------------------------------------------------------------------------------

/// DS_Read.req and DS_Write.res.
struct RecordHead {
    std::uint8_t slot{};
    std::uint8_t index{};
    std::uint8_t length{};  ///< octets wanted, or accepted

    friend constexpr bool operator==(const RecordHead&, const RecordHead&) = default;
};

/// DS_Read.res, DS_Write.req, Data_Transport both ways.
struct Record {
    std::uint8_t slot{};
    std::uint8_t index{};
    Octets data{};
};

namespace detail {

constexpr AcyclicError check_function(Octets pdu, AcyclicFunction f) {
    if (pdu.empty()) return AcyclicError::empty;
    return pdu[0] == core::to_underlying(f) ? AcyclicError::none : AcyclicError::function;
}

constexpr AcyclicResult<RecordHead> decode_head(Octets pdu, AcyclicFunction f) {
    if (const AcyclicError e = check_function(pdu, f); e != AcyclicError::none) return e;
    if (pdu.size() < kRecordHeader) return AcyclicError::too_short;
    return RecordHead{pdu[1], pdu[2], pdu[3]};
}

constexpr AcyclicResult<RecordHead> decode_bare(Octets pdu, AcyclicFunction f) {
    const auto head = decode_head(pdu, f);
    if (!head) return head;
    if (pdu.size() > kRecordHeader) return AcyclicError::too_long;
    if (head->length == 0) return AcyclicError::length_zero;
    if (head->length > kMaxRecord) return AcyclicError::length_range;
    return head;
}

constexpr AcyclicResult<Record> decode_filled(Octets pdu, AcyclicFunction f) {
    const auto head = decode_head(pdu, f);
    if (!head) return head.error();
    if (head->length > kMaxRecord) return AcyclicError::length_range;
    if (head->length != pdu.size() - kRecordHeader) return AcyclicError::length_mismatch;
    return Record{head->slot, head->index, pdu.subspan(kRecordHeader)};
}

constexpr AcyclicResult<std::size_t> encode_head(AcyclicFunction f, const RecordHead& h, std::span<std::uint8_t> out) {
    if (h.length > kMaxRecord) return AcyclicError::length_range;
    if (out.size() < kRecordHeader) return AcyclicError::no_room;
    out[0] = core::to_underlying(f);
    out[1] = h.slot;
    out[2] = h.index;
    out[3] = h.length;
    return kRecordHeader;
}

}  // namespace detail

/// Octets asked for: 1..240, nothing behind them.
constexpr AcyclicResult<RecordHead> decode_ds_read_req(Octets pdu) { return detail::decode_bare(pdu, AcyclicFunction::ds_read); }
/// The record, perhaps shorter than asked for; it may be empty.
constexpr AcyclicResult<Record> decode_ds_read_res(Octets pdu) { return detail::decode_filled(pdu, AcyclicFunction::ds_read); }
/// A record of 1..240 octets.
constexpr AcyclicResult<Record> decode_ds_write_req(Octets pdu) {
    const auto r = detail::decode_filled(pdu, AcyclicFunction::ds_write);
    if (r && r->data.empty()) return AcyclicError::length_zero;
    return r;
}
/// Octets accepted.
constexpr AcyclicResult<RecordHead> decode_ds_write_res(Octets pdu) { return detail::decode_bare(pdu, AcyclicFunction::ds_write); }
/// Request and answer look alike; 0..240 octets.
constexpr AcyclicResult<Record> decode_data_transport(Octets pdu) {
    return detail::decode_filled(pdu, AcyclicFunction::data_transport);
}

/// DS_Read.req and DS_Write.res: four octets. Returns the PDU's length, as all encode functions do.
constexpr AcyclicResult<std::size_t> encode(AcyclicFunction f, const RecordHead& h, std::span<std::uint8_t> out) {
    return detail::encode_head(f, h, out);
}
/// DS_Read.res, DS_Write.req, Data_Transport. `r.data` may lie in `out` where it belongs already.
constexpr AcyclicResult<std::size_t> encode(AcyclicFunction f, const Record& r, std::span<std::uint8_t> out) {
    if (r.data.size() > kMaxRecord) return AcyclicError::length_range;
    if (out.size() < kRecordHeader + r.data.size()) return AcyclicError::no_room;
    const auto length = static_cast<std::uint8_t>(r.data.size());
    for (std::size_t i = 0; i < r.data.size(); ++i) out[kRecordHeader + i] = r.data[i];
    const auto head = detail::encode_head(f, {r.slot, r.index, length}, out);
    if (!head) return head;
    return kRecordHeader + r.data.size();
}

// ---- alarm acknowledgement ----------------------------------------------------------------------------------------

/// Which alarm: what Alarm_Ack carries and its answer echoes. The lower specifier bits are taken over as they are.
struct AlarmAck {
    std::uint8_t slot{};
    std::uint8_t type{};
    std::uint8_t specifier{};  ///< bits 7..3 Seq_Nr, bit 2 Add_Ack, bits 1..0 as in the alarm

    constexpr std::uint8_t seq_nr() const { return core::slice(specifier, 3, 5); }
    friend constexpr bool operator==(const AlarmAck&, const AlarmAck&) = default;
};

/// Request and answer look alike.
constexpr AcyclicResult<AlarmAck> decode_alarm_ack(Octets pdu) {
    if (const AcyclicError e = detail::check_function(pdu, AcyclicFunction::alarm_ack); e != AcyclicError::none) return e;
    if (pdu.size() < kRecordHeader) return AcyclicError::too_short;
    if (pdu.size() > kRecordHeader) return AcyclicError::too_long;
    return AlarmAck{pdu[1], pdu[2], pdu[3]};
}

constexpr AcyclicResult<std::size_t> encode(const AlarmAck& a, std::span<std::uint8_t> out) {
    if (out.size() < kRecordHeader) return AcyclicError::no_room;
    out[0] = core::to_underlying(AcyclicFunction::alarm_ack);
    out[1] = a.slot;
    out[2] = a.type;
    out[3] = a.specifier;
    return kRecordHeader;
}

// ---- the two short ones of MS2 ------------------------------------------------------------------------------------

inline constexpr std::size_t kIdlePdu = 2;

/// Idle: the second octet comes back as it was.
constexpr AcyclicResult<std::uint8_t> decode_idle(Octets pdu) {
    if (const AcyclicError e = detail::check_function(pdu, AcyclicFunction::idle); e != AcyclicError::none) return e;
    if (pdu.size() < kIdlePdu) return AcyclicError::too_short;
    if (pdu.size() > kIdlePdu) return AcyclicError::too_long;
    return pdu[1];
}

constexpr AcyclicResult<std::size_t> encode_idle(std::uint8_t second, std::span<std::uint8_t> out) {
    if (out.size() < kIdlePdu) return AcyclicError::no_room;
    out[0] = core::to_underlying(AcyclicFunction::idle);
    out[1] = second;
    return kIdlePdu;
}

/// The resource manager's answer: the SAP that the connection will have, and the slave's least Send_Timeout.
struct ResourceManager {
    std::uint8_t sap{};
    std::uint16_t send_timeout{};  ///< 10 ms

    friend constexpr bool operator==(const ResourceManager&, const ResourceManager&) = default;
};

inline constexpr std::size_t kResourceManagerPdu = 4;

constexpr AcyclicResult<ResourceManager> decode_resource_manager(Octets pdu) {
    if (const AcyclicError e = detail::check_function(pdu, AcyclicFunction::resource_manager); e != AcyclicError::none) return e;
    if (pdu.size() < kResourceManagerPdu) return AcyclicError::too_short;
    if (pdu.size() > kResourceManagerPdu) return AcyclicError::too_long;
    return ResourceManager{pdu[1], core::word(pdu[2], pdu[3])};
}

constexpr AcyclicResult<std::size_t> encode(const ResourceManager& rm, std::span<std::uint8_t> out) {
    if (out.size() < kResourceManagerPdu) return AcyclicError::no_room;
    out[0] = core::to_underlying(AcyclicFunction::resource_manager);
    out[1] = rm.sap;
    out[2] = core::high(rm.send_timeout);
    out[3] = core::low(rm.send_timeout);
    return kResourceManagerPdu;
}

}  // namespace dpchip::dp
