// SPDX-License-Identifier: Apache-2.0
// TOML to EventEntry.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <dpchip/cli/event_config.hpp>
#include <dpchip/cli/settings.hpp>
#include <dpchip/cli/toml_reader.hpp>
#include <dpchip/dp/global_control.hpp>

namespace dpchip::cli {
namespace {

constexpr std::array<const char*, kEventKinds> kNames{"power_off", "power_on", "unplug", "plug", "diagnosis", "global_control", "fault", "mode", "io"};

/// A slave of the file, by its address or its name.
std::size_t slave_of(TomlReader& t, const LineConfig& config) {
    const auto who = t.text_or_number("slave");
    if (!who) refuse(t.place(), "[[event]] without slave");
    for (std::size_t i = 0; i < config.slaves.size(); ++i)
        if (config.slaves[i].name == *who || std::to_string(config.slaves[i].address.value_or(-1)) == *who) return i;
    t.refuse_key("slave", fmt::format("\"{}\" is neither the address nor the name of a [[slave]]", *who));
}

void read_diagnosis(TomlReader& t, EventEntry& e) {
    e.octets = t.octets("octets").value_or(std::vector<std::uint8_t>{});
    if (e.octets.size() > 238) t.refuse_key("octets", "more than 238 octets");
    e.ext_diag = t.boolean("ext_diag").value_or(!e.octets.empty());
    e.stat_diag = t.boolean("stat_diag").value_or(false);
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

}  // namespace

const char* name(EventKind kind) { return kNames[static_cast<std::size_t>(kind)]; }

EventEntry read_event(const toml::table& table, const LineConfig& config) {
    TomlReader t{table, config.file, "[[event]]"};
    EventEntry e;
    e.at = t.place();
    const auto when = t.duration("at");
    if (!when) refuse(e.at, "[[event]] without at");
    e.when = *when;
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
    }
    t.finish();
    return e;
}

void sort_events(LineConfig& config) {
    std::stable_sort(config.events.begin(), config.events.end(), [](const EventEntry& a, const EventEntry& b) { return a.when < b.when; });
}

}  // namespace dpchip::cli
