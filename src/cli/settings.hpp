// SPDX-License-Identifier: Apache-2.0
// Values that TOML and the command line share: chips, options of the model, I/O behaviours.
#pragma once

#include <string>

#include <dpchip/cli/failure.hpp>
#include <dpchip/regmap/options.hpp>
#include <dpchip/regmap/variant.hpp>

namespace dpchip::cli {

/// "vpc3+c" and its kind; refuses others with a list.
regmap::Variant parse_chip(const std::string& name, const Place& at);
/// Sets an option of the model, or refuses name or value with what is possible.
void set_option(regmap::Options& options, const std::string& name, const std::string& value, const Place& at);
/// The same from "NAME=VALUE".
void set_option(regmap::Options& options, const std::string& name_and_value, const Place& at);
/// Refuses what is none of echo, invert, counter, hold:HEX.
void check_io(const std::string& text, const Place& at);
/// What --show-options prints.
std::string options_text();

}  // namespace dpchip::cli
