// SPDX-License-Identifier: Apache-2.0
// RD_Output, SAP 57 (6.2.8; reference 3.10): the user's output buffer for any master, in DATA-EXCH.
#pragma once

#include <dpchip/chip/context.hpp>

namespace dpchip::chip::rd_output {

template <class C>
Answer serve(C& c) { return c.s.dp_state == DpState::data_exch ? Answer::rd_output : Answer::rs; }

}  // namespace dpchip::chip::rd_output
