// SPDX-License-Identifier: Apache-2.0
// GSD to driver configuration. Buffers are as long as the RAM allows, so that a wrong telegram is taken in and judged.
#include <dpchip/slave/station_plan.hpp>

#include <algorithm>
#include <array>
#include <limits>

#include <dpchip/driver/layout.hpp>
#include <dpchip/dp/set_prm.hpp>
#include <dpchip/gsd/user_prm.hpp>
#include <dpchip/slave/error.hpp>

namespace dpchip::slave {
namespace {

bool is_signed(gsd::DataType t) {
    return t == gsd::DataType::signed8 || t == gsd::DataType::signed16 || t == gsd::DataType::signed32;
}
bool is_bits(gsd::DataType t) { return t == gsd::DataType::bit || t == gsd::DataType::bit_area; }

std::uint8_t clamp_octets(std::uint64_t wanted, unsigned low, unsigned high) {
    return static_cast<std::uint8_t>(std::clamp<std::uint64_t>(wanted, low, high));
}

void check_address(const gsd::Gsd& gsd, const SlaveSetup& setup) {
    if (setup.address > 126)
        throw SlaveError{SlaveError::Kind::address, "station address " + std::to_string(setup.address) + ": 0 to 126 are possible"};
    if (setup.address == 126 && !gsd.set_slave_add)
        throw SlaveError{SlaveError::Kind::address,
                         "station address 126 is for stations whose master gives them their address, and " + gsd.model_name +
                             " does not know Set_Slave_Add (Set_Slave_Add_supp = 0)"};
}

/// With Spec_Clear_Mode the chip refuses a Set_Prm that enables DP-V1 without Fail_Safe (7.1). Files exist that promise
/// Fail_Safe and give just such parameters as their default: their own parameters must do, so the mode stays off.
bool accepts_fail_safe(const gsd::Gsd& gsd, const OwnedPrmRules& prm) {
    const std::uint8_t status_1 = prm.default_octet(0);
    return gsd.fail_safe_required || (status_1 & dp::kDpv1Enable) == 0 || (status_1 & dp::kFailSafe) != 0;
}

/// RAM sizes of a chip, the one after reset first.
std::vector<driver::RamSize> ram_sizes(regmap::Variant variant) {
    const regmap::Traits& t = regmap::traits(variant);
    if (t.ram_bytes == driver::bytes(driver::RamSize::bytes_1536)) return {driver::RamSize::bytes_1536};
    if (t.max_ram_bytes == driver::bytes(driver::RamSize::bytes_4096))
        return {driver::RamSize::bytes_2048, driver::RamSize::bytes_4096};
    return {driver::RamSize::bytes_2048};
}

/// Finds room: generous lengths in either RAM, then less, then only what the station needs.
void choose_lengths(driver::Config& c, const gsd::Configuration& configuration) {
    const std::size_t needed_prm = dp::kSetPrmHeader + std::size_t{c.prm_rules.min_octets};
    driver::ConfigError error = driver::ConfigError::none;
    for (const unsigned room : {244u, 96u, 0u})
        for (const driver::RamSize ram : ram_sizes(c.variant)) {
            c.ram = ram;
            c.max_prm = clamp_octets(std::max<std::uint64_t>(needed_prm, room), 7, 244);
            c.max_cfg = clamp_octets(std::max<std::uint64_t>(configuration.cfg.size(), room), 0, 244);
            error = driver::lay_out(c).error;
            if (error == driver::ConfigError::none) return;
        }
    const auto kind = error >= driver::ConfigError::dout_space ? SlaveError::Kind::ram : SlaveError::Kind::chip;
    throw SlaveError{kind, std::string{regmap::traits(c.variant).name} + ": " + driver::name(error) + " (" +
                               std::to_string(configuration.input_octets) + " octets of inputs, " +
                               std::to_string(configuration.output_octets) + " of outputs)"};
}

}  // namespace

OwnedPrmRules::OwnedPrmRules(const gsd::Gsd& gsd, const gsd::Configuration& configuration, bool ext_prm) {
    const auto telegram = ext_prm ? gsd::PrmTelegram::set_ext_prm : gsd::PrmTelegram::set_prm;
    const gsd::UserPrmData data = gsd::user_prm_data(gsd, configuration, {}, telegram);
    defaults_ = data.octets;
    for (std::size_t i = 0; i < data.octets.size(); ++i) {
        const auto fixed = static_cast<std::uint8_t>(~data.variable[i]);
        possible_.push_back(static_cast<std::uint8_t>(data.octets[i] | data.variable[i]));
        if (fixed != 0) constants_.push_back({static_cast<std::uint8_t>(i), fixed, data.octets[i]});
    }
    std::size_t count = 0;
    for (const gsd::PrmField& f : data.fields) count += gsd.parameters[f.parameter].allowed.size();
    ranges_.reserve(count);
    for (const gsd::PrmField& f : data.fields) {
        const gsd::Parameter& p = gsd.parameters[f.parameter];
        if (p.allowed.empty()) continue;
        const std::size_t first = ranges_.size();
        for (const gsd::ValueRange& r : p.allowed) ranges_.push_back({r.min, r.max});
        driver::PrmValue v;
        v.offset = static_cast<std::uint8_t>(f.offset);
        v.octets = f.octets;
        v.is_signed = is_signed(p.type);
        if (is_bits(p.type)) {
            v.bit = f.shift;
            v.width = static_cast<std::uint8_t>(__builtin_popcount(f.mask));
        }
        v.ranges = std::span{ranges_}.subspan(first);
        values_.push_back(v);
    }
    const auto octets = static_cast<std::uint8_t>(std::min<std::size_t>(data.octets.size(), 244));
    rules_ = {octets, octets, constants_, values_};
}

std::uint8_t OwnedPrmRules::possible_bits(std::size_t offset) const {
    return offset < possible_.size() ? possible_[offset] : std::uint8_t{0};
}

std::uint8_t OwnedPrmRules::default_octet(std::size_t offset) const {
    return offset < defaults_.size() ? defaults_[offset] : std::uint8_t{0};
}

StationPlan::StationPlan(const gsd::Gsd& gsd, const SlaveSetup& setup) {
    check_address(gsd, setup);
    configuration = gsd::configure(gsd, setup.modules);
    prm = OwnedPrmRules{gsd, configuration, false};
    const regmap::Traits& t = regmap::traits(setup.variant);
    driver::Config& c = driver;
    c.variant = setup.variant;
    c.address = setup.address;
    c.ident = gsd.ident_number;
    c.cfg = configuration.cfg;
    c.cfg_policy = setup.cfg_policy;
    c.prm_rules = prm.rules();
    c.max_diag = clamp_octets(gsd.max_diag_data_len, 6, 244);
    c.set_slave_add = gsd.set_slave_add;
    c.no_add_change = setup.no_add_change;
    c.sync_supported = gsd.sync_mode;
    c.freeze_supported = gsd.freeze_mode;
    c.fail_safe = gsd.fail_safe && accepts_fail_safe(gsd, prm);
    c.user_watchdog = setup.user_watchdog;
    if (setup.min_tsdr) c.min_tsdr = *setup.min_tsdr;
    // Octets 8 and 9 of Set_Prm are the station's own when it is no DP-V1 slave; the chip must not look into them.
    if (t.prm_reserved_checks) {
        const std::uint8_t octet_9 = prm.possible_bits(2);
        c.check_prm_reserved = gsd.dpv1.slave;
        c.prm_cmd_supported = gsd.dpv2.prm_cmd || (!gsd.dpv1.slave && (octet_9 & dp::kPrmCmd) != 0);
        c.sync_ena = gsd.dpv2.isochron_mode || (!gsd.dpv1.slave && (octet_9 & dp::kIsoMReq) != 0);
    }
    if (gsd.dpv2.x_prm_sap && t.ext_prm) {
        ext_prm = OwnedPrmRules{gsd, configuration, true};
        c.set_ext_prm = true;
    }
    if (setup.cfg_policy == driver::CfgPolicy::follow_master) {
        c.max_inputs = clamp_octets(gsd.max_input_len.value_or(configuration.input_octets), 0, 244);
        c.max_outputs = clamp_octets(gsd.max_output_len.value_or(configuration.output_octets), 0, 244);
    }
    // Without outputs no DX_Out would tell of the exchange; the chips that can are told to say it all the same.
    if (configuration.output_octets == 0 && !t.access_violation) c.dx_int = driver::DxInt::always;
    choose_lengths(c, configuration);
}

}  // namespace dpchip::slave
