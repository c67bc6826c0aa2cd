// SPDX-License-Identifier: Apache-2.0
// Control parameters 00H..15H, read side and write side, of all variants: one row a register, and the decode tables made
// from the rows (VPC3+C 4.2 figures 4-2 and 4-3, 5.1 to 5.3, 6.2; APC3 tables 3.2, 3.3 and 4.1 to 4.6; hardware
// reference 12). A bit that no field covers is reserved. What is not in the table for a variant is Effect::reserved.
//
// VPC3+ step A, VPC3+B and SPC3: no manual at hand; they follow Traits (variant.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <dpchip/regmap/interrupts.hpp>
#include <dpchip/regmap/reg.hpp>

namespace dpchip::regmap {

namespace fields {

inline constexpr VariantSet kVpc3c = in(Variant::vpc3c);
inline constexpr VariantSet kNotVpc3c = in(Variant::vpc3a, Variant::vpc3b, Variant::apc3, Variant::spc3);
inline constexpr VariantSet kNotStepBC = in(Variant::vpc3a, Variant::apc3, Variant::spc3);

/// The eight interrupt bits of one octet, seen with one kind of access. Bit 0 has two names on VPC3+C.
template <unsigned Octet>
consteval auto interrupt_octet(Access access) {
    std::array<Field, Octet == 0 ? 9 : 8> f{};
    for (std::size_t i = 0; i < 8; ++i) {
        const InterruptBit& b = kInterruptBits[Octet * 8 + i];
        // An acknowledgement register has no power over these three (5.3.2).
        const Access a = access == Access::w1c && b.by_acknowledgement ? Access::reserved : access;
        f[i] = {b.name, static_cast<std::uint8_t>(i), 1, a, b.meaning, b.variants};
    }
    if constexpr (Octet == 0) {
        f[0].variants = kNotVpc3c;
        f[8] = {"MAC_Reset/Clock_Sync", 0, 1, access,
                "CS_Supported = 0: Offline has been reached; 1: a Clock_Value has been received, or clock synchronisation failed",
                kVpc3c};
    }
    return f;
}
inline constexpr auto kInterruptLowRo = interrupt_octet<0>(Access::ro), kInterruptLowSet = interrupt_octet<0>(Access::w1s),
                      kInterruptLowAck = interrupt_octet<0>(Access::w1c), kInterruptLowMask = interrupt_octet<0>(Access::wo);
inline constexpr auto kInterruptHighRo = interrupt_octet<1>(Access::ro), kInterruptHighSet = interrupt_octet<1>(Access::w1s),
                      kInterruptHighAck = interrupt_octet<1>(Access::w1c), kInterruptHighMask = interrupt_octet<1>(Access::wo);

// clang-format off
inline constexpr Field kStatusLow[]{
    {"WD_State",             6, 2, Access::ro, "00 BAUD_SEARCH, 01 BAUD_CONTROL, 10 DP_CONTROL"},
    {"DP_State",             4, 2, Access::ro, "00 WAIT-PRM, 01 WAIT-CFG, 10 DATA-EXCH"},
    {"RAM_Access_Violation", 3, 1, Access::ro, "an address beyond the RAM was used; until reset or the next Start", kSpc3Class},
    {"Reserved",             3, 1, Access::reserved, "reads 0", kVpc3},
    {"Diag_Flag",            2, 1, Access::ro, "1: the master has not fetched the diagnosis yet"},
    {"Reserved",             1, 1, Access::reserved, "reads 0"},
    {"Offline/Passive-Idle", 0, 1, Access::ro, "0 Offline, 1 Passive_Idle"},
};
inline constexpr Field kStatusHigh[]{
    {"Release",   4, 4, Access::ro, "chip type and step: C VPC3+C, B VPC3+B, 0 VPC3+ step A, APC3 and SPC3"},
    {"Baud Rate", 0, 4, Access::ro, "0 12 Mbit/s, 1 6M, 2 3M, 3 1.5M, 4 500k, 5 187.5k, 6 93.75k, 7 45.45k, 8 19.2k, 9 9.6k, F searching"},
};
inline constexpr Field kMode0Low[]{
    {"Freeze_Supported",  7, 1, Access::offline_only, "1: Freeze is carried out"},
    {"Sync_Supported",    6, 1, Access::offline_only, "1: Sync is carried out"},
    {"Early_Rdy",         5, 1, Access::offline_only, "1: ready comes one CLK earlier"},
    {"INT_Pol",           4, 1, Access::offline_only, "X/INT active level: 0 low, 1 high"},
    {"CS_Supported",      3, 1, Access::offline_only, "1: clock synchronisation on, bit 0 of the interrupts is Clock_Sync", kVpc3c},
    {"Reserved",          3, 1, Access::reserved,     "write 0", in(Variant::vpc3a, Variant::vpc3b)},
    {"MinTSDR",           3, 1, Access::offline_only, "minTSDR after Start: 0 pure DP (11 tBit), 1 combined operation (255 tBit)", kSpc3Class},
    {"WD_Base",           2, 1, Access::offline_only, "watchdog time base 0 10 ms, 1 1 ms; octet 7 of Set_Prm overwrites it"},
    {"Dis_Stop_Control",  1, 1, Access::offline_only, "1: stop bits are not checked; octet 7 of Set_Prm overwrites it"},
    {"Dis_Start_Control", 0, 1, Access::offline_only, "1: the moment of the following start bit is not checked; octet 7 of Set_Prm overwrites it"},
};
inline constexpr Field kMode0High[]{
    {"Reserved",              7, 1, Access::reserved,     "write 0"},
    {"PrmCmd_Supported",      6, 1, Access::offline_only, "1: Set_Prm may carry PrmCmd", kStepBC},
    {"Reserved",              6, 1, Access::reserved,     "write 0", kNotStepBC},
    {"Spec_Clear_Mode",       5, 1, Access::offline_only, "1: fail safe, Data_Exchange without outputs clears them"},
    {"Spec_Prm_Buf_Mode",     4, 1, Access::offline_only, "1: Set_Prm goes straight to the Prm_Buf of R_Len_Spec_Prm_Buf octets, without an Aux-Buffer"},
    {"Set_Ext_Prm_Supported", 3, 1, Access::offline_only, "1: SAP 53 is activated", kStepBC},
    {"WD_Test",               3, 1, Access::reserved,     "must be 0; no function", kSpc3Class},
    {"Reserved",              3, 1, Access::reserved,     "write 0", in(Variant::vpc3a)},
    {"User_Time_Base",        2, 1, Access::offline_only, "User_Timer_Clock every 0 1 ms, 1 10 ms", kVpc3},
    {"Reserved",              2, 1, Access::reserved,     "write 0", kSpc3Class},
    {"EOI_Time_Base",         1, 1, Access::offline_only, "X/INT stays inactive after EOI for 0 1 us, 1 1 ms"},
    {"DP_Mode",               0, 1, Access::offline_only, "1: the DP services are on"},
};
inline constexpr Field kMode1Read[]{
    {"Reserved",             6, 2, Access::reserved, "reads 0"},
    {"Res_User_WD",          5, 1, Access::ro, "1 until the next Data_Exchange reloads the User_WD_Timer"},
    {"En_Change_Cfg_Buffer", 4, 1, Access::ro, "1: User_Cfg_Data_Okay exchanges Cfg_Buf and Read_Cfg_Buf"},
    {"User_LEAVE-MASTER",    3, 1, Access::ro, "1 until the way to WAIT-PRM is done"},
    {"Go_Offline",           2, 1, Access::ro, "1 until Offline is reached"},
    {"EOI",                  1, 1, Access::ro, "reads 0"},
    {"Start_VPC3",           0, 1, Access::ro, "1 while running"},
};
inline constexpr Field kMode1Set[]{
    {"Reserved",             6, 2, Access::reserved, "write 0"},
    {"Res_User_WD",          5, 1, Access::w1s, "the next Data_Exchange loads the User_WD_Timer from R_User_WD_Value"},
    {"En_Change_Cfg_Buffer", 4, 1, Access::w1s, "User_Cfg_Data_Okay shall exchange Cfg_Buf and Read_Cfg_Buf"},
    {"User_LEAVE-MASTER",    3, 1, Access::w1s, "send the DP_SM to WAIT-PRM"},
    {"Go_Offline",           2, 1, Access::w1s, "go Offline after the current request"},
    {"EOI",                  1, 1, Access::w1s, "end of interrupt: X/INT goes inactive for its inactive time"},
    {"Start_VPC3",           0, 1, Access::w1s, "leave Offline for Passive_Idle; on an APC3 the bit is Start_APC3"},
};
inline constexpr Field kMode1Reset[]{
    {"Reserved",             6, 2, Access::reserved, "write 0"},
    {"Res_User_WD",          5, 1, Access::w1c, "take Res_User_WD back"},
    {"En_Change_Cfg_Buffer", 4, 1, Access::w1c, "User_Cfg_Data_Okay shall leave the buffers alone"},
    {"User_LEAVE-MASTER",    3, 1, Access::w1c, "take the request back"},
    {"Go_Offline",           2, 1, Access::w1c, "take the request back"},
    {"EOI",                  1, 1, Access::w1c, "no effect: the bit is never 1"},
    {"Start_VPC3",           0, 1, Access::w1c, "clears the bit; the chip stays online"},
};
inline constexpr Field kMode2[]{
    {"4KB_Mode",              7, 1, Access::offline_only, "RAM 0 2 KB in segments of 8, 1 4 KB in segments of 16", kStepBC},
    {"No_Check_Prm_Reserved", 6, 1, Access::offline_only, "1: reserved bits of DPV1_Status_2 and 3 are not checked", kStepBC},
    {"SYNC_Pol",              5, 1, Access::offline_only, "SYNC pulse 0 low, 1 high", kStepBC},
    {"SYNC_Ena",              4, 1, Access::offline_only, "1: pin 13 gives SYNC pulses (isochron mode)", kStepBC},
    {"DX_Int_Port",           3, 1, Access::offline_only, "1: pin 13 gives DX_Out synchronised to SYNCH; ignored with SYNC_Ena = 1", kStepBC},
    {"DX_Int_Mode",           2, 1, Access::offline_only, "DX_Out 0 only when there are outputs, 1 after every Data_Exchange"},
    {"No_Check_GC_Reserved",  1, 1, Access::offline_only, "1: reserved bits of Global_Control are not checked"},
    {"GC_Int_Mode",           0, 1, Access::offline_only, "New_GC_Command 0 only for a changed Global_Control, 1 for each"},
};
inline constexpr Field kMode3[]{
    {"Reserved",        2, 6, Access::reserved,     "write 0"},
    {"DX_Int_Mode_2",   1, 1, Access::offline_only, "1: DX_Out only when the octets received differ from the U buffer"},
    {"GC_Int_Mode_Ext", 0, 1, Access::offline_only, "with GC_Int_Mode = 0: 0 a changed telegram counts, 1 only a changed Control_Command"},
};
inline constexpr Field kBufferSm[]{
    {"F", 6, 2, Access::ro, "number of the free buffer, 0 none"},
    {"U", 4, 2, Access::ro, "number of the user's buffer"},
    {"N", 2, 2, Access::ro, "number of the next buffer, 0 none"},
    {"D", 0, 2, Access::ro, "number of the buffer the chip works with"},
};
inline constexpr Field kNewDinBufferCmd[]{{"U_Buffer", 0, 2, Access::command, "the U buffer goes to N; number of the new U buffer"}};
inline constexpr Field kNextDoutBufferCmd[]{
    {"U_Buffer_Cleared", 3, 1, Access::command, "1: the U buffer was cleared, not received"},
    {"State_U_Buffer",   2, 1, Access::command, "1: the U buffer is new"},
    {"Ind_U_Buffer",     0, 2, Access::command, "N goes to U if there is one; number of the U buffer"},
};
inline constexpr Field kNextDxboutBufferCmd[]{
    {"State_U_Buffer", 2, 1, Access::command, "1: the U buffer is new"},
    {"Ind_U_Buffer",   0, 2, Access::command, "N goes to U if there is one; number of the U buffer"},
};
inline constexpr Field kDiagBufferSm[]{
    {"Diag_Buf2", 2, 2, Access::ro, "owner of buffer 2: 00 Nil, 01 User, 10 VPC3+, 11 VPC3_Send_Mode"},
    {"Diag_Buf1", 0, 2, Access::ro, "owner of buffer 1: 00 Nil, 01 User, 10 VPC3+, 11 VPC3_Send_Mode"},
};
inline constexpr Field kNewDiagBufferCmd[]{{"User_Buffer", 0, 2, Access::command, "hands the user's buffer over; number of the new one, 0 while the exchange has to wait"}};
inline constexpr Field kPrmOkay[]{{"Answer", 0, 2, Access::command, "accepts the data; 00 User_Prm_Finished, 01 Prm_Conflict, 11 Not_Allowed"}};
inline constexpr Field kPrmNotOkay[]{{"Answer", 0, 2, Access::command, "refuses the data; 00 User_Prm_Finished, 01 Prm_Conflict, 11 Not_Allowed"}};
inline constexpr Field kCfgOkay[]{{"Answer", 0, 2, Access::command, "accepts the data; 00 User_Cfg_Finished, 01 Cfg_Conflict, 11 Not_Allowed"}};
inline constexpr Field kCfgNotOkay[]{{"Answer", 0, 2, Access::command, "refuses the data; 00 User_Cfg_Finished, 01 Cfg_Conflict, 11 Not_Allowed"}};
inline constexpr Field kSsaFree[]{{"Free", 0, 8, Access::command, "the SSA_Buf is free again; reads 00H"}};
inline constexpr Field kBaudControl[]{{"WD_BAUD_CONTROL_Val", 0, 8, Access::wo, "V: the baud rate is watched for V * V * 10 ms"}};
inline constexpr Field kMinTsdr[]{{"minTSDR_Val", 0, 8, Access::wo, "least time before an answer, in bit times; below 11 acts as 11"}};
inline constexpr Field kSyncPw[]{{"Sync_PW", 0, 8, Access::wo, "width of the SYNC pulse in 1/12 us"}};
inline constexpr Field kControlCommand[]{{"Control_Command", 0, 8, Access::wo, "a SYNCH telegram has this Control_Command"}};
inline constexpr Field kGroupSelect[]{{"Group_Select", 0, 8, Access::wo, "a SYNCH telegram has this Group_Select"}};

}  // namespace fields

/// 00H..15H. Rows of one address and direction differ in their variants.
inline constexpr Reg kControlParameters[]{
    {0x00, Dir::read,  "Int-Req-Reg 7..0",       "5.3.1", 0x00, Effect::irr_low,     fields::kInterruptLowRo},
    {0x01, Dir::read,  "Int-Req-Reg 15..8",      "5.3.1", 0x00, Effect::irr_high,    fields::kInterruptHighRo},
    {0x02, Dir::read,  "Int-Reg 7..0",           "5.3.2", 0x00, Effect::ir_low,      fields::kInterruptLowRo},
    {0x03, Dir::read,  "Int-Reg 15..8",          "5.3.2", 0x00, Effect::ir_high,     fields::kInterruptHighRo},
    {0x04, Dir::read,  "Status-Reg 7..0",        "5.2",   0x00, Effect::status_low,  fields::kStatusLow},
    {0x05, Dir::read,  "Status-Reg 15..8",       "5.2",   0xCF, Effect::status_high, fields::kStatusHigh},
    {0x06, Dir::read,  "Mode-Reg0 7..0",         "5.1.1", 0x00, Effect::mode0_low,   fields::kMode0Low,  kVpc3},
    {0x07, Dir::read,  "Mode-Reg0 15..8",        "5.1.1", 0x00, Effect::mode0_high,  fields::kMode0High, kVpc3},
    {0x08, Dir::read,  "Din_Buffer_SM",          "6.2.5", 0xE1, Effect::din_buffer_sm,          fields::kBufferSm},
    {0x09, Dir::read,  "New_Din_Buffer_Cmd",     "6.2.5", 0x00, Effect::new_din_buffer_cmd,     fields::kNewDinBufferCmd},
    {0x0A, Dir::read,  "Dout_Buffer_SM",         "6.2.5", 0xE1, Effect::dout_buffer_sm,         fields::kBufferSm},
    {0x0B, Dir::read,  "Next_Dout_Buffer_Cmd",   "6.2.5", 0x00, Effect::next_dout_buffer_cmd,   fields::kNextDoutBufferCmd},
    {0x0C, Dir::read,  "Diag_Buffer_SM",         "6.2.4", 0x09, Effect::diag_buffer_sm,         fields::kDiagBufferSm},
    {0x0D, Dir::read,  "New_Diag_Buffer_Cmd",    "6.2.4", 0x00, Effect::new_diag_buffer_cmd,    fields::kNewDiagBufferCmd},
    {0x0E, Dir::read,  "User_Prm_Data_Okay",     "6.2.2", 0x00, Effect::user_prm_data_okay,     fields::kPrmOkay},
    {0x0F, Dir::read,  "User_Prm_Data_Not_Okay", "6.2.2", 0x00, Effect::user_prm_data_not_okay, fields::kPrmNotOkay},
    {0x10, Dir::read,  "User_Cfg_Data_Okay",     "6.2.3", 0x00, Effect::user_cfg_data_okay,     fields::kCfgOkay},
    {0x11, Dir::read,  "User_Cfg_Data_Not_Okay", "6.2.3", 0x00, Effect::user_cfg_data_not_okay, fields::kCfgNotOkay},
    {0x12, Dir::read,  "DXBout_Buffer_SM",       "7.3.1", 0xE1, Effect::dxbout_buffer_sm,       fields::kBufferSm, kStepBC},
    {0x13, Dir::read,  "Next_DXBout_Buffer_Cmd", "7.3.1", 0x00, Effect::next_dxbout_buffer_cmd, fields::kNextDxboutBufferCmd, kStepBC},
    {0x14, Dir::read,  "SSA_Buffer_Free_Cmd",    "6.2.1", 0x00, Effect::ssa_buffer_free_cmd,    fields::kSsaFree},
    {0x15, Dir::read,  "Mode-Reg1",              "5.1.2", 0x00, Effect::mode1,                  fields::kMode1Read, kVpc3},

    {0x00, Dir::write, "Int-Req-Reg 7..0",       "5.3.1", 0x00, Effect::irr_set_low,      fields::kInterruptLowSet},
    {0x01, Dir::write, "Int-Req-Reg 15..8",      "5.3.1", 0x00, Effect::irr_set_high,     fields::kInterruptHighSet},
    {0x02, Dir::write, "Int-Ack-Reg 7..0",       "5.3.2", 0x00, Effect::iar_low,          fields::kInterruptLowAck},
    {0x03, Dir::write, "Int-Ack-Reg 15..8",      "5.3.2", 0x00, Effect::iar_high,         fields::kInterruptHighAck},
    {0x04, Dir::write, "IntMask-Reg 7..0",       "5.3.2", 0xFF, Effect::imr_low,          fields::kInterruptLowMask},
    {0x05, Dir::write, "IntMask-Reg 15..8",      "5.3.2", 0xFF, Effect::imr_high,         fields::kInterruptHighMask},
    {0x06, Dir::write, "Mode-Reg0 7..0",         "5.1.1", 0x00, Effect::mode0_write_low,  fields::kMode0Low},
    {0x07, Dir::write, "Mode-Reg0 15..8",        "5.1.1", 0x00, Effect::mode0_write_high, fields::kMode0High},
    {0x08, Dir::write, "Mode-Reg1-S",            "5.1.2", 0x00, Effect::mode1_set,        fields::kMode1Set},
    {0x09, Dir::write, "Mode-Reg1-R",            "5.1.2", 0x00, Effect::mode1_reset,      fields::kMode1Reset},
    {0x0A, Dir::write, "WD_BAUD_CONTROL_Val",    "5.4.2", 0x10, Effect::wd_baud_control_val, fields::kBaudControl},
    {0x0B, Dir::write, "minTSDR_Val",            "4.2",   0x0B, Effect::min_tsdr_val,     fields::kMinTsdr},
    {0x0C, Dir::write, "Mode-Reg2",              "5.1.3", 0x01, Effect::mode2_write,      fields::kMode2, kVpc3},
    {0x0D, Dir::write, "Sync_PW_Reg",            "7.3.2", 0x00, Effect::sync_pw,          fields::kSyncPw, kStepBC},
    {0x0E, Dir::write, "Control_Command_Reg",    "7.3.2", 0x00, Effect::control_command,  fields::kControlCommand, kStepBC},
    {0x0F, Dir::write, "Group_Select_Reg",       "7.3.2", 0x00, Effect::group_select,     fields::kGroupSelect, kStepBC},
    {0x12, Dir::write, "Mode-Reg3",              "5.1.4", 0x00, Effect::mode3_write,      fields::kMode3, kStepBC},
};
// clang-format on
static_assert(well_formed(kControlParameters));

/// One effect for each address 00H..3FH. From 16H on the cells are RAM; the table says Effect::reserved there.
using DecodeTable = std::array<Effect, 64>;

consteval DecodeTable make_decode_table(Variant variant, Dir dir) {
    DecodeTable table{};
    for (const Reg& reg : kControlParameters)
        if (reg.dir == dir && reg.variants.has(variant)) table[reg.address] = reg.effect;
    return table;
}

inline constexpr std::array<std::array<DecodeTable, 2>, kVariants> kDecode = [] {
    std::array<std::array<DecodeTable, 2>, kVariants> all{};
    for (std::size_t v = 0; v < kVariants; ++v) {
        for (const Reg& reg : kControlParameters)
            if (reg.variants.has(static_cast<Variant>(v))) all[v][static_cast<std::size_t>(reg.dir)][reg.address] = reg.effect;
    }
    return all;
}();

/// The decode table of one variant and direction: what the chip holds on to at construction.
constexpr const DecodeTable& index(Variant variant, Dir dir) {
    return kDecode[static_cast<std::size_t>(variant)][static_cast<std::size_t>(dir)];
}
static_assert(index(Variant::vpc3c, Dir::write) == make_decode_table(Variant::vpc3c, Dir::write));

/// What an access to the Intel address 00H..15H does; Effect::reserved for every other address.
constexpr Effect effect(Variant variant, Dir dir, std::uint16_t address) {
    return address < 64 ? index(variant, dir)[address] : Effect::reserved;
}

/// The register at an Intel address, or null: reserved, or RAM.
constexpr const Reg* find(Variant variant, Dir dir, std::uint16_t address) {
    for (const Reg& reg : kControlParameters)
        if (reg.address == address && reg.dir == dir && reg.variants.has(variant)) return &reg;
    return nullptr;
}

/// True when reading the address acts: debuggers and views must not read there, only peek.
constexpr bool read_acts(Variant variant, std::uint16_t address) {
    const Reg* reg = find(variant, Dir::read, address);
    return reg != nullptr && !reg->fields.empty() && reg->fields.front().access == Access::command;
}

/// The value after RESET as the table's variant sees it, where Traits differ from VPC3+C.
constexpr std::uint8_t reset_value(Variant variant, const Reg& reg) {
    const Traits& t = traits(variant);
    if (reg.effect == Effect::status_high) return static_cast<std::uint8_t>(t.release << 4 | 0x0F);
    if (reg.effect == Effect::wd_baud_control_val) return t.baud_control_reset;
    if (reg.effect == Effect::min_tsdr_val) return t.min_tsdr_reset;
    if (reg.effect == Effect::mode0_write_low) return t.dis_start_reset ? 0x01 : 0x00;
    return reg.reset;
}

}  // namespace dpchip::regmap
