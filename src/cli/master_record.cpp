// SPDX-License-Identifier: Apache-2.0
// `dpchip master read` and `dpchip master write`: records of a DP-V1 slave.
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <dpchip/cli/acyclic_session.hpp>
#include <dpchip/cli/interrupt.hpp>
#include <dpchip/cli/master_verbs.hpp>

namespace dpchip::cli {
namespace {

struct Arguments {
    AcyclicArguments acyclic;
    int slot = 0, index = 0, length = 240;
    std::string data;
    bool json = false;
};

std::string place(const Arguments& a) { return fmt::format("slot {} index {}", a.slot, a.index); }

nlohmann::ordered_json head(const Arguments& a) {
    nlohmann::ordered_json j;
    j["address"] = a.acyclic.address;
    j["slot"] = a.slot;
    j["index"] = a.index;
    return j;
}

ExitCode read(const Arguments& a) {
    AcyclicSession session{a.acyclic};
    const Interrupt interrupt{session.live().line()};
    session.open();
    session.relation().read(static_cast<std::uint8_t>(a.slot), static_cast<std::uint8_t>(a.index), static_cast<std::size_t>(a.length));
    session.finish("DS_Read " + place(a));
    const std::string octets = hex_text(session.relation().data(), dp::kMaxRecord);
    if (a.json) {
        nlohmann::ordered_json j = head(a);
        j["length"] = session.relation().data().size();
        j["octets"] = octets;
        std::printf("%s\n", j.dump(2).c_str());
    } else {
        std::printf("%s\n", octets.c_str());
    }
    return ExitCode::ok;
}

ExitCode write(const Arguments& a) {
    const auto data = parse_hex(a.data);
    if (!data || data->empty()) throw Failure{ExitCode::usage, "--data " + a.data + ": hexadecimal octets are expected, such as 01A0"};
    if (data->size() > dp::kMaxRecord) throw Failure{ExitCode::usage, fmt::format("--data: {} octets, 240 are possible", data->size())};
    AcyclicSession session{a.acyclic};
    const Interrupt interrupt{session.live().line()};
    session.open();
    session.relation().write(static_cast<std::uint8_t>(a.slot), static_cast<std::uint8_t>(a.index), *data);
    session.finish("DS_Write " + place(a));
    const unsigned taken = session.relation().accepted();
    if (a.json) {
        nlohmann::ordered_json j = head(a);
        j["taken"] = taken;
        std::printf("%s\n", j.dump(2).c_str());
    } else {
        std::printf("%u octet%s taken\n", taken, taken == 1 ? "" : "s");
    }
    return ExitCode::ok;
}

void add_place(CLI::App& c, Arguments& a) {
    add_acyclic_arguments(c, a.acyclic, ChooseClass::yes);
    c.add_option("--slot", a.slot, "slot (0)")->type_name("N")->check(CLI::Range(0, 254));
    c.add_option("--index", a.index, "index")->type_name("N")->check(CLI::Range(0, 255))->required();
    c.add_flag("--json", a.json, "as JSON");
}

}  // namespace

void add_master_read(CLI::App& master, Job& job) {
    CLI::App* const c = master.add_subcommand("read", "read a record of a DP-V1 slave");
    const auto a = std::make_shared<Arguments>();
    add_place(*c, *a);
    c->add_option("--length", a->length, "octets at most (240)")->type_name("N")->check(CLI::Range(1, 240));
    c->footer(footer("  dpchip master read --line pty:dp0 --address 5 --slot 1 --index 4\n"
                     "  dpchip master read --line pty:dp0 --address 5 --slot 1 --index 4 --class 2\n"
                     "Class 1 parameterises the slave and exchanges data with outputs 0 meanwhile; class 2 disturbs nobody.\n"
                     "Exit code 1: the slave refuses, with its error in words and in octets."));
    c->callback([a, &job] { job = [a] { return read(*a); }; });
}

void add_master_write(CLI::App& master, Job& job) {
    CLI::App* const c = master.add_subcommand("write", "write a record of a DP-V1 slave");
    const auto a = std::make_shared<Arguments>();
    add_place(*c, *a);
    c->add_option("--data", a->data, "the record, 1 to 240 octets")->type_name("HEX")->required();
    c->footer(footer("  dpchip master write --line pty:dp0 --address 5 --slot 1 --index 4 --data 0102A0\n"
                     "Class 1 parameterises the slave and exchanges data with outputs 0 meanwhile; class 2 disturbs nobody."));
    c->callback([a, &job] { job = [a] { return write(*a); }; });
}

}  // namespace dpchip::cli
