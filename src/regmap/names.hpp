// SPDX-License-Identifier: Apache-2.0
// The name of an address, as the variant's manual prints it: for traces, views and `dpchip regs`.
#pragma once

#include <cstdint>
#include <string_view>

#include <dpchip/regmap/control_parameters.hpp>
#include <dpchip/regmap/organizational_parameters.hpp>

namespace dpchip::regmap {

/// "New_Din_Buffer_Cmd", "R_TS_Adr", "Reserved"; "RAM" from 40H on. `address` is an Intel address.
constexpr std::string_view name(Variant variant, Dir dir, std::uint16_t address) {
    if (address > 0x3F) return "RAM";
    if (const Cell* cell = find_cell(address)) {
        if (kSpc3Class.has(variant) && !cell->apc3_name.empty()) return cell->apc3_name;
        return cell->variants.has(variant) ? cell->name : kReserved;
    }
    const Reg* reg = find(variant, dir, address);
    return reg != nullptr ? reg->name : kReserved;
}

}  // namespace dpchip::regmap
