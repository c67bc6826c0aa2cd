// SPDX-License-Identifier: Apache-2.0
// The master of a line and its slaves, as the files say.
#include <dpchip/cli/dpv2_config.hpp>
#include <dpchip/cli/master_setup.hpp>
#include <dpchip/cli/slave_arguments.hpp>

namespace dpchip::cli {
namespace {

MasterEntry only_master(const LineConfig& config) {
    if (config.masters.size() > 1) refuse(config.masters[1].at, "one [[master]] is possible: the master does not share the bus with others");
    return config.masters.empty() ? MasterEntry{} : config.masters.front();
}

}  // namespace

master::MasterConfig master_config(const LineConfig& config, fdl::BaudCode baud) {
    const MasterEntry entry = only_master(config);
    master::MasterConfig m;
    m.address = entry.address;
    m.baud = config.baud.value_or(baud);
    m.max_retry = entry.max_retry;
    m.gap_factor = entry.gap_factor;
    m.min_cycle = entry.min_cycle;
    m.mode = entry.mode;
    apply_dpv2(m, entry.dpv2);
    if (config.slot_time) m.slot_time = config.slot_time->at(m.baud);
    return m;
}

std::vector<master::SlaveConfig> slave_configs(const LineConfig& config, GsdShelf& shelf, std::uint32_t watchdog_ms) {
    const auto inputs_of = [&](std::uint8_t address) -> std::optional<std::uint8_t> {
        for (const SlaveEntry& entry : config.slaves)
            if (entry.address == address) return static_cast<std::uint8_t>(configure(shelf.get(entry.gsd, entry.at), entry).input_octets);
        return std::nullopt;
    };
    const MasterDpv2Entry master = only_master(config).dpv2;
    std::vector<master::SlaveConfig> all;
    for (const SlaveEntry& entry : config.slaves) {
        if (entry.address == 126) refuse(entry.at, "a slave with address 126 has to get another one first");
        const gsd::Gsd& gsd = shelf.get(entry.gsd, entry.at);
        all.push_back(master_config(gsd, entry, watchdog_ms));
        apply_dpv2(all.back(), gsd, entry.dpv2, master, inputs_of);
    }
    return all;
}

void add_slaves(master::Master& master, const LineConfig& config, const std::vector<master::SlaveConfig>& slaves) {
    for (std::size_t i = 0; i < slaves.size(); ++i) {
        const SlaveEntry& entry = config.slaves[i];
        if (const auto added = master.add(slaves[i]); !added) refuse(entry.at, title(entry) + ": " + master::name(added.error()));
    }
}

}  // namespace dpchip::cli
