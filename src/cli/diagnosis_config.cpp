// SPDX-License-Identifier: Apache-2.0
// TOML to diagnosis blocks and alarms (reference 5.5).
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <dpchip/cli/diagnosis_config.hpp>
#include <dpchip/cli/units.hpp>
#include <dpchip/dp/alarm.hpp>

namespace dpchip::cli {
namespace {

constexpr std::size_t kMaxExtDiag = dp::kMaxDiag - dp::kDiagHeader;
const std::vector<std::string_view> kSpecifiers{"general", "appears", "disappears", "disappears_but_others"};  // dp::Specifier's order

void append(std::vector<std::uint8_t>& all, std::span<const std::uint8_t> block) { all.insert(all.end(), block.begin(), block.end()); }

void read_module_status(TomlReader& t, std::vector<std::uint8_t>& all) {
    const std::array<std::string_view, 4> words{"ok", "fault", "wrong_module", "no_module"};  // dp::ModulState's order
    std::vector<dp::ModulState> states;
    for (const std::string& word : t.texts("module_status")) {
        const auto* const found = std::find(words.begin(), words.end(), word);
        if (found == words.end()) t.refuse_key("module_status", fmt::format("\"{}\" is none of {}", word, fmt::join(words, ", ")));
        states.push_back(static_cast<dp::ModulState>(found - words.begin()));
    }
    if (states.empty()) return;
    std::array<std::uint8_t, dp::kMaxDeviceBlock> block{};
    const auto size = dp::encode_modul_status(states, block);
    if (!size) t.refuse_key("module_status", dp::name(size.error()));
    append(all, std::span{block}.first(*size));
}

void read_identifiers(TomlReader& t, std::vector<std::uint8_t>& all) {
    const std::vector<std::int64_t> marked = t.integers("identifiers", 0, 243);
    if (marked.empty()) return;
    const auto modules = static_cast<std::size_t>(*std::max_element(marked.begin(), marked.end())) + 1;
    std::array<std::uint8_t, dp::kMaxDeviceBlock> block{};
    const auto is_marked = [&](std::size_t n) { return std::find(marked.begin(), marked.end(), static_cast<std::int64_t>(n)) != marked.end(); };
    const auto size = dp::encode_identifiers(modules, is_marked, block);
    if (!size) t.refuse_key("identifiers", dp::name(size.error()));
    append(all, std::span{block}.first(*size));
}

/// 1..9 by their names, any by its number.
std::uint8_t channel_error(TomlReader& t) {
    const auto text = t.text_or_number("error");
    if (!text) refuse(t.place(), "channels: an entry without error");
    for (std::uint8_t n = 0; n < 32; ++n)
        if (*text == std::to_string(n) || (n != 0 && n < 10 && *text == dp::channel_error_name(n))) return n;
    t.refuse_key("error", fmt::format("\"{}\" is neither 0 .. 31 nor one of short circuit, undervoltage, overvoltage, overload, overtemperature, line break, "
                                      "upper limit value exceeded, lower limit value exceeded, error", *text));
}

void read_channels(TomlReader& t, const std::string& file, std::vector<std::uint8_t>& all) {
    for (const toml::table* table : t.tables("channels")) {
        TomlReader c{*table, file, "channels"};
        dp::ChannelDiag channel{};
        channel.identifier = static_cast<std::uint8_t>(c.integer("identifier", 0, 63).value_or(0));
        channel.channel = static_cast<std::uint8_t>(c.integer("channel", 0, 63).value_or(0));
        const std::size_t direction = c.word("direction", {"none", "input", "output", "both"}).value_or(0);
        channel.input = (direction & 1u) != 0;
        channel.output = (direction & 2u) != 0;
        channel.type = static_cast<std::uint8_t>(c.word("type", {"reserved", "bit", "2 bit", "4 bit", "byte", "word", "2 words"}).value_or(0));
        channel.error = channel_error(c);
        c.finish();
        std::array<std::uint8_t, 3> block{};
        static_cast<void>(dp::encode(channel, block));
        append(all, block);
    }
}

/// A type by name, or the manufacturer's by number.
template <class Names>
std::uint8_t type_of(TomlReader& t, const Names& names, const char* what) {
    const auto text = t.text_or_number("type");
    std::string known;
    for (const auto& [word, type] : names) {
        if (text && (*text == word || *text == std::to_string(type))) return type;
        known += std::string{word} + ", ";
    }
    for (int n = 32; n <= 126; ++n)
        if (text && *text == std::to_string(n)) return static_cast<std::uint8_t>(n);
    if (!text) refuse(t.place(), fmt::format("do = \"{}\" needs type: {}or the manufacturer's 32 .. 126", what, known));
    t.refuse_key("type", fmt::format("\"{}\" is none of {}nor the manufacturer's 32 .. 126", *text, known));
}

struct NamedType {
    std::string_view word;
    std::uint8_t type;
};
constexpr NamedType kAlarmTypes[]{{"diagnostic", 1}, {"process", 2}, {"pull", 3}, {"plug", 4}, {"status", 5}, {"update", 6}};
constexpr NamedType kStatusTypes[]{{"status_message", 1}, {"modul_status", 2}, {"dxb_link_status", 3}, {"prm_cmd_ack", 30}, {"red_state", 31}};

struct EnableWord {
    std::string_view word;
    std::uint8_t bit;
};
constexpr EnableWord kEnableWords[]{{"pull_plug", dp::kEnablePullPlugAlarm},       {"process", dp::kEnableProcessAlarm},
                                    {"diagnostic", dp::kEnableDiagnosticAlarm},    {"manufacturer", dp::kEnableManufacturerSpecificAlarm},
                                    {"status", dp::kEnableStatusAlarm},            {"update", dp::kEnableUpdateAlarm}};
constexpr std::uint8_t kEveryAlarm = 0xFC;

}  // namespace

void read_diagnosis(TomlReader& t, EventEntry& e) {
    const std::string file = e.at.file;
    read_module_status(t, e.octets);
    read_identifiers(t, e.octets);
    read_channels(t, file, e.octets);
    const auto octets = t.octets("octets").value_or(std::vector<std::uint8_t>{});
    append(e.octets, octets);
    if (e.octets.size() > kMaxExtDiag) refuse(t.place("octets"), fmt::format("a diagnosis of {} octets: {} are possible", e.octets.size(), kMaxExtDiag));
    e.ext_diag = t.boolean("ext_diag").value_or(!e.octets.empty());
    e.stat_diag = t.boolean("stat_diag").value_or(false);
}

void read_alarm(TomlReader& t, EventEntry& e) {
    const bool status = e.kind == EventKind::status;
    e.alarm.status = status;
    e.alarm.type = status ? type_of(t, kStatusTypes, "status") : type_of(t, kAlarmTypes, "alarm");
    e.alarm.slot = static_cast<std::uint8_t>(t.integer("slot", 0, dp::kMaxAlarmSlot).value_or(0));
    e.alarm.specifier = static_cast<std::uint8_t>(t.word("specifier", kSpecifiers).value_or(0));
    if (!status) e.alarm.add_ack = t.boolean("add_ack").value_or(false);
    e.octets = t.octets("octets").value_or(std::vector<std::uint8_t>{});
    if (e.octets.size() > dp::kMaxDeviceBlock - dp::kAlarmHeader)
        t.refuse_key("octets", fmt::format("{} octets of user data: {} are possible", e.octets.size(), dp::kMaxDeviceBlock - dp::kAlarmHeader));
}

void read_enabled_alarms(TomlReader& t, SlaveEntry& slave) {
    slave.alarms_at = t.place("alarms");
    for (const std::string& word : t.texts("alarms")) {
        const auto* const found = std::find_if(std::begin(kEnableWords), std::end(kEnableWords), [&](const EnableWord& w) { return w.word == word; });
        if (found != std::end(kEnableWords)) slave.alarms |= found->bit;
        else if (word == "all") slave.all_alarms = true;
        else t.refuse_key("alarms", fmt::format("\"{}\" is none of all, pull_plug, process, diagnostic, manufacturer, status, update", word));
    }
    if (slave.all_alarms) slave.alarms = kEveryAlarm;
    const auto sequence = t.integer("alarm_sequence", 0, 32);
    if (!sequence) return;
    if (slave.alarms == 0) t.refuse_key("alarm_sequence", "without alarms it says nothing");
    for (std::uint8_t mode = 0; mode <= dp::kAlarmModeMask; ++mode) {
        slave.alarm_mode = mode;
        if (dp::alarm_limit(mode) == *sequence) return;
    }
    t.refuse_key("alarm_sequence", fmt::format("{} alarms at a time: 2, 4, 8, 12, 16, 24 and 32 are possible, and 0 for one of each type", *sequence));
}

}  // namespace dpchip::cli
