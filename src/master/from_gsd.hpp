// SPDX-License-Identifier: Apache-2.0
// A slave's configuration from its GSD file and the modules plugged.
#pragma once

#include <span>

#include <dpchip/gsd/configuration.hpp>
#include <dpchip/gsd/gsd.hpp>
#include <dpchip/gsd/user_prm.hpp>
#include <dpchip/master/config.hpp>

namespace dpchip::master {

/// Ident, parameters with their defaults (or `settings`), configuration octets, lengths, Min_Slave_Intervall and
/// Fail_Safe. Watchdog, group, Sync and Freeze are left to the caller. Throws gsd::GsdError for bad settings.
SlaveConfig slave_config(const gsd::Gsd& gsd, const gsd::Configuration& configuration, std::uint8_t address,
                         std::span<const gsd::PrmSetting> settings = {});

}  // namespace dpchip::master
