// SPDX-License-Identifier: Apache-2.0
// A complete DP slave in software: a chip, its firmware (the driver), an identity (its GSD) and something to do (I/O).
// It is a station of a segment; nothing it does after construction allocates.
//
// The firmware runs firmware_delay after X/INT has gone active, at one tick: its accesses to the chip take no time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <dpchip/chip/chip.hpp>
#include <dpchip/core/clock.hpp>
#include <dpchip/core/fixed_queue.hpp>
#include <dpchip/driver/dpv1.hpp>
#include <dpchip/driver/isochron.hpp>
#include <dpchip/driver/redundancy.hpp>
#include <dpchip/fdl/transmission.hpp>
#include <dpchip/gsd/gsd.hpp>
#include <dpchip/slave/acyclic.hpp>
#include <dpchip/slave/dpv2.hpp>
#include <dpchip/slave/error.hpp>
#include <dpchip/slave/ext_diag.hpp>
#include <dpchip/slave/io_behaviour.hpp>
#include <dpchip/slave/station_plan.hpp>

namespace dpchip::slave {

using core::Ticks;

/// What has happened since power-up.
struct Counters {
    std::uint64_t exchanges{};          ///< Data_Exchange answers with inputs; without inputs, outputs taken
    std::uint64_t set_prm{};            ///< Set_Prm heard
    std::uint64_t prm_refused{};        ///< of these, refused by the firmware
    std::uint64_t chk_cfg{};
    std::uint64_t cfg_refused{};
    std::uint64_t slave_diag{};
    std::uint64_t global_control{};     ///< obeyed
    std::uint64_t set_slave_add{};      ///< obeyed
    std::uint64_t outputs_cleared{};    ///< by power-up, Clear_Data, fail safe or LEAVE-MASTER
    std::uint64_t data_exch_entered{};
    std::uint64_t data_exch_left{};
    std::uint64_t watchdog_timeouts{};  ///< of the times it left: the master was silent
    std::uint64_t baud_rates_found{};
    std::uint64_t interrupts{};         ///< calls of the interrupt routine
};

/// What is to be kept over power-down: Set_Slave_Add's business.
struct StoredAddress {
    std::uint8_t address{};
    bool no_add_change{};
};

/// One virtual slave. It neither moves nor copies: the firmware holds on to it.
class VirtualSlave {
public:
    /// Powers the slave up at line time setup.clock's origin. Throws GsdError for modules and parameters, SlaveError for
    /// the rest. `gsd` is not needed afterwards.
    VirtualSlave(const gsd::Gsd& gsd, const SlaveSetup& setup);
    VirtualSlave(const VirtualSlave&) = delete;
    VirtualSlave& operator=(const VirtualSlave&) = delete;

    // ---- a segment::Station, in line time -----------------------------------------------------------------------
    Ticks next() const;
    void advance(Ticks to);
    void hear(const fdl::Transmission& heard);
    void hear_character(const fdl::Character& character);
    void carrier(Ticks at);
    bool take(fdl::Transmission& sent);
    void sent(Ticks at);
    bool hears_all() const { return chip_.hears_all(); }
    std::uint8_t address() const { return chip_.address(); }

    // ---- the process behind it ----------------------------------------------------------------------------------
    std::span<const std::uint8_t> inputs() const { return {inputs_.data(), driver_.inputs()}; }
    std::span<const std::uint8_t> outputs() const { return {outputs_.data(), driver_.outputs()}; }
    /// True while the outputs are those of a master, and not cleared ones.
    bool outputs_valid() const { return outputs_valid_; }
    const IoBehaviour& io() const { return io_; }
    void set_io(const IoBehaviour& io);
    /// As the driver's set_diagnosis(). Status messages of DP-V2 (redundancy, links) are put behind it as long as they say
    /// something and there is room.
    driver::DiagResult set_diagnosis(std::span<const std::uint8_t> ext_diag, driver::DiagFlags flags = {});
    // ---- DP-V1, as far as the GSD says so -----------------------------------------------------------------------
    /// An alarm or a status message for the master; `seq_nr` is given by the driver. What clears or updates an alarm is
    /// another alarm: Specifier disappears, Alarm_Type update.
    driver::AlarmRaised raise(const dp::AlarmStatus& alarm);
    const RecordTable& records() const { return records_; }
    RecordTable& records() { return records_; }
    const Identification& identification() const { return identification_; }
    /// Asked before the records; null: nobody. It must outlive the slave.
    void set_handler(RecordHandler* handler) { handler_ = handler; }
    /// For requests that the handler put off. False when nobody waits any more.
    bool complete(const driver::Handle& handle, const driver::RecordAnswer& answer, std::span<const std::uint8_t> data = {});
    bool complete(const driver::Handle& handle, const driver::InitiateAnswer& answer);
    /// Ends the class-2 connection on this SAP with an Abort of instance user.
    bool abort_connection(std::uint8_t sap, std::uint8_t reason);
    const AcyclicCounters& acyclic_counters() const { return acyclic_counters_; }
    /// Takes the oldest of up to 64 events; nothing when there is none. Newer ones than these 64 are lost until then.
    std::optional<AcyclicEvent> take_event() {
        if (events_.empty()) return std::nullopt;
        return events_.pop();
    }

