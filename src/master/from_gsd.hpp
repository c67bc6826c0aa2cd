// SPDX-License-Identifier: Apache-2.0
// A slave's configuration from its GSD file and the modules plugged.
#pragma once

#include <span>

#include <dpchip/gsd/configuration.hpp>
#include <dpchip/gsd/gsd.hpp>
#include <dpchip/gsd/user_prm.hpp>
#include <dpchip/master/config.hpp>
#include <dpchip/master/ms1.hpp>
#include <dpchip/master/ms2.hpp>

namespace dpchip::master {

/// Ident, parameters with their defaults (or `settings`), configuration octets, lengths, Min_Slave_Intervall and
/// Fail_Safe. Watchdog, group, Sync and Freeze are left to the caller. Throws gsd::GsdError for bad settings.
SlaveConfig slave_config(const gsd::Gsd& gsd, const gsd::Configuration& configuration, std::uint8_t address,
                         std::span<const gsd::PrmSetting> settings = {});

/// Sets DPV1_Enable in the slave's parameters, with Fail_Safe where the GSD says so: MS1 needs it. `alarms`: bits of
/// DPV1_Status_2, of which those that the GSD supports are set; those that it requires are set anyway. `alarm_mode`: 0 one alarm of each type at a time, 1..7
/// see dp::alarm_limit().
void enable_dpv1(SlaveConfig& slave, const gsd::DpV1& dpv1, bool fail_safe, std::uint8_t alarms = 0, std::uint8_t alarm_mode = 0);

/// Bits of DPV1_Status_2 for the alarms that the GSD supports.
std::uint8_t supported_alarms(const gsd::DpV1& dpv1);

/// How long the slave may take for an answer: C1_Response_Timeout and C2_Response_Timeout, and a second for the
/// line; without them the relation's own default.
Ms1Config ms1_config(const gsd::Gsd& gsd, std::uint8_t address);
Ms2Config ms2_config(const gsd::Gsd& gsd, std::uint8_t address);

}  // namespace dpchip::master
