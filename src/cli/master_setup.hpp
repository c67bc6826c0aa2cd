// SPDX-License-Identifier: Apache-2.0
// From a LineConfig to the master of its line and what that master is told of each slave; simulated and live lines alike.
#pragma once

#include <vector>

#include <dpchip/cli/line_config.hpp>
#include <dpchip/cli/stations.hpp>
#include <dpchip/master/master.hpp>

namespace dpchip::cli {

/// What [[master]] says of the master; `baud` holds for files that say nothing. Throws Failure.
master::MasterConfig master_config(const LineConfig& config, fdl::BaudCode baud);

/// A slave each, in the order of the entries, with the blocks of parameters that links and their kind need. `watchdog_ms`
/// holds for entries that say nothing. Throws Failure.
std::vector<master::SlaveConfig> slave_configs(const LineConfig& config, GsdShelf& shelf, std::uint32_t watchdog_ms);

/// Adds the slaves to a master; refusals name the entry. Throws Failure.
void add_slaves(master::Master& master, const LineConfig& config, const std::vector<master::SlaveConfig>& slaves);

}  // namespace dpchip::cli
