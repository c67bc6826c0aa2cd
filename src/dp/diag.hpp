// SPDX-License-Identifier: Apache-2.0
// Slave_Diag: the six octets of the header, and the blocks of Ext_Diag_Data (reference 3.7, 5.5).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/core/bits.hpp>
#include <dpchip/core/result.hpp>

namespace dpchip::dp {

inline constexpr std::size_t kDiagHeader = 6;
inline constexpr std::size_t kMaxDiag = 244;
inline constexpr std::uint8_t kNoMaster = 0xFF;  ///< Master_Add of a slave without owner

/// A bit of the header; the enumerator's value is 8 * octet + bit.
enum class DiagFlag : std::uint8_t {
    station_non_existent = 0,  ///< set by the master only
    station_not_ready = 1,
    cfg_fault = 2,
    ext_diag = 3,
    not_supported = 4,
    invalid_slave_response = 5,  ///< set by the master only
    prm_fault = 6,
    master_lock = 7,  ///< set by the master only
    prm_req = 8,
    stat_diag = 9,
    always_one = 10,
    wd_on = 11,
    freeze_mode = 12,
    sync_mode = 13,
    deactivated = 15,  ///< set by the master only
    ext_diag_overflow = 23,
};

/// A header bit and its name.
struct DiagBit {
    DiagFlag flag;
    const char* name;
};
// clang-format off
inline constexpr DiagBit kDiagBits[]{
    {DiagFlag::station_non_existent, "Station_Non_Existent"}, {DiagFlag::station_not_ready, "Station_Not_Ready"},
    {DiagFlag::cfg_fault, "Cfg_Fault"}, {DiagFlag::ext_diag, "Ext_Diag"}, {DiagFlag::not_supported, "Not_Supported"},
    {DiagFlag::invalid_slave_response, "Invalid_Slave_Response"}, {DiagFlag::prm_fault, "Prm_Fault"}, {DiagFlag::master_lock, "Master_Lock"},
    {DiagFlag::prm_req, "Prm_Req"}, {DiagFlag::stat_diag, "Stat_Diag"}, {DiagFlag::wd_on, "WD_On"}, {DiagFlag::freeze_mode, "Freeze_Mode"},
    {DiagFlag::sync_mode, "Sync_Mode"}, {DiagFlag::deactivated, "Deactivated"}, {DiagFlag::ext_diag_overflow, "Ext_Diag_Overflow"},
};
// clang-format on

/// The six octets.
struct DiagHeader {
    std::uint8_t status_1{};
    std::uint8_t status_2{0x04};
    std::uint8_t status_3{};
    std::uint8_t master_add{kNoMaster};
    std::uint16_t ident{};

