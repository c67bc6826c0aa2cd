// SPDX-License-Identifier: Apache-2.0
// DP-V1 of the virtual slave: its answers, its alarms, its log.
#include <dpchip/slave/acyclic.hpp>

#include <algorithm>

#include <dpchip/slave/virtual_slave.hpp>

namespace dpchip::slave {

namespace {

std::string closed_text(const AcyclicEvent& e) {
    const std::string head = "connection on SAP " + std::to_string(e.sap) + " closed ";
    const std::string why = e.abort.instance == dp::AbortInstance::user ? "user reason " + std::to_string(e.abort.reason)
                                                                        : dp::abort_reason_name(e.abort.instance, e.abort.reason);
    switch (e.closed_by) {
    case driver::ClosedBy::master: return head + "by the master: " + why;
    case driver::ClosedBy::driver: return head + "by the slave: " + why;
    case driver::ClosedBy::user: return head + "by the application: " + why;
    case driver::ClosedBy::offline: break;
    }
    return head + "because the slave goes offline";
}

std::string alarm_text(const dp::AlarmAck& a) {
    return std::string{dp::alarm_type_name(a.type)} + " slot " + std::to_string(a.slot) + " Seq_Nr " + std::to_string(a.seq_nr());
}

}  // namespace

std::string text(const AcyclicEvent& e) {
    using Kind = AcyclicEvent::Kind;
    switch (e.kind) {
    case Kind::ms1_opened: return "MS1 open for master " + std::to_string(e.master);
    case Kind::ms1_closed: return "MS1 closed";
    case Kind::connection_opened: return "connection on SAP " + std::to_string(e.sap) + " open for master " + std::to_string(e.master);
    case Kind::connection_closed: return closed_text(e);
    case Kind::request_dropped: return "nobody waits for the answer on SAP " + std::to_string(e.sap) + " any more";
    case Kind::alarm_acknowledged: return alarm_text(e.alarm) + " acknowledged";
    case Kind::alarm_dropped: return alarm_text(e.alarm) + " dropped: the master is gone";
    }
    return "unknown";
}

// ---- the slave's own side ----------------------------------------------------------------------------------------

driver::AlarmRaised VirtualSlave::raise(const dp::AlarmStatus& alarm) {
    const driver::AlarmRaised raised = driver_.raise(alarm);
    if (raised.result == driver::AlarmResult::queued && !alarm.status) ++acyclic_counters_.alarms_raised;
    run_firmware_if_due();
    return raised;
}

bool VirtualSlave::complete(const driver::Handle& handle, const driver::RecordAnswer& answer, std::span<const std::uint8_t> data) {
    const bool known = driver_.complete(handle, answer, data);
    if (known && answer.kind == driver::RecordAnswer::Kind::refused) ++acyclic_counters_.refused;
    run_firmware_if_due();
    return known;
}

bool VirtualSlave::complete(const driver::Handle& handle, const driver::InitiateAnswer& answer) {
    const bool known = driver_.complete(handle, answer);
    run_firmware_if_due();
    return known;
}

bool VirtualSlave::abort_connection(std::uint8_t sap, std::uint8_t reason) {
    const bool known = driver_.abort_connection(sap, reason);
    run_firmware_if_due();
    return known;
}

// ---- what the driver asks ----------------------------------------------------------------------------------------

driver::RecordAnswer VirtualSlave::Firmware::noted(const driver::RecordAnswer& answer) {
    if (answer.kind == driver::RecordAnswer::Kind::refused) ++slave->acyclic_counters_.refused;
    return answer;
}

driver::RecordAnswer VirtualSlave::Firmware::read(const driver::RecordCall& call, std::span<std::uint8_t> out) {
    VirtualSlave& s = *slave;
    ++s.acyclic_counters_.reads;
    if (s.handler_ != nullptr)
        if (const auto answer = s.handler_->read(call, out)) return noted(*answer);
    const auto octets = s.records_.read(call.slot, call.index);
    if (!octets) return noted(driver::refused(octets.error()));
    const std::size_t n = std::min(octets->size(), out.size());
    std::copy_n(octets->begin(), n, out.begin());
    return driver::answered(n);
}

driver::RecordAnswer VirtualSlave::Firmware::write(const driver::RecordCall& call, std::span<const std::uint8_t> data) {
    VirtualSlave& s = *slave;
    ++s.acyclic_counters_.writes;
    if (s.handler_ != nullptr)
        if (const auto answer = s.handler_->write(call, data)) return noted(*answer);
    const auto taken = s.records_.write(call.slot, call.index, data);
    return taken ? driver::answered(*taken) : noted(driver::refused(taken.error()));
}

driver::RecordAnswer VirtualSlave::Firmware::data_transport(const driver::RecordCall& call, std::span<const std::uint8_t> data,
                                                            std::span<std::uint8_t> out) {
    VirtualSlave& s = *slave;
    ++s.acyclic_counters_.transports;
    if (s.handler_ != nullptr)
        if (const auto answer = s.handler_->transport(call, data, out)) return noted(*answer);
    return noted(driver::refused(dp::ErrorCode1::feature_not_supported));
}

void VirtualSlave::Firmware::request_dropped(driver::Handle handle) {
    ++slave->acyclic_counters_.requests_dropped;
    slave->events_.push({.kind = AcyclicEvent::Kind::request_dropped, .sap = handle.sap});
    if (slave->handler_ != nullptr) slave->handler_->dropped(handle);
}

void VirtualSlave::Firmware::ms1_opened(std::uint8_t master) {
    slave->events_.push({.kind = AcyclicEvent::Kind::ms1_opened, .sap = dp::kSapMs1, .master = master});
}

void VirtualSlave::Firmware::ms1_closed() { slave->events_.push({.kind = AcyclicEvent::Kind::ms1_closed, .sap = dp::kSapMs1}); }

driver::InitiateAnswer VirtualSlave::Firmware::initiate(const driver::InitiateCall& call) {
    if (slave->handler_ != nullptr)
        if (const auto answer = slave->handler_->initiate(call)) return *answer;
    return driver::accept_connection();
}

void VirtualSlave::Firmware::connection_opened(std::uint8_t sap, std::uint8_t master) {
    ++slave->acyclic_counters_.connections_opened;
    slave->events_.push({.kind = AcyclicEvent::Kind::connection_opened, .sap = sap, .master = master});
}

void VirtualSlave::Firmware::connection_closed(std::uint8_t sap, driver::ClosedBy by, const dp::Abort& abort) {
    ++slave->acyclic_counters_.connections_closed;
    slave->events_.push({.kind = AcyclicEvent::Kind::connection_closed, .sap = sap, .closed_by = by, .abort = abort});
}

void VirtualSlave::Firmware::alarm_acknowledged(const dp::AlarmAck& alarm) {
    ++slave->acyclic_counters_.alarms_acknowledged;
    slave->events_.push({.kind = AcyclicEvent::Kind::alarm_acknowledged, .alarm = alarm});
}

void VirtualSlave::Firmware::alarm_dropped(const dp::AlarmAck& alarm) {
    ++slave->acyclic_counters_.alarms_dropped;
    slave->events_.push({.kind = AcyclicEvent::Kind::alarm_dropped, .alarm = alarm});
}

bool VirtualSlave::Firmware::has_im(std::uint8_t slot, std::uint16_t im_index) {
    return slot == 0 && im_index >= dp::kIm0 && im_index <= dp::kIm4;
}

driver::RecordAnswer VirtualSlave::Firmware::read_im(std::uint8_t, std::uint16_t im_index, std::span<std::uint8_t, dp::kImRecord> out) {
    const auto record = slave->identification_.record(im_index);
    if (!record) return noted(driver::refused(dp::ErrorCode1::invalid_index));
    std::ranges::copy(*record, out.begin());
    return driver::answered();
}

driver::RecordAnswer VirtualSlave::Firmware::write_im(std::uint8_t, std::uint16_t im_index, std::span<const std::uint8_t, dp::kImRecord> octets) {
    if (slave->identification_.write(im_index, octets)) return driver::answered();
    return noted(driver::refused(dp::ErrorCode1::access_denied));
}

}  // namespace dpchip::slave
