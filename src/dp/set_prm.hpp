// SPDX-License-Identifier: Apache-2.0
// Set_Prm: Station_Status, watchdog factors, DPV1_Status octets; decode and encode (reference 3.4.1, 3.4.5).
// Structured blocks in the user data: structured_prm.hpp. Acceptance rules (reference 3.4.2, 3.4.3) are the chip's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/core/bits.hpp>
#include <dpchip/core/result.hpp>

namespace dpchip::dp {

inline constexpr std::size_t kSetPrmHeader = 7;  ///< octets in front of the user parameters
inline constexpr std::size_t kMaxSetPrm = 244;
inline constexpr std::size_t kMaxUserPrm = kMaxSetPrm - kSetPrmHeader;  ///< 237

// Station_Status, octet 0.
inline constexpr std::uint8_t kLockReq = 0x80;
inline constexpr std::uint8_t kUnlockReq = 0x40;
inline constexpr std::uint8_t kSyncReq = 0x20;
inline constexpr std::uint8_t kFreezeReq = 0x10;
inline constexpr std::uint8_t kWdOn = 0x08;

// DPV1_Status_1, octet 7.
inline constexpr std::uint8_t kDpv1Enable = 0x80;
inline constexpr std::uint8_t kFailSafe = 0x40;
inline constexpr std::uint8_t kPublisherEnable = 0x20;
inline constexpr std::uint8_t kWdBase1ms = 0x04;
inline constexpr std::uint8_t kDisStopControl = 0x02;
inline constexpr std::uint8_t kDisStartControl = 0x01;

// DPV1_Status_2, octet 8.
inline constexpr std::uint8_t kEnablePullPlugAlarm = 0x80;
inline constexpr std::uint8_t kEnableProcessAlarm = 0x40;
inline constexpr std::uint8_t kEnableDiagnosticAlarm = 0x20;
inline constexpr std::uint8_t kEnableManufacturerSpecificAlarm = 0x10;
inline constexpr std::uint8_t kEnableStatusAlarm = 0x08;
inline constexpr std::uint8_t kEnableUpdateAlarm = 0x04;
inline constexpr std::uint8_t kCheckCfgMode = 0x01;

// DPV1_Status_3, octet 9.
inline constexpr std::uint8_t kPrmCmd = 0x80;
inline constexpr std::uint8_t kIsoMReq = 0x10;
inline constexpr std::uint8_t kPrmStructure = 0x08;
inline constexpr std::uint8_t kAlarmModeMask = 0x07;

/// A bit of Set_Prm and its name. For traces and displays.
struct PrmBit {
    std::uint8_t octet;  ///< 0, 7, 8 or 9
    std::uint8_t mask;
    const char* name;
};
// clang-format off
inline constexpr PrmBit kPrmBits[]{
    {0, kLockReq, "Lock_Req"}, {0, kUnlockReq, "Unlock_Req"}, {0, kSyncReq, "Sync_Req"}, {0, kFreezeReq, "Freeze_Req"}, {0, kWdOn, "WD_On"},
    {7, kDpv1Enable, "DPV1_Enable"}, {7, kFailSafe, "Fail_Safe"}, {7, kPublisherEnable, "Publisher_Enable"},
    {7, kWdBase1ms, "WD_Base"}, {7, kDisStopControl, "Dis_Stop_Control"}, {7, kDisStartControl, "Dis_Start_Control"},
    {8, kEnablePullPlugAlarm, "Enable_Pull_Plug_Alarm"}, {8, kEnableProcessAlarm, "Enable_Process_Alarm"},
    {8, kEnableDiagnosticAlarm, "Enable_Diagnostic_Alarm"}, {8, kEnableManufacturerSpecificAlarm, "Enable_Manufacturer_Specific_Alarm"},
    {8, kEnableStatusAlarm, "Enable_Status_Alarm"}, {8, kEnableUpdateAlarm, "Enable_Update_Alarm"}, {8, kCheckCfgMode, "Check_Cfg_Mode"},
    {9, kPrmCmd, "PrmCmd"}, {9, kIsoMReq, "IsoM_Req"}, {9, kPrmStructure, "Prm_Structure"},
};
// clang-format on

/// Alarms that may be outstanding in total for an Alarm_Mode of 1..7; 0 means one of each type and gives 0.
constexpr std::uint8_t alarm_limit(std::uint8_t alarm_mode) {
    constexpr std::uint8_t limits[8]{0, 2, 4, 8, 12, 16, 24, 32};
    return limits[alarm_mode & kAlarmModeMask];
}

/// The unit of the watchdog factors.
enum class WdBase : std::uint8_t { ms_10, ms_1 };
constexpr std::uint32_t milliseconds(WdBase base) { return base == WdBase::ms_10 ? 10 : 1; }

/// T_WD = base * factor_1 * factor_2; both 1..255 while the watchdog is on.
struct WdFactors {
    std::uint8_t factor_1{1};
    std::uint8_t factor_2{1};

