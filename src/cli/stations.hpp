// SPDX-License-Identifier: Apache-2.0
// From entries of a LineConfig to objects: GSDs read once, virtual slaves, and what a master is told of its slaves.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <dpchip/chip/state_names.hpp>
#include <dpchip/cli/line_config.hpp>
#include <dpchip/gsd/configuration.hpp>
#include <dpchip/gsd/gsd.hpp>
#include <dpchip/slave/virtual_slave.hpp>

namespace dpchip::cli {

/// GSD files by path: "-" is stdin, "builtin:..." are inside the program. Throws Failure.
class GsdShelf {
public:
    const gsd::Gsd& get(const std::string& path, const Place& at = {});

private:
    std::map<std::string, std::unique_ptr<gsd::Gsd>> files_;
};

/// Modules plugged as the entry says; refusals name the entry.
gsd::Configuration configure(const gsd::Gsd& gsd, const SlaveEntry& entry);

/// Powers a slave up at line time `at`. `stored`: an address given by Set_Slave_Add in an earlier run.
std::unique_ptr<slave::VirtualSlave> make_slave(const gsd::Gsd& gsd, const SlaveEntry& entry, Ticks at = {},
                                                const slave::StoredAddress* stored = nullptr);

/// What a class-1 master is told. `watchdog_ms` holds for entries that say nothing.
master::SlaveConfig master_config(const gsd::Gsd& gsd, const SlaveEntry& entry, std::uint32_t watchdog_ms);

/// What the firmware says of faults: present rate, or "searching".
std::string rate_text(const slave::VirtualSlave& slave);

}  // namespace dpchip::cli
