// SPDX-License-Identifier: Apache-2.0
#include <dpchip/gsd/configuration.hpp>

#include <algorithm>
#include <optional>

#include <dpchip/dp/cfg.hpp>
#include <dpchip/gsd/text.hpp>

namespace dpchip::gsd {
namespace {

/// "  #3 (ref 7) name", a line per module; long lists are cut.
std::string listed(const Gsd& gsd, std::span<const std::size_t> modules) {
    constexpr std::size_t limit = 200;
    std::string text;
    for (std::size_t i = 0; i < modules.size() && i < limit; ++i) {
        const Module& m = gsd.modules[modules[i]];
        text += "\n  #" + std::to_string(modules[i] + 1) + "  " + m.name;
        if (m.reference) text += "  (reference " + std::to_string(*m.reference) + ")";
    }
    if (modules.size() > limit) text += "\n  ... and " + std::to_string(modules.size() - limit) + " more";
    return text;
}

std::vector<std::size_t> all_modules(const Gsd& gsd) {
    std::vector<std::size_t> all(gsd.modules.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    return all;
}

template <class Predicate>
std::vector<std::size_t> modules_where(const Gsd& gsd, Predicate predicate) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < gsd.modules.size(); ++i)
        if (predicate(gsd.modules[i])) found.push_back(i);
    return found;
}

std::string label(const Gsd& gsd) { return gsd.file.empty() ? gsd.model_name : gsd.file; }

/// "#n", or nothing.
std::optional<std::size_t> by_position(const Gsd& gsd, std::string_view name) {
    if (!name.starts_with('#')) return std::nullopt;
    const auto n = to_number(name.substr(1));
    if (!n || *n < 1 || static_cast<std::size_t>(*n) > gsd.modules.size()) return std::nullopt;
    return static_cast<std::size_t>(*n - 1);
}

void check_limit(const Gsd& gsd, std::size_t value, std::optional<std::uint32_t> limit, const char* keyword,
                 const char* what) {
    if (limit && value > *limit)
        throw GsdError{label(gsd) + ": " + std::to_string(value) + " " + what + ", but " + keyword + " is " +
                       std::to_string(*limit)};
}

void check_slots(const Gsd& gsd, const std::vector<std::size_t>& modules) {
    for (const SlotRule& rule : gsd.slots) {
        if (rule.slot < 1 || rule.slot > modules.size()) continue;
        const Module& m = gsd.modules[modules[rule.slot - 1]];
        if (m.reference && rule.allows(*m.reference)) continue;
        const auto allowed =
            modules_where(gsd, [&](const Module& c) { return c.reference && rule.allows(*c.reference); });
        throw GsdError{label(gsd) + ": module '" + m.name + "' may not be in slot " + std::to_string(rule.slot) +
                       "; allowed are:" + listed(gsd, allowed)};
    }
}

}  // namespace

std::size_t find_module(const Gsd& gsd, std::string_view name) {
    const std::string wanted = folded(name);
    auto found = modules_where(gsd, [&](const Module& m) { return folded(m.name) == wanted; });
    if (found.empty()) {
        if (const auto at = by_position(gsd, wanted)) return *at;
        if (const auto n = to_number(wanted))
            found = modules_where(gsd, [&](const Module& m) { return m.reference == n; });
    }
    if (found.empty() && !wanted.empty())
        found = modules_where(gsd, [&](const Module& m) { return folded(m.name).starts_with(wanted); });
    if (found.size() == 1) return found.front();
    const std::string what = label(gsd) + ": module '" + std::string{name} + "'";
    if (found.empty()) throw GsdError{what + " does not exist; there are:" + listed(gsd, all_modules(gsd))};
    throw GsdError{what + " could be one of:" + listed(gsd, found)};
}

Configuration configure(const Gsd& gsd, std::span<const std::string> names) {
    std::vector<std::size_t> modules;
    for (const std::string& name : names) modules.push_back(find_module(gsd, name));
    const auto preset = modules_where(gsd, [](const Module& m) { return m.preset; });
    if (names.empty()) {
        if (!preset.empty()) modules = gsd.modular_station ? preset : std::vector{preset.front()};
        else if (gsd.modules.size() == 1) modules = {0};
        else throw GsdError{label(gsd) + ": which modules? There are:" + listed(gsd, all_modules(gsd))};
    } else if (gsd.fix_preset_modules) {
        const bool named = modules.size() >= preset.size() && std::equal(preset.begin(), preset.end(), modules.begin());
        if (!named) modules.insert(modules.begin(), preset.begin(), preset.end());
    }
    return configure_modules(gsd, std::move(modules));
}

Configuration configure_modules(const Gsd& gsd, std::vector<std::size_t> modules) {
    Configuration c;
    c.modules = std::move(modules);
    for (const std::size_t m : c.modules) {
        if (m >= gsd.modules.size()) throw GsdError{label(gsd) + ": there is no module #" + std::to_string(m + 1)};
        const auto& cfg = gsd.modules[m].cfg;
        c.cfg.insert(c.cfg.end(), cfg.begin(), cfg.end());
    }
    if (gsd.modular_station) check_limit(gsd, c.modules.size(), gsd.max_module, "Max_Module", "modules");
    else if (c.modules.size() > 1) throw GsdError{label(gsd) + ": a compact station takes one module"};
    check_limit(gsd, c.cfg.size(), dp::kMaxCfgOctets, "the limit of Chk_Cfg", "configuration octets");
    const dp::CfgTotals totals = dp::cfg_totals(c.cfg, dp::CfgUse::get_cfg);
    if (!totals.ok())
        throw GsdError{label(gsd) + ": configuration octet " + std::to_string(totals.error_offset) + ": " +
                       dp::name(totals.error)};
    c.input_octets = totals.input_octets;
    c.output_octets = totals.output_octets;
    if (gsd.modular_station) {
        check_limit(gsd, c.input_octets, gsd.max_input_len, "Max_Input_Len", "octets of inputs");
        check_limit(gsd, c.output_octets, gsd.max_output_len, "Max_Output_Len", "octets of outputs");
        check_limit(gsd, std::size_t{c.input_octets} + c.output_octets, gsd.max_data_len, "Max_Data_Len",
                    "octets of inputs and outputs");
    }
    check_slots(gsd, c.modules);
    return c;
}

}  // namespace dpchip::gsd
