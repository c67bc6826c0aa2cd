// SPDX-License-Identifier: Apache-2.0
// GSD text -> value. Total: any octets give a value and a list of what is wrong with them, in linear time.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <dpchip/gsd/diagnostic.hpp>
#include <dpchip/gsd/gsd.hpp>

namespace dpchip::gsd {

/// What was understood, and what was not. With errors the value holds all that could be read.
struct Parsed {
    Gsd gsd;
    std::vector<Diagnostic> diagnostics;  ///< by position; the list ends after 1000 of them

    bool ok() const;  ///< no errors; warnings are allowed
};

/// Reads GSD text, Latin-1 or UTF-8; `file` is the name for messages.
Parsed parse(std::string_view text, std::string file = "");

/// Reads a file. Throws GsdError only when it cannot be read or is larger than 16 MiB.
Parsed read(const std::string& path);

/// Reads a file and insists on it: throws GsdError with all errors.
Gsd load(const std::string& path);

}  // namespace dpchip::gsd
