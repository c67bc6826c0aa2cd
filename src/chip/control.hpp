// SPDX-License-Identifier: Apache-2.0
// Processor accesses: control parameters 00H..15H by their Effect, everything else is RAM (4.1 to 4.3, 5.1, 5.2).
//
// The only place that knows the Motorola rule: address bit 0 is inverted for 00H..07H and for R_User_WD_Value.
#pragma once

#include <dpchip/chip/ms.hpp>
#include <dpchip/regmap/control_parameters.hpp>

namespace dpchip::chip::control {

using regmap::Dir;
using regmap::Effect;

inline constexpr std::uint8_t kMode1Bits = 0x3F;

/// The Intel address that an access means.
constexpr std::uint16_t intel_address(const State& s, std::uint16_t address) {
    const bool word = address <= 0x07 || address == regmap::org::r_user_wd_value_low || address == regmap::org::r_user_wd_value_high;
    return s.bus_mode == BusMode::motorola && word ? static_cast<std::uint16_t>(address ^ 1u) : address;
}

/// The address lines that the chip looks at: AB10..AB0, and AB11 in 4 KB mode.
constexpr std::uint16_t decoded(const State& s, const regmap::Traits& t, std::uint16_t address) {
    const unsigned lines = dpram::size(s, t) > 2048 ? 0xFFFu : 0x7FFu;
    return intel_address(s, static_cast<std::uint16_t>(address & lines));
}

constexpr std::uint16_t status(const State& s, const regmap::Traits& t) {
    namespace st = regmap::status;
    const unsigned low = (s.passive_idle != 0 ? st::passive_idle : 0u) | (s.diag_flag != 0 ? st::diag_flag : 0u) |
                         (s.ram_access_violation != 0 ? st::ram_access_violation : 0u) |
                         static_cast<unsigned>(s.dp_state) << st::dp_state_lsb | static_cast<unsigned>(s.wd_state) << st::wd_state_lsb;
    const unsigned high = static_cast<unsigned>(s.baud) << st::baud_lsb | static_cast<unsigned>(t.release) << st::release_lsb;
    return static_cast<std::uint16_t>(low | high);
}

// ---- acknowledgements: 0EH, 0FH, 10H, 11H ------------------------------------------------------------------------

constexpr std::uint8_t acknowledge_result(const State& s, std::uint8_t counter) {
    namespace a = regmap::acknowledge;
    if (s.dp_state == DpState::wait_prm || counter == 0) return a::not_allowed;
    return counter > 1 ? a::conflict : a::finished;
}

template <class C>
std::uint8_t acknowledge_prm(C& c, bool okay, std::uint16_t address) {
    const std::uint8_t result = acknowledge_result(c.s, c.s.prm_counter);
    if (result == regmap::acknowledge::not_allowed) {
        c.find(Rule::acknowledge_not_allowed, address);
    } else if (result == regmap::acknowledge::conflict) {
        aux::present_waiting_prm(c);
    } else {
        irq::clear(c, aux::prm_interrupt(c.s.prm_present));
        aux::set_counter(c, Fact::prm_counter, c.s.prm_counter, 0);
        if (okay) dp::enter_data_exch_if_ready(c);
        else dp::leave_with_fault(c, regmap::LeaveCause::prm_not_okay, &State::prm_fault);
    }
    return result;
}

/// 6.2.9: the configuration that was just accepted becomes the one that Get_Cfg reads.
template <class C>
void change_cfg_buffer(C& c) {
    const std::uint8_t cfg = dpram::pointer(c.s, regmap::org::r_cfg_buf_ptr);
    dpram::set_pointer(c.s, regmap::org::r_cfg_buf_ptr, dpram::pointer(c.s, regmap::org::r_read_cfg_buf_ptr));
    dpram::set_pointer(c.s, regmap::org::r_read_cfg_buf_ptr, cfg);
}

template <class C>
void accept_cfg(C& c) {
    c.s.cfg_okay = 1;
    c.s.cfg_fault = 0;
    if ((c.s.mode1 & regmap::mode1::en_change_cfg_buffer) != 0) change_cfg_buffer(c);
    diag::refresh(c);
    dp::enter_data_exch_if_ready(c);
}

template <class C>
std::uint8_t acknowledge_cfg(C& c, bool okay, std::uint16_t address) {
    const std::uint8_t result = acknowledge_result(c.s, c.s.cfg_counter);
    if (result == regmap::acknowledge::not_allowed) {
        c.find(Rule::acknowledge_not_allowed, address);
    } else if (result == regmap::acknowledge::conflict) {
        aux::present_waiting_cfg(c);
    } else {
        irq::clear(c, regmap::interrupt::new_cfg_data);
        aux::set_counter(c, Fact::cfg_counter, c.s.cfg_counter, 0);
        if (okay) accept_cfg(c);
        else dp::leave_with_fault(c, regmap::LeaveCause::cfg_not_okay, &State::cfg_fault);
    }
    return result;
}

// ---- commands by reading -----------------------------------------------------------------------------------------

template <class C>
std::uint8_t new_din_buffer_cmd(C& c) {
    const std::uint8_t user = din::new_buffer_cmd(c);
    c.s.din_given = c.s.passive_idle;
    dp::enter_data_exch_if_ready(c);
    return user;
}

/// Next_DXBout_Buffer_Cmd: N -> U. These buffers are never cleared, so there is no third mark (figure 7-13).
template <class C>
std::uint8_t next_dxbout_buffer_cmd(C& c) {
    BufferSm sm{c.s.dxbout_sm};
    const bool fresh = sm.fetch(Slot::u);
    change(c, Fact::dxbout_buffer_sm, c.s.dxbout_sm, sm.raw());
    return static_cast<std::uint8_t>(sm.at(Slot::u) | (fresh ? regmap::next_dout::state_u_buffer : 0u));
}
constexpr std::uint8_t peek_next_dxbout_buffer_cmd(const State& s) {
    BufferSm sm{s.dxbout_sm};
    const bool fresh = sm.fetch(Slot::u);
    return static_cast<std::uint8_t>(sm.at(Slot::u) | (fresh ? regmap::next_dout::state_u_buffer : 0u));
}

/// What a read cycle would deliver. Nothing changes.
template <class C>
std::uint8_t peek_register(const C& c, Effect effect) {
    const State& s = c.s;
    // clang-format off
    switch (effect) {
    case Effect::irr_low:                return core::low(s.irr);
    case Effect::irr_high:               return core::high(s.irr);
    case Effect::ir_low:                 return core::low(irq::ir(s));
    case Effect::ir_high:                return core::high(irq::ir(s));
    case Effect::status_low:             return core::low(status(s, *c.traits));
    case Effect::status_high:            return core::high(status(s, *c.traits));
    case Effect::mode0_low:              return core::low(s.mode0);
    case Effect::mode0_high:             return core::high(s.mode0);
    case Effect::mode1:                  return s.mode1;
    case Effect::din_buffer_sm:          return s.din_sm;
    case Effect::dout_buffer_sm:         return s.dout_sm;
    case Effect::diag_buffer_sm:         return s.diag_sm;
    case Effect::dxbout_buffer_sm:       return s.dxbout_sm;
    case Effect::new_din_buffer_cmd:     return din::peek_new_buffer_cmd(s);
    case Effect::next_dout_buffer_cmd:   return dout::peek_next_buffer_cmd(s);
    case Effect::new_diag_buffer_cmd:    return diag::peek_new_diag_cmd(s);
    case Effect::user_prm_data_okay:
    case Effect::user_prm_data_not_okay: return acknowledge_result(s, s.prm_counter);
    case Effect::user_cfg_data_okay:
    case Effect::user_cfg_data_not_okay: return acknowledge_result(s, s.cfg_counter);
    case Effect::next_dxbout_buffer_cmd: return peek_next_dxbout_buffer_cmd(s);
    case Effect::ssa_buffer_free_cmd:
    case Effect::reserved:
    case Effect::irr_set_low: case Effect::irr_set_high: case Effect::iar_low: case Effect::iar_high:
    case Effect::imr_low: case Effect::imr_high: case Effect::mode0_write_low: case Effect::mode0_write_high:
    case Effect::mode1_set: case Effect::mode1_reset: case Effect::wd_baud_control_val: case Effect::min_tsdr_val:
    case Effect::mode2_write: case Effect::sync_pw: case Effect::control_command: case Effect::group_select:
    case Effect::mode3_write:            return 0;
    }
    // clang-format on
    return 0;
}

/// A read cycle on a control parameter: commands act, everything else is looked at.
template <class C>
std::uint8_t read_register(C& c, Effect effect, std::uint16_t address) {
    switch (effect) {
    case Effect::irr_low:
    case Effect::ir_low: irq::seen(c.s, 0x00FF); break;
    case Effect::irr_high:
    case Effect::ir_high: irq::seen(c.s, 0xFF00); break;
    case Effect::new_din_buffer_cmd: return new_din_buffer_cmd(c);
    case Effect::next_dout_buffer_cmd: return dout::next_buffer_cmd(c);
    case Effect::new_diag_buffer_cmd: return diag::new_diag_cmd(c);
    case Effect::user_prm_data_okay: return acknowledge_prm(c, true, address);
    case Effect::user_prm_data_not_okay: return acknowledge_prm(c, false, address);
    case Effect::user_cfg_data_okay: return acknowledge_cfg(c, true, address);
    case Effect::user_cfg_data_not_okay: return acknowledge_cfg(c, false, address);
    case Effect::next_dxbout_buffer_cmd: return next_dxbout_buffer_cmd(c);
    case Effect::ssa_buffer_free_cmd: c.s.ssa_busy = 0; break;
    case Effect::reserved: case Effect::status_low: case Effect::status_high: case Effect::mode0_low:
    case Effect::mode0_high: case Effect::mode1: case Effect::din_buffer_sm: case Effect::dout_buffer_sm:
    case Effect::diag_buffer_sm: case Effect::dxbout_buffer_sm: case Effect::irr_set_low: case Effect::irr_set_high:
    case Effect::iar_low: case Effect::iar_high: case Effect::imr_low: case Effect::imr_high:
    case Effect::mode0_write_low: case Effect::mode0_write_high: case Effect::mode1_set: case Effect::mode1_reset:
    case Effect::wd_baud_control_val: case Effect::min_tsdr_val: case Effect::mode2_write: case Effect::sync_pw:
    case Effect::control_command: case Effect::group_select: case Effect::mode3_write: break;
    }
    return peek_register(c, effect);
}

// ---- write side --------------------------------------------------------------------------------------------------

/// Mode Registers 0, 2 and 3 may be set in Offline only; a write while online is ignored.
template <class C>
bool may_set_mode(C& c, std::uint16_t address) {
    if (c.s.passive_idle == 0) return true;
    c.find(Rule::mode_reg_online, address);
    return false;
}

/// APC3: the default of minTSDR depends on MinTSDR, pure DP or combi operation (reference 3.4.4).
template <class C>
void set_mode0(C& c, std::uint16_t value) {
    const auto before = c.s.mode0;
    c.s.mode0 = value & c.traits->mode0_bits;
    const bool combi_changed = ((before ^ c.s.mode0) & regmap::mode0::min_tsdr) != 0;
    if (c.traits->access_violation && combi_changed)
        c.s.min_tsdr = (c.s.mode0 & regmap::mode0::min_tsdr) != 0 ? std::uint8_t{255} : c.traits->min_tsdr_reset;
    if (((before ^ c.s.mode0) & regmap::mode0::int_pol) != 0) outputs::changed(c, Fact::x_int, Pin::x_int);
}

/// The role and the polarity of pin 13 may change with it.
template <class C>
void set_mode2(C& c, std::uint8_t value) {
    const Level before = outputs::level(c.s, Pin::xdataexch_sync);
    c.s.mode2 = value & c.traits->mode2_bits;
    if (outputs::level(c.s, Pin::xdataexch_sync) != before) outputs::changed(c, Fact::xdataexch_sync, Pin::xdataexch_sync);
}

template <class C>
void set_mode1(C& c, std::uint8_t bits) {
    namespace m1 = regmap::mode1;
    const bool online = c.s.passive_idle != 0;
    c.s.mode1 |= bits & (m1::res_user_wd | m1::en_change_cfg_buffer);
    if ((bits & m1::eoi) != 0) irq::end_of_interrupt(c);
    if ((bits & m1::user_leave_master) != 0 && online) dp::leave_master(c, regmap::LeaveCause::user_leave_master);
    if ((bits & m1::go_offline) != 0 && online) {
        c.s.mode1 |= m1::go_offline;
        ms::request_offline(c);
    }
    if ((bits & m1::start_vpc3) != 0 && !online) ms::start(c);
}

template <class C>
void reset_mode1(C& c, std::uint8_t bits) {
    c.s.mode1 &= static_cast<std::uint8_t>(~(bits & kMode1Bits));
    if ((bits & regmap::mode1::go_offline) == 0 || c.s.ram_access_violation != 0) return;
    c.s.offline_requested = 0;
    timers::stop(c.s, Timer::offline);
}

constexpr std::uint16_t with_low(std::uint16_t w, std::uint8_t octet) { return core::word(core::high(w), octet); }
constexpr std::uint16_t with_high(std::uint16_t w, std::uint8_t octet) { return core::word(octet, core::low(w)); }
constexpr std::uint16_t in_high(std::uint8_t octet) { return core::word(octet, 0); }

template <class C>
void write_register(C& c, Effect effect, std::uint16_t address, std::uint8_t v) {
    // clang-format off
    switch (effect) {
    case Effect::irr_set_low:         return irq::set_by_user(c, v);
    case Effect::irr_set_high:        return irq::set_by_user(c, in_high(v));
    case Effect::iar_low:             return irq::acknowledge(c, v);
    case Effect::iar_high:            irq::acknowledge(c, in_high(v)); return isom::after_acknowledge(c);
    case Effect::imr_low:             return irq::set_imr(c, with_low(c.s.imr, v));
    case Effect::imr_high:            return irq::set_imr(c, with_high(c.s.imr, v));
    case Effect::mode0_write_low:     if (may_set_mode(c, address)) set_mode0(c, with_low(c.s.mode0, v));  return;
    case Effect::mode0_write_high:    if (may_set_mode(c, address)) set_mode0(c, with_high(c.s.mode0, v)); return;
    case Effect::mode1_set:           return set_mode1(c, v);
    case Effect::mode1_reset:         return reset_mode1(c, v);
    case Effect::wd_baud_control_val: c.s.wd_baud_control_val = v; return;
    case Effect::min_tsdr_val:        c.s.min_tsdr = v;            return;
    case Effect::mode2_write:         if (may_set_mode(c, address)) set_mode2(c, v); return;
    case Effect::sync_pw:             c.s.sync_pw = v;             return;
    case Effect::control_command:     c.s.control_command = v;     return;
    case Effect::group_select:        c.s.group_select = v;        return;
    case Effect::mode3_write:         if (may_set_mode(c, address)) c.s.mode3 = v; return;
    case Effect::reserved:            return c.find(Rule::reserved_write, address);
    case Effect::irr_low: case Effect::irr_high: case Effect::ir_low: case Effect::ir_high: case Effect::status_low:
    case Effect::status_high: case Effect::mode0_low: case Effect::mode0_high: case Effect::mode1:
    case Effect::din_buffer_sm: case Effect::dout_buffer_sm: case Effect::diag_buffer_sm: case Effect::dxbout_buffer_sm:
    case Effect::new_din_buffer_cmd: case Effect::next_dout_buffer_cmd: case Effect::new_diag_buffer_cmd:
    case Effect::user_prm_data_okay: case Effect::user_prm_data_not_okay: case Effect::user_cfg_data_okay:
    case Effect::user_cfg_data_not_okay: case Effect::next_dxbout_buffer_cmd: case Effect::ssa_buffer_free_cmd: return;
    }
    // clang-format on
}

// ---- whole accesses ----------------------------------------------------------------------------------------------

/// APC3 and SPC3: an access beyond the RAM goes 400H lower, and the chip goes Offline.
template <class C>
std::uint16_t checked(C& c, std::uint16_t address) {
    if (address < dpram::size(c.s, *c.traits)) return address;
    const std::uint16_t folded = dpram::fold(c, address);
    ms::request_offline(c);
    return folded;
}

/// An event that a processor access causes is older than the next access: an IAR write may clear it.
template <class C, class Access>
auto access(C& c, Access&& act) {
    const std::uint16_t arriving = irq::arriving(c.s);
    struct Forget {
        State& s;
        std::uint16_t kept;
        ~Forget() { s.irr_fresh &= kept; }
    } const forget{c.s, arriving};
    return act();
}

template <class C>
std::uint8_t read(C& c, std::uint16_t bus_address) {
    const std::uint16_t a = checked(c, decoded(c.s, *c.traits, bus_address));
    const auto read_control = [&] { return read_register(c, regmap::effect(c.traits->variant, Dir::read, a), a); };
    const std::uint8_t value = a < regmap::control::count   ? access(c, read_control)
                               : clock_sync::watches(c, a) ? clock_sync::read(c, a)
                                                           : c.s.ram[a];
    c.fact(Fact::cpu_read, a, value);
    return value;
}

template <class C>
void write(C& c, std::uint16_t bus_address, std::uint8_t value) {
    const std::uint16_t a = checked(c, decoded(c.s, *c.traits, bus_address));
    c.fact(Fact::cpu_write, a, value);
    const auto write_control = [&] { write_register(c, regmap::effect(c.traits->variant, Dir::write, a), a, value); };
    if (a < regmap::control::count) access(c, write_control);
    else if (clock_sync::watches(c, a)) clock_sync::write(c, a, value);
    else c.s.ram[a] = value;
}

template <class C>
std::uint8_t peek(const C& c, std::uint16_t bus_address) {
    std::uint16_t a = decoded(c.s, *c.traits, bus_address);
    if (a >= dpram::size(c.s, *c.traits)) a = static_cast<std::uint16_t>(a - 0x400);
    if (a < regmap::control::count) return peek_register(c, regmap::effect(c.traits->variant, Dir::read, a));
    return clock_sync::watches(c, a) ? clock_sync::peek(c, a) : c.s.ram[a];
}

/// True when accesses to all these addresses only move octets of RAM and nobody watches: they may go in one step.
template <class C>
bool plain(const C& c, std::uint16_t address, std::size_t octets) {
    return !c.trace.active() && !clock_sync::enabled(c) && address >= regmap::kFirstBuffer && address + octets <= dpram::size(c.s, *c.traits);
}

}  // namespace dpchip::chip::control