    // ---- DP-V2, as far as the GSD says so -----------------------------------------------------------------------
    /// Told of samples, SYNCHs and the time; null: nobody. It must outlive the slave.
    void set_dpv2_handler(Dpv2Handler* handler) { dpv2_handler_ = handler; }
    const Dpv2Counters& dpv2_counters() const { return dpv2_counters_; }
    /// Links of the present parameters.
    std::span<const dp::DxbLink> links() const { return dxb_.links(); }
    /// Link_Status of link `n` of links(): dp::kLinkStatus and its kind.
    std::uint8_t link_status(std::size_t n) { return dxb_.link_status(n); }
    /// How regular the SYNC pulses come, in ticks of the station's own crystal; judged as soon as an IsoM block told the cycle.
    const driver::SynchMeter& synch_meter() const { return synch_meter_; }
    /// The time as the slave has it; nothing before the first Clock_Value. Advance first: it is that of the chip's now().
    std::optional<dp::NetworkTime> time() const {
        if (!plan_.clock || !slave_clock_.valid()) return std::nullopt;
        return slave_clock_.now(local_ns());
    }
    /// By how much the crystal is slow as the clock has learnt it from the time master, in parts per billion; 0: not known.
    std::int32_t clock_rate_ppb() const { return slave_clock_.rate_ppb(); }
    /// The crystal against line time, for times that the station tells by its own.
    const core::Clock& crystal() const { return clock_; }
    const driver::RedundantHalf& redundancy() const { return redundancy_; }

    /// The user wants new parameters: to WAIT-PRM.
    void leave_master() { driver_.leave_master(); run_firmware_if_due(); }
    /// Go_Offline and Start again.
    void restart() { driver_.restart(); run_firmware_if_due(); }

    // ---- to look at ---------------------------------------------------------------------------------------------
    const std::string& name() const { return name_; }
    const Counters& counters() const { return counters_; }
    const StoredAddress& stored_address() const { return stored_; }
    chip::DpState dp_state() const { return chip_.dp_state(); }
    chip::WdState wd_state() const { return chip_.wd_state(); }
    /// Present baud rate; nothing while searching.
    std::optional<fdl::BaudCode> baud() const;
    /// Master that owns the slave, 255: none.
    std::uint8_t owner() const { return chip_.owner(); }
    std::uint16_t ident() const { return plan_.driver.ident; }
    const StationPlan& plan() const { return plan_; }
    chip::Chip<>& chip() { return chip_; }
    const chip::Chip<>& chip() const { return chip_; }

private:
    struct Bus {
        chip::Chip<>* chip;
        std::uint8_t read(std::uint16_t a) { return chip->read(a); }
        void write(std::uint16_t a, std::uint8_t v) { chip->write(a, v); }
        void read_block(std::uint16_t a, std::span<std::uint8_t> out) { chip->read_block(a, out); }
        void write_block(std::uint16_t a, std::span<const std::uint8_t> in) { chip->write_block(a, in); }
    };
    /// The application on top of the driver.
    struct Firmware : driver::AcyclicEvents {
        VirtualSlave* slave = nullptr;
        driver::Verdict set_prm(const dp::SetPrm& prm);
        std::uint16_t own_interrupts() const;
        std::uint16_t more_mode0() const;
        std::uint8_t more_mode2() const;
        void serve_own(std::uint16_t irr);
        void prm_refused(driver::PrmFault) { ++slave->counters_.prm_refused; }
        driver::Verdict set_ext_prm(std::span<const std::uint8_t> octets);
        void cfg_refused() { ++slave->counters_.cfg_refused; }
        void data_exch_entered();
        void data_exch_left() { ++slave->counters_.data_exch_left; }
        void dx_out();
        void wd_dp_control_timeout() { ++slave->counters_.watchdog_timeouts; }
        void baud_rate_detect(std::uint8_t) { ++slave->counters_.baud_rates_found; }
        void new_gc_command(std::uint8_t) { ++slave->counters_.global_control; }
        void new_ssa_data(const dp::SetSlaveAdd& ssa);

