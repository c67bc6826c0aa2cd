// SPDX-License-Identifier: Apache-2.0
// Whole files as text.
#pragma once

#include <string>

namespace dpchip::cli {

/// The octets of a file, or of stdin for "-". Throws Failure{input} when it cannot be read.
std::string read_all(const std::string& path);

}  // namespace dpchip::cli
