// SPDX-License-Identifier: Apache-2.0
// The virtual slave: time of the line against time of the chip, the firmware's turn, and what is counted.
#include <dpchip/slave/virtual_slave.hpp>

#include <algorithm>

#include <dpchip/dp/saps.hpp>
#include <dpchip/fdl/telegram.hpp>

namespace dpchip::slave {

VirtualSlave::VirtualSlave(const gsd::Gsd& gsd, const SlaveSetup& setup)
    : plan_{gsd, setup}, name_{setup.name.empty() ? gsd.model_name : setup.name}, io_{setup.io}, clock_{setup.clock},
      firmware_delay_{setup.firmware_delay}, line_now_{setup.clock.line(Ticks{0})},
      drifts_{setup.clock.ppb() != 0 || setup.clock.line(Ticks{0}) != Ticks{0}}, records_{setup.records},
      identification_{setup.identification ? *setup.identification : slave::identification(gsd)}, chip_{setup.variant, setup.options},
      driver_{Bus{&chip_}, firmware_}, ext_diag_{plan_.diag_room()} {
    firmware_.slave = this;
    if (io_.held().size() > plan_.configuration.input_octets)
        throw SlaveError{SlaveError::Kind::io_behaviour, "I/O behaviour '" + io_.text() + "': the station has " +
                                                             std::to_string(plan_.configuration.input_octets) + " octets of inputs"};
    if (records_.error() != RecordTable::Error::none) throw SlaveError{SlaveError::Kind::records, slave::name(records_.error())};
    stored_ = {setup.address, setup.no_add_change};
    const driver::ConfigError error = driver_.configure(plan_.driver);
    if (error != driver::ConfigError::none) throw SlaveError{SlaveError::Kind::chip, driver::name(error)};
    if (!configure_dpv2()) throw SlaveError{SlaveError::Kind::ram, "the RAM is too small for the links or the clock"};
    driver_.start();
    write_inputs();
    run_firmware_if_due();
}

std::optional<fdl::BaudCode> VirtualSlave::baud() const {
    if (chip_.wd_state() == chip::WdState::baud_search) return std::nullopt;
    return chip_.baud();
}

Ticks VirtualSlave::next() const {
    const Ticks local = std::min(chip_.next(), firmware_due_);
    return drifts_ ? std::max(clock_.line(local), line_now_) : local;
}

void VirtualSlave::advance(Ticks to) {
    line_now_ = to;
    const Ticks local = drifts_ ? clock_.local(to) : to;
    for (Ticks due = std::min(chip_.next(), firmware_due_); due <= local; due = std::min(chip_.next(), firmware_due_))
        step(std::max(due, chip_.now()));
    if (chip_.now() < local) chip_.advance(local);
}

/// Moves the chip, and lets the firmware run when it is its turn.
void VirtualSlave::step(Ticks local) {
    chip_.advance(local);
    if (plan_.synchronous()) look_at_sync();
    run_firmware_if_due();
}

/// A pin that is active while the routine is not yet due starts the delay once.
void VirtualSlave::run_firmware_if_due() {
    if (!chip_.interrupt_active()) {
        firmware_due_ = core::kNever;
        return;
    }
    if (firmware_due_ == core::kNever) firmware_due_ = chip_.now() + firmware_delay_;
    if (firmware_due_ > chip_.now()) return;
    firmware_due_ = core::kNever;
    ++counters_.interrupts;
    driver_.on_interrupt();
    driver_.feed_user_watchdog();
}

void VirtualSlave::hear(const fdl::Transmission& heard) {
    count_request(heard);
    if (!drifts_) {
        chip_.hear(heard);
    } else {
        fdl::Transmission local = heard;
        local.start = chip_.now() - (heard.end() - heard.start);
        chip_.hear(local);
    }
    run_firmware_if_due();
}

void VirtualSlave::hear_character(const fdl::Character& character) {
    if (!drifts_) {
        chip_.hear_character(character);
    } else {
        fdl::Character local = character;
        local.start = chip_.now() - (character.end() - character.start);
        chip_.hear_character(local);
    }
    run_firmware_if_due();
}

void VirtualSlave::carrier(Ticks at) { chip_.carrier(drifts_ ? std::min(clock_.local(at), chip_.now()) : at); }

bool VirtualSlave::take(fdl::Transmission& sent) {
    if (!chip_.take(sent)) return false;
    if (drifts_) sent.start = line_now_;
    count_answer(sent);
    return true;
}

void VirtualSlave::sent(Ticks at) {
    chip_.sent(drifts_ ? std::max(clock_.local(at), chip_.now()) : at);
    run_firmware_if_due();
}

void VirtualSlave::set_io(const IoBehaviour& io) {
    if (io.held().size() > driver_.inputs())
        throw SlaveError{SlaveError::Kind::io_behaviour, "I/O behaviour '" + io.text() + "': the station has " +
                                                             std::to_string(driver_.inputs()) + " octets of inputs"};
    io_ = io;
    write_inputs();
}

driver::DiagResult VirtualSlave::set_diagnosis(std::span<const std::uint8_t> ext_diag, driver::DiagFlags flags) {
    if (ext_diag.size() > ext_diag_.room()) return driver::DiagResult::too_long;
    static_cast<void>(ext_diag_.set(ExtDiag::Part::process, ext_diag));
    diag_flags_ = flags;
    const driver::DiagResult result = hand_over_diagnosis();
    run_firmware_if_due();
    return result;
}

void VirtualSlave::write_inputs() {
    const std::span<std::uint8_t> in{inputs_.data(), driver_.inputs()};
    if (in.empty()) return;
    io_.fill(in, outputs(), answers_);
    driver_.write_inputs(in);
}

/// Set_Prm of seven octets and other things never reach the firmware: they are counted on the line. An undamaged
/// telegram has its DSAP behind the addresses and FC.
void VirtualSlave::count_request(const fdl::Transmission& heard) {
    const bool sd3 = heard.octets[0] == fdl::kSd3;
    if (!sd3 && (heard.octets[0] != fdl::kSd2 || heard.length < 10)) return;
    if (heard.octets[sd3 ? 1 : 4] != (address() | 0x80u)) return;
    switch (heard.octets[sd3 ? 4 : 7]) {
    case dp::kSapSetPrm: ++counters_.set_prm; break;
    case dp::kSapChkCfg: ++counters_.chk_cfg; break;
    case dp::kSapSlaveDiag: ++counters_.slave_diag; break;
    default: break;
    }
}

/// An answer to Data_Exchange is the only one with data and without SAPs.
void VirtualSlave::count_answer(const fdl::Transmission& answer) {
    if (driver_.inputs() == 0 || answer.octets[0] != fdl::kSd2 || (answer.octets[4] & 0x80u) != 0) return;
    ++counters_.exchanges;
    ++answers_;
    if (io_.kind() == IoBehaviour::Kind::counter) write_inputs();
}

driver::Verdict VirtualSlave::Firmware::set_ext_prm(std::span<const std::uint8_t> octets) {
    const bool right = driver::check(slave->plan_.ext_prm_rules(), octets) == driver::PrmFault::none;
    if (right && (!slave->plan_.dpv2() || slave->take_blocks(octets))) return driver::Verdict::accept;
    ++slave->counters_.prm_refused;
    return driver::Verdict::refuse;
}

void VirtualSlave::Firmware::data_exch_entered() {
    ++slave->counters_.data_exch_entered;
    slave->write_inputs();
}

void VirtualSlave::Firmware::dx_out() {
    VirtualSlave& s = *slave;
    const driver::Outputs found = s.driver_.fetch_outputs(s.outputs_);
    if (s.driver_.inputs() == 0 && found == driver::Outputs::fresh) ++s.counters_.exchanges;
    if (found == driver::Outputs::unchanged) return;
    s.outputs_valid_ = found == driver::Outputs::fresh;
    if (found == driver::Outputs::cleared) ++s.counters_.outputs_cleared;
    if (s.io_.kind() == IoBehaviour::Kind::echo || s.io_.kind() == IoBehaviour::Kind::invert) s.write_inputs();
}

void VirtualSlave::Firmware::new_ssa_data(const dp::SetSlaveAdd& ssa) {
    ++slave->counters_.set_slave_add;
    slave->stored_ = {ssa.address, ssa.no_add_chg};
}

}  // namespace dpchip::slave
