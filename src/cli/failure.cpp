// SPDX-License-Identifier: Apache-2.0
// Places and refusals in words.
#include <dpchip/cli/failure.hpp>

namespace dpchip::cli {

std::string to_string(const Place& at) {
    if (at.file.empty()) return {};
    if (at.line == 0) return at.file;
    return at.file + ':' + std::to_string(at.line) + ':' + std::to_string(at.column);
}

void refuse(const Place& at, const std::string& message) {
    if (at.file.empty()) throw Failure{ExitCode::usage, message};
    throw Failure{ExitCode::input, to_string(at) + ": error: " + message};
}

}  // namespace dpchip::cli
