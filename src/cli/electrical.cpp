// SPDX-License-Identifier: Apache-2.0
// The electrical side of a chip as tables; three ways to print them.
#include <dpchip/cli/electrical.hpp>

#include <algorithm>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <dpchip/pins/pin.hpp>
#include <dpchip/regmap/bus_timing.hpp>
#include <dpchip/regmap/electrical.hpp>
#include <dpchip/trace/pin_finding_text.hpp>

namespace dpchip::cli {
namespace {

using core::Ticks;
using regmap::Figure;
using regmap::Supply;
using regmap::Variant;
using Row = std::vector<std::string>;
using Json = nlohmann::ordered_json;

/// Chips of the SPC3 kind have the APC3's pins, all others those of the VPC3+C.
bool like_apc3(Variant v) { return regmap::kSpc3Class.has(v); }

std::string thousandths(std::int32_t milli) {
    const std::int64_t n = milli;
    std::string text = fmt::format("{}{}.{:03}", n < 0 ? "-" : "", std::abs(n) / 1000, std::abs(n) % 1000);
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
    return text;
}

std::string words(const Figure& f) {
    switch (f.kind) {
    case Figure::Kind::none: return "-";
    case Figure::Kind::absolute: return thousandths(f.milli);
    case Figure::Kind::plus_minus: return "+-" + thousandths(f.milli);
    case Figure::Kind::times_supply: return thousandths(f.milli) + " VDD";
    case Figure::Kind::supply_plus: return f.milli == 0 ? "VDD" : "VDD + " + thousandths(f.milli);
    }
    return "?";
}

const char* words(pins::InputType type) {
    switch (type) {
    case pins::InputType::none: return "-";
    case pins::InputType::cmos: return "CMOS";
    case pins::InputType::cmos_schmitt: return "CMOS Schmitt";
    case pins::InputType::cmos_pulldown: return "CMOS, pull-down";
    case pins::InputType::ttl_schmitt: return "TTL Schmitt";
    }
    return "?";
}

const char* words(pins::PinDirection direction) {
    switch (direction) {
    case pins::PinDirection::supply: return "supply";
    case pins::PinDirection::input: return "in";
    case pins::PinDirection::output: return "out";
    case pins::PinDirection::bidirectional: return "in, out";
    }
    return "?";
}

const char* words(pins::OutputStage stage) {
    return stage == pins::OutputStage::none ? "-" : stage == pins::OutputStage::tristate ? "tristate" : "push-pull";
}

PrintedTable pin_table(Variant v) {
    PrintedTable t{"Pins", like_apc3(v) ? "table 2.1" : "figure 3-1", {"pin", "name", "direction", "input", "output", "function"}, {}};
    for (const pins::PinInfo& p : pins::kPinTable)
        t.rows.push_back({std::to_string(p.number()), std::string{like_apc3(v) ? p.apc3_name : p.name}, words(p.direction), words(p.input),
                          words(p.output), std::string{p.function}});
    return t;
}

PrintedTable bus_pin_table(Variant v) {
    PrintedTable t{"Bus pins in the four modes", like_apc3(v) ? "table 2.1" : "figure 8-2", {"pin", "RAM"}, {}};
    for (const std::string_view mode : regmap::kProcessorModeNames) t.columns.emplace_back(mode);
    const bool has_4k = regmap::traits(v).max_ram_bytes > 2048;
    for (const pins::BusPinFunctions& f : pins::kBusPinFunctions) {
        const auto row = [&](const char* ram, const auto& functions) {
            Row r{std::to_string(pins::info(f.pin).number()), ram};
            r.insert(r.end(), functions.begin(), functions.end());
            t.rows.push_back(r);
        };
        row(has_4k ? "2 KB" : "all", f.with_2k);
        if (has_4k) row("4 KB", f.with_4k);
    }
    return t;
}

PrintedTable figures(std::string title, std::string place, std::span<const regmap::ElectricalRow> rows) {
    PrintedTable t{std::move(title), std::move(place), {"symbol", "parameter", "min", "typ", "max", "unit"}, {}};
    for (const regmap::ElectricalRow& r : rows)
        t.rows.push_back({std::string{r.symbol}, std::string{r.parameter}, words(r.min), words(r.typ), words(r.max), std::string{r.unit}});
    return t;
}

PrintedTable output_cells() {
    PrintedTable t{"Output drivers", "figure 10-4", {"signal", "stage", "drive mA", "load pF"}, {}};
    for (const pins::PinInfo& p : pins::kPinTable)
        if (pins::is_output(p.id)) t.rows.push_back({std::string{p.name}, words(p.output), std::to_string(p.drive_ma), std::to_string(p.load_pf)});
    return t;
}

std::string limit(Ticks t) { return t == regmap::kNoMin || t == regmap::kNoMax ? "-" : trace::nanoseconds_text(t); }
const char* words(regmap::TimingKind kind) { return kind == regmap::TimingKind::check ? "processor" : "chip"; }

PrintedTable system_timing() {
    PrintedTable t{"System timing, ns", "section 10.7.1", {"symbol", "parameter", "min", "max", "owed by"}, {}};
    for (const regmap::SystemTimingParameter& p : regmap::kSystemTiming) {
        t.rows.push_back({std::string{p.symbol}, std::string{p.name}, limit(p.limits.min), limit(p.limits.max), words(p.kind)});
    }
    return t;
}

std::string events(regmap::BusEvents set) {
    std::string text;
    for (std::size_t i = 0; i < regmap::kBusEvents; ++i)
        if (const auto e = static_cast<regmap::BusEvent>(i); set.has(e)) text += (text.empty() ? "" : ", ") + std::string{regmap::name(e)};
    return text;
}

const char* words(regmap::Cycle cycle) { return cycle == regmap::Cycle::read ? "R" : cycle == regmap::Cycle::write ? "W" : "R W"; }

PrintedTable bus_timing(Variant v, regmap::ProcessorMode mode) {
    PrintedTable t{"Bus timing, " + std::string{regmap::name(mode)} + ", ns", {}, {"no.", "cycle", "parameter", "from", "to", "3.3 V min", "max"}, {}};
    const bool with_5v = v != Variant::apc3;
    if (with_5v) t.columns.insert(t.columns.end(), {"5 V min", "max"});
    t.columns.emplace_back("owed by");
    for (const regmap::TimingParameter& p : regmap::kBusTiming) {
        if (p.mode != mode) continue;
        t.place = "figure " + std::string{p.figure};
        Row r{std::to_string(p.number), words(p.cycle), std::string{p.name}, events(p.from), events(p.to), limit(p.at(Supply::v3_3).min), limit(p.at(Supply::v3_3).max)};
        if (with_5v) r.insert(r.end(), {limit(p.at(Supply::v5).min), limit(p.at(Supply::v5).max)});
        r.emplace_back(words(p.kind));
        t.rows.push_back(r);
    }
    return t;
}

PrintedTable internal_timing() {
    PrintedTable t{"Inside the bus interface, ns from the first rising CLK at or after the strobe", {}, {"event", "3.3 V", "5 V"}, {}};
    const auto& low = regmap::internal_timing(Supply::v3_3);
    const auto& high = regmap::internal_timing(Supply::v5);
    const auto row = [&](const char* what, Ticks at_3_3, Ticks at_5) { t.rows.push_back({what, trace::nanoseconds_text(at_3_3), trace::nanoseconds_text(at_5)}); };
    row("a read acts", regmap::kReadAccess, regmap::kReadAccess);
    row("data valid", low.data_valid, high.data_valid);
    row("ready, Early_Rdy = 1", low.early_ready, high.early_ready);
    row("ready, Early_Rdy = 0", low.normal_ready, high.normal_ready);
    row("a write acts (from the CLK edge after the strobe)", regmap::kWriteAccess, regmap::kWriteAccess);
    return t;
}

PrintedTable dimensions(Variant v) {
    PrintedTable t{"Package, 44-pin PQFP, mm", like_apc3(v) ? "table 7.1" : "figure 10-22", {"symbol", "meaning", "min", "nom", "max"}, {}};
    for (const regmap::Dimension& d : regmap::kPackageDimensions) {
        const Row r = like_apc3(v) ? Row{words(d.apc3_min), words(d.apc3_nom), words(d.apc3_max)} : Row{words(d.vpc3c_min), words(d.vpc3c_nom), words(d.vpc3c_max)};
        if (r == Row{"-", "-", "-"}) continue;
        t.rows.push_back({std::string{d.symbol}, std::string{d.meaning}, r[0], r[1], r[2]});
    }
    return t;
}

/// Whose figures these are.
std::string note(Variant v) {
    if (v == Variant::vpc3c) return {};
    if (v == Variant::apc3) return "The APC3 manual has no figures of bus timing: those of the VPC3+C at 3.3 V, with which it calls itself compatible.";
    return "No manual of this chip at hand: these are the figures of its nearest relative.";
}

std::size_t width(const PrintedTable& t, std::size_t column) {
    std::size_t w = t.columns[column].size();
    for (const Row& r : t.rows) w = std::max(w, r[column].size());
    return w;
}

std::string heading(const PrintedTable& t) { return t.place.empty() ? t.title + " (decided by the model)" : t.title + " (" + t.place + ")"; }

}  // namespace

std::vector<PrintedTable> electrical_tables(Variant v) {
    std::vector<PrintedTable> all{pin_table(v), bus_pin_table(v)};
    if (like_apc3(v)) {
        all.push_back(figures("Ratings", "chapter 1, table 2.1", regmap::kApc3Ratings));
    } else {
        all.push_back(figures("Absolute maximum ratings", "figure 10-1", regmap::kMaximumRatings));
        all.push_back(figures("Recommended operating conditions", "figure 10-2", regmap::kOperatingConditions));
        all.push_back(figures("General DC characteristics", "figure 10-3", regmap::kGeneralDc));
        all.push_back(output_cells());
        all.push_back(figures("DC characteristics at 5 V", "figure 10-5", regmap::kDc5V));
        all.push_back(figures("DC characteristics at 3.3 V", "figure 10-6", regmap::kDc3V3));
    }
    all.push_back(system_timing());
    using enum regmap::ProcessorMode;
    for (const auto mode : {sync_intel, async_intel, sync_motorola, async_motorola}) all.push_back(bus_timing(v, mode));
    all.push_back(internal_timing());
    all.push_back(dimensions(v));
    return all;
}

std::string electrical_text(Variant v) {
    std::string out = std::string{regmap::traits(v).name} + ": pins, ratings and timing\n";
    if (const std::string words = note(v); !words.empty()) out += words + '\n';
    for (const PrintedTable& t : electrical_tables(v)) {
        out += '\n' + heading(t) + '\n';
        const auto line = [&](const Row& r) {
            std::string text;
            for (std::size_t c = 0; c < r.size(); ++c) text += fmt::format("{:<{}}  ", r[c], width(t, c));
            text.erase(text.find_last_not_of(' ') + 1);
            out += text + '\n';
        };
        line(t.columns);
        for (const Row& r : t.rows) line(r);
    }
    return out;
}

std::string electrical_markdown(Variant v) {
    std::string out = "# Pins, ratings and timing of " + std::string{regmap::traits(v).name} + '\n';
    if (const std::string words = note(v); !words.empty()) out += "\n**" + words + "**\n";
    for (const PrintedTable& t : electrical_tables(v)) {
        out += fmt::format("\n## {}\n\n| {} |\n|{}\n", heading(t), fmt::join(t.columns, " | "), fmt::join(std::vector<const char*>(t.columns.size(), "---|"), ""));
        for (const Row& r : t.rows) out += fmt::format("| {} |\n", fmt::join(r, " | "));
    }
    return out;
}

std::string electrical_json(Variant v) {
    Json j{{"chip", regmap::traits(v).name}, {"documented", regmap::traits(v).documented}};
    if (const std::string words = note(v); !words.empty()) j["note"] = words;
    for (const PrintedTable& t : electrical_tables(v)) j["tables"].push_back({{"title", t.title}, {"place", t.place}, {"columns", t.columns}, {"rows", t.rows}});
    return j.dump(2) + '\n';
}

}  // namespace dpchip::cli