    constexpr bool has(DiagFlag f) const {
        const unsigned at = core::to_underlying(f);
        return core::bit(at < 8 ? status_1 : at < 16 ? status_2 : status_3, at & 7u);
    }
    constexpr void set(DiagFlag f, bool on = true) {
        const unsigned at = core::to_underlying(f);
        std::uint8_t& octet = at < 8 ? status_1 : at < 16 ? status_2 : status_3;
        const unsigned mask = 1u << (at & 7u);
        octet = static_cast<std::uint8_t>(on ? octet | mask : octet & ~mask);
    }
    /// What a master waits for before Data_Exchange: no fault, no request for parameters, ready.
    constexpr bool ready() const {
        return !has(DiagFlag::station_not_ready) && !has(DiagFlag::cfg_fault) && !has(DiagFlag::prm_fault) &&
               !has(DiagFlag::not_supported) && !has(DiagFlag::prm_req) && !has(DiagFlag::station_non_existent) &&
               !has(DiagFlag::master_lock);
    }
    friend constexpr bool operator==(const DiagHeader&, const DiagHeader&) = default;
};

enum class DiagError : std::uint8_t {
    none,
    too_short,    ///< fewer than 6 octets
    too_long,     ///< more than 244 octets
    no_room,      ///< the buffer to encode into is too small
    length_zero,  ///< a block that announces no octets, not even its header
    truncated,    ///< a block goes on beyond the last octet
};

constexpr const char* name(DiagError e) {
    switch (e) {
    case DiagError::none: return "no error";
    case DiagError::too_short: return "fewer than 6 octets";
    case DiagError::too_long: return "more than 244 octets";
    case DiagError::no_room: return "no room";
    case DiagError::length_zero: return "block of length 0";
    case DiagError::truncated: return "block cut short";
    }
    return "no error";
}

constexpr core::Result<DiagHeader, DiagError> decode_diag_header(std::span<const std::uint8_t> octets) {
    if (octets.size() < kDiagHeader) return DiagError::too_short;
    if (octets.size() > kMaxDiag) return DiagError::too_long;
    return DiagHeader{octets[0], octets[1], octets[2], octets[3], core::word(octets[4], octets[5])};
}

/// Writes the six octets into `out`; returns 6.
constexpr core::Result<std::size_t, DiagError> encode(const DiagHeader& h, std::span<std::uint8_t> out) {
    if (out.size() < kDiagHeader) return DiagError::no_room;
    out[0] = h.status_1;
    out[1] = h.status_2;
    out[2] = h.status_3;
    out[3] = h.master_add;
    out[4] = core::high(h.ident);
    out[5] = core::low(h.ident);
    return kDiagHeader;
}

/// Kind of an Ext_Diag block, header bits 7..6.
enum class DiagBlockKind : std::uint8_t { device = 0, identifier = 1, channel = 2, revision = 3 };

constexpr const char* name(DiagBlockKind k) {
    switch (k) {
    case DiagBlockKind::device: return "device related";
    case DiagBlockKind::identifier: return "identifier related";
    case DiagBlockKind::channel: return "channel related";
    case DiagBlockKind::revision: return "revision";
    }
    return "device related";
}

/// One block of Ext_Diag_Data. The functions below it read what its kind says.
struct DiagBlock {
    DiagBlockKind kind{};
    std::size_t offset{};                    ///< of the header, counted from the first octet of Ext_Diag_Data
    std::span<const std::uint8_t> octets{};  ///< header included, never empty

    constexpr std::span<const std::uint8_t> data() const { return octets.subspan(1); }
    /// Revision of a revision block, or the identifier number of a channel block: 0..63.
    constexpr std::uint8_t number() const { return octets[0] & 0x3Fu; }
};

/// Goes through Ext_Diag_Data (the octets behind the six). false from next() at the end and at an error.
class DiagBlockWalker {
public:
    constexpr explicit DiagBlockWalker(std::span<const std::uint8_t> ext_diag) : octets_{ext_diag} {}

