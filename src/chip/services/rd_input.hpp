// SPDX-License-Identifier: Apache-2.0
// RD_Input, SAP 56 (6.2.7; reference 3.10): the inputs for any master, in DATA-EXCH.
#pragma once

#include <dpchip/chip/context.hpp>

namespace dpchip::chip::rd_input {

template <class C>
Answer serve(C& c) { return c.s.dp_state == DpState::data_exch ? Answer::rd_input : Answer::rs; }

}  // namespace dpchip::chip::rd_input
