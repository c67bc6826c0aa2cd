// SPDX-License-Identifier: Apache-2.0
// Results of the driver in words.
#include <dpchip/cli/slave_events.hpp>

#include <fmt/format.h>

#include <dpchip/dp/alarm.hpp>
#include <dpchip/trace/service_text.hpp>

namespace dpchip::cli {
namespace {

std::string who(const slave::VirtualSlave& s) { return fmt::format("slave {} {}", s.stored_address().address, s.name()); }

Deed diagnose(slave::VirtualSlave& s, const EventEntry& e) {
    const driver::Config& c = s.plan().driver;
    const driver::DiagFlags flags{e.ext_diag, e.stat_diag, false};
    if (s.set_diagnosis(e.octets, flags) == driver::DiagResult::too_long)
        refuse(e.at, fmt::format("{} has room for {} octets of diagnosis with the header{}", who(s), c.max_diag - c.dpv1.max_alarm,
                                 c.dpv1.max_alarm != 0 ? fmt::format("; {} more are kept for alarms", c.dpv1.max_alarm) : std::string{}));
    return {true, e.octets.empty() ? "diagnosis cleared" : "diagnosis set"};
}

Deed raise(slave::VirtualSlave& s, const EventEntry& e) {
    const driver::AcyclicConfig& dpv1 = s.plan().driver.dpv1;
    if (dpv1.max_alarm == 0) refuse(e.at, fmt::format("{} has no alarms: its GSD supports none, or its chip has no DP-V1", who(s)));
    dp::AlarmStatus alarm = e.alarm;
    alarm.data = e.octets;
    if (!alarm.status && (dp::alarm_enable_bit(alarm.type) & dpv1.alarms) == 0)
        refuse(e.at, fmt::format("the GSD of {} does not support {}", who(s), dp::alarm_type_name(alarm.type)));
    const driver::AlarmRaised raised = s.raise(alarm);
    alarm.seq_nr = raised.seq_nr;
    const std::string text = trace::alarm_text(alarm);
    switch (raised.result) {
    case driver::AlarmResult::queued: return {true, text + " raised"};
    case driver::AlarmResult::closed: return {false, text + ": nobody hears it: no data exchange with DPV1_Enable"};
    case driver::AlarmResult::not_enabled: return {false, text + ": the master has not enabled this type"};
    case driver::AlarmResult::queue_full: return {false, text + ": too many are waiting or not acknowledged"};
    case driver::AlarmResult::too_long: refuse(e.at, fmt::format("{} has room for {} octets of an alarm with its header", who(s), dpv1.max_alarm));
    case driver::AlarmResult::malformed: break;
    }
    refuse(e.at, text + ": there is no such alarm");
}

}  // namespace

Deed do_to(slave::VirtualSlave& s, const EventEntry& e) {
    switch (e.kind) {
    case EventKind::diagnosis: return diagnose(s, e);
    case EventKind::alarm:
    case EventKind::status: return raise(s, e);
    case EventKind::io: s.set_io(slave::IoBehaviour{e.io}); return {true, "io " + e.io};
    case EventKind::power_off:
    case EventKind::power_on:
    case EventKind::unplug:
    case EventKind::plug:
    case EventKind::global_control:
    case EventKind::fault:
    case EventKind::mode:
    case EventKind::switch_over: break;
    }
    refuse(e.at, fmt::format("{} is not the slave's own doing", name(e.kind)));
}

}  // namespace dpchip::cli
