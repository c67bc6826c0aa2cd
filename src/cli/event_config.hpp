// SPDX-License-Identifier: Apache-2.0
// [[event]] of a TOML file, and the same as a line of words.
#pragma once

#include <toml++/toml.h>

#include <dpchip/cli/line_config.hpp>

namespace dpchip::cli {

/// Reads one event. The slaves of `config` must be known already.
EventEntry read_event(const toml::table& table, const LineConfig& config);
/// Reads an event of the slave's own side from a line of words, to happen at once: `DO KEY=VALUE ...` with the keys of
/// [[event]], values with blanks in quotes, lists with commas; `at` is where the line stands, for messages. Throws Failure.
EventEntry read_command(const std::string& line, const Place& at, const LineConfig& config);
/// Puts events into the order of their times; those of one time keep the order of the file.
void sort_events(LineConfig& config);

}  // namespace dpchip::cli
