// SPDX-License-Identifier: Apache-2.0
// Checks with messages that say what would be right.
#include <fmt/format.h>

#include <dpchip/cli/settings.hpp>
#include <dpchip/slave/io_behaviour.hpp>
#include <dpchip/slave/error.hpp>

namespace dpchip::cli {

regmap::Variant parse_chip(const std::string& name, const Place& at) {
    if (const auto variant = regmap::variant_from_name(name)) return *variant;
    std::string names;
    for (const regmap::Traits& t : regmap::kTraits) names += (names.empty() ? "" : ", ") + std::string{t.name};
    refuse(at, fmt::format("chip \"{}\": {} are possible", name, names));
}

void set_option(regmap::Options& options, const std::string& name, const std::string& value, const Place& at) {
    const auto done = regmap::set_option(options, name, value);
    if (done) return;
    if (done.error() == regmap::OptionError::unknown_name) {
        std::string names;
        for (const regmap::OptionInfo& o : regmap::option_table()) names += (names.empty() ? "" : ", ") + std::string{o.name};
        refuse(at, fmt::format("option \"{}\" does not exist; there are {}", name, names));
    }
    for (const regmap::OptionInfo& o : regmap::option_table())
        if (o.name == name) refuse(at, fmt::format("option {} = \"{}\": it takes {}", name, value, o.values));
}

void set_option(regmap::Options& options, const std::string& name_and_value, const Place& at) {
    const std::size_t equals = name_and_value.find('=');
    if (equals == std::string::npos) refuse(at, fmt::format("option \"{}\": NAME=VALUE is expected", name_and_value));
    set_option(options, name_and_value.substr(0, equals), name_and_value.substr(equals + 1), at);
}

void check_io(const std::string& text, const Place& at) {
    try {
        const slave::IoBehaviour checked{text};
    } catch (const slave::SlaveError& e) {
        refuse(at, e.what());
    }
}

std::string options_text() {
    std::string out;
    for (const regmap::OptionInfo& o : regmap::option_table())
        out += fmt::format("{:<32}{:<22}default {:<10}reference {:<7}{}\n", o.name, o.values, o.default_text, o.section, o.meaning);
    return out;
}

}  // namespace dpchip::cli
