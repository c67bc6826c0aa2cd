// SPDX-License-Identifier: Apache-2.0
// The firmware driver for VPC3+ and APC3: initialises the chip, answers its questions (Set_Prm, Chk_Cfg), moves inputs,
// outputs and diagnosis (VPC3+C chapters 4 to 6; APC3 chapters 3 to 5; reference 4.14 and 10). DP-V1 comes with dpv1.hpp.
//
// Freestanding C++20: no heap, no exceptions, no RTTI, no floating point. It never waits: what has to wait is a state
// that the next poll() or on_interrupt() goes on with. Either of them may be used alone, or both: the functions for the
// main program mask X/INT while they work. fetch_outputs() and write_inputs() belong to one context only.
//
// DP-V2 stands beside it: dxb_subscriber.hpp, isochron.hpp, slave_clock.hpp, redundancy.hpp.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/core/bits.hpp>
#include <dpchip/dp/cfg.hpp>
#include <dpchip/dp/set_prm.hpp>
#include <dpchip/dp/set_slave_add.hpp>
#include <dpchip/driver/acyclic_events.hpp>
#include <dpchip/driver/alarm_queue.hpp>
#include <dpchip/driver/bus_port.hpp>
#include <dpchip/driver/config.hpp>
#include <dpchip/driver/diagnosis.hpp>
#include <dpchip/driver/events.hpp>
#include <dpchip/driver/layout.hpp>
#include <dpchip/regmap/address.hpp>
#include <dpchip/regmap/organizational_parameters.hpp>

namespace dpchip::driver {

namespace ctl = regmap::control;
namespace org = regmap::org;

/// What fetch_outputs() found.
enum class Outputs : std::uint8_t {
    unchanged,  ///< nothing since the last call; the span is untouched
    fresh,      ///< outputs from the master
    cleared,    ///< the chip cleared them: power-up, Clear_Data, fail safe, or the master is gone. All zero
};

/// Where the driver stands with its chip.
enum class State : std::uint8_t {
    unconfigured,
    offline,        ///< configured, not started
    online,
    going_offline,  ///< Go_Offline given, not yet reached
};

/// A driver for DP-V0: no code, no data. The other choice is Dpv1, in dpv1.hpp.
struct NoDpv1 {
    static constexpr bool present = false;
    template <BusPort Bus, class App>
    struct Engine {
        Engine(const Bus&, App&) {}
    };
};

/// Drives one chip. Bus: a handle, kept by value. App: derived from Events, with DP-V1 from AcyclicEvents.
/// PendingDiagnoses: see DiagQueue. D: NoDpv1 or Dpv1<connections, alarms>.
template <BusPort Bus, class App = Events, std::size_t PendingDiagnoses = 1, class D = NoDpv1>
class Vpc3 {
    using Engine = typename D::template Engine<Bus, App>;
    static constexpr bool kDpv1 = D::present;

public:
    /// `app` must outlive the driver.
    Vpc3(Bus bus, App& app) : bus_{bus}, app_{&app}, acyclic_{bus, app} {
        static_assert(Application<App> && (!kDpv1 || AcyclicApplication<App>));
    }

    // ---- life ---------------------------------------------------------------------------------------------------
    /// Tests and clears the RAM, writes every register and cell, lays out the buffers. The chip must be Offline.
    [[nodiscard]] ConfigError configure(const Config& config);
    /// Leaves Offline. False when not configured or not offline.
    bool start();
    /// Sends the chip Offline after the current request; Events::offline() tells when it is there.
    void go_offline();
    /// go_offline(), then start() by itself.
    void restart();
    /// Gives the master up: the slave wants new parameters.
    void leave_master();

    // ---- events -------------------------------------------------------------------------------------------------
    /// Serves everything that is due, hands waiting diagnoses over, feeds the user watchdog. For the main program.
    /// Returns the interrupt bits that were served (regmap::interrupt).
    std::uint16_t poll();
    /// Serves everything that is due and ends with EOI. For the interrupt routine. Returns the bits that were served.
    std::uint16_t on_interrupt();
    /// What poll() does for the user watchdog, for programs that only use on_interrupt().
    void feed_user_watchdog();

