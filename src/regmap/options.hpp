// SPDX-License-Identifier: Apache-2.0
// Options of the model: every `cfg:` decision of the engineering reference (9.1), one table for C++, C, TOML and --show-options.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <dpchip/core/result.hpp>

namespace dpchip::regmap {

/// Answer to Data_Exchange with a wrong output length (reference 3.8).
enum class DxLenErrorAnswer : std::uint8_t { by_case, inputs, rr };
/// Answer to Data_Exchange while Diag_Flag is set and there are no inputs (3.8).
enum class DhWithoutInputs : std::uint8_t { dummy_octet, sd1, sc };
/// Answer to Ident and LSAP status requests (2.2).
enum class IdentLsapAnswer : std::uint8_t { rs, none };
/// RAM after a hardware RESET (4.8).
enum class RamAfterReset : std::uint8_t { keep, zero, ones };

struct Options {
    std::uint8_t start_window_samples = 1;   ///< quarter-bit samples a start bit may come early or late inside a telegram
    std::uint16_t allow_gap_tbits = 0;       ///< idle bit times tolerated inside a telegram with Dis_Start_Control = 0
    std::uint16_t rts_lead_clk = 4;          ///< RTS before the first start bit, in CLK
    std::uint16_t rts_trail_clk = 4;         ///< RTS after the last stop bit, in CLK
    std::uint32_t t_proc_clk = 144;          ///< processing time before an answer, in CLK
    std::array<std::uint32_t, 10> baud_probe_ms{};  ///< per rate, fastest first; 0: max(100 ms, 6000 tBit)
    std::uint8_t initial_din_sm = 0xE1;      ///< Din_Buffer_SM before and after Start
    std::uint8_t initial_dout_sm = 0xE1;     ///< Dout_Buffer_SM before Start; Start clears D and shifts it
    std::uint8_t initial_dxb_sm = 0xE1;
    std::uint8_t initial_diag_sm = 0x09;
    DxLenErrorAnswer dx_len_error_answer = DxLenErrorAnswer::by_case;
    DhWithoutInputs dh_without_inputs = DhWithoutInputs::dummy_octet;
    bool gc_reserved_sets_not_supported = false;
    bool gc_requires_prm_req = false;
    bool gc_triggers_wd = false;
    bool quirk_keep_master_add = false;
    bool leave_master_stops_wd = true;
    bool apc3_reset_dis_start = true;
    IdentLsapAnswer ident_lsap_answer = IdentLsapAnswer::rs;
    std::uint16_t sync_pulse_delay_clk = 4;  ///< SYNC pulse after the end of the SYNCH telegram, in CLK
    RamAfterReset ram_after_reset = RamAfterReset::keep;
};

enum class OptionError : std::uint8_t {
    unknown_name,  ///< no option of that name
    bad_value,     ///< not a number, or none of the words the option takes
    out_of_range,  ///< a number, but not one that the option takes
};

/// One row of the table that --show-options prints.
struct OptionInfo {
    std::string_view name;
    std::string_view values;        ///< "0..255", "true|false", "dummy_octet|sd1|sc", "ms[,ms...]"
    std::string_view default_text;
    std::string_view section;       ///< of the engineering reference
    std::string_view meaning;
};
std::span<const OptionInfo> option_table();

/// Sets one option from its text. Numbers are decimal or 0x..; baud_probe_ms takes one number for all rates or ten, comma-separated.
core::Result<bool, OptionError> set_option(Options& options, std::string_view name, std::string_view text);

}  // namespace dpchip::regmap
