// SPDX-License-Identifier: Apache-2.0
// Alarms: their types, what Set_Prm enables; and the building of diagnosis blocks: alarm, status, Modul_Status,
// identifier and channel related (reference 5.5). Taking blocks apart: diag.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/core/bits.hpp>
#include <dpchip/core/result.hpp>
#include <dpchip/dp/acyclic.hpp>
#include <dpchip/dp/diag.hpp>
#include <dpchip/dp/set_prm.hpp>

namespace dpchip::dp {

/// Alarm_Type; 32..126 are the manufacturer's.
enum class AlarmType : std::uint8_t { diagnostic = 1, process = 2, pull = 3, plug = 4, status = 5, update = 6 };

/// Status_Type; 32..126 are the manufacturer's.
enum class StatusType : std::uint8_t { status_message = 1, modul_status = 2, dxb_link_status = 3, prm_cmd_ack = 30, red_state = 31 };

/// Specifier bits 1..0.
enum class Specifier : std::uint8_t {
    general = 0,
    appears = 1,                ///< and the slot is disturbed
    disappears = 2,             ///< and the slot is all right again
    disappears_but_others = 3,  ///< and the slot is still disturbed
};

inline constexpr std::uint8_t kMaxAlarmSlot = 254;
inline constexpr std::uint8_t kSeqNumbers = 32;
inline constexpr std::size_t kAlarmHeader = 4;     ///< header, type, slot, specifier
inline constexpr std::size_t kMaxDeviceBlock = 63;

/// The bit of DPV1_Status_2 that allows an alarm type; 0 for a type that does not exist.
constexpr std::uint8_t alarm_enable_bit(std::uint8_t alarm_type) {
    switch (static_cast<AlarmType>(alarm_type)) {
    case AlarmType::diagnostic: return kEnableDiagnosticAlarm;
    case AlarmType::process: return kEnableProcessAlarm;
    case AlarmType::pull:
    case AlarmType::plug: return kEnablePullPlugAlarm;
    case AlarmType::status: return kEnableStatusAlarm;
    case AlarmType::update: return kEnableUpdateAlarm;
    }
    return alarm_type >= 32 && alarm_type <= 126 ? kEnableManufacturerSpecificAlarm : std::uint8_t{0};
}

/// What of an alarm the acknowledgement repeats.
constexpr AlarmAck alarm_ack(const AlarmStatus& a) {
    return {a.slot, a.type, static_cast<std::uint8_t>(unsigned{a.seq_nr} << 3 | (a.add_ack ? 4u : 0u) | (a.specifier & 3u))};
}

enum class BlockError : std::uint8_t {
    type,        ///< no such Alarm_Type or Status_Type
    slot,        ///< above 254; identifier or channel number above 63
    seq_nr,      ///< above 31
    specifier,   ///< above 3; channel type above 7 or error above 31
    too_long,    ///< the block would be longer than 63 octets
    no_room,     ///< the buffer to encode into is too small
};

constexpr const char* name(BlockError e) {
    switch (e) {
    case BlockError::type: return "no such type";
    case BlockError::slot: return "no such slot";
    case BlockError::seq_nr: return "sequence number above 31";
    case BlockError::specifier: return "no such specifier";
    case BlockError::too_long: return "block longer than 63 octets";
    case BlockError::no_room: return "no room";
    }
    return "no such type";
}

using BlockResult = core::Result<std::size_t, BlockError>;

/// A device-related block with an alarm or a status. Returns its octets, as all functions here do.
constexpr BlockResult encode(const AlarmStatus& a, std::span<std::uint8_t> out) {
    const std::size_t length = kAlarmHeader + a.data.size();
    if (a.type == 0 || a.type > 126) return BlockError::type;
    if (a.slot > kMaxAlarmSlot) return BlockError::slot;
    if (a.seq_nr >= kSeqNumbers || (a.status && a.seq_nr != 0)) return BlockError::seq_nr;
    if (a.specifier > 3 || (a.status && a.add_ack)) return BlockError::specifier;
    if (length > kMaxDeviceBlock) return BlockError::too_long;
    if (length > out.size()) return BlockError::no_room;
    const AlarmAck id = alarm_ack(a);
    out[0] = static_cast<std::uint8_t>(length);
    out[1] = static_cast<std::uint8_t>(a.type | (a.status ? 0x80u : 0u));
    out[2] = id.slot;
    out[3] = id.specifier;
    for (std::size_t i = 0; i < a.data.size(); ++i) out[kAlarmHeader + i] = a.data[i];
    return length;
}

/// Modul_Status: the states of the slots from 1 on.
constexpr BlockResult encode_modul_status(std::span<const ModulState> states, std::span<std::uint8_t> out) {
    const std::size_t length = kAlarmHeader + (states.size() + 3) / 4;
    if (length > kMaxDeviceBlock) return BlockError::too_long;
    if (length > out.size()) return BlockError::no_room;
    out[0] = static_cast<std::uint8_t>(length);
    out[1] = 0x80u | core::to_underlying(StatusType::modul_status);
    out[2] = out[3] = 0;
    for (std::size_t i = kAlarmHeader; i < length; ++i) out[i] = 0;
    for (std::size_t i = 0; i < states.size(); ++i) {
        std::uint8_t& octet = out[kAlarmHeader + i / 4];
        octet = static_cast<std::uint8_t>(octet | static_cast<unsigned>(states[i]) << 2 * (i % 4));
    }
    return length;
}

/// Identifier-related block: which of `modules` modules (counted from 0) have a diagnosis. `marked(n)` says it.
template <class Marked>
constexpr BlockResult encode_identifiers(std::size_t modules, Marked&& marked, std::span<std::uint8_t> out) {
    const std::size_t length = 1 + (modules + 7) / 8;
    if (length > kMaxDeviceBlock) return BlockError::too_long;
    if (length > out.size()) return BlockError::no_room;
    out[0] = static_cast<std::uint8_t>(0x40u | length);
    for (std::size_t i = 1; i < length; ++i) out[i] = 0;
    for (std::size_t n = 0; n < modules; ++n)
        if (marked(n)) out[1 + n / 8] = static_cast<std::uint8_t>(out[1 + n / 8] | 1u << n % 8);
    return length;
}

/// Channel-related block: three octets.
constexpr BlockResult encode(const ChannelDiag& c, std::span<std::uint8_t> out) {
    if (c.identifier > 63 || c.channel > 63) return BlockError::slot;
    if (c.type > 7 || c.error > 31) return BlockError::specifier;
    if (out.size() < 3) return BlockError::no_room;
    out[0] = static_cast<std::uint8_t>(0x80u | c.identifier);
    out[1] = static_cast<std::uint8_t>((c.output ? 0x80u : 0u) | (c.input ? 0x40u : 0u) | c.channel);
    out[2] = static_cast<std::uint8_t>(c.type << 5 | c.error);
    return std::size_t{3};
}

}  // namespace dpchip::dp
