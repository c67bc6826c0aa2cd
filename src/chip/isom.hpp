// SPDX-License-Identifier: Apache-2.0
// Isochron Mode and Simple Sync Mode: SYNCH telegrams, the SYNC pulse and the three roles of pin 13 (7.3.2, figures 7-16,
// 7-17; reference 6.2; hardware reference 8).
#pragma once

#include <dpchip/chip/irq.hpp>
#include <dpchip/chip/mac.hpp>

namespace dpchip::chip::isom {

inline constexpr std::int64_t kSyncPwClk = 4;  // Sync_PW counts in 1/12 us

template <class C>
bool isochron(const C& c) { return c.traits->isom && (c.s.mode2 & regmap::mode2::sync_ena) != 0; }

template <class C>
bool simple_sync(const C& c) {
    return c.traits->isom && (c.s.mode2 & (regmap::mode2::sync_ena | regmap::mode2::dx_int_port)) == regmap::mode2::dx_int_port;
}

/// Every Global_Control to everybody is compared with Control_Command_Reg and Group_Select_Reg, whoever sent it.
template <class C>
bool is_synch(const C& c, std::span<const std::uint8_t> d) {
    return c.s.dp_state == DpState::data_exch && (c.s.request_da & 0x7F) == fdl::kBroadcast && d.size() == 2 &&
           d[0] == c.s.control_command && d[1] == c.s.group_select;
}

template <class C>
void set_sync(C& c, bool active) {
    if ((c.s.sync_active != 0) == active) return;
    c.s.sync_active = active ? 1 : 0;
    outputs::changed(c, Fact::xdataexch_sync, Pin::xdataexch_sync);
}

template <class C>
Ticks pulse_width(const C& c) { return core::kClk * (kSyncPwClk * c.s.sync_pw); }

/// Isochron Mode: a pulse on every SYNCH, which begins anew when the last one is not over; Sync_PW = 0 gives none.
template <class C>
void start_pulse(C& c) {
    if (c.s.sync_pw == 0) return;
    const Ticks at = std::max(c.s.now, c.s.request_end + core::kClk * c.options.sync_pulse_delay_clk);
    timers::start(c.s, Timer::sync, c.s.sync_active != 0 ? at + pulse_width(c) : at);
}

template <class C>
void pulse_edge(C& c) {
    const bool begins = c.s.sync_active == 0;
    set_sync(c, begins);
    if (begins) timers::start(c.s, Timer::sync, c.s.now + pulse_width(c));
    else timers::stop(c.s, Timer::sync);
}

/// A Data_Exchange wants DX_Out: at once, or with the next SYNCH.
template <class C>
void dx_out(C& c) {
    if (simple_sync(c)) c.s.dx_stored = 1;
    else irq::raise(c, regmap::interrupt::dx_out);
}

/// Simple Sync Mode: the stored event becomes DX_Out, and the pin shows it as far as DX_Out is not masked.
template <class C>
void release_dx_out(C& c) {
    if (c.s.dx_stored == 0) return;
    c.s.dx_stored = 0;
    irq::raise(c, regmap::interrupt::dx_out);
    if ((c.s.imr & regmap::interrupt::dx_out) == 0) set_sync(c, true);
}

/// The pin of Simple Sync Mode stays active until DX_Out is acknowledged.
template <class C>
void after_acknowledge(C& c) {
    if (simple_sync(c) && (c.s.irr & regmap::interrupt::dx_out) == 0) set_sync(c, false);
}

/// A SYNCH telegram, before it is looked at as an ordinary Global_Control.
template <class C>
void synch(C& c, std::span<const std::uint8_t> d) {
    if (!is_synch(c, d)) return;
    if (simple_sync(c)) return release_dx_out(c);
    if (!isochron(c)) return;
    start_pulse(c);
    dpram::set_cell(c.s, regmap::org::r_gc_command, d[0]);
    irq::raise(c, regmap::interrupt::new_gc_command);
}

template <class C>
void stop(C& c) {
    c.s.dx_stored = 0;
    timers::stop(c.s, Timer::sync);
    set_sync(c, false);
}

}  // namespace dpchip::chip::isom
