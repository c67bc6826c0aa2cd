// SPDX-License-Identifier: Apache-2.0
// Counts what the whole test program takes from the heap.
#pragma once

#include <cstddef>

namespace dpchip::slave::testing {

/// Calls of operator new since the program began.
std::size_t allocations();

}  // namespace dpchip::slave::testing
