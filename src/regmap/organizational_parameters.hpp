// SPDX-License-Identifier: Apache-2.0
// Organizational parameters 16H..3FH: RAM cells that tell the chip where its buffers are, and who writes them
// (VPC3+C 4.3 figure 4-4; APC3 table 3.4; reference 4.4 and 4.12).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <dpchip/regmap/variant.hpp>

namespace dpchip::regmap {

/// Who writes a cell after Start.
enum class Writer : std::uint8_t {
    user,  ///< the user only
    chip,  ///< set up by the user, or preset; then the chip writes it
};

struct Cell {
    std::uint16_t address{};   ///< Intel address
    std::string_view name;     ///< VPC3+C spelling
    std::string_view section;  ///< VPC3+C manual
    Writer writer{};
    std::string_view meaning;
    VariantSet variants = kAllVariants;  ///< where the chip uses the cell; elsewhere it is plain RAM
    std::string_view apc3_name{};        ///< the APC3's spelling where it differs
};

inline constexpr std::string_view kReserved = "Reserved";

// clang-format off
inline constexpr std::array<Cell, 42> kOrganizationalParameters{{
    {0x16, "R_TS_Adr",             "4.3",   Writer::chip, "station address; Set_Slave_Add changes it"},
    {0x17, "SAP_List_Ptr",         "7.2.1", Writer::user, "segment of the SAP list; without one, of an octet FFH", kAllVariants, kReserved},
    {0x18, "R_User_WD_Value 7..0", "6.2.5", Writer::user, "Data_Exchange telegrams the user may miss; at 19H in Motorola mode"},
    {0x19, "R_User_WD_Value 15..8","6.2.5", Writer::user, "high octet; at 18H in Motorola mode"},
    {0x1A, "R_Len_Dout_Buf",       "6.2.5", Writer::user, "length of the three Dout_Buf", kAllVariants, "R_Len_Dout_Puf"},
    {0x1B, "R_Dout_Buf_Ptr1",      "6.2.5", Writer::user, "segment of Dout_Buf 1"},
    {0x1C, "R_Dout_Buf_Ptr2",      "6.2.5", Writer::user, "segment of Dout_Buf 2"},
    {0x1D, "R_Dout_Buf_Ptr3",      "6.2.5", Writer::user, "segment of Dout_Buf 3"},
    {0x1E, "R_Len_Din_Buf",        "6.2.5", Writer::user, "length of the three Din_Buf"},
    {0x1F, "R_Din_Buf_Ptr1",       "6.2.5", Writer::user, "segment of Din_Buf 1"},
    {0x20, "R_Din_Buf_Ptr2",       "6.2.5", Writer::user, "segment of Din_Buf 2"},
    {0x21, "R_Din_Buf_Ptr3",       "6.2.5", Writer::user, "segment of Din_Buf 3"},
    {0x22, "R_Len_DXBout_Buf",     "7.3.1", Writer::user, "length of the three DXBout_Buf", kStepBC, kReserved},
    {0x23, "R_DXBout_Buf_Ptr1",    "7.3.1", Writer::user, "segment of DXBout_Buf 1", kStepBC, kReserved},
    {0x24, "R_Len_Diag_Buf1",      "6.2.4", Writer::user, "length of Diag_Buf 1, at least 6"},
    {0x25, "R_Len_Diag_Buf2",      "6.2.4", Writer::user, "length of Diag_Buf 2, at least 6"},
    {0x26, "R_Diag_Buf_Ptr1",      "6.2.4", Writer::user, "segment of Diag_Buf 1", kAllVariants, "R_Diag_Puf_Ptr1"},
    {0x27, "R_Diag_Buf_Ptr2",      "6.2.4", Writer::user, "segment of Diag_Buf 2", kAllVariants, "R_Diag_Puf_Ptr2"},
    {0x28, "R_Len_Cntrl_Buf1",     "6.1",   Writer::user, "length of Aux_Buf 1 and of the buffers it is exchanged with", kAllVariants, "R_Len_Cntrl_Pbuf1"},
    {0x29, "R_Len_Cntrl_Buf2",     "6.1",   Writer::user, "length of Aux_Buf 2 and of the buffers it is exchanged with", kAllVariants, "R_Len_Cntrl_Pbuf2"},
    {0x2A, "R_Aux_Buf_Sel",        "6.1",   Writer::user, "bit 0 Set_(Ext_)Prm, 1 Chk_Cfg, 2 Set_Slave_Adr: 0 by Aux_Buf 1, 1 by Aux_Buf 2", kAllVariants, "R_Aux_Puf_Sel"},
    {0x2B, "R_Aux_Buf_Ptr1",       "6.1",   Writer::chip, "segment of Aux_Buf 1; exchanged on reception"},
    {0x2C, "R_Aux_Buf_Ptr2",       "6.1",   Writer::chip, "segment of Aux_Buf 2; exchanged on reception"},
    {0x2D, "R_Len_SSA_Data",       "6.2.1", Writer::chip, "octets of the last Set_Slave_Add"},
    {0x2E, "R_SSA_Buf_Ptr",        "6.2.1", Writer::chip, "segment of the SSA_Buf; 00H: SAP 55 is not activated"},
    {0x2F, "R_Len_Prm_Data",       "6.2.2", Writer::chip, "octets in the Prm_Buf"},
    {0x30, "R_Prm_Buf_Ptr",        "6.2.2", Writer::chip, "segment of the Prm_Buf; exchanged on reception"},
    {0x31, "R_Len_Cfg_Data",       "6.2.3", Writer::chip, "octets in the Cfg_Buf"},
    {0x32, "R_Cfg_Buf_Ptr",        "6.2.3", Writer::chip, "segment of the Cfg_Buf; exchanged on reception"},
    {0x33, "R_Len_Read_Cfg_Data",  "6.2.9", Writer::user, "octets in the Read_Cfg_Buf"},
    {0x34, "R_Read_Cfg_Buf_Ptr",   "6.2.9", Writer::chip, "segment of the Read_Cfg_Buf; exchanged with En_Change_Cfg_Buffer = 1"},
    {0x35, "R_Len_DXB_Link_Buf",   "7.3.1", Writer::user, "octets of the DXB_Linktable", kStepBC, kReserved},
    {0x36, "R_DXB_Link_Buf_Ptr",   "7.3.1", Writer::user, "segment of the DXB_Link_Buf", kStepBC, kReserved},
    {0x37, "R_Len_DXB_Status_Buf", "7.3.1", Writer::user, "octets of the DXB_Status", kStepBC, kReserved},
    {0x38, "R_DXB_Status_Buf_Ptr", "7.3.1", Writer::user, "segment of the DXB_Status_Buf", kStepBC, kReserved},
    {0x39, "R_Real_No_Add_Change", "6.2.1", Writer::chip, "00H: Set_Slave_Add may change the address; the service itself can lock it"},
    {0x3A, "R_Ident_Low",          "4.3",   Writer::user, "Ident_Number, low octet"},
    {0x3B, "R_Ident_High",         "4.3",   Writer::user, "Ident_Number, high octet"},
    {0x3C, "R_GC_Command",         "6.2.6", Writer::chip, "the last Control_Command of Global_Control"},
    {0x3D, "R_Len_Spec_Prm_Buf",   "5.1.1", Writer::user, "length of the Prm_Buf with Spec_Prm_Buf_Mode = 1"},
    {0x3E, "R_DXBout_Buf_Ptr2",    "7.3.1", Writer::user, "segment of DXBout_Buf 2", kStepBC, kReserved},
    {0x3F, "R_DXBout_Buf_Ptr3",    "7.3.1", Writer::user, "segment of DXBout_Buf 3", kStepBC, kReserved},
}};
// clang-format on
static_assert([] {
    for (std::size_t i = 0; i < kOrganizationalParameters.size(); ++i)
        if (kOrganizationalParameters[i].address != 0x16 + i || kOrganizationalParameters[i].name.empty()) return false;
    return true;
}());

/// The cell at 16H..3FH, or null.
constexpr const Cell* find_cell(std::uint16_t address) {
    if (address < 0x16 || address > 0x3F) return nullptr;
    return &kOrganizationalParameters[address - 0x16u];
}

/// The octet that the processor reaches in Motorola mode: bit 0 of the address is inverted for the word registers
/// 00H..07H and R_User_WD_Value, and nowhere else (4.2, reference 4.1).
constexpr std::uint16_t motorola_address(std::uint16_t address) {
    const bool word = address < 0x08 || address == 0x18 || address == 0x19;
    return word ? static_cast<std::uint16_t>(address ^ 1u) : address;
}

}  // namespace dpchip::regmap