    friend constexpr bool operator==(const WdFactors&, const WdFactors&) = default;
};

/// T_WD in milliseconds, at most 650250; 0 when a factor is 0 (not allowed while WD_On).
constexpr std::uint32_t t_wd_ms(WdFactors f, WdBase base) { return milliseconds(base) * f.factor_1 * f.factor_2; }

enum class WdError : std::uint8_t { too_long };  ///< longer than 255 * 255 units

/// The factors of the shortest watchdog time that is not shorter than `ms`. Never 1 * 1, which masters of a
/// VPC3+C may not use: two units are the least.
constexpr core::Result<WdFactors, WdError> wd_factors(std::uint32_t ms, WdBase base) {
    const std::uint32_t unit = milliseconds(base);
    std::uint32_t wanted = ms / unit + (ms % unit != 0 ? 1u : 0u);
    if (wanted > 255u * 255u) return WdError::too_long;
    if (wanted < 2) wanted = 2;
    WdFactors best{255, 255};
    for (std::uint32_t a = 1; a <= 255; ++a) {
        const std::uint32_t b = (wanted + a - 1) / a;
        if (b > 255 || b < a) continue;
        if (a * b < std::uint32_t{best.factor_1} * best.factor_2)
            best = {static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b)};
    }
    return best;
}

/// A Set_Prm, taken apart. `user_prm` is a view: octet 7 (DPV1_Status_1) and all that follows.
struct SetPrm {
    std::uint8_t station_status{kLockReq};
    WdFactors wd{};
    std::uint8_t min_tsdr{};  ///< bit times; 0 = keep
    std::uint16_t ident{};
    std::uint8_t group_ident{};                ///< bit k: member of group k + 1
    std::span<const std::uint8_t> user_prm{};  ///< 0..237 octets

    constexpr bool lock_req() const { return (station_status & kLockReq) != 0; }
    constexpr bool unlock_req() const { return (station_status & kUnlockReq) != 0; }
    constexpr bool sync_req() const { return (station_status & kSyncReq) != 0; }
    constexpr bool freeze_req() const { return (station_status & kFreezeReq) != 0; }
    constexpr bool wd_on() const { return (station_status & kWdOn) != 0; }
    /// DPV1_Status octets; 0 when not sent.
    constexpr std::uint8_t dpv1_status_1() const { return user_octet(0); }
    constexpr std::uint8_t dpv1_status_2() const { return user_octet(1); }
    constexpr std::uint8_t dpv1_status_3() const { return user_octet(2); }
    constexpr WdBase wd_base() const { return (dpv1_status_1() & kWdBase1ms) != 0 ? WdBase::ms_1 : WdBase::ms_10; }
    /// The user data behind the three DPV1_Status octets; for a DP-V1 slave.
    constexpr std::span<const std::uint8_t> behind_dpv1_status() const {
        return user_prm.subspan(user_prm.size() < 3 ? user_prm.size() : 3);
    }
    /// User octet `n`, 0 when not sent.
    constexpr std::uint8_t user_octet(std::size_t n) const {
        return n < user_prm.size() ? user_prm[n] : std::uint8_t{0};
    }
};

enum class SetPrmError : std::uint8_t {
    too_short,  ///< fewer than 7 octets
    too_long,   ///< more than 244 octets
    no_room,    ///< the buffer to encode into is too small
};

constexpr core::Result<SetPrm, SetPrmError> decode_set_prm(std::span<const std::uint8_t> octets) {
    if (octets.size() < kSetPrmHeader) return SetPrmError::too_short;
    if (octets.size() > kMaxSetPrm) return SetPrmError::too_long;
    SetPrm prm{};
    prm.station_status = octets[0];
    prm.wd = {octets[1], octets[2]};
    prm.min_tsdr = octets[3];
    prm.ident = core::word(octets[4], octets[5]);
    prm.group_ident = octets[6];
    prm.user_prm = octets.subspan(kSetPrmHeader);
    return prm;
}

/// Writes the telegram data into `out`; returns its length.
constexpr core::Result<std::size_t, SetPrmError> encode(const SetPrm& prm, std::span<std::uint8_t> out) {
    const std::size_t length = kSetPrmHeader + prm.user_prm.size();
    if (length > kMaxSetPrm) return SetPrmError::too_long;
    if (length > out.size()) return SetPrmError::no_room;
    out[0] = prm.station_status;
    out[1] = prm.wd.factor_1;
    out[2] = prm.wd.factor_2;
    out[3] = prm.min_tsdr;
    out[4] = core::high(prm.ident);
    out[5] = core::low(prm.ident);
    out[6] = prm.group_ident;
    for (std::size_t i = 0; i < prm.user_prm.size(); ++i) out[kSetPrmHeader + i] = prm.user_prm[i];
    return length;
}

}  // namespace dpchip::dp
