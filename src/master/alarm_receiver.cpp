// SPDX-License-Identifier: Apache-2.0
// Alarms out of diagnoses.
#include <dpchip/master/alarm_receiver.hpp>

#include <algorithm>

#include <dpchip/dp/diag.hpp>

namespace dpchip::master {

void AlarmReceiver::look() {
    if (slave_->counters().lost != lost_exchange_) {  // a new beginning: numbers start over
        lost_exchange_ = slave_->counters().lost;
        known_ = false;
    }
    if (slave_->counters().diagnoses == diagnoses_) return;
    diagnoses_ = slave_->counters().diagnoses;
    const auto diagnosis = slave_->diagnosis();
    if (!slave_->exchanging() || diagnosis.size() <= dp::kDiagHeader) {
        known_ = false;
        return;
    }
    bool found = false;
    dp::DiagBlockWalker walker{diagnosis.subspan(dp::kDiagHeader)};
    for (dp::DiagBlock block{}; walker.next(block);) {
        const auto alarm = dp::alarm_status(block);
        if (!alarm || alarm->type == 0) continue;
        if (!alarm->status) found = true;
        receive(*alarm);
    }
    if (!found) known_ = false;
}

/// One and the same alarm stays in the diagnosis until it is acknowledged, and other reasons may show it again.
void AlarmReceiver::receive(const dp::AlarmStatus& alarm) {
    const dp::AlarmAck id = dp::alarm_ack(alarm);
    if (!alarm.status) {
        if (known_ && id == last_) return;
        if (!ms1_->acknowledge(id)) return;  // no room: the slave keeps it, and another diagnosis shows it
        known_ = true;
        last_ = id;
    }
    ++(alarm.status ? status_messages_ : alarms_);
    ReceivedAlarm r{alarm.status, alarm.type, alarm.slot, alarm.seq_nr, alarm.add_ack, alarm.specifier,
                    static_cast<std::uint8_t>(std::min(alarm.data.size(), dp::kMaxDeviceBlock)), {}};
    std::copy_n(alarm.data.begin(), r.size, r.octets.begin());
    received_.push(r);
}

}  // namespace dpchip::master
