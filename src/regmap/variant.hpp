// SPDX-License-Identifier: Apache-2.0
// The chips of the family as data: what one has and another has not (hardware reference 12; VPC3+C manual 1, 3.1, 5.2).
//
// No manual at hand describes VPC3+B, VPC3+ (step A) and SPC3 in full. What is not said of them in the VPC3+C and APC3
// manuals is marked `documented = false` and follows the nearest relative.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace dpchip::regmap {

enum class Variant : std::uint8_t { vpc3a, vpc3b, vpc3c, apc3, spc3 };
inline constexpr std::size_t kVariants = 5;

/// A set of variants, for registers and fields that not all have.
struct VariantSet {
    std::uint8_t bits{};
    constexpr bool has(Variant v) const { return ((bits >> static_cast<unsigned>(v)) & 1u) != 0; }
    constexpr VariantSet operator|(VariantSet o) const { return {static_cast<std::uint8_t>(bits | o.bits)}; }
    bool operator==(const VariantSet&) const = default;
};
consteval VariantSet in(auto... v) { return {static_cast<std::uint8_t>(((1u << static_cast<unsigned>(v)) | ...))}; }

inline constexpr VariantSet kAllVariants = in(Variant::vpc3a, Variant::vpc3b, Variant::vpc3c, Variant::apc3, Variant::spc3);
/// The VPC3+ steps B and C: 4 KB RAM, DP-V1, DP-V2 registers.
inline constexpr VariantSet kStepBC = in(Variant::vpc3b, Variant::vpc3c);
/// All steps of the VPC3+.
inline constexpr VariantSet kVpc3 = in(Variant::vpc3a, Variant::vpc3b, Variant::vpc3c);
/// APC3 and SPC3: 1.5 KB RAM, DP-V0 only.
inline constexpr VariantSet kSpc3Class = in(Variant::apc3, Variant::spc3);

struct Traits {
    Variant variant{};
    std::string_view name;            ///< as --chip and the C API spell it
    bool documented{};                ///< a manual of this very chip was at hand
    std::uint16_t ram_bytes{};        ///< at reset; VPC3+B/C: 4096 after 4KB_Mode = 1
    std::uint16_t max_ram_bytes{};
    bool access_violation{};          ///< addresses from ram_bytes on fold by -400h, set Status bit 3 and end in Offline
    std::uint8_t release{};           ///< Status Register bits 15..12
    bool mode_regs_readable{};        ///< 06H, 07H, 15H can be read back
    bool dpv1{};                      ///< SAP list, DPV1_Status octets, FDL_Ind, Poll_End_Ind
    bool dxb{};                       ///< data exchange broadcast
    bool isom{};                      ///< isochron mode, Mode Register 2 with the SYNC bits
    bool clock_sync{};                ///< CS_Supported
    bool ext_prm{};                   ///< SAP 53
    bool user_timer{};                ///< User_Timer_Clock interrupt
    std::uint16_t interrupts{};       ///< IRR bits that exist
    std::uint8_t min_tsdr_reset{};    ///< in bit times
    std::uint8_t baud_control_reset{};///< WD_BAUD_CONTROL_Val after reset
    bool din_gates_data_exch{};       ///< DATA-EXCH waits for the first New_Din_Buffer_Cmd (APC3 5.2.3)
    bool gc_only_changed{};           ///< New_GC_Command only when the control octet changed
    bool presets_gc_command{};        ///< Start writes 00H to R_GC_Command
    bool prm_reserved_checks{};       ///< checks 5..8 of Set_Prm (reference 3.4.3)
    bool dis_start_reset{};           ///< Dis_Start_Control is 1 after reset
    bool sd3_proves_baud{};           ///< an SD3 telegram ends the baud rate search
    bool chk_cfg_aux1{};              ///< Chk_Cfg comes through Aux-Buffer 1 whatever R_Aux_Buf_Sel says (reference 10.16)
    std::uint16_t mode0_bits{};       ///< bits of Mode Register 0 that exist
    std::uint8_t mode2_bits{};        ///< bits of Mode Register 2 that exist; writing the others has no effect
};

