// SPDX-License-Identifier: Apache-2.0
// Structured_Prm_Data in the parameters of a slave: links, isochronous cycles, clock synchronisation, redundancy commands
// (VPC3+C 7.1, 7.3; reference 3.4.6, 6). Each function adds a block behind those that are there and sets the bits of
// DPV1_Status that it needs. Before Master::add(), or before a new Set_Prm.
#pragma once

#include <cstddef>
#include <span>

#include <dpchip/core/result.hpp>
#include <dpchip/core/ticks.hpp>
#include <dpchip/dp/clock.hpp>
#include <dpchip/dp/dxb_prm.hpp>
#include <dpchip/dp/isom_prm.hpp>
#include <dpchip/dp/redundancy.hpp>
#include <dpchip/gsd/gsd.hpp>
#include <dpchip/master/config.hpp>

namespace dpchip::master {

/// How many octets of user_prm there are now. With an error, nothing has changed.
using BlockAdded = core::Result<std::size_t, ConfigError>;

/// Makes a subscriber of it: a DXB_Linktable. At most 29 links; the slave needs a watchdog for them.
BlockAdded add_links(SlaveConfig& slave, std::span<const dp::DxbLink> links);
/// Isochron Mode (figure 7-18): DPV1_Enable, Fail_Safe and IsoM_Req besides; no Sync_Req, no Freeze_Req, not in group 8.
BlockAdded add_isochron(SlaveConfig& slave, const dp::IsoMPrm& times);
BlockAdded add_clock(SlaveConfig& slave, const dp::TimeAr& time);
BlockAdded add_prm_cmd(SlaveConfig& slave, const dp::PrmCmd& command);

/// The times of a cycle in the units of a GSD, T_I and T_O as short as it allows. T_DP is 0, which add_isochron() refuses,
/// when the cycle is no whole number of TBASE_DP within TDP_MIN and TDP_MAX.
dp::IsoMPrm isochron_times(const gsd::DpV2& abilities, Ticks cycle);

}  // namespace dpchip::master
