// SPDX-License-Identifier: Apache-2.0
// GSD to driver configuration. Buffers are as long as the RAM allows, so that a wrong telegram is taken in and judged.
#include <dpchip/slave/station_plan.hpp>

#include <algorithm>
#include <array>
#include <limits>

#include <dpchip/driver/acyclic_layout.hpp>
#include <dpchip/driver/layout.hpp>
#include <dpchip/driver/slave_clock.hpp>
#include <dpchip/dp/alarm.hpp>
#include <dpchip/dp/set_prm.hpp>
#include <dpchip/gsd/user_prm.hpp>
#include <dpchip/slave/error.hpp>

namespace dpchip::slave {
namespace {

constexpr std::uint8_t kDpv1StatusOctets = 3;

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

/// DX_Int_Port means nothing while SYNC_Ena is set (5.1.3).
void check_simple_sync(const regmap::Traits& chip, bool sync_ena) {
    if (!chip.isom) throw SlaveError{SlaveError::Kind::chip, std::string{chip.name} + " does not know Simple Sync Mode"};
    if (sync_ena)
        throw SlaveError{SlaveError::Kind::chip, "Simple Sync Mode is for stations without Isochron Mode, and this one has it (Isochron_Mode_supp, "
                                                 "or user parameters in the place of IsoM_Req)"};
}

/// With Spec_Clear_Mode the chip refuses a Set_Prm that enables DP-V1 without Fail_Safe (7.1). Files exist that promise
/// Fail_Safe and give just such parameters as their default: their own parameters must do, so the mode stays off.
bool accepts_fail_safe(const gsd::Gsd& gsd, const OwnedPrmRules& prm) {
    const std::uint8_t status_1 = prm.default_octet(0);
    return gsd.fail_safe_required || (status_1 & dp::kDpv1Enable) == 0 || (status_1 & dp::kFailSafe) != 0;
}

/// Alarm types of a GSD as bits of DPV1_Status_2.
std::uint8_t alarm_bits(const gsd::DpV1& v1) {
    unsigned bits = 0;
    if (v1.diagnostic_alarm) bits |= dp::kEnableDiagnosticAlarm;
    if (v1.process_alarm) bits |= dp::kEnableProcessAlarm;
    if (v1.pull_plug_alarm) bits |= dp::kEnablePullPlugAlarm;
    if (v1.status_alarm) bits |= dp::kEnableStatusAlarm;
    if (v1.update_alarm) bits |= dp::kEnableUpdateAlarm;
    if (v1.manufacturer_specific_alarm) bits |= dp::kEnableManufacturerSpecificAlarm;
    return static_cast<std::uint8_t>(bits);
}

/// DP-V1 as the keywords say. Alarms are acknowledged over MS1, so that they open SAP 51 also for stations that keep no
/// records there. Of the room in the diagnosis behind the six octets alarms get one half, at least the shortest one.
driver::AcyclicConfig acyclic_config(const gsd::Gsd& gsd, const SlaveSetup& setup, std::uint8_t max_diag) {
    const gsd::DpV1& v1 = gsd.dpv1;
    driver::AcyclicConfig a{};
    const unsigned room = max_diag - 6u;
    a.alarms = room >= dp::kAlarmHeader ? alarm_bits(v1) : std::uint8_t{0};
    a.ms1 = v1.c1_read_write || a.alarms != 0;
    if (a.ms1) a.ms1_max_data = clamp_octets(v1.c1_read_write ? v1.c1_max_data_len : 0, 4, dp::kMaxRecord);
    a.alarm_sap = a.ms1 && v1.extra_alarm_sap;
    if (a.alarms != 0) {
        a.max_alarm = clamp_octets(room / 2, dp::kAlarmHeader, dp::kMaxDeviceBlock);
        a.alarm_sequence = v1.alarm_sequence_mode_count >= 2 ? clamp_octets(v1.alarm_sequence_mode_count, 2, 32) : std::uint8_t{0};
    }
    if (v1.c2_read_write) {
        a.connections = setup.connections.value_or(clamp_octets(v1.c2_max_count_channels, 1, driver::kMaxConnections));
        a.ms2_max_data = clamp_octets(v1.c2_max_data_len, 4, dp::kMaxRecord);
        // What the file promises to take must not be cut off by the slave's own supervision.
        a.send_timeout = static_cast<std::uint16_t>(std::min<std::uint32_t>(v1.c2_response_timeout, dp::kMaxSendTimeout));
        if (v1.max_initiate_pdu_length != 0) a.max_initiate = clamp_octets(v1.max_initiate_pdu_length, dp::kMinInitiateReq, dp::kMaxInitiatePdu);
    }
    a.identification = v1.ident_maintenance || setup.identification;
    return a;
}

/// RAM sizes of a chip, the one after reset first.
std::vector<driver::RamSize> ram_sizes(regmap::Variant variant) {
    const regmap::Traits& t = regmap::traits(variant);
    if (t.ram_bytes == driver::bytes(driver::RamSize::bytes_1536)) return {driver::RamSize::bytes_1536};
    if (t.max_ram_bytes == driver::bytes(driver::RamSize::bytes_4096))
        return {driver::RamSize::bytes_2048, driver::RamSize::bytes_4096};
    return {driver::RamSize::bytes_2048};
}

/// What DP-V2 takes at the end of the RAM.
struct Dpv2Room {
    driver::DxbConfig dxb;
    bool clock;
    unsigned octets(std::uint8_t shift) const {
        const unsigned segment = 1u << shift;
        return (dxb.max_links != 0 ? driver::DxbSubscriber<driver::MemoryMappedBus>::room(dxb, shift) + segment : 0u) +
               (clock ? driver::SlaveClock<driver::MemoryMappedBus>::kRoom : 0u);
    }
};

/// Why the chip's RAM cannot hold it all; none when it can.
driver::ConfigError fault_of(const driver::Config& c, const Dpv2Room& room) {
    const driver::Layout cyclic = driver::lay_out(c);
    if (cyclic.error != driver::ConfigError::none) return cyclic.error;
    const driver::AcyclicLayout acyclic = driver::lay_out_acyclic(c, cyclic);
    if (acyclic.error != driver::ConfigError::none) return acyclic.error;
    return acyclic.used_bytes + room.octets(cyclic.shift) > cyclic.ram_bytes ? driver::ConfigError::acyclic_space : driver::ConfigError::none;
}

/// Class-2 connections are given up last of all, one after the other.
bool fits_with_fewer_connections(driver::Config& c, const Dpv2Room& room) {
    while (c.dpv1.connections > 1) {
        --c.dpv1.connections;
        if (fault_of(c, room) == driver::ConfigError::none) return true;
    }
    return false;
}

/// Whether other modules than the plugged ones find room, too, without giving up connections for them.
bool has_room(driver::Config c, const Dpv2Room& dpv2) {
    c.ram = ram_sizes(c.variant).back();
    c.max_prm = clamp_octets(dp::kSetPrmHeader + std::size_t{c.prm_rules.min_octets}, 7, 244);
    return fault_of(c, dpv2) == driver::ConfigError::none;
}

/// Finds room: generous lengths in either RAM, then less, then only what the station needs.
void choose_lengths(driver::Config& c, const gsd::Configuration& configuration, const Dpv2Room& dpv2) {
    const std::size_t needed_prm = dp::kSetPrmHeader + std::size_t{c.prm_rules.min_octets};
    driver::ConfigError error = driver::ConfigError::none;
    for (const unsigned room : {244u, 96u, 0u})
        for (const driver::RamSize ram : ram_sizes(c.variant)) {
            c.ram = ram;
            c.max_prm = clamp_octets(std::max<std::uint64_t>(needed_prm, room), 7, 244);
            c.max_cfg = clamp_octets(std::max<std::uint64_t>(configuration.cfg.size(), room), 0, 244);
            error = fault_of(c, dpv2);
            if (error == driver::ConfigError::none) return;
        }
    if (fits_with_fewer_connections(c, dpv2)) return;
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
        const bool dpv1_status = gsd.dpv1.slave && !ext_prm && i < kDpv1StatusOctets;
        if (fixed != 0 && !dpv1_status) constants_.push_back({static_cast<std::uint8_t>(i), fixed, data.octets[i]});
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
    const std::uint8_t most = gsd.dpv1.slave && !ext_prm ? std::max(octets, kDpv1StatusOctets) : octets;
    rules_ = {octets, most, constants_, values_};
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
    isochron = setup.isochron;
    clock_rate = setup.clock_rate;
    if (isochron.simple_sync) check_simple_sync(t, c.sync_ena);
    if (gsd.dpv2.x_prm_sap && t.ext_prm) {
        ext_prm = OwnedPrmRules{gsd, configuration, true};
        c.set_ext_prm = true;
    }
    if (c.cfg_policy == driver::CfgPolicy::plugged && gsd.dpv1.slave && gsd.dpv1.check_cfg_mode && t.dpv1) c.cfg_policy = driver::CfgPolicy::as_parameterised;
    if (c.cfg_policy != driver::CfgPolicy::plugged) {
        c.max_inputs = clamp_octets(gsd.max_input_len.value_or(configuration.input_octets), 0, 244);
        c.max_outputs = clamp_octets(gsd.max_output_len.value_or(configuration.output_octets), 0, 244);
    }
    // Without outputs no DX_Out would tell of the exchange; the chips that can are told to say it all the same.
    if (configuration.output_octets == 0 && !t.access_violation) c.dx_int = driver::DxInt::always;
    if (gsd.dpv1.slave && t.dpv1) {
        c.dpv1 = acyclic_config(gsd, setup, c.max_diag);
        if (c.dpv1.connections != 0) c.user_timer = driver::UserTimer::ms_10;  // for their timeouts
    }
    if (t.dxb && gsd.dpv1.slave) {
        publisher = gsd.dpv2.publisher;
        if (gsd.dpv2.subscriber) dxb = {clamp_octets(gsd.dpv2.dxb_max_link_count, 1, dp::kMaxDxbLinks), clamp_octets(gsd.dpv2.dxb_max_data_length, 1, dp::kMaxPublished)};
        clock = gsd.dpv2.time_sync && t.clock_sync;
        blocks = publisher || dxb.max_links != 0 || clock || gsd.dpv2.isochron_mode || gsd.dpv2.prm_cmd;
        if (blocks) c.prm_rules.max_octets = dp::kMaxUserPrm;
    }
    if (c.cfg_policy == driver::CfgPolicy::as_parameterised && !has_room(c, {dxb, clock})) {
        c.cfg_policy = driver::CfgPolicy::plugged;
        c.max_inputs = c.max_outputs = 0;
    }
    choose_lengths(c, configuration, {dxb, clock});
}

driver::PrmRules StationPlan::ext_prm_rules() const {
    driver::PrmRules rules = ext_prm.rules();
    if (dpv2()) rules.max_octets = dp::kMaxSetPrm;
    return rules;
}

}  // namespace dpchip::slave
