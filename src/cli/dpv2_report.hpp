// SPDX-License-Identifier: Apache-2.0
// What a simulation measured of DP-V2: samples, SYNC pulses, clocks, roles.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <dpchip/cli/simulation.hpp>

namespace dpchip::cli {

/// A line for each slave that has something to say.
void report_dpv2(const Simulation& simulation);
/// The same under "dpv2" of a slave's entry.
void report_dpv2(const Simulation& simulation, std::size_t slave, nlohmann::ordered_json& entry);

}  // namespace dpchip::cli
