// SPDX-License-Identifier: Apache-2.0
// What a GSD says, held against itself: references, ranges, limits, configuration octets. Used by the parser.
#pragma once

#include <vector>

#include <dpchip/gsd/gsd.hpp>

namespace dpchip::gsd {

/// Fills in what follows from the text (lengths of modules) and appends what is wrong.
void check(Gsd& gsd, std::vector<Diagnostic>& diagnostics);

}  // namespace dpchip::gsd
