// SPDX-License-Identifier: Apache-2.0
// A table on a terminal that is drawn again in place.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace dpchip::cli {

/// Rows of text; the first is the head.
using Rows = std::vector<std::vector<std::string>>;

/// Columns aligned, two blanks between them, a line each.
std::vector<std::string> align(const Rows& rows);
/// Prints the table on stdout.
void print(const Rows& rows);

/// Draws on stdout; does nothing when that is no terminal.
class LiveView {
public:
    LiveView();
    bool active() const { return active_; }
    /// Replaces what was drawn before, cut to the terminal's size.
    void draw(const Rows& rows);
    /// Removes what was drawn.
    void clear();

private:
    bool active_, colour_;
    std::size_t drawn_ = 0;
};

}  // namespace dpchip::cli
