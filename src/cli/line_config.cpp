// SPDX-License-Identifier: Apache-2.0
// TOML to LineConfig: the line itself, slaves and masters. Events are in event_config.cpp.
#include <filesystem>

#include <fmt/format.h>

#include <dpchip/cli/diagnosis_config.hpp>
#include <dpchip/cli/event_config.hpp>
#include <dpchip/cli/input.hpp>
#include <dpchip/cli/line_config.hpp>
#include <dpchip/cli/settings.hpp>
#include <dpchip/cli/toml_reader.hpp>

namespace dpchip::cli {
namespace {

/// A path beside the TOML file, unless it is absolute, built in, or comes from stdin.
std::string beside(const std::string& file, const std::string& path) {
    if (path.starts_with("builtin:") || file == "-") return path;
    return (std::filesystem::path{file}.parent_path() / path).lexically_normal().string();
}

/// A key of a table of free names as the text of its value.
std::string value_text(const TomlReader& t, const toml::node& node, std::string_view key) {
    if (const auto* v = node.as_string()) return v->get();
    if (const auto* v = node.as_integer()) return std::to_string(v->get());
    if (const auto* v = node.as_boolean()) return v->get() ? "true" : "false";
    refuse(t.place_of(node), fmt::format("{}: a text, a whole number, true or false is expected", key));
}

void read_options(TomlReader& t, SlaveEntry& slave) {
    const toml::table* const options = t.table("options");
    if (options == nullptr) return;
    for (const auto& [key, node] : *options) {
        std::string text;
        if (const toml::array* list = node.as_array()) {  // baud_probe_ms = [1, 1, ...]
            for (const toml::node& element : *list) text += (text.empty() ? "" : ",") + value_text(t, element, key.str());
        } else {
            text = value_text(t, node, key.str());
        }
        set_option(slave.options, std::string{key.str()}, text, t.place_of(node));
    }
}

void read_parameters(TomlReader& t, SlaveEntry& slave) {
    const toml::table* const parameters = t.table("parameters");
    if (parameters == nullptr) return;
    for (const auto& [key, node] : *parameters) {
        try {
            slave.parameters.push_back(gsd::prm_setting(std::string{key.str()} + '=' + value_text(t, node, key.str())));
        } catch (const gsd::GsdError& e) {
            refuse(t.place_of(node), e.what());
        }
    }
}

SlaveEntry read_slave(const toml::table& table, const std::string& file) {
    TomlReader t{table, file, "[[slave]]"};
    SlaveEntry s;
    s.at = t.place();
    s.name = t.text("name").value_or("");
    const auto gsd = t.text("gsd");
    if (!gsd) refuse(s.at, "[[slave]] without gsd");
    s.gsd = beside(file, *gsd);
    s.modules = t.texts("modules");
    const auto address = t.integer("address", 0, 126);
    if (!address) refuse(s.at, "[[slave]] without address");
    s.address = static_cast<int>(*address);
    if (const auto chip = t.text("chip")) s.chip = parse_chip(*chip, t.place("chip"));
    s.io = t.text("io");
    if (s.io) check_io(*s.io, t.place("io"));
    read_options(t, s);
    read_parameters(t, s);
    if (const auto v = t.integer("min_tsdr", 11, 255)) s.min_tsdr = static_cast<std::uint8_t>(*v);
    s.no_add_change = t.boolean("no_add_change").value_or(false);
    s.follow_master = t.word("cfg", {"plugged", "follow_master"}).value_or(0) == 1;
    s.crystal_ppb = static_cast<std::int32_t>(t.integer("crystal_ppb", -1'000'000, 1'000'000).value_or(0));
    s.firmware_delay = t.duration("firmware_delay").value_or(Ticks{});
    s.user_watchdog = static_cast<std::uint16_t>(t.integer("user_watchdog", 0, 65535).value_or(0));
    s.records = read_records(t, file, [&](const std::string& path) { return beside(file, path); });
    s.identification = read_identification(t, file);
    if (const auto v = t.integer("watchdog_ms", 0, 650'250)) s.watchdog_ms = static_cast<std::uint32_t>(*v);
    s.group = static_cast<std::uint8_t>(t.integer("group", 0, 255).value_or(0));
    s.sync = t.boolean("sync").value_or(false);
    s.freeze = t.boolean("freeze").value_or(false);
    s.dpv2 = read_dpv2(t, file);
    read_enabled_alarms(t, s);
    t.finish();
    return s;
}

MasterEntry read_master(const toml::table& table, const std::string& file, LineConfig& config) {
    TomlReader t{table, file, "[[master]]"};
    MasterEntry m;
    m.at = t.place();
    m.name = t.text("name").value_or("master");
    m.address = static_cast<std::uint8_t>(t.integer("address", 0, 125).value_or(1));
    m.min_cycle = t.duration("cycle").value_or(Ticks{});
    m.max_retry = static_cast<std::uint8_t>(t.integer("max_retry", 0, 15).value_or(1));
    m.gap_factor = static_cast<std::uint8_t>(t.integer("gap_factor", 0, 100).value_or(0));
    m.dpv2 = read_master_dpv2(t);
    if (const auto mode = t.word("mode", {"offline", "stop", "clear", "operate"})) m.mode = static_cast<master::Mode>(*mode);
    if (const auto baud = t.text_or_number("baud")) {
        const auto rate = parse_baud(*baud);
        if (!rate) t.refuse_key("baud", fmt::format("\"{}\" is none of the ten rates", *baud));
        if (config.baud && config.baud != rate) t.refuse_key("baud", "the line has another rate");
        config.baud = rate;
    }
    t.finish();
    return m;
}

void read_line(TomlReader& t, LineConfig& c) {
    c.line = t.text("line");
    c.line_at = t.place("line");
    if (const auto baud = t.text_or_number("baud")) {
        c.baud_auto = *baud == "auto";
        c.baud = parse_baud(*baud);
        if (!c.baud && !c.baud_auto)
            t.refuse_key("baud", fmt::format("\"{}\" is none of the ten rates, nor \"auto\"", *baud));
    }
    if (const auto slot = t.text_or_number("slot_time")) {
        c.slot_time = parse_slot_time(*slot);
        if (!c.slot_time) t.refuse_key("slot_time", fmt::format("\"{}\" is neither bit times (300) nor a time (\"200ms\")", *slot));
    }
    if (t.word("pace", {"prompt", "wire"}) == std::size_t{1}) c.pace = live::Pace::wire;
    if (const auto trace = t.text("trace")) c.trace = beside(c.file, *trace);
    if (const auto link = t.integer("link_type", 0, 65535)) {
        if (*link != 147 && *link != 257) t.refuse_key("link_type", "147 and 257 are possible");
        c.link_type = static_cast<trace::LinkType>(*link);
    }
    if (const auto dir = t.text("state_dir")) c.state_dir = beside(c.file, *dir);
    c.duration = t.duration("duration");
    if (const auto cycles = t.integer("cycles", 1, 1'000'000'000)) c.cycles = static_cast<std::uint64_t>(*cycles);
}

}  // namespace

LineConfig parse_line_config(const std::string& text, const std::string& file) {
    toml::table table;
    try {
        table = toml::parse(std::string_view{text}, std::string_view{file});
    } catch (const toml::parse_error& e) {
        const Place at{file, static_cast<std::uint32_t>(e.source().begin.line), static_cast<std::uint32_t>(e.source().begin.column)};
        refuse(at, std::string{e.description()});
    }
    LineConfig c;
    c.file = file;
    TomlReader t{table, c.file, "the file"};
    read_line(t, c);
    for (const toml::table* slave : t.tables("slave")) c.slaves.push_back(read_slave(*slave, c.file));
    for (const toml::table* master : t.tables("master")) c.masters.push_back(read_master(*master, c.file, c));
    for (const toml::table* event : t.tables("event")) c.events.push_back(read_event(*event, c));
    t.finish();
    sort_events(c);
    return c;
}

LineConfig read_line_config(const std::string& path) {
    return parse_line_config(read_all(path), path);
}

std::string title(const SlaveEntry& slave) {
    const std::string address = slave.address ? std::to_string(*slave.address) : "?";
    return slave.name.empty() ? "slave " + address : "slave " + address + " (" + slave.name + ")";
}

void check_addresses(const LineConfig& config, std::optional<std::uint8_t> master_address) {
    const SlaveEntry* owner[127]{};
    for (const SlaveEntry& s : config.slaves) {
        if (!s.address) refuse(s.at, "a slave of " + s.gsd + " has no address; give one with --address 0..126");
        if (*s.address < 0 || *s.address > 126) refuse(s.at, fmt::format("address {}: 0 to 126 are possible", *s.address));
        const SlaveEntry*& taken = owner[*s.address];
        if (taken != nullptr)
            refuse(s.at, fmt::format("address {} is used twice on this line{}", *s.address,
                                     taken->at.line != 0 ? "; first at " + to_string(taken->at) : std::string{}));
        if (master_address == *s.address) refuse(s.at, fmt::format("address {} is the master's", *s.address));
        taken = &s;
    }
}

}  // namespace dpchip::cli
