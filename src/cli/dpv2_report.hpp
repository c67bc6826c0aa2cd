// SPDX-License-Identifier: Apache-2.0
// What slaves did in DP-V2 and a simulation measured: samples, SYNC pulses, clocks, roles.
#pragma once

#include <cstdint>
#include <optional>

#include <nlohmann/json_fwd.hpp>

#include <dpchip/cli/simulation.hpp>

namespace dpchip::cli {

/// A line, if the slave has something to say. `clock_error_ns`: its time minus the master's, where that is known.
void report_dpv2(const SlaveEntry& entry, const slave::VirtualSlave& slave, std::optional<std::int64_t> clock_error_ns = {});
/// A line for each slave that has something to say.
void report_dpv2(const Simulation& simulation);
/// The same under "dpv2" of a slave's entry.
void report_dpv2(const Simulation& simulation, std::size_t slave, nlohmann::ordered_json& entry);

}  // namespace dpchip::cli
