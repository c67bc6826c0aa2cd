// SPDX-License-Identifier: Apache-2.0
// A finding of the package as a line of text: rule, pin, and for timing number, time found and limit (10.7).
#pragma once

#include <cstdint>
#include <string>

#include <dpchip/core/ticks.hpp>

namespace dpchip::trace {

/// `rule` and `detail` as in a core::Finding that layer pins made.
std::string pin_finding_text(std::uint16_t rule, std::uint32_t detail);

/// Nanoseconds with as many decimals as it takes, at most three (rounded towards zero): "136.7", "-0.016".
std::string nanoseconds_text(core::Ticks t);

}  // namespace dpchip::trace
