// SPDX-License-Identifier: Apache-2.0
// What an [[event]] says about a diagnosis, an alarm or a status message (docs/config.md), and which alarms a [[slave]]'s
// master enables.
#pragma once

#include <dpchip/cli/line_config.hpp>
#include <dpchip/cli/toml_reader.hpp>

namespace dpchip::cli {

/// Ext_Diag_Data from module_status, identifiers, channels and octets, in this order; ext_diag and stat_diag.
void read_diagnosis(TomlReader& t, EventEntry& event);
/// type, slot, specifier, add_ack and octets of an alarm or a status message; event.kind says which.
void read_alarm(TomlReader& t, EventEntry& event);
/// `alarms` and `alarm_sequence` of a [[slave]].
void read_enabled_alarms(TomlReader& t, SlaveEntry& slave);

}  // namespace dpchip::cli
