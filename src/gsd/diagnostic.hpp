// SPDX-License-Identifier: Apache-2.0
// What a reader of GSD text has to say: errors and warnings with line and column, and the exception that carries them.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace dpchip::gsd {

/// A place in a text: line and column count from 1, columns in characters (a tab is one). 0, 0: the file as a whole.
struct Position {
    std::uint32_t line{};
    std::uint32_t column{};

    friend bool operator==(const Position&, const Position&) = default;
};

enum class Severity : std::uint8_t {
    warning,  ///< sloppy, but its meaning is clear
    error,    ///< the station cannot be set up as the text says
};

struct Diagnostic {
    Severity severity{};
    Position at{};
    std::string message;  ///< UTF-8, one line, no full stop
};

/// "file:line:column: error: message"; without position "file: error: message".
std::string to_string(const Diagnostic& diagnostic, std::string_view file);

/// Something that was asked for does not fit the GSD, or the GSD cannot be read. what() has all of it, a line each.
class GsdError : public std::runtime_error {
public:
    explicit GsdError(const std::string& message) : std::runtime_error{message} {}
    GsdError(std::string_view file, std::vector<Diagnostic> diagnostics);

    /// The errors of a text; empty when the exception is not about a text.
    const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

private:
    std::vector<Diagnostic> diagnostics_;
};

}  // namespace dpchip::gsd
