// SPDX-License-Identifier: Apache-2.0
// Facts in the manual's words.
#include <array>

#include <dpchip/core/bits.hpp>
#include <dpchip/dp/saps.hpp>
#include <dpchip/fdl/function_code.hpp>
#include <dpchip/fdl/telegram.hpp>
#include <dpchip/regmap/address.hpp>
#include <dpchip/regmap/interrupts.hpp>
#include <dpchip/regmap/names.hpp>
#include <dpchip/trace/fact_text.hpp>
#include <dpchip/trace/pin_finding_text.hpp>
#include <dpchip/trace/text.hpp>

namespace dpchip::trace {
namespace {

using core::TraceRecord;
using regmap::Dir;
using regmap::Fact;
using regmap::Variant;

constexpr std::array<const char*, static_cast<std::size_t>(Fact::count)> kNames{
    "reset",           "cpu_read",      "cpu_write",       "irr",           "x_int",        "rts",
    "xdataexch_sync",  "passive_idle",  "dp_state",        "wd_state",      "baud",         "baud_probe",
    "heard",           "proof",         "retry",           "rejected",      "answer",       "answer_end",
    "answer_given_up", "Din_Buffer_SM", "Dout_Buffer_SM",  "DXBout_Buffer_SM", "Diag_Buffer_SM", "diag_flag",
    "exchange",        "prm_counter",   "cfg_counter",     "leave_master",  "user_wd",      "sync_mode",
    "freeze_mode",     "station_address", "finding",     "pin_finding",   "ram_wait"};
static_assert(kNames.back() != nullptr, "every fact has a name");

constexpr std::array<const char*, 10> kCauses{"unlock", "faulty Set_Prm", "User_Prm_Data_Not_Okay", "User_Cfg_Data_Not_Okay",
    "output length", "watchdog", "User_WD_Timer", "User_LEAVE-MASTER", "empty Chk_Cfg", "Go_Offline"};

const char* dp_state(std::uint32_t state) {
    constexpr const char* kStates[]{"WAIT-PRM", "WAIT-CFG", "DATA-EXCH"};
    return state < 3 ? kStates[state] : "?";
}

const char* wd_state(std::uint32_t state) {
    constexpr const char* kStates[]{"BAUD_SEARCH", "BAUD_CONTROL", "DP_CONTROL"};
    return state < 3 ? kStates[state] : "?";
}

std::string rate(std::uint32_t code) {
    return code < fdl::kBaudRates ? std::string{fdl::kBaud[code].name} : std::string{"searching"};
}

std::string change(const std::string& before, const std::string& after) { return before + " -> " + after; }

/// " (F=3 U=2 N=0 D=1)" of the register at `address`.
std::string fields(Variant variant, std::uint16_t address, std::uint32_t value) {
    const regmap::Reg* reg = regmap::find(variant, Dir::read, address);
    std::string words;
    if (reg == nullptr) return words;
    for (const regmap::Field& field : reg->fields)
        if (field.variants.has(variant) && field.access != regmap::Access::reserved)
            add_word(words, std::string{field.name} + '=' + std::to_string(core::slice(value, field.lsb, field.width)), " ");
    return words.empty() ? words : " (" + words + ')';
}

std::string buffer_sm(Variant variant, std::uint16_t address, const TraceRecord& r) {
    return change(hex_number(r.a), hex_number(r.b)) + fields(variant, address, r.b);
}

std::string access(Variant variant, Dir dir, const TraceRecord& r) {
    return hex_number(r.a, 3) + ' ' + std::string{regmap::name(variant, dir, r.a)} + " = " + hex_number(r.b);
}

std::string interrupts(Variant variant, bool clock_sync, const TraceRecord& r) {
    std::string words = change(hex_number(r.a, 4), hex_number(r.b, 4));
    for (unsigned bit = 0; bit < 16; ++bit) {
        if (core::bit(r.a, bit) == core::bit(r.b, bit)) continue;
        const std::string_view name = bit == 0 && clock_sync ? regmap::kClockSync.name : regmap::interrupt_name(variant, bit);
        words += core::bit(r.b, bit) ? " +" : " -";
        words += name.empty() ? "bit " + std::to_string(bit) : std::string{name};
    }
    return words;
}

std::string telegram(const TraceRecord& r) {
    const fdl::FunctionCode fc{static_cast<std::uint8_t>(r.b >> 24)};
    const auto dsap = static_cast<std::uint8_t>(r.b >> 16), ssap = static_cast<std::uint8_t>(r.b >> 8);
    std::string words = std::to_string(r.a & 0x7Fu) + "->" + std::to_string((r.a >> 8) & 0x7Fu) + " FC " + hex_number(fc.octet);
    if (fc.clock_value()) words += " Clock_Value";
    else if (fc.is_request()) words += std::string{" "} + fdl::name(fc.request());
    else words += std::string{" "} + fdl::name(fc.response());
    if (dsap != 0xFF) words += std::string{" DSAP "} + std::to_string(dsap) + ' ' + (fc.is_request() ? dp::name(dp::service(dsap)) : "");
    if (words.back() == ' ') words.pop_back();
    if (ssap != 0xFF) words += std::string{" SSAP "} + std::to_string(ssap);
    return words + ", " + std::to_string(r.b & 0xFFu) + " octets";
}

std::string answer(const TraceRecord& r) {
    const auto fc = static_cast<std::uint8_t>(r.a >> 8);
    if (fc == fdl::kSc) return "SC";
    return std::string{fdl::name(fdl::FunctionCode{fc}.response())} + " to " + std::to_string(r.a & 0x7Fu) + ", " + std::to_string(r.b) + " octets";
}

std::string finding(const TraceRecord& r) {
    if (r.a >= regmap::kRules.size()) return std::string{"rule "} + std::to_string(r.a);
    const regmap::RuleInfo& rule = regmap::kRules[r.a];
    return std::string{rule.name} + ' ' + hex_number(r.b, 4) + ": " + std::string{rule.text};
}

std::string value_words(const TraceRecord& r, Variant variant, bool clock_sync) {
    namespace control = regmap::control;
    switch (static_cast<Fact>(r.what)) {
    case Fact::reset:
    case Fact::retry:
    case Fact::answer_end:
    case Fact::answer_given_up: return {};
    case Fact::cpu_read: return access(variant, Dir::read, r);
    case Fact::cpu_write: return access(variant, Dir::write, r);
    case Fact::irr: return interrupts(variant, clock_sync, r);
    case Fact::x_int:
    case Fact::rts:
    case Fact::xdataexch_sync: return r.b != 0 ? "high" : "low";
    case Fact::passive_idle: return r.b != 0 ? "Passive_Idle" : "Offline";
    case Fact::dp_state: return change(dp_state(r.a), dp_state(r.b));
    case Fact::wd_state: return change(wd_state(r.a), wd_state(r.b));
    case Fact::baud:
    case Fact::baud_probe: return rate(r.b);
    case Fact::heard:
    case Fact::proof: return telegram(r);
    case Fact::rejected:
        return std::string{r.a <= core::to_underlying(fdl::Reject::collision) ? fdl::name(static_cast<fdl::Reject>(r.a)) : "?"} + " after " +
               std::to_string(r.b) + " octets";
    case Fact::answer: return answer(r);
    case Fact::din_buffer_sm: return buffer_sm(variant, control::din_buffer_sm, r);
    case Fact::dout_buffer_sm: return buffer_sm(variant, control::dout_buffer_sm, r);
    case Fact::dxbout_buffer_sm: return buffer_sm(variant, control::dxbout_buffer_sm, r);
    case Fact::diag_buffer_sm: return buffer_sm(variant, control::diag_buffer_sm, r);
    case Fact::exchange:
        return std::string{dp::name(dp::service(static_cast<std::uint8_t>(r.a)))} + ": aux now " + hex_number(r.b >> 8) + ", target " + hex_number(r.b & 0xFFu);
    case Fact::leave_master: return r.a < kCauses.size() ? kCauses[r.a] : "?";
    case Fact::finding: return finding(r);
    case Fact::pin_finding: return pin_finding_text(r.a, r.b);
    case Fact::ram_wait: return std::to_string(r.b) + " CLK in all";
    case Fact::diag_flag:
    case Fact::prm_counter:
    case Fact::cfg_counter:
    case Fact::user_wd:
    case Fact::sync_mode:
    case Fact::freeze_mode:
    case Fact::station_address:
    case Fact::count: break;
    }
    return std::to_string(r.b);
}

/// Distance in bit times with two digits, rounded down; "-" when it is not known.
std::string bit_times(core::Ticks distance, core::Ticks bit) {
    const std::int64_t hundredths = distance.n / bit.n * 100 + distance.n % bit.n * 100 / bit.n;
    const std::string fraction = std::to_string(hundredths % 100);
    return std::to_string(hundredths / 100) + (fraction.size() == 1 ? ".0" : ".") + fraction;
}

std::string right(const std::string& text, std::size_t width) {
    return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

}  // namespace

std::string time_text(core::Ticks at) {
    const std::int64_t ns = core::to_ns(at);
    const std::int64_t thousandths = (at.n - ns * core::kTicksPerNs) * 1000 / core::kTicksPerNs;
    const std::string fraction = std::to_string(1000 + thousandths);
    return std::to_string(ns) + '.' + fraction.substr(1) + " ns";
}

std::string fact_words(const TraceRecord& record, Variant variant, bool clock_sync) {
    if (record.what >= kNames.size()) return std::string{"fact "} + std::to_string(record.what);
    std::string words = kNames[record.what];
    add_word(words, value_words(record, variant, clock_sync), " ");
    return words;
}

std::string FactText::line(const TraceRecord& record) {
    const auto fact = static_cast<Fact>(record.what);
    if ((fact == Fact::baud || fact == Fact::baud_probe) && record.b < fdl::kBaudRates) rate_ = static_cast<fdl::BaudCode>(record.b);
    if (fact == Fact::reset) {
        t0_.reset();
        clock_sync_ = false;
    }
    if (fact == Fact::cpu_write && record.a == regmap::control::mode_reg0_low)
        clock_sync_ = regmap::traits(variant_).clock_sync && (record.b & regmap::mode0::cs_supported) != 0;
    if (fact == Fact::heard || fact == Fact::proof) t0_ = record.at;
    std::string bits = "-";
    if (rate_ && t0_ && record.at >= *t0_) bits = std::string{"+"} + bit_times(record.at - *t0_, fdl::baud(*rate_).bit);
    return right(time_text(record.at), 20) + right(bits, 13) + " tBit  " + fact_words(record, variant_, clock_sync_);
}

}  // namespace dpchip::trace
