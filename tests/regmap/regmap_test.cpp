// SPDX-License-Identifier: Apache-2.0
// The register map against a table typed from the manuals (VPC3+C figures 4-2, 4-3; APC3 tables 3.2, 3.3; hardware reference 12).
#include <gtest/gtest.h>

#include <set>
#include <string>

#include <dpchip/regmap/address.hpp>
#include <dpchip/regmap/names.hpp>

namespace dpchip::regmap {
namespace {

struct Expected {
    std::uint16_t address;
    Dir dir;
    const char* vpc3c;
    const char* vpc3b;
    const char* vpc3a;
    const char* apc3;  // SPC3 alike
};

constexpr auto r = Dir::read, w = Dir::write;
constexpr const char* none = "Reserved";
// clang-format off
constexpr Expected kTyped[]{
    {0x00, r, "Int-Req-Reg 7..0", "Int-Req-Reg 7..0", "Int-Req-Reg 7..0", "Int-Req-Reg 7..0"},
    {0x01, r, "Int-Req-Reg 15..8", "Int-Req-Reg 15..8", "Int-Req-Reg 15..8", "Int-Req-Reg 15..8"},
    {0x02, r, "Int-Reg 7..0", "Int-Reg 7..0", "Int-Reg 7..0", "Int-Reg 7..0"},
    {0x03, r, "Int-Reg 15..8", "Int-Reg 15..8", "Int-Reg 15..8", "Int-Reg 15..8"},
    {0x04, r, "Status-Reg 7..0", "Status-Reg 7..0", "Status-Reg 7..0", "Status-Reg 7..0"},
    {0x05, r, "Status-Reg 15..8", "Status-Reg 15..8", "Status-Reg 15..8", "Status-Reg 15..8"},
    {0x06, r, "Mode-Reg0 7..0", "Mode-Reg0 7..0", "Mode-Reg0 7..0", none},
    {0x07, r, "Mode-Reg0 15..8", "Mode-Reg0 15..8", "Mode-Reg0 15..8", none},
    {0x08, r, "Din_Buffer_SM", "Din_Buffer_SM", "Din_Buffer_SM", "Din_Buffer_SM"},
    {0x09, r, "New_Din_Buffer_Cmd", "New_Din_Buffer_Cmd", "New_Din_Buffer_Cmd", "New_Din_Buffer_Cmd"},
    {0x0A, r, "Dout_Buffer_SM", "Dout_Buffer_SM", "Dout_Buffer_SM", "Dout_Buffer_SM"},
    {0x0B, r, "Next_Dout_Buffer_Cmd", "Next_Dout_Buffer_Cmd", "Next_Dout_Buffer_Cmd", "Next_Dout_Buffer_Cmd"},
    {0x0C, r, "Diag_Buffer_SM", "Diag_Buffer_SM", "Diag_Buffer_SM", "Diag_Buffer_SM"},
    {0x0D, r, "New_Diag_Buffer_Cmd", "New_Diag_Buffer_Cmd", "New_Diag_Buffer_Cmd", "New_Diag_Buffer_Cmd"},
    {0x0E, r, "User_Prm_Data_Okay", "User_Prm_Data_Okay", "User_Prm_Data_Okay", "User_Prm_Data_Okay"},
    {0x0F, r, "User_Prm_Data_Not_Okay", "User_Prm_Data_Not_Okay", "User_Prm_Data_Not_Okay", "User_Prm_Data_Not_Okay"},
    {0x10, r, "User_Cfg_Data_Okay", "User_Cfg_Data_Okay", "User_Cfg_Data_Okay", "User_Cfg_Data_Okay"},
    {0x11, r, "User_Cfg_Data_Not_Okay", "User_Cfg_Data_Not_Okay", "User_Cfg_Data_Not_Okay", "User_Cfg_Data_Not_Okay"},
    {0x12, r, "DXBout_Buffer_SM", "DXBout_Buffer_SM", none, none},
    {0x13, r, "Next_DXBout_Buffer_Cmd", "Next_DXBout_Buffer_Cmd", none, none},
    {0x14, r, "SSA_Buffer_Free_Cmd", "SSA_Buffer_Free_Cmd", "SSA_Buffer_Free_Cmd", "SSA_Buffer_Free_Cmd"},
    {0x15, r, "Mode-Reg1", "Mode-Reg1", "Mode-Reg1", none},
    {0x00, w, "Int-Req-Reg 7..0", "Int-Req-Reg 7..0", "Int-Req-Reg 7..0", "Int-Req-Reg 7..0"},
    {0x01, w, "Int-Req-Reg 15..8", "Int-Req-Reg 15..8", "Int-Req-Reg 15..8", "Int-Req-Reg 15..8"},
    {0x02, w, "Int-Ack-Reg 7..0", "Int-Ack-Reg 7..0", "Int-Ack-Reg 7..0", "Int-Ack-Reg 7..0"},
    {0x03, w, "Int-Ack-Reg 15..8", "Int-Ack-Reg 15..8", "Int-Ack-Reg 15..8", "Int-Ack-Reg 15..8"},
    {0x04, w, "IntMask-Reg 7..0", "IntMask-Reg 7..0", "IntMask-Reg 7..0", "IntMask-Reg 7..0"},
    {0x05, w, "IntMask-Reg 15..8", "IntMask-Reg 15..8", "IntMask-Reg 15..8", "IntMask-Reg 15..8"},
    {0x06, w, "Mode-Reg0 7..0", "Mode-Reg0 7..0", "Mode-Reg0 7..0", "Mode-Reg0 7..0"},
    {0x07, w, "Mode-Reg0 15..8", "Mode-Reg0 15..8", "Mode-Reg0 15..8", "Mode-Reg0 15..8"},
    {0x08, w, "Mode-Reg1-S", "Mode-Reg1-S", "Mode-Reg1-S", "Mode-Reg1-S"},
    {0x09, w, "Mode-Reg1-R", "Mode-Reg1-R", "Mode-Reg1-R", "Mode-Reg1-R"},
    {0x0A, w, "WD_BAUD_CONTROL_Val", "WD_BAUD_CONTROL_Val", "WD_BAUD_CONTROL_Val", "WD_BAUD_CONTROL_Val"},
    {0x0B, w, "minTSDR_Val", "minTSDR_Val", "minTSDR_Val", "minTSDR_Val"},
    {0x0C, w, "Mode-Reg2", "Mode-Reg2", "Mode-Reg2", none},
    {0x0D, w, "Sync_PW_Reg", "Sync_PW_Reg", none, none},
    {0x0E, w, "Control_Command_Reg", "Control_Command_Reg", none, none},
    {0x0F, w, "Group_Select_Reg", "Group_Select_Reg", none, none},
    {0x10, w, none, none, none, none},
    {0x11, w, none, none, none, none},
    {0x12, w, "Mode-Reg3", "Mode-Reg3", none, none},
    {0x13, w, none, none, none, none},
    {0x14, w, none, none, none, none},
    {0x15, w, none, none, none, none},
};
// clang-format on

// proves: VPC3C 4.2-03..21, VPC3C 4.2-23..24, VPC3C 4.2-26..34, VPC3C 4.2-38..40, APC3 3.2-02..27, E001, E021, E052
TEST(ControlParameters, EveryAddressDecodesAsTheManualsPrintIt) {
    EXPECT_EQ(std::size(kTyped), 44u);
    for (const Expected& e : kTyped) {
        const char* per_variant[]{e.vpc3a, e.vpc3b, e.vpc3c, e.apc3, e.apc3};
        for (std::size_t v = 0; v < kVariants; ++v) {
            const auto variant = static_cast<Variant>(v);
            EXPECT_EQ(name(variant, e.dir, e.address), per_variant[v]) << v << " " << e.address;
            const bool reserved = std::string{per_variant[v]} == none;
            EXPECT_EQ(effect(variant, e.dir, e.address) == Effect::reserved, reserved) << v << " " << e.address;
            EXPECT_EQ(find(variant, e.dir, e.address) == nullptr, reserved);
        }
    }
}

TEST(ControlParameters, NoEffectServesTwoAddressesOfOneVariant) {
    for (std::size_t v = 0; v < kVariants; ++v) {
        std::set<Effect> seen;
        for (const Dir dir : {Dir::read, Dir::write})
            for (std::uint16_t a = 0; a < 0x200; ++a) {
                const Effect e = effect(static_cast<Variant>(v), dir, a);
                if (e == Effect::reserved) continue;
                EXPECT_LT(a, control::count);
                EXPECT_TRUE(seen.insert(e).second) << v << " " << a;
            }
    }
}

TEST(ControlParameters, ExactlyTheCommandsActWhenRead) {
    const std::set<std::uint16_t> commands{0x09, 0x0B, 0x0D, 0x0E, 0x0F, 0x10, 0x11, 0x13, 0x14};
    for (std::size_t v = 0; v < kVariants; ++v)
        for (std::uint16_t a = 0; a < 0x100; ++a) {
            const auto variant = static_cast<Variant>(v);
            const bool exists = a != 0x13 || traits(variant).dxb;
            EXPECT_EQ(read_acts(variant, a), commands.contains(a) && exists) << v << " " << a;
        }
}

TEST(ControlParameters, ResetValuesFollowTheVariant) {
    struct { Variant variant; Dir dir; std::uint16_t address; std::uint8_t value; } const rows[]{
        {Variant::vpc3c, r, 0x05, 0xCF}, {Variant::vpc3b, r, 0x05, 0xBF}, {Variant::vpc3a, r, 0x05, 0x0F},
        {Variant::apc3, r, 0x05, 0x0F},  {Variant::vpc3c, r, 0x08, 0xE1}, {Variant::vpc3c, r, 0x0C, 0x09},
        {Variant::vpc3c, w, 0x04, 0xFF}, {Variant::vpc3c, w, 0x0A, 0x10}, {Variant::apc3, w, 0x0A, 0x1E},
        {Variant::vpc3c, w, 0x0B, 0x0B}, {Variant::vpc3c, w, 0x0C, 0x01}, {Variant::vpc3c, w, 0x06, 0x00},
        {Variant::apc3, w, 0x06, 0x01},
    };
    for (const auto& row : rows) {
        const Reg* reg = find(row.variant, row.dir, row.address);
        ASSERT_NE(reg, nullptr);
        EXPECT_EQ(reset_value(row.variant, *reg), row.value) << row.address;
    }
}

TEST(ControlParameters, FieldsSitAtTheBitsThatAddressHppNames) {
    struct { Dir dir; std::uint16_t address; const char* field; unsigned mask; Variant variant; } const rows[]{
        {w, 0x06, "Freeze_Supported", mode0::freeze_supported, Variant::vpc3c},
        {w, 0x06, "Sync_Supported", mode0::sync_supported, Variant::apc3},
        {w, 0x06, "INT_Pol", mode0::int_pol, Variant::vpc3c},
        {w, 0x06, "CS_Supported", mode0::cs_supported, Variant::vpc3c},
        {w, 0x06, "MinTSDR", mode0::min_tsdr, Variant::apc3},
        {w, 0x07, "DP_Mode", mode0::dp_mode >> 8, Variant::vpc3c},
        {w, 0x07, "EOI_Time_Base", mode0::eoi_time_base >> 8, Variant::apc3},
        {w, 0x07, "User_Time_Base", mode0::user_time_base >> 8, Variant::vpc3a},
        {w, 0x07, "Set_Ext_Prm_Supported", mode0::set_ext_prm_supported >> 8, Variant::vpc3b},
        {w, 0x07, "Spec_Prm_Buf_Mode", mode0::spec_prm_buf_mode >> 8, Variant::apc3},
        {w, 0x07, "Spec_Clear_Mode", mode0::spec_clear_mode >> 8, Variant::vpc3c},
        {w, 0x07, "PrmCmd_Supported", mode0::prm_cmd_supported >> 8, Variant::vpc3c},
        {w, 0x08, "Start_VPC3", mode1::start_vpc3, Variant::vpc3c},
        {w, 0x08, "EOI", mode1::eoi, Variant::apc3},
        {w, 0x09, "Go_Offline", mode1::go_offline, Variant::vpc3c},
        {r, 0x15, "Res_User_WD", mode1::res_user_wd, Variant::vpc3c},
        {w, 0x0C, "4KB_Mode", mode2::mode_4kb, Variant::vpc3c},
        {w, 0x0C, "DX_Int_Mode", mode2::dx_int_mode, Variant::vpc3a},
        {w, 0x12, "DX_Int_Mode_2", mode3::dx_int_mode_2, Variant::vpc3c},
        {r, 0x04, "Diag_Flag", status::diag_flag, Variant::vpc3c},
        {r, 0x04, "RAM_Access_Violation", status::ram_access_violation, Variant::apc3},
        {r, 0x01, "DX_Out", interrupt::dx_out >> 8, Variant::apc3},
        {w, 0x02, "New_Ext_Prm_Data", interrupt::new_ext_prm_data, Variant::vpc3c},
        {r, 0x0B, "U_Buffer_Cleared", next_dout::u_buffer_cleared, Variant::vpc3c},
    };
    for (const auto& row : rows) {
        const Reg* reg = find(row.variant, row.dir, row.address);
        ASSERT_NE(reg, nullptr) << row.field;
        bool found = false;
        for (const Field& f : reg->fields)
            if (f.name == row.field && f.variants.has(row.variant)) {
                found = true;
                EXPECT_EQ(((1u << f.width) - 1u) << f.lsb, row.mask) << row.field;
            }
        EXPECT_TRUE(found) << row.field;
    }
}

// proves: APC3 4.1.1-04, APC3 4.3-21, APC3 4.3-30
TEST(ControlParameters, FieldsOfAbsentFeaturesAreAbsent) {
    for (const Field& f : find(Variant::apc3, w, 0x07)->fields) {
        if (!f.variants.has(Variant::apc3)) continue;
        EXPECT_NE(f.name, "PrmCmd_Supported");
        EXPECT_NE(f.name, "User_Time_Base");
        EXPECT_NE(f.name, "Set_Ext_Prm_Supported");
    }
    EXPECT_EQ(interrupt_name(Variant::apc3, 4), "");
    EXPECT_EQ(interrupt_name(Variant::apc3, 13), "DX_Out");
    EXPECT_EQ(interrupt_name(Variant::vpc3c, 15), "FDL_Ind");
    EXPECT_EQ(interrupt_name(Variant::vpc3c, 16), "");
}

TEST(OrganizationalParameters, NamesFollowTheVariantsManual) {
    EXPECT_EQ(name(Variant::vpc3c, r, org::sap_list_ptr), "SAP_List_Ptr");
    EXPECT_EQ(name(Variant::apc3, r, org::sap_list_ptr), "Reserved");
    EXPECT_EQ(name(Variant::apc3, w, org::r_len_dout_buf), "R_Len_Dout_Puf");
    EXPECT_EQ(name(Variant::apc3, w, org::r_len_dxbout_buf), "Reserved");
    EXPECT_EQ(name(Variant::vpc3a, w, org::r_len_dxbout_buf), "Reserved");
    EXPECT_EQ(name(Variant::vpc3b, w, org::r_dxbout_buf_ptr3), "R_DXBout_Buf_Ptr3");
    EXPECT_EQ(name(Variant::vpc3c, w, org::r_gc_command), "R_GC_Command");
    EXPECT_EQ(name(Variant::vpc3c, w, 0x40), "RAM");
    EXPECT_EQ(find_cell(0x15), nullptr);
    EXPECT_EQ(find_cell(0x40), nullptr);
}

TEST(OrganizationalParameters, CellsTheChipWritesAreThoseOfTheReference) {
    const std::set<std::uint16_t> chip{0x16, 0x39, 0x2D, 0x2F, 0x31, 0x2B, 0x2C, 0x2E, 0x30, 0x32, 0x34, 0x3C};
    for (const Cell& cell : kOrganizationalParameters)
        EXPECT_EQ(cell.writer == Writer::chip, chip.contains(cell.address)) << cell.name;
}

// proves: VPC3C 4.2-02, VPC3C 4.3-05, VPC3C 8.1.1-01, APC3 3.2-01, APC3 3.3-04
TEST(OrganizationalParameters, MotorolaModeSwapsTheWordRegistersAndNothingElse) {
    const std::set<std::uint16_t> swapped{0, 1, 2, 3, 4, 5, 6, 7, 0x18, 0x19};
    for (std::uint16_t a = 0; a < 0x1000; ++a) EXPECT_EQ(motorola_address(a), swapped.contains(a) ? a ^ 1 : a);
}

}  // namespace
}  // namespace dpchip::regmap
