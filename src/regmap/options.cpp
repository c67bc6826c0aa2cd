// SPDX-License-Identifier: Apache-2.0
// The option table: name, range, default, meaning and setter of each option in one row (engineering reference 9.1).
#include <dpchip/regmap/options.hpp>

#include <charconv>
#include <limits>
#include <system_error>
#include <type_traits>

namespace dpchip::regmap {
namespace {

using Set = core::Result<bool, OptionError>;

struct Row {
    OptionInfo info;
    Set (*set)(Options&, std::string_view);
};

/// A whole text that is one number: decimal, or hexadecimal after 0x.
core::Result<std::uint64_t, OptionError> parse_number(std::string_view text) {
    int base = 10;
    if (text.starts_with("0x") || text.starts_with("0X")) {
        base = 16;
        text.remove_prefix(2);
    }
    std::uint64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value, base);
    if (error == std::errc::result_out_of_range) return OptionError::out_of_range;
    if (error != std::errc{} || stop != end) return OptionError::bad_value;
    return value;
}

template <auto Member, std::uint64_t Min, std::uint64_t Max>
Set number(Options& options, std::string_view text) {
    using T = std::remove_reference_t<decltype(options.*Member)>;
    static_assert(Max <= std::numeric_limits<T>::max());
    const auto value = parse_number(text);
    if (!value) return value.error();
    if (*value < Min || *value > Max) return OptionError::out_of_range;
    options.*Member = static_cast<T>(*value);
    return true;
}

template <auto Member>
Set boolean(Options& options, std::string_view text) {
    if (text == "true" || text == "on" || text == "1") options.*Member = true;
    else if (text == "false" || text == "off" || text == "0") options.*Member = false;
    else return OptionError::bad_value;
    return true;
}

/// `Words` in the order of the enumerators, separated by '|': the same text that the table shows.
template <auto Member, const char* Words>
Set word(Options& options, std::string_view text) {
    using T = std::remove_reference_t<decltype(options.*Member)>;
    std::string_view rest = Words;
    for (std::uint8_t i = 0; !text.empty(); ++i) {
        const std::size_t bar = rest.find('|');
        if (rest.substr(0, bar) == text) {
            options.*Member = static_cast<T>(i);
            return true;
        }
        if (bar == std::string_view::npos) break;
        rest.remove_prefix(bar + 1);
    }
    return OptionError::bad_value;
}

/// Buffers 1 to 3 each in one place, U and D never without one, and N or F empty (reference 4.5).
constexpr bool valid_three_buffer_sm(unsigned sm) {
    unsigned seen = 0;
    for (unsigned shift = 0; shift < 8; shift += 2) seen |= 1u << ((sm >> shift) & 3u);
    return sm <= 0xFF && seen == 0xF && ((sm >> 4) & 3u) != 0 && (sm & 3u) != 0;
}

template <auto Member>
Set three_buffer_sm(Options& options, std::string_view text) {
    const auto value = parse_number(text);
    if (!value) return value.error();
    if (*value > 0xFF || !valid_three_buffer_sm(static_cast<unsigned>(*value))) return OptionError::out_of_range;
    options.*Member = static_cast<std::uint8_t>(*value);
    return true;
}

Set diag_sm(Options& options, std::string_view text) {
    const auto value = parse_number(text);
    if (!value) return value.error();
    if (*value != 0x09 && *value != 0x06) return OptionError::out_of_range;
    options.initial_diag_sm = static_cast<std::uint8_t>(*value);
    return true;
}

/// One number for all rates, or ten of them, fastest rate first.
Set baud_probe_ms(Options& options, std::string_view text) {
    constexpr std::uint64_t kHour = 3'600'000;
    std::array<std::uint32_t, 10> times{};
    std::size_t count = 0;
    for (;;) {
        if (count == times.size()) return OptionError::bad_value;
        const std::size_t comma = text.find(',');
        const auto value = parse_number(text.substr(0, comma));
        if (!value) return value.error();
        if (*value > kHour) return OptionError::out_of_range;
        times[count++] = static_cast<std::uint32_t>(*value);
        if (comma == std::string_view::npos) break;
        text.remove_prefix(comma + 1);
    }
    if (count == 1) times.fill(times[0]);
    else if (count != times.size()) return OptionError::bad_value;
    options.baud_probe_ms = times;
    return true;
}

constexpr char kDxLenWords[] = "by_case|inputs|rr";
constexpr char kDhWords[] = "dummy_octet|sd1|sc";
constexpr char kIdentWords[] = "rs|none";
constexpr char kRamWords[] = "keep|zero|ones";
constexpr char kBool[] = "true|false";

using O = Options;
// clang-format off
constexpr Row kRows[]{
    {{"start_window_samples", "0..3", "1", "1.3", "quarter-bit samples that a start bit inside a telegram may come early or late"}, number<&O::start_window_samples, 0, 3>},
    {{"allow_gap_tbits", "0..65535", "0", "1.3", "idle bit times tolerated inside a telegram while Dis_Start_Control is 0"}, number<&O::allow_gap_tbits, 0, 65535>},
    {{"rts_lead_clk", "0..65535", "4", "1.5", "RTS comes this many CLK before the first start bit"}, number<&O::rts_lead_clk, 0, 65535>},
    {{"rts_trail_clk", "0..65535", "4", "1.5", "RTS stays this many CLK after the last stop bit"}, number<&O::rts_trail_clk, 0, 65535>},
    {{"t_proc_clk", "0..48000000", "144", "1.6", "processing time before an answer, in CLK"}, number<&O::t_proc_clk, 0, 48'000'000>},
    {{"baud_probe_ms", "ms[,ms...]", "0", "4.10", "time spent on a baud rate while searching: one number, or ten from 12M to 9.6k; 0: max(100 ms, 6000 tBit)"}, baud_probe_ms},
    {{"initial_din_sm", "buffer states", "0xE1", "4.5", "Din_Buffer_SM before and after Start"}, three_buffer_sm<&O::initial_din_sm>},
    {{"initial_dout_sm", "buffer states", "0xE1", "4.5", "Dout_Buffer_SM before Start, which clears D and shifts it"}, three_buffer_sm<&O::initial_dout_sm>},
    {{"initial_dxb_sm", "buffer states", "0xE1", "4.5", "DXBout_Buffer_SM before and after Start"}, three_buffer_sm<&O::initial_dxb_sm>},
    {{"initial_diag_sm", "0x06|0x09", "0x09", "4.6", "Diag_Buffer_SM before and after Start"}, diag_sm},
    {{"dx_len_error_answer", kDxLenWords, "by_case", "3.8", "answer to Data_Exchange with a wrong output length; by_case: too short inputs, too long RR"}, word<&O::dx_len_error_answer, kDxLenWords>},
    {{"dh_without_inputs", kDhWords, "dummy_octet", "3.8", "answer while Diag_Flag is set and there are no inputs"}, word<&O::dh_without_inputs, kDhWords>},
    {{"gc_reserved_sets_not_supported", kBool, "false", "3.9", "reserved bits of Global_Control set Not_Supported"}, boolean<&O::gc_reserved_sets_not_supported>},
    {{"gc_requires_prm_req", kBool, "false", "3.9", "Sync and Freeze only work when Set_Prm asked for them"}, boolean<&O::gc_requires_prm_req>},
    {{"gc_triggers_wd", kBool, "false", "4.10", "a Global_Control of the owner restarts the watchdog"}, boolean<&O::gc_triggers_wd>},
    {{"quirk_keep_master_add", kBool, "false", "3.12", "the diagnosis keeps the old Master_Add after a configuration fault"}, boolean<&O::quirk_keep_master_add>},
    {{"leave_master_stops_wd", kBool, "true", "3.12", "LEAVE-MASTER takes the WD_SM to BAUD_CONTROL"}, boolean<&O::leave_master_stops_wd>},
    {{"apc3_reset_dis_start", kBool, "true", "3.4.1", "Dis_Start_Control of an APC3 is 1 after reset"}, boolean<&O::apc3_reset_dis_start>},
    {{"ident_lsap_answer", kIdentWords, "rs", "2.2", "answer to Ident and LSAP status requests"}, word<&O::ident_lsap_answer, kIdentWords>},
    {{"sync_pulse_delay_clk", "0..65535", "4", "6.2", "SYNC pulse this many CLK after the end of the SYNCH telegram"}, number<&O::sync_pulse_delay_clk, 0, 65535>},
    {{"ram_after_reset", kRamWords, "keep", "4.8", "RAM after a hardware RESET"}, word<&O::ram_after_reset, kRamWords>},
};
// clang-format on

constexpr auto kInfos = [] {
    std::array<OptionInfo, std::size(kRows)> infos{};
    for (std::size_t i = 0; i < infos.size(); ++i) infos[i] = kRows[i].info;
    return infos;
}();

}  // namespace

std::span<const OptionInfo> option_table() { return kInfos; }

core::Result<bool, OptionError> set_option(Options& options, std::string_view name, std::string_view text) {
    for (const Row& row : kRows)
        if (row.info.name == name) return row.set(options, text);
    return OptionError::unknown_name;
}

}  // namespace dpchip::regmap
