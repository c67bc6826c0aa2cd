// SPDX-License-Identifier: Apache-2.0
// What the driver tells and asks the application. Derive from Events and hide what you want to hear; nothing is virtual.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>

#include <dpchip/driver/prm_rules.hpp>
#include <dpchip/dp/set_prm.hpp>
#include <dpchip/dp/set_slave_add.hpp>

namespace dpchip::driver {

enum class Verdict : std::uint8_t { accept, refuse };

/// Called from within poll() and on_interrupt(). Views are valid during the call. fetch_outputs(), write_inputs(),
/// set_diagnosis(), leave_master(), go_offline() and restart() may be called from here.
struct Events {
    /// A Set_Prm with user data has passed PrmRules. After a conflict the question comes again, for the newer telegram.
    Verdict set_prm(const dp::SetPrm&) { return Verdict::accept; }
    /// A Set_Prm has been refused by PrmRules.
    void prm_refused(PrmFault) {}
    /// A Set_Ext_Prm: structured blocks.
    Verdict set_ext_prm(std::span<const std::uint8_t>) { return Verdict::accept; }
    /// A Chk_Cfg that the configured policy accepts, and the lengths it means.
    Verdict chk_cfg(std::span<const std::uint8_t>, std::uint8_t /*inputs*/, std::uint8_t /*outputs*/) { return Verdict::accept; }
    /// A Chk_Cfg has been refused: it differs, does not fit, or came without the parameters it needs.
    void cfg_refused() {}

    void data_exch_entered() {}
    void data_exch_left() {}
    /// DX_Out: fetch_outputs() has something, or had it already.
    void dx_out() {}
    /// The chip has given a diagnosis buffer back.
    void diag_buffer_changed() {}
    /// The master's watchdog time ran out.
    void wd_dp_control_timeout() {}
    /// Code 0..9, fastest first.
    void baud_rate_detect(std::uint8_t /*code*/) {}
    void new_gc_command(std::uint8_t /*control_command*/) {}
    /// Set_Slave_Add has changed the address: store it, and No_Add_Chg, for the next power-up.
    void new_ssa_data(const dp::SetSlaveAdd&) {}
    void user_timer_clock() {}
    /// Offline has been reached.
    void offline() {}

    // What the application does beside the driver, with the parts of DP-V2 (dxb_subscriber.hpp, slave_clock.hpp,
    // isochron.hpp). Left as they are, these cost nothing.
    /// Interrupt bits that it serves and acknowledges by itself.
    std::uint16_t own_interrupts() const { return 0; }
    /// Some of them are pending.
    void serve_own(std::uint16_t) {}
    /// Bits of Mode Registers 0 and 2 that it needs.
    std::uint16_t more_mode0() const { return 0; }
    std::uint8_t more_mode2() const { return 0; }
};

template <class A>
concept Application = std::derived_from<A, Events>;

}  // namespace dpchip::driver
