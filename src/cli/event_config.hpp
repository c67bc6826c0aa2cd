// SPDX-License-Identifier: Apache-2.0
// [[event]] of a SCENARIO.toml.
#pragma once

#include <toml++/toml.h>

#include <dpchip/cli/line_config.hpp>

namespace dpchip::cli {

/// Reads one event. The slaves of `config` must be known already.
EventEntry read_event(const toml::table& table, const LineConfig& config);
/// Puts events into the order of their times; those of one time keep the order of the file.
void sort_events(LineConfig& config);

}  // namespace dpchip::cli
