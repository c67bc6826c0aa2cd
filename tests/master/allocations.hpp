// SPDX-License-Identifier: Apache-2.0
// How often this program has allocated memory: the cycle must not.
#pragma once

#include <cstdint>

namespace dpchip::test {

/// Calls of operator new so far.
std::uint64_t allocations();

}  // namespace dpchip::test