    constexpr bool next(DiagBlock& block) {
        if (error_ != DiagError::none || offset_ == octets_.size()) return false;
        const std::uint8_t header = octets_[offset_];
        const auto kind = static_cast<DiagBlockKind>(header >> 6);
        const std::size_t length = kind == DiagBlockKind::channel    ? std::size_t{3}
                                   : kind == DiagBlockKind::revision ? std::size_t{1}
                                                                     : std::size_t{header & 0x3Fu};
        if (length == 0) error_ = DiagError::length_zero;
        else if (length > octets_.size() - offset_) error_ = DiagError::truncated;
        if (error_ != DiagError::none) return false;
        block = {kind, offset_, octets_.subspan(offset_, length)};
        offset_ += length;
        return true;
    }
    constexpr DiagError error() const { return error_; }
    /// First octet not yet walked over; with an error, the bad block's header.
    constexpr std::size_t offset() const { return offset_; }

private:
    std::span<const std::uint8_t> octets_;
    std::size_t offset_{};
    DiagError error_{DiagError::none};
};

/// True when identifier (module) `n`, counted from 0, is marked in an identifier block.
constexpr bool identifier_marked(const DiagBlock& block, std::size_t n) {
    return block.kind == DiagBlockKind::identifier && n / 8 < block.data().size() &&
           core::bit(block.data()[n / 8], static_cast<unsigned>(n % 8));
}

/// Channel block, taken apart.
struct ChannelDiag {
    std::uint8_t identifier{};  ///< identifier (module) number 0..63
    std::uint8_t channel{};     ///< 0..63
    bool input{}, output{};
    std::uint8_t type{};   ///< 0..7, see channel_type_name()
    std::uint8_t error{};  ///< 0..31, see channel_error_name()
};

/// Call for channel blocks only; others give an empty value.
constexpr ChannelDiag channel_diag(const DiagBlock& block) {
    if (block.kind != DiagBlockKind::channel || block.octets.size() < 3) return {};
    const std::uint8_t channel = block.octets[1], type = block.octets[2];
    return {block.number(),          static_cast<std::uint8_t>(channel & 0x3Fu),
            core::bit(channel, 6),   core::bit(channel, 7),
            core::slice(type, 5, 3), core::slice(type, 0, 5)};
}

constexpr const char* channel_type_name(std::uint8_t type) {
    constexpr const char* names[8]{"reserved", "bit", "2 bit", "4 bit", "byte", "word", "2 words", "reserved"};
    return names[type & 7u];
}
/// 16..31 are the device's own: a GSD's Channel_Diag names them.
constexpr const char* channel_error_name(std::uint8_t error) {
    constexpr const char* names[10]{"reserved",
                                    "short circuit",
                                    "undervoltage",
                                    "overvoltage",
                                    "overload",
                                    "overtemperature",
                                    "line break",
                                    "upper limit value exceeded",
                                    "lower limit value exceeded",
                                    "error"};
    if (error < 10) return names[error];
    return error >= 16 && error < 32 ? "manufacturer specific" : "reserved";
}

/// A DP-V1 slave's device-related block: an alarm or a status (reference 5.5).
struct AlarmStatus {
    bool status{};             ///< a status PDU, else an alarm
    std::uint8_t type{};       ///< Alarm_Type or Status_Type, 0..127
    std::uint8_t slot{};       ///< 0..254
    std::uint8_t seq_nr{};     ///< alarms: 0..31
    bool add_ack{};            ///< alarms: an additional acknowledgement is wanted
    std::uint8_t specifier{};  ///< 0 general, 1 appears, 2 disappears, 3 disappears and the slot is still disturbed
    std::span<const std::uint8_t> data{};
};

/// `truncated` when the block is not device related or too short for the three octets.
constexpr core::Result<AlarmStatus, DiagError> alarm_status(const DiagBlock& block) {
    if (block.kind != DiagBlockKind::device || block.octets.size() < 4) return DiagError::truncated;
    const std::uint8_t type = block.octets[1], specifier = block.octets[3];
    AlarmStatus a{};
    a.status = core::bit(type, 7);
    a.type = type & 0x7Fu;
    a.slot = block.octets[2];
    a.seq_nr = core::slice(specifier, 3, 5);
    a.add_ack = core::bit(specifier, 2);
    a.specifier = core::slice(specifier, 0, 2);
    a.data = block.octets.subspan(4);
    return a;
}

constexpr const char* alarm_type_name(std::uint8_t type) {
    constexpr const char* names[7]{"reserved",   "Diagnostic_Alarm", "Process_Alarm", "Pull_Alarm",
                                   "Plug_Alarm", "Status_Alarm",     "Update_Alarm"};
    if (type < 7) return names[type];
    return type >= 32 && type <= 126 ? "Manufacturer_Specific_Alarm" : "reserved";
}
constexpr const char* status_type_name(std::uint8_t type) {
    switch (type) {
    case 1: return "Status_Message";
    case 2: return "Modul_Status";
    case 3: return "DXB_Link_Status";
    case 30: return "PrmCmdAck";
    case 31: return "Red_State";
    default: return type >= 32 && type <= 126 ? "manufacturer specific" : "reserved";
    }
}

/// State of a slot in Modul_Status, two bits each.
enum class ModulState : std::uint8_t { ok = 0, fault = 1, wrong_module = 2, no_module = 3 };

/// State of slot `n` (counted from 0) in the data of a Modul_Status; ok when it is not in there.
constexpr ModulState modul_state(std::span<const std::uint8_t> data, std::size_t n) {
    if (n / 4 >= data.size()) return ModulState::ok;
    return static_cast<ModulState>(core::slice(data[n / 4], static_cast<unsigned>(2 * (n % 4)), 2));
}

}  // namespace dpchip::dp
