// SPDX-License-Identifier: Apache-2.0
// DP_State and WD_State in words, as the manuals spell them (5.2).
#pragma once

#include <dpchip/chip/state.hpp>

namespace dpchip::chip {

constexpr const char* name(DpState state) {
    switch (state) {
    case DpState::wait_prm: return "WAIT-PRM";
    case DpState::wait_cfg: return "WAIT-CFG";
    case DpState::data_exch: return "DATA-EXCH";
    }
    return "?";
}

constexpr const char* name(WdState state) {
    switch (state) {
    case WdState::baud_search: return "BAUD_SEARCH";
    case WdState::baud_control: return "BAUD_CONTROL";
    case WdState::dp_control: return "DP_CONTROL";
    }
    return "?";
}

}  // namespace dpchip::chip
