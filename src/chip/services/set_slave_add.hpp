// SPDX-License-Identifier: Apache-2.0
// Set_Slave_Add, SAP 55 (6.2.1; reference 3.3).
#pragma once

#include <dpchip/chip/dp_sm.hpp>
#include <dpchip/chip/mac.hpp>

namespace dpchip::chip::set_slave_add {

inline constexpr std::uint8_t kHighestAddress = 125, kTrue = 0xFF, kNone = 0xFF;
inline constexpr std::size_t kShortest = 4;

template <class C>
bool acceptable(const C& c, std::span<const std::uint8_t> d) {
    return d.size() >= kShortest && d[0] <= kHighestAddress && d[1] == dpram::cell(c.s, regmap::org::r_ident_high) &&
           d[2] == dpram::cell(c.s, regmap::org::r_ident_low) &&
           dpram::cell(c.s, regmap::org::r_real_no_add_change) == 0;
}

/// Errors are answered positively and change nothing; the new address is valid once the answer has been sent.
template <class C>
Answer serve(C& c) {
    const auto d = mac::data(c.s);
    if (dpram::pointer(c.s, regmap::org::r_ssa_buf_ptr) == 0) return Answer::rs;
    if (d.size() > aux::limit(c, aux::Service::ssa)) return Answer::rr;
    const bool wait_prm = c.s.dp_state == DpState::wait_prm;
    if (wait_prm && c.s.ssa_busy != 0) return Answer::rr;
    aux::receive(c, aux::Service::ssa, d);
    if (!wait_prm) return Answer::sc;
    if (!acceptable(c, d)) return Answer::sc;
    const std::uint8_t address = d[0], no_add_chg = d[3];
    aux::exchange(c, aux::Service::ssa, static_cast<std::uint8_t>(d.size()));
    dpram::set_cell(c.s, regmap::org::r_real_no_add_change, no_add_chg != 0 ? kTrue : std::uint8_t{0});
    c.s.ssa_busy = 1;
    c.s.next_ts = address;
    irq::raise(c, regmap::interrupt::new_ssa_data);
    return Answer::sc;
}

/// The answer has been sent with the old address.
template <class C>
void address_becomes_valid(C& c) {
    if (c.s.next_ts == kNone) return;
    dpram::set_cell(c.s, regmap::org::r_ts_adr, c.s.next_ts);
    change(c, Fact::station_address, c.s.ts, c.s.next_ts);
    c.s.next_ts = kNone;
}

}  // namespace dpchip::chip::set_slave_add
