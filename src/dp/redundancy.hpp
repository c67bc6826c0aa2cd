// SPDX-License-Identifier: Apache-2.0
// Redundancy: PrmCmd, block type 2, and the status messages that answer it, PrmCmdAck and Red_State (reference 3.4.6, 6.4).
// The bits come from published firmware, not from a manual.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/core/bits.hpp>
#include <dpchip/core/result.hpp>
#include <dpchip/dp/structured_prm.hpp>

namespace dpchip::dp {

inline constexpr std::size_t kPrmCmdBlock = 8, kRedStatus = 8;

/// What happens to the class-1 acyclic connection of the slave.
enum class Msac1sControl : std::uint8_t { none, stop, start, reset };

/// The command of a master to one half of a redundant slave.
struct PrmCmd {
    std::uint8_t slot{};
    std::uint8_t seq_nr{};              ///< 0..31, repeated in the acknowledgement
    bool backup_request{}, primary_request{};
    Msac1sControl msac1s{};
    bool check_properties{}, master_state_clear{};
    std::uint8_t properties{};          ///< kRed*
    std::uint16_t output_hold_time{};   ///< TOH

    friend constexpr bool operator==(const PrmCmd&, const PrmCmd&) = default;
};

/// Properties.
inline constexpr std::uint8_t kRedPrimaryReqUsed = 0x01, kRedStartStopUsed = 0x02, kRedAddressChanged = 0x04, kRedAddressOffset64 = 0x08;
/// RedState octets.
inline constexpr std::uint8_t kRedBackup = 0x01, kRedPrimary = 0x02, kRedHwDefect = 0x04, kRedDataExchange = 0x08,
                              kRedMasterStateClear = 0x10, kRedBaudrateFound = 0x20, kRedTohStarted = 0x40;

enum class PrmCmdError : std::uint8_t {
    type,      ///< not a block of type 2
    length,    ///< not 8 octets
    reserved,  ///< a reserved bit of Function or Properties is set
    conflict,  ///< Backup_Request together with Primary_Request
    seq_nr,    ///< above 31
    no_room,
};

constexpr core::Result<PrmCmd, PrmCmdError> decode_prm_cmd(const PrmBlock& b) {
    if (b.type != static_cast<std::uint8_t>(PrmBlockType::prm_cmd)) return PrmCmdError::type;
    if (b.data.size() != kPrmCmdBlock - 4) return PrmCmdError::length;
    const std::uint8_t function = b.data[0], properties = b.data[1];
    if ((function & 0xA0u) != 0 || (properties & 0xF0u) != 0) return PrmCmdError::reserved;
    if ((function & 0x03u) == 0x03u) return PrmCmdError::conflict;
    return PrmCmd{b.slot, core::slice(b.reserved, 3, 5), core::bit(function, 0), core::bit(function, 1),
                  static_cast<Msac1sControl>(core::slice(function, 2, 2)), core::bit(function, 4), core::bit(function, 6),
                  properties, core::word(b.data[2], b.data[3])};
}

/// The octet Function, as command and acknowledgement have it.
constexpr std::uint8_t function(const PrmCmd& c) {
    return static_cast<std::uint8_t>((c.backup_request ? 0x01u : 0u) | (c.primary_request ? 0x02u : 0u) |
                                     static_cast<unsigned>(c.msac1s) << 2 | (c.check_properties ? 0x10u : 0u) |
                                     (c.master_state_clear ? 0x40u : 0u));
}

constexpr core::Result<std::size_t, PrmCmdError> encode(const PrmCmd& c, std::span<std::uint8_t> out) {
    if (c.seq_nr > 31) return PrmCmdError::seq_nr;
    if ((c.properties & 0xF0u) != 0) return PrmCmdError::reserved;
    if (c.backup_request && c.primary_request) return PrmCmdError::conflict;
    if (out.size() < kPrmCmdBlock) return PrmCmdError::no_room;
    out[0] = kPrmCmdBlock;
    out[1] = static_cast<std::uint8_t>(PrmBlockType::prm_cmd);
    out[2] = c.slot;
    out[3] = static_cast<std::uint8_t>(c.seq_nr << 3);
    out[4] = function(c);
    out[5] = c.properties;
    out[6] = core::high(c.output_hold_time);
    out[7] = core::low(c.output_hold_time);
    return kPrmCmdBlock;
}

/// PrmCmdAck or Red_State: a status block of the diagnosis.
struct RedStatus {
    bool acknowledges{};         ///< PrmCmdAck; else Red_State, which a slave sends by itself
    std::uint8_t seq_nr{};       ///< of the PrmCmd
    std::uint8_t function{};     ///< of the PrmCmd; 0 in Red_State
    std::uint8_t red_state_1{};  ///< this half: kRed*
    std::uint8_t red_state_2{};  ///< the other half, as far as this one knows
    std::uint8_t red_state_3{};

    friend constexpr bool operator==(const RedStatus&, const RedStatus&) = default;
};
inline constexpr std::uint8_t kPrmCmdAckType = 0x9E, kRedStateType = 0x9F;

constexpr core::Result<std::size_t, PrmCmdError> encode(const RedStatus& s, std::span<std::uint8_t> out) {
    if (s.seq_nr > 31) return PrmCmdError::seq_nr;
    if (out.size() < kRedStatus) return PrmCmdError::no_room;
    out[0] = kRedStatus;
    out[1] = s.acknowledges ? kPrmCmdAckType : kRedStateType;
    out[2] = 0;
    out[3] = static_cast<std::uint8_t>(s.seq_nr << 3);
    out[4] = s.function;
    out[5] = s.red_state_1;
    out[6] = s.red_state_2;
    out[7] = s.red_state_3;
    return kRedStatus;
}

/// Takes a status block of the diagnosis apart, header octet included.
constexpr core::Result<RedStatus, PrmCmdError> decode_red_status(std::span<const std::uint8_t> block) {
    if (block.size() != kRedStatus || block[0] != kRedStatus) return PrmCmdError::length;
    if (block[1] != kPrmCmdAckType && block[1] != kRedStateType) return PrmCmdError::type;
    return RedStatus{block[1] == kPrmCmdAckType, core::slice(block[3], 3, 5), block[4], block[5], block[6], block[7]};
}

}  // namespace dpchip::dp
