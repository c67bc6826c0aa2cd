// SPDX-License-Identifier: Apache-2.0
// What a TOML file says of DP-V2: links, publishers, isochronous cycles, clock synchronisation, redundancy (docs/config.md).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <dpchip/cli/toml_reader.hpp>
#include <dpchip/driver/redundancy.hpp>
#include <dpchip/gsd/gsd.hpp>
#include <dpchip/master/config.hpp>
#include <dpchip/slave/station_plan.hpp>

namespace dpchip::cli {

/// A [[slave.link]].
struct LinkEntry {
    Place at{};
    std::uint8_t publisher{};                  ///< its address
    std::optional<std::uint8_t> length{};      ///< what it publishes; nothing: the inputs of that slave
    std::uint8_t offset = 0;
    std::optional<std::uint8_t> octets{};      ///< nothing: the rest
};

/// Of a [[slave]].
struct Dpv2Entry {
    Place at{};
    bool publisher = false;
    std::vector<LinkEntry> links;
    bool simple_sync = false;
    bool clock_rate = true;
    std::optional<driver::Role> prm_cmd{};
};

/// Of a [[master]].
struct MasterDpv2Entry {
    Ticks isochron{}, jitter{};
    Ticks clock_sync{};
};

Dpv2Entry read_dpv2(TomlReader& slave, const std::string& file);
MasterDpv2Entry read_master_dpv2(TomlReader& master);

void apply_dpv2(slave::SlaveSetup& setup, const Dpv2Entry& entry);
void apply_dpv2(master::MasterConfig& config, const MasterDpv2Entry& entry);
/// Blocks of parameters for what the entry, its master and the GSD say. `inputs_of`: octets that the slave with an address
/// publishes, nothing when there is none. Refusals name the entry.
void apply_dpv2(master::SlaveConfig& config, const gsd::Gsd& gsd, const Dpv2Entry& entry, const MasterDpv2Entry& master,
                const std::function<std::optional<std::uint8_t>(std::uint8_t address)>& inputs_of);

}  // namespace dpchip::cli
