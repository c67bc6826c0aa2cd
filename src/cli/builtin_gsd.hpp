// SPDX-License-Identifier: Apache-2.0
// The GSD file that the program carries with it, so that its demonstration needs no other file.
#pragma once

#include <string_view>

namespace dpchip::cli {

/// Stands wherever a GSD file may stand: the remote I/O station of examples/remote_io.gsd.
inline constexpr std::string_view kBuiltinRemoteIo = "builtin:remote_io";

/// The text behind a built-in name; empty when there is none of that name.
std::string_view builtin_gsd(std::string_view name);

}  // namespace dpchip::cli
