// SPDX-License-Identifier: Apache-2.0
// `dpchip regs`: the register map of a chip, from the table that the chip's model itself decodes with.
#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <dpchip/cli/commands.hpp>
#include <dpchip/cli/electrical.hpp>
#include <dpchip/cli/settings.hpp>
#include <dpchip/regmap/address.hpp>
#include <dpchip/regmap/control_parameters.hpp>
#include <dpchip/regmap/interrupts.hpp>
#include <dpchip/regmap/names.hpp>
#include <dpchip/regmap/organizational_parameters.hpp>

namespace dpchip::cli {
namespace {

using regmap::Variant;
using Json = nlohmann::ordered_json;

const char* name(regmap::Access access) {
    switch (access) {
    case regmap::Access::ro: return "ro";
    case regmap::Access::rw: return "rw";
    case regmap::Access::wo: return "wo";
    case regmap::Access::w1s: return "w1s";
    case regmap::Access::w1c: return "w1c";
    case regmap::Access::command: return "command";
    case regmap::Access::reserved: return "reserved";
    case regmap::Access::offline_only: return "offline only";
    }
    return "?";
}

std::string bits(const regmap::Field& f) {
    return f.width == 1 ? std::to_string(f.lsb) : fmt::format("{}..{}", f.lsb + f.width - 1, f.lsb);
}

const char* name(regmap::Dir dir) { return dir == regmap::Dir::read ? "read" : "write"; }

/// "" for chips whose manual was at hand.
std::string caveat(Variant v) {
    if (regmap::traits(v).documented) return {};
    return "No manual of this chip at hand: what is not said of it in the VPC3+C and APC3 manuals follows its nearest relative.";
}

std::string ram_text(const regmap::Traits& t) {
    return t.max_ram_bytes == t.ram_bytes ? fmt::format("{} octets of RAM", t.ram_bytes)
                                          : fmt::format("{} octets of RAM, {} with 4KB_Mode", t.ram_bytes, t.max_ram_bytes);
}

template <class F>
void each_reg(Variant v, F&& visit) {
    for (std::uint16_t address = 0; address < regmap::control::count; ++address)
        for (const auto dir : {regmap::Dir::read, regmap::Dir::write})
            if (const regmap::Reg* reg = regmap::find(v, dir, address)) visit(*reg);
}

template <class F>
void each_field(Variant v, const regmap::Reg& reg, F&& visit) {
    std::vector<const regmap::Field*> fields;
    for (const regmap::Field& f : reg.fields)
        if (f.variants.has(v)) fields.push_back(&f);
    std::sort(fields.begin(), fields.end(), [](const auto* a, const auto* b) { return a->lsb > b->lsb; });
    for (const regmap::Field* f : fields) visit(*f);
}

template <class F>
void each_interrupt(Variant v, F&& visit) {
    for (const regmap::InterruptBit& b : regmap::kInterruptBits)
        if (b.variants.has(v)) visit(b, b.bit == 0 && regmap::kClockSync.variants.has(v) ? fmt::format("{}, or Clock_Sync with CS_Supported", b.name) : std::string{b.name});
}

const char* writer(const regmap::Cell& c) { return c.writer == regmap::Writer::chip ? "user, chip" : "user"; }

void print_text(Variant v) {
    const regmap::Traits& t = regmap::traits(v);
    std::printf("%s: %s\n", t.name.data(), ram_text(t).c_str());
    if (const std::string words = caveat(v); !words.empty()) std::printf("%s\n", words.c_str());
    std::printf("\nControl parameters (Intel addresses)\n");
    each_reg(v, [&](const regmap::Reg& r) {
        std::printf("%02XH %-5s  %-24s reset %02XH  section %s\n", r.address, name(r.dir), r.name.data(), regmap::reset_value(v, r), r.section.data());
        each_field(v, r, [](const regmap::Field& f) { std::printf("      %-5s  %-24s %-12s %s\n", bits(f).c_str(), f.name.data(), name(f.access), f.meaning.data()); });
    });
    std::printf("\nOrganizational parameters (RAM)\n");
    for (const regmap::Cell& c : regmap::kOrganizationalParameters)
        if (c.variants.has(v))
            std::printf("%02XH  %-24s %-10s section %-6s %s\n", c.address, regmap::name(v, regmap::Dir::read, c.address).data(), writer(c), c.section.data(), c.meaning.data());
    std::printf("\nInterrupts (IRR, IR, IMR, IAR)\n");
    each_interrupt(v, [](const regmap::InterruptBit& b, const std::string& names) {
        std::printf("bit %-3u %-24s %s%s\n", b.bit, names.c_str(), b.meaning.data(), b.by_acknowledgement ? "; cleared by its acknowledgement" : "");
    });
}

/// A bar would end the cell.
std::string cell(std::string_view text) {
    std::string out;
    for (const char c : text) out += c == '|' ? std::string{"\\|"} : std::string{c};
    return out;
}

void print_markdown(Variant v) {
    const regmap::Traits& t = regmap::traits(v);
    std::printf("# Registers of %s\n\n%s. Sections are those of the VPC3+C manual.\n", t.name.data(), ram_text(t).c_str());
    if (const std::string words = caveat(v); !words.empty()) std::printf("\n**%s**\n", words.c_str());
    std::printf("\n## Control parameters\n\n| address | access | register | reset | section | bits | field | kind | meaning |\n|---|---|---|---|---|---|---|---|---|\n");
    each_reg(v, [&](const regmap::Reg& r) {
        bool first = true;
        const std::string head = fmt::format("| {:02X}H | {} | {} | {:02X}H | {} ", r.address, name(r.dir), cell(r.name), regmap::reset_value(v, r), r.section);
        each_field(v, r, [&](const regmap::Field& f) {
            std::printf("%s| %s | %s | %s | %s |\n", first ? head.c_str() : "| | | | | ", bits(f).c_str(), cell(f.name).c_str(), name(f.access), cell(f.meaning).c_str());
            first = false;
        });
        if (first) std::printf("%s| | | | |\n", head.c_str());
    });
    std::printf("\n## Organizational parameters\n\n| address | name | written by | section | meaning |\n|---|---|---|---|---|\n");
    for (const regmap::Cell& c : regmap::kOrganizationalParameters)
        if (c.variants.has(v))
            std::printf("| %02XH | %s | %s | %s | %s |\n", c.address, cell(regmap::name(v, regmap::Dir::read, c.address)).c_str(), writer(c), c.section.data(), cell(c.meaning).c_str());
    std::printf("\n## Interrupts\n\n| bit | name | meaning |\n|---|---|---|\n");
    each_interrupt(v, [](const regmap::InterruptBit& b, const std::string& names) {
        std::printf("| %u | %s | %s%s |\n", b.bit, cell(names).c_str(), cell(b.meaning).c_str(), b.by_acknowledgement ? "; cleared by its acknowledgement" : "");
    });
}

Json to_json(Variant v) {
    const regmap::Traits& t = regmap::traits(v);
    Json j{{"chip", t.name}, {"documented", t.documented}, {"ram_octets", t.ram_bytes}, {"max_ram_octets", t.max_ram_bytes}};
    if (const std::string words = caveat(v); !words.empty()) j["note"] = words;
    each_reg(v, [&](const regmap::Reg& r) {
        Json e{{"address", r.address}, {"access", name(r.dir)}, {"name", r.name}, {"reset", regmap::reset_value(v, r)}, {"section", r.section}};
        e["fields"] = Json::array();
        each_field(v, r, [&](const regmap::Field& f) {
            e["fields"].push_back({{"name", f.name}, {"lsb", f.lsb}, {"width", f.width}, {"kind", name(f.access)}, {"meaning", f.meaning}});
        });
        j["control_parameters"].push_back(std::move(e));
    });
    for (const regmap::Cell& c : regmap::kOrganizationalParameters)
        if (c.variants.has(v))
            j["organizational_parameters"].push_back({{"address", c.address}, {"name", regmap::name(v, regmap::Dir::read, c.address)},
                                                      {"chip_writes", c.writer == regmap::Writer::chip}, {"section", c.section}, {"meaning", c.meaning}});
    each_interrupt(v, [&](const regmap::InterruptBit& b, const std::string& names) {
        j["interrupts"].push_back({{"bit", b.bit}, {"name", names}, {"meaning", b.meaning}, {"by_acknowledgement", b.by_acknowledgement}});
    });
    return j;
}

struct Arguments {
    std::string chip = "vpc3+c", format = "text";
    bool electrical = false;
};

void print_electrical(Variant v, std::string_view format) {
    const std::string text = format == "json" ? electrical_json(v) : format == "markdown" ? electrical_markdown(v) : electrical_text(v);
    std::fputs(text.c_str(), stdout);
}

ExitCode run(const Arguments& a) {
    const Variant v = parse_chip(a.chip, {});
    if (a.electrical) print_electrical(v, a.format);
    else if (a.format == "json") std::printf("%s\n", to_json(v).dump(2).c_str());
    else if (a.format == "markdown") print_markdown(v);
    else print_text(v);
    return ExitCode::ok;
}

}  // namespace

void add_regs(CLI::App& app, Job& job) {
    CLI::App* const c = app.add_subcommand("regs", "print a chip's register map");
    const auto a = std::make_shared<Arguments>();
    c->add_option("--chip", a->chip, "vpc3+c (default), vpc3+b, vpc3+, apc3, spc3")->type_name("CHIP");
    c->add_option("--format", a->format, "text (default), json, markdown")->check(CLI::IsMember({"text", "json", "markdown"}));
    c->add_flag("--electrical", a->electrical, "pins, ratings, levels, bus timing and dimensions instead of registers");
    c->footer(footer("  dpchip regs --chip apc3 --format markdown > apc3.md\n  dpchip regs --electrical"));
    c->callback([a, &job] { job = [a] { return run(*a); }; });
}

}  // namespace dpchip::cli
