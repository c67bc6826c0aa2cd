// SPDX-License-Identifier: Apache-2.0
// Dout- and Din-Buffers: what the three-buffer machines do to RAM (6.2.5; reference 3.8, 4.5).
#pragma once

#include <dpchip/chip/buffer_sm.hpp>
#include <dpchip/chip/dpram.hpp>
#include <dpchip/chip/irq.hpp>

namespace dpchip::chip {

/// Output data, master to slave.
namespace dout {

constexpr std::uint8_t length(const State& s) { return dpram::cell(s, regmap::org::r_len_dout_buf); }
constexpr std::uint8_t segment(const State& s, std::uint8_t number) {
    return dpram::pointer(s, static_cast<std::uint16_t>(regmap::org::r_dout_buf_ptr1 + number - 1));
}
constexpr std::uint8_t segment(const State& s, Slot slot) { return segment(s, BufferSm{s.dout_sm}.at(slot)); }
constexpr std::uint8_t cleared_bit(std::uint8_t number) { return static_cast<std::uint8_t>(1u << number); }

/// Without Mode Register 2 (APC3) the interrupt comes only when there are outputs.
constexpr bool interrupt_without_outputs(const State& s) { return (s.mode2 & regmap::mode2::dx_int_mode) != 0; }

/// D -> N: the user can have the outputs.
template <class C>
void shift(C& c) {
    BufferSm sm{c.s.dout_sm};
    sm.publish(Slot::d);
    change(c, Fact::dout_buffer_sm, c.s.dout_sm, sm.raw());
    c.s.dout_d_filled = 0;
}

/// Stores received outputs in D.
template <class C>
void fill(C& c, std::span<const std::uint8_t> data) {
    const std::uint8_t number = BufferSm{c.s.dout_sm}.at(Slot::d);
    dpram::write(c, segment(c.s, number), data);
    c.s.dout_cleared &= static_cast<std::uint8_t>(~cleared_bit(number));
}

/// Zeroes D and shifts it, Sync_Mode or not: power-on, LEAVE-MASTER, Clear_Data, fail-safe telegrams.
template <class C>
void clear(C& c) {
    const std::uint8_t number = BufferSm{c.s.dout_sm}.at(Slot::d);
    dpram::zero(c, segment(c.s, number), length(c.s));
    c.s.dout_cleared |= cleared_bit(number);
    shift(c);
}

template <class C>
void clear_with_interrupt(C& c) {
    clear(c);
    if (length(c.s) != 0 || interrupt_without_outputs(c.s)) irq::raise(c, regmap::interrupt::dx_out);
}

/// Number of the user's buffer with the marks of Next_Dout_Buffer_Cmd (figure 6-13).
constexpr std::uint8_t command_result(const State& s, std::uint8_t number, bool fresh) {
    const bool cleared = (s.dout_cleared & cleared_bit(number)) != 0;
    return static_cast<std::uint8_t>(number | (fresh ? regmap::next_dout::state_u_buffer : 0u) |
                                     (cleared ? regmap::next_dout::u_buffer_cleared : 0u));
}

/// Next_Dout_Buffer_Cmd: N -> U, if there is one.
template <class C>
std::uint8_t next_buffer_cmd(C& c) {
    BufferSm sm{c.s.dout_sm};
    const bool fresh = sm.fetch(Slot::u);
    change(c, Fact::dout_buffer_sm, c.s.dout_sm, sm.raw());
    return command_result(c.s, sm.at(Slot::u), fresh);
}

/// What Next_Dout_Buffer_Cmd would return.
constexpr std::uint8_t peek_next_buffer_cmd(const State& s) {
    BufferSm sm{s.dout_sm};
    const bool fresh = sm.fetch(Slot::u);
    return command_result(s, sm.at(Slot::u), fresh);
}

}  // namespace dout

/// Input data, slave to master.
namespace din {

constexpr std::uint8_t length(const State& s) { return dpram::cell(s, regmap::org::r_len_din_buf); }
constexpr std::uint8_t segment(const State& s, Slot slot) {
    return dpram::pointer(s, static_cast<std::uint16_t>(regmap::org::r_din_buf_ptr1 + BufferSm{s.din_sm}.at(slot) - 1));
}

/// N -> D before an answer; Freeze_Mode and repetitions keep D.
template <class C>
void fetch(C& c) {
    BufferSm sm{c.s.din_sm};
    sm.fetch(Slot::d);
    change(c, Fact::din_buffer_sm, c.s.din_sm, sm.raw());
}

/// New_Din_Buffer_Cmd: U -> N; returns the buffer that the user has now.
template <class C>
std::uint8_t new_buffer_cmd(C& c) {
    BufferSm sm{c.s.din_sm};
    sm.publish(Slot::u);
    change(c, Fact::din_buffer_sm, c.s.din_sm, sm.raw());
    return sm.at(Slot::u);
}

constexpr std::uint8_t peek_new_buffer_cmd(const State& s) {
    BufferSm sm{s.din_sm};
    sm.publish(Slot::u);
    return sm.at(Slot::u);
}

}  // namespace din

}  // namespace dpchip::chip
