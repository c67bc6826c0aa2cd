// SPDX-License-Identifier: Apache-2.0
// What a [[slave]] of a TOML file says of DP-V1: [[slave.record]] and [slave.identification] (docs/config.md).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <dpchip/cli/toml_reader.hpp>
#include <dpchip/gsd/gsd.hpp>
#include <dpchip/slave/identification.hpp>
#include <dpchip/slave/record_table.hpp>

namespace dpchip::cli {

/// Fields of I&M0 to I&M3 that differ from what the GSD gives.
struct IdentificationEntry {
    std::optional<std::uint16_t> manufacturer_id{}, hardware_revision{}, revision_counter{}, profile_id{}, profile_type{};
    std::optional<std::string> order_id{}, serial_number{}, software_revision{};
    std::optional<std::string> tag_function{}, tag_location{}, installation_date{}, descriptor{};
};

/// The records of `slave`. `beside` resolves the path of a file with a record's octets.
std::vector<slave::Record> read_records(TomlReader& slave, const std::string& file, const std::function<std::string(const std::string&)>& beside);
std::optional<IdentificationEntry> read_identification(TomlReader& slave, const std::string& file);

slave::Identification identification(const gsd::Gsd& gsd, const IdentificationEntry& entry);

}  // namespace dpchip::cli
