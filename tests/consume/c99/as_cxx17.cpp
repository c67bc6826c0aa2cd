// SPDX-License-Identifier: Apache-2.0
// dpchip.h and dpchip_pins.h in a C++17 translation unit, as the SystemC wrapper of a firmware project includes it.

#include <dpchip/dpchip.h>
#include <dpchip/dpchip_pins.h>

extern "C" int header_is_cxx17() { return dpchip_last_error() != nullptr ? 1 : 0; }
