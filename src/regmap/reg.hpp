// SPDX-License-Identifier: Apache-2.0
// The vocabulary of the register map: registers and fields as pure data, side effects as an enumeration.
//
// One table serves five readers: the chip decodes with it, the driver takes addresses and fields from it, the trace
// names, `dpchip regs` prints and a live view peeks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <dpchip/regmap/variant.hpp>

namespace dpchip::regmap {

enum class Dir : std::uint8_t { read, write };

/// What a processor access does besides moving data. The chip switches over this under -Wswitch-enum.
enum class Effect : std::uint8_t {
    reserved,             ///< reads 00H, writes have no effect
    // read side, plain
    irr_low, irr_high, ir_low, ir_high, status_low, status_high, mode0_low, mode0_high, mode1,
    din_buffer_sm, dout_buffer_sm, diag_buffer_sm, dxbout_buffer_sm,
    // read side, commands: the read itself acts
    new_din_buffer_cmd, next_dout_buffer_cmd, new_diag_buffer_cmd, user_prm_data_okay, user_prm_data_not_okay,
    user_cfg_data_okay, user_cfg_data_not_okay, next_dxbout_buffer_cmd, ssa_buffer_free_cmd,
    // write side
    irr_set_low, irr_set_high, iar_low, iar_high, imr_low, imr_high, mode0_write_low, mode0_write_high,
    mode1_set, mode1_reset, wd_baud_control_val, min_tsdr_val, mode2_write, sync_pw, control_command, group_select,
    mode3_write,
};

/// Access vocabulary of a field.
enum class Access : std::uint8_t {
    ro,            ///< read only
    rw,            ///< read and written at the same address
    wo,            ///< written, cannot be read back
    w1s,           ///< writing 1 sets, 0 leaves
    w1c,           ///< writing 1 clears, 0 leaves
    command,       ///< reading acts
    reserved,      ///< reads 0; write 0
    offline_only,  ///< writable in Offline only
};

struct Field {
    std::string_view name;     ///< the manual's spelling
    std::uint8_t lsb{}, width{};
    Access access = Access::ro;
    std::string_view meaning;
    VariantSet variants = kAllVariants;
};

struct Reg {
    std::uint16_t address{};   ///< Intel address
    Dir dir{};
    std::string_view name;     ///< the manual's spelling
    std::string_view section;  ///< VPC3+C manual section
    std::uint8_t reset{};      ///< of VPC3+C; variants differ where Traits says so
    Effect effect = Effect::reserved;
    std::span<const Field> fields{};
    VariantSet variants = kAllVariants;
};

/// No two registers share (address, direction, variant); fields lie inside the octet and do not overlap.
consteval bool well_formed(std::span<const Reg> table) {
    for (std::size_t i = 0; i < table.size(); ++i) {
        if (table[i].name.empty() || table[i].section.empty()) return false;
        for (std::size_t v = 0; v < kVariants; ++v) {
            unsigned used = 0;
            for (const Field& f : table[i].fields) {
                if (!f.variants.has(static_cast<Variant>(v))) continue;
                const unsigned mask = ((1u << f.width) - 1u) << f.lsb;
                if (f.name.empty() || f.width == 0 || f.lsb + f.width > 8 || (used & mask) != 0) return false;
                used |= mask;
            }
        }
        for (std::size_t j = i + 1; j < table.size(); ++j)
            if (table[i].address == table[j].address && table[i].dir == table[j].dir &&
                (table[i].variants.bits & table[j].variants.bits) != 0)
                return false;
    }
    return true;
}

}  // namespace dpchip::regmap