// clang-format off
inline constexpr std::array<Traits, kVariants> kTraits{{
    {.variant = Variant::vpc3a, .name = "vpc3+", .documented = false, .ram_bytes = 2048, .max_ram_bytes = 2048, .access_violation = false,
     .release = 0x0, .mode_regs_readable = true, .dpv1 = false, .dxb = false, .isom = false, .clock_sync = false, .ext_prm = false,
     .user_timer = true, .interrupts = 0x3F1F, .min_tsdr_reset = 11, .baud_control_reset = 0x10, .din_gates_data_exch = false,
     .gc_only_changed = false, .presets_gc_command = false, .prm_reserved_checks = false, .dis_start_reset = false, .sd3_proves_baud = true,
     .chk_cfg_aux1 = false, .mode0_bits = 0x37FF, .mode2_bits = 0x07},
    {.variant = Variant::vpc3b, .name = "vpc3+b", .documented = false, .ram_bytes = 2048, .max_ram_bytes = 4096, .access_violation = false,
     .release = 0xB, .mode_regs_readable = true, .dpv1 = true, .dxb = true, .isom = true, .clock_sync = false, .ext_prm = true,
     .user_timer = true, .interrupts = 0xFFFF, .min_tsdr_reset = 11, .baud_control_reset = 0x10, .din_gates_data_exch = false,
     .gc_only_changed = false, .presets_gc_command = false, .prm_reserved_checks = true, .dis_start_reset = false, .sd3_proves_baud = true,
     .chk_cfg_aux1 = true, .mode0_bits = 0x7FFF, .mode2_bits = 0xFF},
    {.variant = Variant::vpc3c, .name = "vpc3+c", .documented = true, .ram_bytes = 2048, .max_ram_bytes = 4096, .access_violation = false,
     .release = 0xC, .mode_regs_readable = true, .dpv1 = true, .dxb = true, .isom = true, .clock_sync = true, .ext_prm = true,
     .user_timer = true, .interrupts = 0xFFFF, .min_tsdr_reset = 11, .baud_control_reset = 0x10, .din_gates_data_exch = false,
     .gc_only_changed = false, .presets_gc_command = false, .prm_reserved_checks = true, .dis_start_reset = false, .sd3_proves_baud = true,
     .chk_cfg_aux1 = false, .mode0_bits = 0x7FFF, .mode2_bits = 0xFF},
    {.variant = Variant::apc3, .name = "apc3", .documented = true, .ram_bytes = 1536, .max_ram_bytes = 1536, .access_violation = true,
     .release = 0x0, .mode_regs_readable = false, .dpv1 = false, .dxb = false, .isom = false, .clock_sync = false, .ext_prm = false,
     .user_timer = false, .interrupts = 0x3F0F, .min_tsdr_reset = 11, .baud_control_reset = 0x1E, .din_gates_data_exch = true,
     .gc_only_changed = true, .presets_gc_command = true, .prm_reserved_checks = false, .dis_start_reset = true, .sd3_proves_baud = true,
     .chk_cfg_aux1 = false, .mode0_bits = 0x3BFF, .mode2_bits = 0x00},
    {.variant = Variant::spc3, .name = "spc3", .documented = false, .ram_bytes = 1536, .max_ram_bytes = 1536, .access_violation = true,
     .release = 0x0, .mode_regs_readable = false, .dpv1 = false, .dxb = false, .isom = false, .clock_sync = false, .ext_prm = false,
     .user_timer = false, .interrupts = 0x3F0F, .min_tsdr_reset = 11, .baud_control_reset = 0x1E, .din_gates_data_exch = true,
     .gc_only_changed = true, .presets_gc_command = true, .prm_reserved_checks = false, .dis_start_reset = true, .sd3_proves_baud = true,
     .chk_cfg_aux1 = false, .mode0_bits = 0x3BFF, .mode2_bits = 0x00},
}};
// clang-format on

constexpr const Traits& traits(Variant v) { return kTraits[static_cast<std::size_t>(v)]; }

/// "vpc3+c" -> vpc3c; nothing for a name that is no chip.
constexpr std::optional<Variant> variant_from_name(std::string_view name) {
    for (const Traits& t : kTraits)
        if (t.name == name) return t.variant;
    return std::nullopt;
}

}  // namespace dpchip::regmap
