// SPDX-License-Identifier: Apache-2.0
// TOML to EventEntry. What a diagnosis, an alarm or a status says is in diagnosis_config.cpp.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <dpchip/cli/diagnosis_config.hpp>
#include <dpchip/cli/event_config.hpp>
#include <dpchip/cli/settings.hpp>
#include <dpchip/cli/toml_reader.hpp>
#include <dpchip/dp/global_control.hpp>

namespace dpchip::cli {
namespace {

constexpr std::array<const char*, kEventKinds> kNames{"power_off", "power_on", "unplug", "plug", "diagnosis", "alarm", "status", "global_control", "fault", "mode", "io", "switch_over"};

/// A slave of the file, by its address or its name.
std::size_t slave_of(TomlReader& t, const LineConfig& config) {
    const auto who = t.text_or_number("slave");
    if (!who) refuse(t.place(), "[[event]] without slave");
    for (std::size_t i = 0; i < config.slaves.size(); ++i)
        if (config.slaves[i].name == *who || std::to_string(config.slaves[i].address.value_or(-1)) == *who) return i;
    t.refuse_key("slave", fmt::format("\"{}\" is neither the address nor the name of a [[slave]]", *who));
}

void read_global_control(TomlReader& t, EventEntry& e) {
    for (const std::string& word : t.texts("command")) {
        const auto* const found = std::find_if(std::begin(dp::kGcBits), std::end(dp::kGcBits), [&](const dp::GcBit& b) { return word == b.name; });
        if (found != std::end(dp::kGcBits)) e.command |= found->mask;
        else if (word != "Operate") t.refuse_key("command", fmt::format("\"{}\" is none of Sync, Unsync, Freeze, Unfreeze, Clear_Data, Operate", word));
    }
    e.groups = static_cast<std::uint8_t>(t.integer("groups", 0, 255).value_or(0));
}

void read_fault(TomlReader& t, EventEntry& e, const LineConfig& config) {
    const std::vector<std::string_view> words{"flip", "parity", "stop", "truncate", "gap", "late", "drop", "noise"};  // FaultKind's order
    const auto kind = t.word("fault", words);
    if (!kind) refuse(t.place(), fmt::format("[[event]] with do = \"fault\" needs fault, one of {}", fmt::join(words, ", ")));
    e.fault.kind = static_cast<segment::FaultKind>(*kind + 1);
    e.fault.octet = static_cast<std::uint16_t>(t.integer("octet", 0, 254).value_or(0));
    e.fault.mask = static_cast<std::uint8_t>(t.integer("mask", 1, 255).value_or(1));
    e.fault.bits = t.integer("bits", 1, 1'000'000).value_or(e.fault.kind == segment::FaultKind::noise ? 50 : 1);
    e.count = static_cast<std::uint32_t>(t.integer("count", 1, 1'000'000).value_or(1));
    if (const auto from = t.word("from", {"any", "master", "slave"}); from == std::size_t{1}) e.sender = kMasterSends;
    else if (from == std::size_t{2}) e.sender = slave_of(t, config);
}

/// What happens, without when.
void read_deed(TomlReader& t, EventEntry& e, const LineConfig& config) {
    const auto kind = t.word("do", {kNames.begin(), kNames.end()});
    if (!kind) refuse(e.at, "[[event]] without do");
    e.kind = static_cast<EventKind>(*kind);
    switch (e.kind) {
    case EventKind::power_off:
    case EventKind::power_on:
    case EventKind::unplug:
    case EventKind::plug: e.slave = slave_of(t, config); break;
    case EventKind::diagnosis:
        e.slave = slave_of(t, config);
        read_diagnosis(t, e);
        break;
    case EventKind::alarm:
    case EventKind::status:
        e.slave = slave_of(t, config);
        read_alarm(t, e);
        break;
    case EventKind::global_control: read_global_control(t, e); break;
    case EventKind::fault: read_fault(t, e, config); break;
    case EventKind::mode:
        if (const auto mode = t.word("mode", {"offline", "stop", "clear", "operate"})) e.mode = static_cast<master::Mode>(*mode);
        else refuse(e.at, "[[event]] with do = \"mode\" needs mode");
        break;
    case EventKind::io:
        e.slave = slave_of(t, config);
        e.io = t.text("io").value_or("echo");
        check_io(e.io, t.place("io"));
        break;
    case EventKind::switch_over: break;
    }
}

// ---- the same as words -------------------------------------------------------------------------------------------

/// Words of a line; "..." keeps blanks together. Nothing when a quote is not closed.
std::optional<std::vector<std::string>> words_of(const std::string& line) {
    std::vector<std::string> words;
    bool in_word = false, quoted = false;
    for (const char c : line) {
        if (c == '"') {
            quoted = !quoted;
            if (!in_word) words.emplace_back();
            in_word = true;
        } else if (!quoted && (c == ' ' || c == '\t' || c == '\r')) {
            in_word = false;
        } else {
            if (!in_word) words.emplace_back();
            in_word = true;
            words.back() += c;
        }
    }
    if (quoted) return std::nullopt;
    return words;
}

bool is_number(const std::string& text) {
    return !text.empty() && text.size() < 10 && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

void put(toml::table& table, const std::string& key, const std::string& value) {
    const bool number = (key == "slot" || key == "identifiers") && is_number(value);
    if (number) table.insert_or_assign(key, std::int64_t{std::stol(value)});
    else if (value == "true" || value == "false") table.insert_or_assign(key, value == "true");
    else table.insert_or_assign(key, value);
}

void put_list(toml::table& table, const std::string& key, const std::string& value) {
    toml::array list;
    for (std::size_t from = 0; from <= value.size();) {
        const std::size_t end = std::min(value.find(',', from), value.size());
        const std::string one = value.substr(from, end - from);
        if (is_number(one)) list.push_back(std::int64_t{std::stol(one)});
        else list.push_back(one);
        from = end + 1;
    }
    table.insert_or_assign(key, std::move(list));
}

}  // namespace

const char* name(EventKind kind) { return kNames[static_cast<std::size_t>(kind)]; }

EventEntry read_event(const toml::table& table, const LineConfig& config) {
    TomlReader t{table, config.file, "[[event]]"};
    EventEntry e;
    e.at = t.place();
    const auto when = t.duration("at");
    if (!when) refuse(e.at, "[[event]] without at");
    e.when = *when;
    read_deed(t, e, config);
    t.finish();
    return e;
}

EventEntry read_command(const std::string& line, const Place& at, const LineConfig& config) {
    const auto words = words_of(line);
    if (!words || words->empty()) refuse(at, words ? "nothing to do" : "a quote is not closed");
    toml::table table;
    table.insert_or_assign("do", words->front());
    for (std::size_t i = 1; i < words->size(); ++i) {
        const std::string& word = (*words)[i];
        const std::size_t equals = word.find('=');
        if (equals == std::string::npos || equals == 0) refuse(at, fmt::format("\"{}\": KEY=VALUE is expected", word));
        const std::string key = word.substr(0, equals), value = word.substr(equals + 1);
        if (value.find(',') != std::string::npos) put_list(table, key, value);
        else put(table, key, value);
    }
    try {
        TomlReader t{table, at.file, "this command"};
        EventEntry e;
        e.at = at;
        read_deed(t, e, config);
        t.finish();
        if (!is_of_the_slave(e.kind)) throw Failure{ExitCode::input, fmt::format("\"{}\" is no command: diagnosis, alarm, status and io are", words->front())};
        return e;
    } catch (const Failure& f) {  // the table has no places: say the line's
        const std::string text = f.what();
        const std::size_t colon = text.find("error: ");
        throw Failure{ExitCode::input, to_string(at) + ": error: " + (colon == std::string::npos ? text : text.substr(colon + 7))};
    }
}

void sort_events(LineConfig& config) {
    std::stable_sort(config.events.begin(), config.events.end(), [](const EventEntry& a, const EventEntry& b) { return a.when < b.when; });
}

}  // namespace dpchip::cli