    // ---- data ---------------------------------------------------------------------------------------------------
    /// One bus read when nothing is new. `out` gets outputs() octets, or as many as it holds.
    Outputs fetch_outputs(std::span<std::uint8_t> out);
    /// Gives the chip the next inputs(): what `in` lacks is zero, what it has too much is dropped.
    void write_inputs(std::span<const std::uint8_t> in);
    /// Ext_Diag_Data (without the six octets) and the user's bits. Empty and without bits: the fault is gone. Alarm and
    /// status blocks given to raise() are put behind it.
    DiagResult set_diagnosis(std::span<const std::uint8_t> ext_diag, DiagFlags flags = {});

    // ---- DP-V1 --------------------------------------------------------------------------------------------------
    /// Time for the timeouts of class-2 connections, when there is no User_Timer_Clock. From the main program.
    void tick(std::uint32_t ms) requires(D::present);
    /// Answers a request that was put off with answer_later(). `data`: what a DS_Read or Data_Transport gives. False
    /// when nobody waits for it any more. With the wrong one of the two answers a class-2 connection ends: Abort IV.
    bool complete(const Handle& handle, const RecordAnswer& answer, std::span<const std::uint8_t> data = {}) requires(D::present);
    bool complete(const Handle& handle, const InitiateAnswer& answer) requires(D::present);
    /// Ends the connection on this SAP with an Abort of instance user. False when there is none.
    bool abort_connection(std::uint8_t sap, std::uint8_t reason) requires(D::present);
    /// An alarm or a status message for the master; `seq_nr` is given here. See AlarmQueue.
    AlarmRaised raise(const dp::AlarmStatus& alarm) requires(D::present);
    /// To look at.
    const Engine& dpv1() const requires(D::present) { return acyclic_; }

    // ---- what is known ------------------------------------------------------------------------------------------
    State state() const { return state_; }
    const Config& config() const { return config_; }
    const Layout& layout() const { return layout_; }
    std::uint8_t inputs() const { return inputs_; }    ///< octets, as the present configuration says
    std::uint8_t outputs() const { return outputs_; }
    std::uint8_t address() const { return address_; }  ///< Set_Slave_Add changes it
    /// DP_State, read from the chip: 0 WAIT-PRM, 1 WAIT-CFG, 2 DATA-EXCH.
    std::uint8_t dp_state() { return core::slice(read(ctl::status_reg_low), regmap::status::dp_state_lsb, 2); }
    /// WD_State, read from the chip: 0 BAUD_SEARCH, 1 BAUD_CONTROL, 2 DP_CONTROL.
    std::uint8_t wd_state() { return core::slice(read(ctl::status_reg_low), regmap::status::wd_state_lsb, 2); }
    /// Baud code, read from the chip; 15 while searching.
    std::uint8_t baud_code() { return core::slice(read(ctl::status_reg_high), 0, 4); }
    /// Release nibble: CH VPC3+C, BH VPC3+B.
    std::uint8_t release() { return core::slice(read(ctl::status_reg_high), 4, 4); }
    Bus& bus() { return bus_; }

private:
    using Octets = std::span<const std::uint8_t>;
    static constexpr std::uint8_t kDataExch = 2;
    static constexpr int kConflicts = 4;   // telegrams judged in one go; more wait for the next call

    /// Main program against interrupt routine: X/INT is masked while one is alive. They nest.
    class Quiet {
    public:
        explicit Quiet(Vpc3& d) : d_{d} {
            if (d_.quiet_++ == 0) d_.mask(0xFFFF);
            std::atomic_signal_fence(std::memory_order_seq_cst);
        }
        ~Quiet() {
            std::atomic_signal_fence(std::memory_order_seq_cst);
            if (--d_.quiet_ == 0) d_.mask(d_.imr_);
        }
        Quiet(const Quiet&) = delete;
        Quiet& operator=(const Quiet&) = delete;

