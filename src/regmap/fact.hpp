// SPDX-License-Identifier: Apache-2.0
// The facts a chip traces and the rules its findings name: numbers with words, so that trace/ needs no chip to render them.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include <dpchip/core/finding.hpp>

namespace dpchip::regmap {

/// `what` of a chip's TraceRecord. `a` and `b` as the comments say.
enum class Fact : std::uint16_t {
    reset,             ///< hardware RESET
    cpu_read,          ///< a: address, b: value read
    cpu_write,         ///< a: address, b: value written
    irr,               ///< a: IRR before, b: after
    x_int,             ///< b: level of the pin (0, 1)
    rts,               ///< b: level
    xdataexch_sync,    ///< b: level of pin 13
    passive_idle,      ///< b: 0 Offline, 1 Passive_Idle
    dp_state,          ///< a: DP_State before, b: after (Status coding)
    wd_state,          ///< a: WD_State before, b: after (Status coding)
    baud,              ///< b: baud code; 15 while searching
    baud_probe,        ///< b: code of the rate being tried
    heard,             ///< a: DA << 8 | SA (raw), b: FC << 24 | DSAP << 16 | SSAP << 8 | data octets (SAP 255: none)
    proof,             ///< a telegram proved the baud rate; as heard
    retry,             ///< the frame count bit says: a repetition
    rejected,          ///< a: fdl::Reject, b: octets received so far
    answer,            ///< a: FC (E5 for SC) << 8 | DA, b: octets; at the first start bit
    answer_end,        ///< end of the last stop bit of an answer
    answer_given_up,   ///< somebody else sent before the answer began
    din_buffer_sm,     ///< a: before, b: after
    dout_buffer_sm,    ///< a: before, b: after
    dxbout_buffer_sm,  ///< a: before, b: after
    diag_buffer_sm,    ///< a: before, b: after
    diag_flag,         ///< b: 0, 1
    exchange,          ///< aux buffer exchanged; a: service (SAP), b: segment now in the aux pointer << 8 | in the target pointer
    prm_counter,       ///< b: Set_Prm telegrams not yet acknowledged
    cfg_counter,       ///< b: Chk_Cfg telegrams not yet acknowledged
    leave_master,      ///< a: LeaveCause
    user_wd,           ///< b: User_WD_Timer after a Data_Exchange
    sync_mode,         ///< b: 0, 1
    freeze_mode,       ///< b: 0, 1
    station_address,   ///< b: the address from now on
    finding,           ///< a: Rule, b: detail
    pin_finding,       ///< a: PinRule, b: detail
    ram_wait,          ///< b: CLK periods that the Micro Sequencer has waited for the RAM since power-on (8.2)
    count
};

/// Why the DP_SM went back to WAIT-PRM (reference 3.11).
enum class LeaveCause : std::uint8_t {
    unlock, faulty_set_prm, prm_not_okay, cfg_not_okay, output_length, wd_timeout, user_wd, user_leave_master,
    empty_chk_cfg, go_offline,
};

/// What a finding is about.
enum class Rule : std::uint16_t {
    mode_reg_online,        ///< Mode Register 0, 2 or 3 written outside Offline; ignored. detail: address
    reserved_write,         ///< a reserved control parameter was written; ignored. detail: address
    ram_access_violation,   ///< APC3, SPC3: address beyond the RAM. detail: address
    acknowledge_not_allowed,///< 0EH..11H read with nothing to acknowledge. detail: address
    iar_protected,          ///< IAR written with a bit only an acknowledgement clears. detail: bits
    buffers_overlap,        ///< Start with buffers that overlap. detail: address of the overlap
    buffer_in_registers,    ///< Start with a buffer pointer below 40H. detail: pointer cell
    no_aux1,                ///< Start without Aux-Buffer 1
    ts_out_of_range,        ///< Start with R_TS_Adr above 126. detail: address
    no_dp_mode,             ///< Start with DP_Mode = 0
    watchdog_1_by_1,        ///< Set_Prm with WD_Fact_1 = WD_Fact_2 = 1, which 5.4.3 forbids
    diag_length,            ///< R_Len_Diag_Buf below 6, taken as 6. detail: length
    wd_test,                ///< APC3: WD_Test = 1 has no function
    answer_lost,            ///< an answer was due while the line was taken
    count
};

struct RuleInfo {
    Rule rule;
    core::FindingKind kind;
    std::string_view name, text;
};

// clang-format off
inline constexpr std::array<RuleInfo, static_cast<std::size_t>(Rule::count)> kRules{{
    {Rule::mode_reg_online,         core::FindingKind::misuse,     "mode_reg_online",         "Mode Register 0, 2 or 3 written outside Offline: ignored (5.1)"},
    {Rule::reserved_write,          core::FindingKind::unusual,    "reserved_write",          "reserved control parameter written: ignored (figure 4-3)"},
    {Rule::ram_access_violation,    core::FindingKind::misuse,     "ram_access_violation",    "address beyond the RAM: 400H subtracted, the chip goes Offline (APC3 3.1)"},
    {Rule::acknowledge_not_allowed, core::FindingKind::unusual,    "acknowledge_not_allowed", "acknowledged Prm or Cfg data with none pending (6.2.2, 6.2.3)"},
    {Rule::iar_protected,           core::FindingKind::unusual,    "iar_protected",           "IAR does not clear New_Prm_Data, New_Ext_Prm_Data and New_Cfg_Data (5.3.2)"},
    {Rule::buffers_overlap,         core::FindingKind::misuse,     "buffers_overlap",         "two buffers share RAM (4.1)"},
    {Rule::buffer_in_registers,     core::FindingKind::misuse,     "buffer_in_registers",     "a buffer lies below 40H (4.1)"},
    {Rule::no_aux1,                 core::FindingKind::misuse,     "no_aux1",                 "Aux-Buffer 1 must always be available (6.1)"},
    {Rule::ts_out_of_range,         core::FindingKind::misuse,     "ts_out_of_range",         "R_TS_Adr above 126 never matches (reference 4.8)"},
    {Rule::no_dp_mode,              core::FindingKind::unusual,    "no_dp_mode",              "started with DP_Mode = 0: the DP SAPs answer RS (5.1.1)"},
    {Rule::watchdog_1_by_1,         core::FindingKind::unusual,    "watchdog_1_by_1",         "WD_Fact_1 = WD_Fact_2 = 1 is not allowed (5.4.3)"},
    {Rule::diag_length,             core::FindingKind::misuse,     "diag_length",             "R_Len_Diag_Buf below 6 is taken as 6 (reference 4.6)"},
    {Rule::wd_test,                 core::FindingKind::misuse,     "wd_test",                 "WD_Test must be 0 (APC3 4.1.1)"},
    {Rule::answer_lost,             core::FindingKind::unusual,    "answer_lost",             "an answer was given up because another station sent first (reference 4.13)"},
}};
// clang-format on
static_assert([] {
    for (std::size_t i = 0; i < kRules.size(); ++i)
        if (kRules[i].rule != static_cast<Rule>(i)) return false;
    return true;
}());

}  // namespace dpchip::regmap
