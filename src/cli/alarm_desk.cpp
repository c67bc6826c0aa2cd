// SPDX-License-Identifier: Apache-2.0
// Alarms received, in words.
#include <dpchip/cli/alarm_desk.hpp>

#include <dpchip/dp/alarm.hpp>
#include <dpchip/master/from_gsd.hpp>
#include <dpchip/trace/service_text.hpp>

namespace dpchip::cli {

dp::AlarmStatus alarm_of(const master::ReceivedAlarm& r) {
    dp::AlarmStatus a{};
    a.status = r.status;
    a.type = r.type;
    a.slot = r.slot;
    a.seq_nr = r.seq_nr;
    a.add_ack = r.add_ack;
    a.specifier = r.specifier;
    a.data = r.data();
    return a;
}

std::vector<std::string> alarm_details(const dp::AlarmStatus& alarm, std::uint8_t station, const trace::DeviceTexts& texts) {
    std::array<std::uint8_t, dp::kMaxDeviceBlock> block{};
    const auto size = dp::encode(alarm, block);
    return size ? texts.device_diag(station, std::span{block}.first(*size).subspan(1)) : std::vector<std::string>{};
}

AlarmDesk::AlarmDesk(master::Master& master, const std::vector<SlaveEntry>& slaves, GsdShelf& shelf) : master_{&master} {
    for (std::size_t n = 0; n < slaves.size() && n < master.size(); ++n) {
        if (slaves[n].alarms == 0) continue;
        const gsd::Gsd& gsd = shelf.get(slaves[n].gsd, slaves[n].at);
        const std::uint8_t address = master.slave(n).config().address;
        texts_.set(address, &gsd);
        desks_.push_back(std::make_unique<Desk>(n, master.slave(n), master::ms1_config(gsd, address)));
        master.attach(desks_.back()->ms1);
    }
}

AlarmDesk::~AlarmDesk() {
    for (const auto& d : desks_) master_->detach(d->ms1);
}

void AlarmDesk::look() {
    for (const auto& d : desks_) d->receiver.look();
}

std::vector<AlarmDesk::Line> AlarmDesk::take(Ticks now) {
    std::vector<Line> lines;
    for (const auto& d : desks_)
        while (const auto received = d->receiver.take()) {
            const dp::AlarmStatus alarm = alarm_of(*received);
            lines.push_back({now, d->slave, alarm.status, trace::alarm_text(alarm), alarm_details(alarm, d->ms1.address(), texts_)});
        }
    return lines;
}

}  // namespace dpchip::cli
