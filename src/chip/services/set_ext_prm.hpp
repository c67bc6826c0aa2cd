// SPDX-License-Identifier: Apache-2.0
// Set_Ext_Prm, SAP 53 (7.1; reference 3.5). The user parses the blocks; the chip only hands them over.
#pragma once

#include <dpchip/chip/dp_sm.hpp>
#include <dpchip/chip/mac.hpp>

namespace dpchip::chip::set_ext_prm {

template <class C>
bool activated(const C& c) {
    return c.traits->ext_prm && (c.s.mode0 & regmap::mode0::set_ext_prm_supported) != 0;
}

/// Between Set_Prm and Chk_Cfg only.
template <class C>
Answer serve(C& c) {
    if (!activated(c) || c.s.dp_state != DpState::wait_cfg || c.s.chk_cfg_seen != 0) return Answer::rs;
    const auto d = mac::data(c.s);
    if (d.size() > aux::limit(c, aux::Service::prm)) return Answer::rr;
    aux::receive(c, aux::Service::prm, d);
    if (!dp::is_owner(c.s, mac::master(c.s))) return Answer::sc;
    if (aux::waiting(c, aux::Service::prm) == AuxUser::cfg) return Answer::rr;
    aux::present_prm(c, AuxUser::ext_prm, d);
    return Answer::sc;
}

}  // namespace dpchip::chip::set_ext_prm
