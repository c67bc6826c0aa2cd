// SPDX-License-Identifier: Apache-2.0
// The two diagnosis buffers, their machine and the six octets that the chip composes (6.2.4; reference 3.7, 4.6).
#pragma once

#include <array>

#include <dpchip/chip/dpram.hpp>
#include <dpchip/chip/irq.hpp>

namespace dpchip::chip::diag {

namespace owner_code = regmap::diag_owner;

inline constexpr std::uint8_t kHeader = 6;
/// Bits of octet 0 of the user's buffer (APC3 table 5.7).
inline constexpr std::uint8_t kExtDiag = 1, kStatDiag = 2, kOverflow = 4;

/// Code in Diag_Buffer_SM of buffer 1 or 2.
constexpr std::uint8_t code(const State& s, unsigned number) { return core::slice(s.diag_sm, 2 * (number - 1), 2); }

template <class C>
void set_code(C& c, unsigned number, std::uint8_t value) {
    const unsigned lsb = 2 * (number - 1);
    change(c, Fact::diag_buffer_sm, c.s.diag_sm,
           static_cast<std::uint8_t>((c.s.diag_sm & ~(3u << lsb)) | static_cast<unsigned>(value << lsb)));
}

/// The buffer with that code, or 0.
constexpr unsigned with_code(const State& s, std::uint8_t value) {
    return code(s, 1) == value ? 1u : code(s, 2) == value ? 2u : 0u;
}

/// The buffer that a Slave_Diag answer comes from: the one being sent, else the chip's.
constexpr unsigned own(const State& s) {
    const unsigned sending = with_code(s, owner_code::vpc3_send_mode);
    return sending != 0 ? sending : with_code(s, owner_code::vpc3);
}

constexpr std::uint8_t segment(const State& s, unsigned number) {
    return dpram::pointer(s, static_cast<std::uint16_t>(regmap::org::r_diag_buf_ptr1 + number - 1));
}

/// Length of a buffer's diagnosis, header included; less than the header counts as the header.
template <class C>
std::uint8_t length(C& c, unsigned number) {
    const auto octets = dpram::cell(c.s, static_cast<std::uint16_t>(regmap::org::r_len_diag_buf1 + number - 1));
    if (octets >= kHeader) return octets;
    c.find(Rule::diag_length, octets);
    return kHeader;
}

/// Octets 0..5 as a master would get them now.
constexpr std::array<std::uint8_t, kHeader> header(const State& s) {
    const auto bit = [](bool set, unsigned n) { return set ? 1u << n : 0u; };
    const unsigned o0 = bit(s.dp_state != DpState::data_exch, 1) | bit(s.cfg_fault != 0, 2) |
                        bit((s.diag_control & kExtDiag) != 0, 3) | bit(s.not_supported != 0, 4) | bit(s.prm_fault != 0, 6);
    const unsigned o1 = bit(s.prm_req != 0, 0) | bit((s.diag_control & kStatDiag) != 0, 1) | bit(true, 2) |
                        bit(s.wd_on != 0, 3) | bit(s.freeze_mode != 0, 4) | bit(s.sync_mode != 0, 5);
    const unsigned o2 = bit((s.diag_control & kOverflow) != 0, 7);
    return {static_cast<std::uint8_t>(o0), static_cast<std::uint8_t>(o1), static_cast<std::uint8_t>(o2), s.master_add,
            dpram::cell(s, regmap::org::r_ident_high), dpram::cell(s, regmap::org::r_ident_low)};
}

template <class C>
void write_header(C& c, unsigned number, std::size_t from) {
    const auto octets = header(c.s);
    for (std::size_t i = from; i < kHeader; ++i) c.s.ram[dpram::physical(c, segment(c.s, number), i)] = octets[i];
}

/// Brings the header in the chip's own buffer up to date. Firmware reads Master_Add there.
template <class C>
void refresh(C& c) {
    if (const unsigned number = own(c.s); number != 0) write_header(c, number, 0);
}

/// Start and LEAVE-MASTER: the user's buffer must not keep an old Master_Add; its octet 0 belongs to the user.
template <class C>
void refresh_both(C& c) {
    for (const unsigned number : {1u, 2u}) write_header(c, number, number == own(c.s) ? 0 : 1);
}

template <class C>
void set_flag(C& c, bool flag) {
    change(c, Fact::diag_flag, c.s.diag_flag, static_cast<std::uint8_t>(flag ? 1 : 0));
}

/// The user's buffer becomes the chip's and the other way round.
template <class C>
void exchange(C& c, unsigned filled, unsigned sent) {
    set_code(c, filled, owner_code::vpc3);
    set_code(c, sent, owner_code::user);
    c.s.diag_control = c.s.ram[dpram::physical(c, segment(c.s, filled), 0)] & (kExtDiag | kStatDiag | kOverflow);
    refresh(c);
    set_flag(c, true);
    irq::raise(c, regmap::interrupt::diag_buffer_changed);
}

/// New_Diag_Cmd: returns the number of the new user buffer, 0 while the exchange has to wait for a running answer.
template <class C>
std::uint8_t new_diag_cmd(C& c) {
    const unsigned filled = with_code(c.s, owner_code::user);
    if (filled == 0) return 0;
    if (with_code(c.s, owner_code::vpc3_send_mode) != 0) {
        set_code(c, filled, owner_code::vpc3);
        c.s.diag_pending = 1;
        return 0;
    }
    const unsigned sent = own(c.s);
    if (sent == 0) return 0;
    exchange(c, filled, sent);
    return static_cast<std::uint8_t>(sent);
}

constexpr std::uint8_t peek_new_diag_cmd(const State& s) {
    const bool now = with_code(s, owner_code::user) != 0 && with_code(s, owner_code::vpc3_send_mode) == 0;
    return static_cast<std::uint8_t>(now ? own(s) : 0u);
}

/// The answer begins: its buffer is locked.
template <class C>
void begin_sending(C& c) {
    if (const unsigned number = own(c.s); number != 0) set_code(c, number, owner_code::vpc3_send_mode);
}

/// The answer is over: unlock, and do an exchange that had to wait.
template <class C>
void end_sending(C& c) {
    const unsigned sent = with_code(c.s, owner_code::vpc3_send_mode);
    if (sent == 0) return;
    const unsigned filled = with_code(c.s, owner_code::vpc3);
    if (c.s.diag_pending != 0 && filled != 0) {
        c.s.diag_pending = 0;
        exchange(c, filled, sent);
        return;
    }
    set_code(c, sent, owner_code::vpc3);
}

}  // namespace dpchip::chip::diag
