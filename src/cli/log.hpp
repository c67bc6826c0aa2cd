// SPDX-License-Identifier: Apache-2.0
// The log on stderr, and what is known of the terminal.
#pragma once

#include <spdlog/spdlog.h>

namespace dpchip::cli {

/// Log to stderr: coloured on a terminal unless NO_COLOR is set. `verbose` shows debug messages, `quiet` errors only.
enum class Loudness { quiet, normal, verbose };
void start_log(Loudness loudness);
/// True when `fd` is a terminal.
bool is_terminal(int fd);
/// True when `fd` may be written to in colours: a terminal that is not dumb, and no NO_COLOR.
bool may_colour(int fd);

}  // namespace dpchip::cli
