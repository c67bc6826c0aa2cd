// SPDX-License-Identifier: Apache-2.0
// The virtual slave's firmware for DP-V2: blocks in the parameters, and the interrupts that the driver leaves to it.
#include <array>

#include <dpchip/slave/virtual_slave.hpp>

namespace dpchip::slave {

std::uint16_t VirtualSlave::Firmware::own_interrupts() const {
    const StationPlan& plan = slave->plan_;
    return static_cast<std::uint16_t>((plan.dxb.max_links != 0 ? driver::DxbSubscriber<Bus>::kInterrupts : 0u) |
                                      (plan.clock ? driver::SlaveClock<Bus>::kInterrupts : 0u));
}

std::uint16_t VirtualSlave::Firmware::more_mode0() const {
    return slave->plan_.clock ? driver::SlaveClock<Bus>::kMode0 : std::uint16_t{0};
}

std::uint8_t VirtualSlave::Firmware::more_mode2() const {
    return slave->plan_.synchronous() ? driver::mode2(slave->plan_.isochron) : std::uint8_t{0};
}

void VirtualSlave::Firmware::serve_own(std::uint16_t irr) {
    VirtualSlave& s = *slave;
    Dpv2Handler none;
    Dpv2Handler& handler = s.dpv2_handler_ != nullptr ? *s.dpv2_handler_ : none;
    const std::uint16_t mine = s.dxb_.serve(irr);
    for (driver::DxbSample sample; s.dxb_.fetch(sample);) {
        ++s.dpv2_counters_.samples;
        handler.sample(sample);
    }
    if ((mine & regmap::interrupt::dxb_link_error) != 0) {
        ++s.dpv2_counters_.link_errors;
        handler.link_error();
    }
    if (mine != 0) s.tell_of_links((mine & regmap::interrupt::dxb_link_error) != 0);
    if (!s.plan_.clock) return;
    const driver::ClockEvent event = s.slave_clock_.serve(irr, [&s] { return s.local_ns(); });
    if (event == driver::ClockEvent::none) return;
    ++(event == driver::ClockEvent::set ? s.dpv2_counters_.times_set : s.dpv2_counters_.clock_violations);
    handler.clock(event);
}

/// DXB_Link_Status stands in the diagnosis from the first broken link until all of them are active again. The chip tells
/// only of the former, so the latter is looked for with the samples. Data_Exist is left out: it changes with every broadcast.
void VirtualSlave::tell_of_links(bool broken) {
    if (!broken && !links_told_) return;
    std::array<std::uint8_t, dp::dxb_status_octets(dp::kMaxDxbLinks)> message{};
    std::size_t octets = dxb_.status_message(message);
    bool active = true;
    for (std::size_t link = 0; link < dxb_.links().size(); ++link) {
        std::uint8_t& status = message[dp::dxb_status_octets(link) + 1];
        status = static_cast<std::uint8_t>(status & ~dp::kDataExist);
        active = active && (status & dp::kLinkStatus) != 0;
    }
    links_told_ = !active;
    if (active) octets = 0;
    if (ext_diag_.set(ExtDiag::Part::links, std::span{message}.first(octets))) static_cast<void>(hand_over_diagnosis());
}

/// A DP-V1 slave whose GSD does not say Publisher_supp refuses to be one.
driver::Verdict VirtualSlave::Firmware::set_prm(const dp::SetPrm& prm) {
    VirtualSlave& s = *slave;
    if (!s.plan_.dpv2()) return driver::Verdict::accept;
    s.dxb_.forget();
    s.links_told_ = false;
    const bool links_gone = s.ext_diag_.set(ExtDiag::Part::links, {}), command_gone = s.ext_diag_.set(ExtDiag::Part::redundancy, {});
    if (links_gone || command_gone) static_cast<void>(s.hand_over_diagnosis());
    s.wd_on_ = prm.wd_on();
    const bool publisher_refused = (prm.dpv1_status_1() & dp::kPublisherEnable) != 0 && !s.plan_.publisher;
    const bool structured = (prm.dpv1_status_3() & dp::kPrmStructure) != 0;
    if (!publisher_refused && (!structured || s.take_blocks(prm.behind_dpv1_status()))) return driver::Verdict::accept;
    ++s.counters_.prm_refused;
    ++s.dpv2_counters_.blocks_refused;
    return driver::Verdict::refuse;
}

/// Blocks that it does not know are left to whom they concern.
bool VirtualSlave::take_blocks(std::span<const std::uint8_t> octets) {
    dp::PrmBlockWalker walker{octets};
    for (dp::PrmBlock b; walker.next(b);) {
        if (plan_.dxb.max_links != 0 && dxb_.add(b, wd_on_) != dp::DxbError::none) return false;
        if (plan_.clock && b.type == static_cast<std::uint8_t>(dp::PrmBlockType::time_ar)) {
            const auto time = dp::decode_time_ar(b);
            if (!time) return false;
            slave_clock_.start(*time);
        }
        if (plan_.driver.prm_cmd_supported && b.type == static_cast<std::uint8_t>(dp::PrmBlockType::prm_cmd)) {
            const auto command = dp::decode_prm_cmd(b);
            if (!command) return false;
            obey(*command);
        }
        if (plan_.driver.sync_ena && b.type == static_cast<std::uint8_t>(dp::PrmBlockType::isom)) {
            const auto isom = dp::decode_isom(b);
            if (!isom) return false;
            // 1/12 us are 5000 ticks; the meter counts ticks.
            synch_meter_.expect(isom->cycle() * 5'000, std::uint64_t{isom->t_pll_w} * 5'000);
        }
    }
    return walker.error() == dp::PrmBlockError::none;
}

void VirtualSlave::obey(const dp::PrmCmd& command) {
    redundancy_.set_baud_found(true);
    redundancy_.set_data_exchange(dp_state() == chip::DpState::data_exch);
    const dp::RedStatus status = redundancy_.command(command);
    ++dpv2_counters_.prm_cmds;
    std::array<std::uint8_t, dp::kRedStatus> block{};
    if (dp::encode(status, block) && ext_diag_.set(ExtDiag::Part::redundancy, block)) static_cast<void>(hand_over_diagnosis());
    if (dpv2_handler_ != nullptr) dpv2_handler_->redundancy(status);
}

/// Beginnings of SYNC pulses since the last look; in Simple Sync Mode the pin shows a DX_Out.
void VirtualSlave::look_at_sync() {
    const chip::Level active = plan_.isochron.sync_pol ? chip::Level::high : chip::Level::low;
    while (!chip_.edges().empty()) {
        const chip::Edge edge = chip_.edges().pop();
        if (edge.pin != chip::Pin::xdataexch_sync || edge.level != active) continue;
        ++dpv2_counters_.synchs;
        static_cast<void>(synch_meter_.observe(static_cast<std::uint64_t>(edge.at.n)));
        if (dpv2_handler_ != nullptr) dpv2_handler_->synch(edge.at);
    }
}

/// After the driver is configured, before it starts. False when the RAM does not hold it.
bool VirtualSlave::configure_dpv2() {
    const StationPlan& p = plan_;
    if (p.synchronous()) {
        Bus bus{&chip_};
        driver::write_isochron(bus, p.isochron);
        chip_.watch(1u << static_cast<unsigned>(chip::Pin::xdataexch_sync));
    }
    if (!p.dpv2()) return true;
    slave_clock_.correct_rate(p.clock_rate);
    const driver::Layout& l = driver_.layout();
    const std::uint16_t first = driver_.dpv1().layout().used_bytes;
    const auto end = static_cast<std::uint16_t>(l.ram_bytes - (p.clock ? driver::SlaveClock<Bus>::kRoom : 0));
    if (!dxb_.configure(p.dxb, l, first, end)) return false;
    if (p.clock && !(slave_clock_.configure(l, p.driver.bus_mode) && first <= end)) return false;
    return true;
}

}  // namespace dpchip::slave
