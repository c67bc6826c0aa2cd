// SPDX-License-Identifier: Apache-2.0
// GSD and modules to a slave's configuration.
#include <dpchip/master/from_gsd.hpp>

namespace dpchip::master {

namespace {

/// A GSD counts the slave's own time; the rest of a service is the line's: turns in the cycle, repetitions, slow rates.
constexpr Ticks kLine = core::seconds(1);

std::uint8_t required_alarms(const gsd::DpV1& dpv1) {
    unsigned required = 0;
    if (dpv1.pull_plug_alarm_required) required |= dp::kEnablePullPlugAlarm;
    if (dpv1.process_alarm_required) required |= dp::kEnableProcessAlarm;
    if (dpv1.diagnostic_alarm_required) required |= dp::kEnableDiagnosticAlarm;
    if (dpv1.manufacturer_specific_alarm_required) required |= dp::kEnableManufacturerSpecificAlarm;
    if (dpv1.status_alarm_required) required |= dp::kEnableStatusAlarm;
    if (dpv1.update_alarm_required) required |= dp::kEnableUpdateAlarm;
    return static_cast<std::uint8_t>(required);
}

}  // namespace

SlaveConfig slave_config(const gsd::Gsd& gsd, const gsd::Configuration& configuration, std::uint8_t address,
                         std::span<const gsd::PrmSetting> settings) {
    SlaveConfig slave;
    slave.name = gsd.model_name;
    slave.address = address;
    slave.ident = gsd.ident_number;
    slave.user_prm = gsd::user_prm_data(gsd, configuration, settings).octets;
    slave.cfg = configuration.cfg;
    slave.input_octets = configuration.input_octets;
    slave.output_octets = configuration.output_octets;
    slave.min_slave_interval = core::microseconds(100) * gsd.min_slave_intervall;
    slave.fail_safe = gsd.fail_safe && !slave.user_prm.empty() && (slave.user_prm[0] & dp::kFailSafe) != 0;
    return slave;
}

std::uint8_t supported_alarms(const gsd::DpV1& dpv1) {
    unsigned supported = 0;
    if (dpv1.pull_plug_alarm) supported |= dp::kEnablePullPlugAlarm;
    if (dpv1.process_alarm) supported |= dp::kEnableProcessAlarm;
    if (dpv1.diagnostic_alarm) supported |= dp::kEnableDiagnosticAlarm;
    if (dpv1.manufacturer_specific_alarm) supported |= dp::kEnableManufacturerSpecificAlarm;
    if (dpv1.status_alarm) supported |= dp::kEnableStatusAlarm;
    if (dpv1.update_alarm) supported |= dp::kEnableUpdateAlarm;
    return static_cast<std::uint8_t>(supported);
}

void enable_dpv1(SlaveConfig& slave, const gsd::DpV1& dpv1, bool fail_safe, std::uint8_t alarms, std::uint8_t alarm_mode) {
    if (slave.user_prm.size() < 3) slave.user_prm.resize(3);
    const auto with = [](std::uint8_t octet, unsigned bits) { return static_cast<std::uint8_t>(octet | bits); };
    slave.user_prm[0] = with(slave.user_prm[0], dp::kDpv1Enable | (fail_safe ? unsigned{dp::kFailSafe} : 0u));
    slave.user_prm[1] = with(slave.user_prm[1], (alarms & supported_alarms(dpv1)) | required_alarms(dpv1));
    slave.user_prm[2] = static_cast<std::uint8_t>((slave.user_prm[2] & ~unsigned{dp::kAlarmModeMask}) | (alarm_mode & dp::kAlarmModeMask));
    slave.fail_safe = slave.fail_safe || fail_safe;
}

Ms1Config ms1_config(const gsd::Gsd& gsd, std::uint8_t address) {
    Ms1Config c{.address = address};
    if (gsd.dpv1.c1_response_timeout != 0) c.response_timeout = kLine + core::milliseconds(10) * gsd.dpv1.c1_response_timeout;
    return c;
}

Ms2Config ms2_config(const gsd::Gsd& gsd, std::uint8_t address) {
    Ms2Config c{.address = address};
    if (gsd.dpv1.c2_response_timeout != 0) c.response_timeout = kLine + core::milliseconds(10) * gsd.dpv1.c2_response_timeout;
    return c;
}

}  // namespace dpchip::master
