// SPDX-License-Identifier: Apache-2.0
// Chk_Cfg, SAP 62 (6.2.3; reference 3.6). The user judges the configuration.
#pragma once

#include <dpchip/chip/dp_sm.hpp>
#include <dpchip/chip/mac.hpp>

namespace dpchip::chip::chk_cfg {

template <class C>
Answer serve(C& c) {
    const auto d = mac::data(c.s);
    if (d.size() > aux::limit(c, aux::Service::cfg)) return Answer::rr;
    aux::receive(c, aux::Service::cfg, d);
    if (c.s.dp_state == DpState::wait_prm || !dp::is_owner(c.s, mac::master(c.s))) return Answer::sc;
    const AuxUser occupant = aux::waiting(c, aux::Service::cfg);
    if (occupant == AuxUser::prm || occupant == AuxUser::ext_prm) return Answer::rr;
    if (d.empty()) {
        dp::leave_with_fault(c, regmap::LeaveCause::empty_chk_cfg, &State::cfg_fault);
        return Answer::sc;
    }
    c.s.chk_cfg_seen = 1;
    aux::present_cfg(c, d);
    return Answer::sc;
}

}  // namespace dpchip::chip::chk_cfg
