// SPDX-License-Identifier: Apache-2.0
// Command line to LineConfig.
#include <cstdio>

#include <fmt/format.h>

#include <dpchip/cli/settings.hpp>
#include <dpchip/cli/slave_arguments.hpp>
#include <dpchip/dp/acyclic.hpp>

namespace dpchip::cli {
namespace {

/// An option that belongs to the slave begun last.
template <class F>
void add(CLI::App& command, LineConfig& config, const std::string& name, const std::string& type, const std::string& help, F&& use) {
    command
        .add_option_function<std::string>(
            name,
            [&config, name, use](const std::string& text) {
                if (config.slaves.empty()) throw Failure{ExitCode::usage, name + " must follow the --gsd of the slave it belongs to"};
                use(config.slaves.back(), text);
            },
            help)
        ->type_name(type)
        ->group("Slaves (each --gsd begins one)")
        ->take_last()
        ->trigger_on_parse();
}

int parse_address(const std::string& text) {
    std::size_t used = 0;
    int address = -1;
    try {
        address = std::stoi(text, &used);
    } catch (const std::exception&) {
        used = 0;
    }
    if (used == 0 || used != text.size()) throw Failure{ExitCode::usage, fmt::format("--address {}: a number is expected", text)};
    if (address < 0 || address > 126) throw Failure{ExitCode::usage, fmt::format("--address {}: 0 to 126 are possible", text)};
    return address;
}

/// "SLOT:INDEX=HEX", readable and writable.
slave::Record parse_record(const std::string& text) {
    unsigned slot = 0, index = 0;
    int used = 0;
    const bool head = std::sscanf(text.c_str(), "%3u:%3u=%n", &slot, &index, &used) == 2 && used != 0;
    const auto octets = head ? parse_hex(text.substr(static_cast<std::size_t>(used))) : std::nullopt;
    if (!octets || slot > 254 || index > 255 || octets->empty() || octets->size() > dp::kMaxRecord)
        throw Failure{ExitCode::usage, fmt::format("--record {}: SLOT:INDEX=HEX is expected, 1 to 240 octets, such as 1:4=01A0", text)};
    return {static_cast<std::uint8_t>(slot), static_cast<std::uint8_t>(index), slave::RecordAccess::rw, *octets, 0};
}

void apply_line(const LineArguments& a, LineConfig& c) {
    if (!a.line.empty()) c.line = a.line;
    if (!a.baud.empty()) {
        c.baud = parse_baud(a.baud);
        c.baud_auto = a.baud == "auto";
        if (!c.baud && !c.baud_auto)
            throw Failure{ExitCode::usage, fmt::format("--baud {}: 9600, 19200, 45450, 93750, 187500, 500000, 1.5M, 3M, 6M, 12M and auto are possible", a.baud)};
    }
    if (!a.slot_time.empty()) {
        c.slot_time = parse_slot_time(a.slot_time);
        if (!c.slot_time) throw Failure{ExitCode::usage, fmt::format("--slot-time {}: bit times (300) or a time (200ms) are expected", a.slot_time)};
    }
    if (a.pace == "wire") c.pace = live::Pace::wire;
    if (!a.trace.empty()) c.trace = a.trace;
    if (!a.trace.empty() || a.link_type != 147) c.link_type = static_cast<trace::LinkType>(a.link_type);
    for (SlaveEntry& s : c.slaves) {
        for (const std::string& option : a.options) set_option(s.options, option, {});
        if (a.min_tsdr != 0) s.min_tsdr = static_cast<std::uint8_t>(a.min_tsdr);
    }
}

}  // namespace

void add_slave_arguments(CLI::App& command, LineConfig& config) {
    command
        .add_option_function<std::string>(
            "--gsd",
            [&config](const std::string& path) {
                SlaveEntry entry;
                entry.gsd = path;
                config.slaves.push_back(std::move(entry));
            },
            "GSD file of a slave; builtin:remote_io and builtin:dpv1_io are inside the program")
        ->type_name("FILE")
        ->group("Slaves (each --gsd begins one)")
        ->take_last()
        ->trigger_on_parse();
    add(command, config, "--module", "NAME", "plugged module; several in slot order", [](SlaveEntry& s, const std::string& t) { s.modules.push_back(t); });
    add(command, config, "--address", "N", "station address, 0..126", [](SlaveEntry& s, const std::string& t) { s.address = parse_address(t); });
    add(command, config, "--chip", "CHIP", "vpc3+c (default), vpc3+b, vpc3+, apc3, spc3", [](SlaveEntry& s, const std::string& t) { s.chip = parse_chip(t, {}); });
    add(command, config, "--io", "WHAT", "inputs: echo, invert, counter, hold:HEX", [](SlaveEntry& s, const std::string& t) {
        check_io(t, {});
        s.io = t;
    });
    add(command, config, "--name", "TEXT", "name for people", [](SlaveEntry& s, const std::string& t) { s.name = t; });
    add(command, config, "--record", "SLOT:INDEX=HEX", "a record of a DP-V1 slave", [](SlaveEntry& s, const std::string& t) { s.records.push_back(parse_record(t)); });
    add(command, config, "--parameter", "[SLOT:]NAME=VALUE", "user parameter a master sends", [](SlaveEntry& s, const std::string& t) {
        try {
            s.parameters.push_back(gsd::prm_setting(t));
        } catch (const gsd::GsdError& e) {
            throw Failure{ExitCode::usage, e.what()};
        }
    });
}

void add_line_arguments(CLI::App& command, LineArguments& a) {
    command.add_option("file", a.file, "LINE.toml instead of all the options")->type_name("LINE.toml");
    command.add_option("--line", a.line, "pty[:LINK], serial:DEVICE, tcp:HOST:PORT; a visitor also names a path")->type_name("URI")->group("Line");
    command.add_option("--baud", a.baud, "9600 .. 12M; auto: the UART follows the chip's search")->type_name("RATE")->group("Line");
    command.add_option("--slot-time", a.slot_time, "bit times (300) or a time (200ms)")->type_name("TBIT|MS")->group("Line");
    command.add_option("--trace", a.trace, "record everything on the line")->type_name("FILE.pcapng")->group("Line");
    command.add_option("--link-type", a.link_type, "link type of the trace")->check(CLI::IsMember({147, 257}))->group("Line");
}

void add_model_arguments(CLI::App& command, LineArguments& a) {
    command.add_option("--pace", a.pace, "when a pty's write happens: prompt, or as late as on a wire")->check(CLI::IsMember({"prompt", "wire"}))->group("Line");
    command.add_option("--min-tsdr", a.min_tsdr, "minTSDR of all slaves in bit times")->check(CLI::Range(11, 255))->group("Model");
    command.add_option("--option", a.options, "an option of the model, for all slaves; see --show-options")->type_name("NAME=VALUE")->expected(1)->take_all()->group("Model");
}

LineConfig line_config(const LineArguments& a, LineConfig from_arguments) {
    if (a.file.empty()) {
        apply_line(a, from_arguments);
        return from_arguments;
    }
    if (!from_arguments.slaves.empty()) throw Failure{ExitCode::usage, "slaves come from " + a.file + " or from --gsd, not from both"};
    LineConfig config = read_line_config(a.file);
    apply_line(a, config);
    return config;
}

}  // namespace dpchip::cli
