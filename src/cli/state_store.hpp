// SPDX-License-Identifier: Apache-2.0
// --state-dir: what Set_Slave_Add changed outlives the program, in one small TOML file per slave.
#pragma once

#include <optional>
#include <string>

#include <dpchip/cli/line_config.hpp>
#include <dpchip/slave/virtual_slave.hpp>

namespace dpchip::cli {

class StateStore {
public:
    /// Makes the folder when it is missing. Throws Failure.
    explicit StateStore(std::string folder);
    /// What an earlier run left for this slave; throws Failure when the file is damaged or belongs to another device.
    std::optional<slave::StoredAddress> load(const SlaveEntry& entry, std::uint16_t ident) const;
    /// Writes a new file and renames it over the old one.
    void save(const SlaveEntry& entry, std::uint16_t ident, const slave::StoredAddress& stored) const;
    /// The slave's file: its name, else "slave-" and its configured address.
    std::string path(const SlaveEntry& entry) const;

private:
    std::string folder_;
};

}  // namespace dpchip::cli
