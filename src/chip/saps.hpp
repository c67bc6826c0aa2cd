// SPDX-License-Identifier: Apache-2.0
// Which service a request wants: the SAPs that the chip sets up by itself, and those of the SAP list (6.1, 7.2.1;
// reference 3.1, 3.2, 5.2).
#pragma once

#include <dpchip/chip/sap_list.hpp>
#include <dpchip/chip/services/chk_cfg.hpp>
#include <dpchip/chip/services/data_exchange.hpp>
#include <dpchip/chip/services/get_cfg.hpp>
#include <dpchip/chip/services/global_control.hpp>
#include <dpchip/chip/services/rd_input.hpp>
#include <dpchip/chip/services/rd_output.hpp>
#include <dpchip/chip/services/set_ext_prm.hpp>
#include <dpchip/chip/services/set_prm.hpp>
#include <dpchip/chip/services/set_slave_add.hpp>
#include <dpchip/chip/services/slave_diag.hpp>

namespace dpchip::chip::saps {

/// SRD to one of the chip's own SAPs.
template <class C>
Answer serve_srd(C& c, std::uint8_t dsap) {
    switch (dsap) {
    case 53: return set_ext_prm::serve(c);
    case 55: return set_slave_add::serve(c);
    case 56: return rd_input::serve(c);
    case 57: return rd_output::serve(c);
    case 59: return get_cfg::serve(c);
    case 60: return slave_diag::serve(c);
    case 61: return set_prm::serve(c);
    case 62: return chk_cfg::serve(c);
    default: return Answer::rs;
    }
}

template <class C>
bool dp_mode(const C& c) { return (c.s.mode0 & regmap::mode0::dp_mode) != 0; }

constexpr bool listed(const State& s) { return mac::has_dsap(s) && mac::dsap(s) <= sap_list::kHighestSap; }

/// Requests that want an answer with data: by SAP, or Data_Exchange on the default SAP.
template <class C>
Answer serve_request(C& c) {
    const bool multicast = mac::function_code(c.s).request() == fdl::Request::msrd;
    if (!multicast && listed(c.s)) return sap_list::serve(c, mac::dsap(c.s));
    if (!dp_mode(c)) return multicast ? Answer::none : Answer::rs;
    if (!mac::has_dsap(c.s)) return data_exchange::serve(c);
    return multicast ? Answer::none : serve_srd(c, mac::dsap(c.s));
}

/// A repeated request gets the answer it had, as far as the state still allows it (reference 2.5).
template <class C>
Answer repeat(const C& c) {
    if (c.s.last_answer == Answer::none || data_exchange::refused_multicast(c)) return Answer::none;
    const bool default_sap = !mac::has_dsap(c.s);
    const std::uint8_t dsap = default_sap ? std::uint8_t{0} : mac::dsap(c.s);
    const bool wants_data_exch = default_sap || dsap == 56 || dsap == 57;
    if (wants_data_exch && c.s.dp_state != DpState::data_exch) return Answer::rs;
    if (default_sap && !dp::is_owner(c.s, mac::master(c.s))) return Answer::rs;
    return c.s.last_answer == Answer::response ? Answer::kept : c.s.last_answer;
}

/// Without answer: Global_Control, and indications on the SAP list.
template <class C>
void serve_sdn(C& c) {
    if (listed(c.s) && c.s.request_length != 0) static_cast<void>(sap_list::serve(c, mac::dsap(c.s)));
    else if (dp_mode(c) && mac::has_dsap(c.s) && mac::dsap(c.s) == 58) global_control::serve(c);
}

/// Acknowledged without data: only the SAP list knows such services.
template <class C>
Answer serve_sda(C& c) {
    if (!listed(c.s)) return Answer::rs;
    return c.s.retry != 0 ? repeat(c) : sap_list::serve(c, mac::dsap(c.s));
}

template <class C>
Answer serve_ident(const C& c) {
    return c.options.ident_lsap_answer == regmap::IdentLsapAnswer::rs ? Answer::rs : Answer::none;
}

/// Does what the request asks for and decides the answer.
template <class C>
Answer serve(C& c) {
    const auto request = mac::function_code(c.s).request();
    switch (request) {
    case fdl::Request::fdl_status: return Answer::fdl_status;
    case fdl::Request::ident:
    case fdl::Request::lsap_status: return serve_ident(c);
    case fdl::Request::sdn_low:
    case fdl::Request::sdn_high:
        serve_sdn(c);
        return Answer::none;
    case fdl::Request::sda_low:
    case fdl::Request::sda_high: return serve_sda(c);
    case fdl::Request::srd_low:
    case fdl::Request::srd_high:
    case fdl::Request::msrd: break;
    case fdl::Request::time_event:
        if ((c.s.request_da & 0x7F) == fdl::kBroadcast) clock_sync::receive(c);
        return Answer::none;
    }
    return c.s.retry != 0 ? repeat(c) : serve_request(c);
}

}  // namespace dpchip::chip::saps
