// SPDX-License-Identifier: Apache-2.0
// The chip's model in the words of the API.
#include "model.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "error.hpp"

namespace dpchip::capi {
namespace {

std::string variant_names() {
    std::string names;
    for (const regmap::Traits& t : regmap::kTraits) names += (names.empty() ? "" : ", ") + std::string{t.name};
    return names;
}

const char* words(regmap::OptionError error) {
    switch (error) {
    case regmap::OptionError::unknown_name: return "there is no such option";
    case regmap::OptionError::bad_value: return "not a value of this option";
    case regmap::OptionError::out_of_range: return "out of the option's range";
    }
    return "refused";
}

std::string values_of(std::string_view name) {
    for (const regmap::OptionInfo& o : regmap::option_table())
        if (o.name == name) return " (it takes " + std::string{o.values} + ")";
    return {};
}

const char* kind_name(core::FindingKind kind) {
    switch (kind) {
    case core::FindingKind::misuse: return "misuse";
    case core::FindingKind::unusual: return "unusual";
    case core::FindingKind::unverified: return "unverified";
    case core::FindingKind::timing_violation: return "timing violation";
    }
    return "finding";
}

}  // namespace

std::optional<regmap::Variant> variant_called(const char* name) {
    const auto variant = name == nullptr ? std::nullopt : regmap::variant_from_name(name);
    if (!variant) fail(DPCHIP_E_NAME, "no chip is called '" + std::string{name == nullptr ? "(null)" : name} + "'; known: " + variant_names());
    return variant;
}

int set_chip_option(Model& model, const char* name, const char* text) {
    const auto result = regmap::set_option(model.options(), name, text);
    if (result) return DPCHIP_OK;
    const int code = result.error() == regmap::OptionError::unknown_name ? DPCHIP_E_NAME : DPCHIP_E_ARGUMENT;
    return fail(code, std::string{name} + "=" + text + ": " + words(result.error()) + values_of(name));
}

int fill_info(const Model& m, dpchip_chip_info* info) {
    if (info->size < sizeof(size_t)) return fail(DPCHIP_E_ARGUMENT, "dpchip_chip_info.size is not set");
    dpchip_chip_info known{};
    known.size = info->size;
    known.online = m.online() ? 1 : 0;
    known.dp_state = static_cast<int>(m.dp_state());
    known.wd_state = static_cast<int>(m.wd_state());
    known.baud_code = static_cast<int>(m.baud());
    known.address = m.address();
    known.owner = m.owner();
    known.findings = static_cast<std::uint32_t>(m.findings().size());
    std::memcpy(info, &known, std::min(info->size, sizeof known));
    return DPCHIP_OK;
}

std::int64_t save_model(const Model& model, void* bytes, std::size_t capacity) {
    const auto result = model.save({static_cast<std::uint8_t*>(bytes), capacity});
    if (!result) return fail(DPCHIP_E_SPACE, "a snapshot takes " + std::to_string(Model::snapshot_size()) + " octets");
    return static_cast<std::int64_t>(*result);
}

std::string finding_head(const core::Finding& f) { return std::to_string(core::to_ns(f.at)) + " ns: " + kind_name(f.kind) + ": "; }

std::string chip_finding(const core::Finding& f) {
    const regmap::RuleInfo& rule = regmap::kRules[f.rule];
    std::array<char, 16> detail{};
    std::snprintf(detail.data(), detail.size(), "%04XH", static_cast<unsigned>(f.detail));
    return finding_head(f) + std::string{rule.text} + " [" + std::string{rule.name} + ", " + detail.data() + ']';
}

void give_text(const std::string& words, char* text, std::size_t capacity) {
    if (capacity == 0) return;
    const std::size_t n = std::min(words.size(), capacity - 1);
    std::memcpy(text, words.data(), n);
    text[n] = '\0';
}

}  // namespace dpchip::capi