    private:
        Vpc3& d_;
    };

    // ---- bus ----------------------------------------------------------------------------------------------------
    std::uint16_t at(std::uint16_t address) const {
        return config_.bus_mode == BusMode::motorola ? regmap::motorola_address(address) : address;
    }
    std::uint8_t read(std::uint16_t address) { return bus_.read(at(address)); }
    void write(std::uint16_t address, std::uint8_t value) { bus_.write(at(address), value); }
    std::uint16_t read_word(std::uint16_t address) {
        const std::uint8_t high = read(static_cast<std::uint16_t>(address + 1));
        return core::word(high, read(address));
    }
    void write_word(std::uint16_t address, std::uint16_t value) {
        write(static_cast<std::uint16_t>(address + 1), core::high(value));
        write(address, core::low(value));
    }
    void mask(std::uint16_t imr) {
        if (state_ != State::unconfigured && config_.service == Service::interrupt) write_word(ctl::int_mask_reg_low, imr);
    }
    void fill(std::uint16_t from, std::size_t octets, std::uint8_t value) {
        for (std::size_t i = 0; i < octets; ++i) bus_.write(static_cast<std::uint16_t>(from + i), value);
    }

    // ---- configure() --------------------------------------------------------------------------------------------
    bool test_ram(std::uint16_t pattern);
    void write_registers();
    void write_cells();
    std::uint16_t mode0() const;
    std::uint8_t mode2() const;
    bool has_mode2() const { return !regmap::traits(config_.variant).access_violation; }
    bool has_mode3() const { return regmap::traits(config_.variant).isom; }

    // ---- service ------------------------------------------------------------------------------------------------
    std::uint16_t serve();
    void serve_requests(std::uint16_t irr);
    void serve_indications(std::uint16_t irr);
    void serve_prm(std::uint16_t irr);
    void serve_cfg();
    void serve_ssa();
    void serve_offline();
    Octets received(std::uint16_t pointer_cell, std::uint16_t length_cell);
    bool judge_prm(Octets octets);
    bool judge_cfg(Octets octets);
    bool may_differ() const;
    bool take_cfg(Octets octets, bool plugged);
    bool is_read_cfg(Octets octets);
    void adapt_lengths(std::uint8_t inputs, std::uint8_t outputs);
    void publish_inputs_again();
    void hand_over_diagnosis();
    bool write_diagnosis(const detail::Diagnosis& d);
    void note_prm(Octets octets) requires(D::present);
    void note_cfg() requires(D::present);
    void finish_acyclic() requires(D::present);
    bool diag_fetched() requires(D::present);
    std::uint8_t owner() requires(D::present);

    Bus bus_;
    App* app_;
    Config config_{};
    Layout layout_{};
    State state_ = State::unconfigured;
    std::uint16_t imr_ = 0xFFFF;
    std::uint16_t handled_ = 0;    // interrupt bits this driver serves
    std::uint8_t quiet_ = 0;
    std::uint8_t inputs_ = 0, outputs_ = 0, address_ = 126;
    std::uint8_t din_u_ = 0;       // number of the user's Din_Buf
    bool restart_ = false;
    bool prm_accepted_ = false;    // user parameters of this master have been accepted
    bool following_ = false;       // the configuration is the master's, not the plugged one
    bool has_diagnosis_ = false;
    detail::Diagnosis latest_{};
    detail::DiagQueue<PendingDiagnoses> queue_{};
    std::array<std::uint8_t, 244> scratch_{};
    [[no_unique_address]] Engine acyclic_;
};

}  // namespace dpchip::driver

#include <dpchip/driver/vpc3_configure.hpp>
#include <dpchip/driver/vpc3_dpv1.hpp>
#include <dpchip/driver/vpc3_service.hpp>
