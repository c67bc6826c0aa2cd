// SPDX-License-Identifier: Apache-2.0
// What can go wrong with a live line: a kind for programs, words for people.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace dpchip::live {

enum class LineErrorKind : std::uint8_t {
    malformed,    ///< the URI is not one
    missing,      ///< no such device, host or service
    permission,   ///< not allowed to open it
    busy,         ///< somebody else uses it
    unsuitable,   ///< it is no terminal, or refuses even parity
    baud,         ///< it does not do the wanted rate within 2 %
    gone,         ///< it was there and is no more
    system,       ///< anything else the operating system says
};
const char* name(LineErrorKind kind);

class LineError : public std::runtime_error {
public:
    LineError(LineErrorKind kind, const std::string& what) : std::runtime_error{what}, kind_{kind} {}
    [[nodiscard]] LineErrorKind kind() const { return kind_; }

private:
    LineErrorKind kind_;
};

/// Throws a LineError for errno `code`: "what: words of the system".
[[noreturn]] void throw_system(const std::string& what, int code);

}  // namespace dpchip::live
