// SPDX-License-Identifier: Apache-2.0
// From a GSD and plugged modules to what the driver wants: configuration octets, rules for Set_Prm, buffer lengths.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <dpchip/core/clock.hpp>
#include <dpchip/driver/config.hpp>
#include <dpchip/driver/dxb_subscriber.hpp>
#include <dpchip/driver/isochron.hpp>
#include <dpchip/gsd/configuration.hpp>
#include <dpchip/gsd/gsd.hpp>
#include <dpchip/regmap/options.hpp>
#include <dpchip/regmap/variant.hpp>
#include <dpchip/slave/identification.hpp>
#include <dpchip/slave/record_table.hpp>

namespace dpchip::slave {

/// What a virtual slave is made of, besides its GSD.
struct SlaveSetup {
    std::string name{};                ///< for people; empty: the GSD's Model_Name
    std::vector<std::string> modules{};  ///< as gsd::configure takes them; empty: the preset or only module
    std::uint8_t address = 126;
    regmap::Variant variant = regmap::Variant::vpc3c;
    regmap::Options options{};         ///< of the chip's model
    std::string io = "echo";
    std::optional<std::uint8_t> min_tsdr{};              ///< bit times; else the chip's default
    bool no_add_change = false;                          ///< Set_Slave_Add has locked the address before
    driver::CfgPolicy cfg_policy = driver::CfgPolicy::plugged;
    core::Clock clock{};                                 ///< the crystal against line time
    core::Ticks firmware_delay{};                        ///< from X/INT to the interrupt routine
    std::uint16_t user_watchdog = 0;                     ///< R_User_WD_Value; 0: off
    driver::IsochronConfig isochron{};                   ///< what is a SYNCH, and the SYNC pin. Simple Sync Mode is the user's
                                                         ///< choice; Isochron Mode comes with Isochron_Mode_supp
    bool clock_rate = true;                              ///< Time_Sync_supp: the crystal's drift is learnt and allowed for
    std::vector<Record> records{};                       ///< DP-V1
    std::optional<Identification> identification{};      ///< I&M; else from the GSD, and only when that says so
    std::optional<std::uint8_t> connections{};           ///< class-2; else as many as the GSD says and the RAM holds
};

/// User_Prm_Data rules with everything their views point to. Stays where it is.
class OwnedPrmRules {
public:
    OwnedPrmRules() = default;
    /// The DPV1_Status octets of a DP-V1 slave are its master's to choose: constants of the GSD do not bind them.
    OwnedPrmRules(const gsd::Gsd& gsd, const gsd::Configuration& configuration, bool ext_prm);
    OwnedPrmRules(OwnedPrmRules&&) = default;
    OwnedPrmRules& operator=(OwnedPrmRules&&) = default;
    OwnedPrmRules(const OwnedPrmRules&) = delete;
    OwnedPrmRules& operator=(const OwnedPrmRules&) = delete;

    const driver::PrmRules& rules() const { return rules_; }
    /// Bits of an octet that may be 1 in a good telegram; 0 beyond the end.
    std::uint8_t possible_bits(std::size_t offset) const;
    /// An octet as the GSD gives it by default; 0 beyond the end.
    std::uint8_t default_octet(std::size_t offset) const;

private:
    std::vector<driver::PrmConstant> constants_;
    std::vector<driver::PrmRange> ranges_;
    std::vector<driver::PrmValue> values_;
    std::vector<std::uint8_t> possible_, defaults_;
    driver::PrmRules rules_{};
};

/// A station ready to be configured. The driver's views point into it: it must stay alive as long as the driver.
struct StationPlan {
    gsd::Configuration configuration;
    OwnedPrmRules prm, ext_prm;
    driver::Config driver;
    driver::DxbConfig dxb{};      ///< Subscriber_supp
    bool publisher = false;       ///< Publisher_supp
    bool clock = false;           ///< Time_Sync_supp
    bool clock_rate = true;
    driver::IsochronConfig isochron{};
    bool blocks = false;          ///< blocks of DP-V2 are looked for in the parameters: a DP-V1 slave that knows any of them
    bool dpv2() const { return blocks; }
    /// Isochron Mode or Simple Sync Mode.
    bool synchronous() const { return driver.sync_ena || isochron.simple_sync; }
    /// Octets of Ext_Diag_Data beside alarms.
    std::size_t diag_room() const { return std::size_t{driver.max_diag} - 6u - driver.dpv1.max_alarm; }
    /// Those of ext_prm; blocks of DP-V2 may follow what the GSD describes.
    driver::PrmRules ext_prm_rules() const;

    /// Throws GsdError for modules, SlaveError for address, chip and RAM.
    StationPlan(const gsd::Gsd& gsd, const SlaveSetup& setup);
};

}  // namespace dpchip::slave
