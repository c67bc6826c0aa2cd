// SPDX-License-Identifier: Apache-2.0
// Global_Control: Control_Command, Group_Select, what is valid and who is addressed (reference 3.9).
// What the commands do to the buffers is the chip's business.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace dpchip::dp {

inline constexpr std::uint8_t kGcSync = 0x20;
inline constexpr std::uint8_t kGcUnsync = 0x10;
inline constexpr std::uint8_t kGcFreeze = 0x08;
inline constexpr std::uint8_t kGcUnfreeze = 0x04;
inline constexpr std::uint8_t kGcClearData = 0x02;
inline constexpr std::uint8_t kGcReserved = 0xC1;
inline constexpr std::size_t kGlobalControlSize = 2;

/// A bit of Control_Command and its name.
struct GcBit {
    std::uint8_t mask;
    const char* name;
};
inline constexpr GcBit kGcBits[]{{kGcSync, "Sync"},
                                 {kGcUnsync, "Unsync"},
                                 {kGcFreeze, "Freeze"},
                                 {kGcUnfreeze, "Unfreeze"},
                                 {kGcClearData, "Clear_Data"}};

/// What a pair of bits (Sync/Unsync, Freeze/Unfreeze) asks for. The Un bit dominates.
enum class ModeChange : std::uint8_t { none, enter, leave };

/// The two octets.
struct GlobalControl {
    std::uint8_t control_command{};  ///< 00 = Operate
    std::uint8_t group_select{};     ///< 0 = everybody

    constexpr bool clear_data() const { return (control_command & kGcClearData) != 0; }
    constexpr bool reserved_set() const { return (control_command & kGcReserved) != 0; }
    constexpr ModeChange sync() const { return change(kGcSync, kGcUnsync); }
    constexpr ModeChange freeze() const { return change(kGcFreeze, kGcUnfreeze); }
    /// A slave that is a member of the groups in `group_ident` has to obey.
    constexpr bool addresses(std::uint8_t group_ident) const {
        return group_select == 0 || (group_select & group_ident) != 0;
    }
    friend constexpr bool operator==(const GlobalControl&, const GlobalControl&) = default;

    constexpr ModeChange change(std::uint8_t enter, std::uint8_t leave) const {
        if ((control_command & leave) != 0) return ModeChange::leave;
        return (control_command & enter) != 0 ? ModeChange::enter : ModeChange::none;
    }
};

/// True for data that a slave may look at: exactly two octets, and no reserved bit unless these are not checked.
constexpr bool valid_global_control(std::span<const std::uint8_t> data, bool check_reserved = true) {
    return data.size() == kGlobalControlSize && !(check_reserved && (data[0] & kGcReserved) != 0);
}

/// Call with two octets or more; fewer give Operate for everybody.
constexpr GlobalControl decode_global_control(std::span<const std::uint8_t> data) {
    return data.size() < kGlobalControlSize ? GlobalControl{} : GlobalControl{data[0], data[1]};
}

}  // namespace dpchip::dp
