// SPDX-License-Identifier: Apache-2.0
// Telegrams for the tests of trace/, written as in the reference.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <dpchip/trace/hex_text.hpp>

namespace dpchip::trace {

inline std::vector<std::uint8_t> octets(std::string_view hex) { return read_hex(hex).octets; }

}  // namespace dpchip::trace
