// SPDX-License-Identifier: Apache-2.0
#include <dpchip/gsd/diagnostic.hpp>

namespace dpchip::gsd {
namespace {

std::string all(std::string_view file, const std::vector<Diagnostic>& diagnostics) {
    std::string text;
    for (const Diagnostic& d : diagnostics) {
        if (!text.empty()) text += '\n';
        text += to_string(d, file);
    }
    return text;
}

}  // namespace

std::string to_string(const Diagnostic& d, std::string_view file) {
    std::string text{file};
    if (d.at.line != 0) text += ":" + std::to_string(d.at.line) + ":" + std::to_string(d.at.column);
    text += d.severity == Severity::error ? ": error: " : ": warning: ";
    return text + d.message;
}

GsdError::GsdError(std::string_view file, std::vector<Diagnostic> diagnostics)
    : std::runtime_error{all(file, diagnostics)}, diagnostics_{std::move(diagnostics)} {}

}  // namespace dpchip::gsd
