// SPDX-License-Identifier: Apache-2.0
// The sixteen interrupt bits, the same positions in IRR, IR, IMR and IAR (VPC3+C 5.3, APC3 tables 4.5 and 4.6).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <dpchip/regmap/variant.hpp>

namespace dpchip::regmap {

struct InterruptBit {
    std::uint8_t bit{};
    std::string_view name;              ///< the manual's spelling
    std::string_view meaning;
    VariantSet variants = kAllVariants; ///< where the bit exists
    bool by_acknowledgement{};          ///< cleared by User_Prm_Data_Okay and its like, never by the IAR (5.3.2)
};

// clang-format off
/// In order of the bits. Bit 0 is Clock_Sync instead where CS_Supported = 1 (VPC3+C): kClockSync.
inline constexpr std::array<InterruptBit, 16> kInterruptBits{{
    { 0, "MAC_Reset",             "Offline has been reached after Go_Offline, or after a RAM access violation on an APC3"},
    { 1, "Go/Leave_DATA-EXCH",    "DP_SM has entered or left DATA-EXCH"},
    { 2, "Baud_Rate_Detect",      "BAUD_SEARCH has been left: a baud rate is proven"},
    { 3, "WD_DP_CONTROL_Timeout", "the master's watchdog time ran out in DP_CONTROL"},
    { 4, "User_Timer_Clock",      "tick of the user's timer, every 1 ms or 10 ms", kVpc3},
    { 5, "DXB_Link_Error",        "a publisher stayed silent for a watchdog time", kStepBC},
    { 6, "New_Ext_Prm_Data",      "Set_Ext_Prm data are in the Prm_Buf", kStepBC, true},
    { 7, "DXB_Out",               "publisher data are in the N buffer of DXBout", kStepBC},
    { 8, "New_GC_Command",        "R_GC_Command holds a new Control_Command"},
    { 9, "New_SSA_Data",          "Set_Slave_Add data are in the SSA_Buf"},
    {10, "New_Cfg_Data",          "Chk_Cfg data are in the Cfg_Buf", kAllVariants, true},
    {11, "New_Prm_Data",          "Set_Prm data are in the Prm_Buf", kAllVariants, true},
    {12, "Diag_Buffer_Changed",   "the diagnosis buffers have been exchanged: the old one is the user's again"},
    {13, "DX_Out",                "output data, or cleared outputs, are in the N buffer of Dout"},
    {14, "Poll_End_Ind",          "the response to an acyclic service has been sent", kStepBC},
    {15, "FDL_Ind",               "an acyclic request is in an indication buffer", kStepBC},
}};
// clang-format on
inline constexpr InterruptBit kClockSync{0, "Clock_Sync", "a Clock_Value has been received, or clock synchronisation failed",
                                         in(Variant::vpc3c)};

static_assert([] {
    for (std::size_t v = 0; v < kVariants; ++v)
        for (std::size_t i = 0; i < kInterruptBits.size(); ++i) {
            const InterruptBit& b = kInterruptBits[i];
            if (b.bit != i || b.name.empty()) return false;
            if (b.variants.has(static_cast<Variant>(v)) != (((unsigned{kTraits[v].interrupts} >> i) & 1u) != 0)) return false;
        }
    return true;
}());

/// The name of interrupt bit `bit` (0..15), "" where the variant has none. Bit 0 is MAC_Reset here.
constexpr std::string_view interrupt_name(Variant variant, unsigned bit) {
    if (bit >= kInterruptBits.size() || !kInterruptBits[bit].variants.has(variant)) return {};
    return kInterruptBits[bit].name;
}

}  // namespace dpchip::regmap
