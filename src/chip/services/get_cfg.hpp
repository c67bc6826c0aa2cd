// SPDX-License-Identifier: Apache-2.0
// Get_Cfg, SAP 59 (6.2.9; reference 3.10): the Read_Cfg-Buffer for any master, in every state.
#pragma once

#include <dpchip/chip/context.hpp>

namespace dpchip::chip::get_cfg {

template <class C>
Answer serve(C&) { return Answer::get_cfg; }

}  // namespace dpchip::chip::get_cfg
