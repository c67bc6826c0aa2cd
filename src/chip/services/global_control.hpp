// SPDX-License-Identifier: Apache-2.0
// Global_Control, SAP 58 (6.2.6; reference 3.9). A SYNCH telegram is one too (7.3.2).
#pragma once

#include <dpchip/chip/dp_sm.hpp>
#include <dpchip/chip/isom.hpp>
#include <dpchip/chip/mac.hpp>

namespace dpchip::chip::global_control {

/// Control_Command (figure 6-16).
inline constexpr std::uint8_t kClearData = 0x02, kUnfreeze = 0x04, kFreeze = 0x08, kUnsync = 0x10, kSync = 0x20;
inline constexpr std::uint8_t kReserved = 0xC1;

template <class C>
bool valid(C& c, std::span<const std::uint8_t> d) {
    if (c.s.dp_state != DpState::data_exch || !dp::is_owner(c.s, mac::master(c.s)) || d.size() != 2) return false;
    const bool check = (c.s.mode2 & regmap::mode2::no_check_gc_reserved) == 0;
    if (!check || (d[0] & kReserved) == 0) return true;
    if (c.options.gc_reserved_sets_not_supported) {
        c.s.not_supported = 1;
        diag::refresh(c);
    }
    return false;
}

constexpr bool addressed(const State& s, std::uint8_t group_select) {
    return group_select == 0 || (group_select & s.group_ident) != 0;
}

template <class C>
bool allowed(const C& c, std::uint16_t supported, std::uint8_t requested) {
    return (c.s.mode0 & supported) != 0 && (!c.options.gc_requires_prm_req || requested != 0);
}

template <class C>
void freeze(C& c, std::uint8_t command) {
    if (!allowed(c, regmap::mode0::freeze_supported, c.s.freeze_req)) return;
    if ((command & kUnfreeze) != 0) {
        change(c, Fact::freeze_mode, c.s.freeze_mode, std::uint8_t{0});
    } else if ((command & kFreeze) != 0) {
        din::fetch(c);
        change(c, Fact::freeze_mode, c.s.freeze_mode, std::uint8_t{1});
    }
}

/// Outputs that Sync_Mode kept back go to the user with the next Sync or Unsync.
template <class C>
void sync(C& c, std::uint8_t command) {
    if (!allowed(c, regmap::mode0::sync_supported, c.s.sync_req) || (command & (kSync | kUnsync)) == 0) return;
    if (c.s.dout_d_filled != 0) {
        dout::shift(c);
        irq::raise(c, regmap::interrupt::dx_out);
    }
    const bool on = (command & kUnsync) == 0;
    change(c, Fact::sync_mode, c.s.sync_mode, static_cast<std::uint8_t>(on ? 1 : 0));
}

/// New_GC_Command by GC_Int_Mode and GC_Int_Mode_Ext; APC3 knows only changed control octets.
template <class C>
bool tells_user(const C& c, std::uint8_t command, std::uint8_t group) {
    const bool command_changed = command != c.s.gc_command_before;
    if (c.traits->gc_only_changed) return command_changed;
    if ((c.s.mode2 & regmap::mode2::gc_int_mode) != 0) return true;
    if ((c.s.mode3 & regmap::mode3::gc_int_mode_ext) != 0) return command_changed;
    return command_changed || group != c.s.gc_group_before;
}

template <class C>
void serve(C& c) {
    const auto d = mac::data(c.s);
    isom::synch(c, d);
    if (!valid(c, d) || !addressed(c.s, d[1])) return;
    const std::uint8_t command = d[0], group = d[1];
    freeze(c, command);
    if ((command & kClearData) != 0) dout::clear_with_interrupt(c);
    sync(c, command);
    dpram::set_cell(c.s, regmap::org::r_gc_command, command);
    if (tells_user(c, command, group)) irq::raise(c, regmap::interrupt::new_gc_command);
    c.s.gc_command_before = command;
    c.s.gc_group_before = group;
    diag::refresh(c);
}

}  // namespace dpchip::chip::global_control