        driver::RecordAnswer noted(const driver::RecordAnswer& answer);
        driver::RecordAnswer read(const driver::RecordCall& call, std::span<std::uint8_t> out);
        driver::RecordAnswer write(const driver::RecordCall& call, std::span<const std::uint8_t> data);
        driver::RecordAnswer data_transport(const driver::RecordCall& call, std::span<const std::uint8_t> data, std::span<std::uint8_t> out);
        void request_dropped(driver::Handle handle);
        void ms1_opened(std::uint8_t master);
        void ms1_closed();
        driver::InitiateAnswer initiate(const driver::InitiateCall& call);
        void connection_opened(std::uint8_t sap, std::uint8_t master);
        void connection_closed(std::uint8_t sap, driver::ClosedBy by, const dp::Abort& abort);
        void alarm_acknowledged(const dp::AlarmAck& alarm);
        void alarm_dropped(const dp::AlarmAck& alarm);
        bool has_im(std::uint8_t slot, std::uint16_t im_index);
        driver::RecordAnswer read_im(std::uint8_t slot, std::uint16_t im_index, std::span<std::uint8_t, dp::kImRecord> out);
        driver::RecordAnswer write_im(std::uint8_t slot, std::uint16_t im_index, std::span<const std::uint8_t, dp::kImRecord> octets);
    };

    void step(Ticks local);
    void run_firmware_if_due();
    void write_inputs();
    bool configure_dpv2();
    bool take_blocks(std::span<const std::uint8_t> octets);
    void obey(const dp::PrmCmd& command);
    void look_at_sync();
    void tell_of_links(bool broken);
    driver::DiagResult hand_over_diagnosis() { return driver_.set_diagnosis(ext_diag_.all(), diag_flags_); }
    std::uint64_t local_ns() const { return static_cast<std::uint64_t>(core::to_ns(chip_.now())); }
    void count_request(const fdl::Transmission& heard);
    void count_answer(const fdl::Transmission& answer);

    StationPlan plan_;
    std::string name_;
    IoBehaviour io_;
    core::Clock clock_;
    Ticks firmware_delay_;
    Ticks firmware_due_ = core::kNever;  // local time
    Ticks line_now_;
    bool drifts_;                        // the crystal is not the line's: times are converted
    bool outputs_valid_ = false;
    std::uint64_t answers_ = 0;
    Counters counters_{};
    StoredAddress stored_{};
    std::array<std::uint8_t, 244> inputs_{}, outputs_{};
    RecordTable records_;
    Identification identification_;
    RecordHandler* handler_ = nullptr;
    AcyclicCounters acyclic_counters_{};
    core::FixedQueue<AcyclicEvent, 64> events_;
    chip::Chip<> chip_;
    Firmware firmware_;
    driver::Vpc3<Bus, Firmware, 1, driver::Dpv1<driver::kMaxConnections, 16>> driver_;
    bool wd_on_ = false;                 // WD_On of the present parameters
    driver::DxbSubscriber<Bus> dxb_{Bus{&chip_}};
    driver::SlaveClock<Bus> slave_clock_{Bus{&chip_}};
    driver::SynchMeter synch_meter_;
    driver::RedundantHalf redundancy_;
    bool links_told_ = false;            // DXB_Link_Status stands in the diagnosis
    ExtDiag ext_diag_;
    driver::DiagFlags diag_flags_{};     // of the process
    Dpv2Handler* dpv2_handler_ = nullptr;
    Dpv2Counters dpv2_counters_{};
};

}  // namespace dpchip::slave
