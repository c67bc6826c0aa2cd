// SPDX-License-Identifier: Apache-2.0
// The GSD files that the program carries with it, so that first steps need no other file.
#pragma once

#include <string_view>

namespace dpchip::cli {

/// They stand wherever a GSD file may stand: the stations of examples/remote_io.gsd (DP-V0) and examples/dpv1_io.gsd
/// (DP-V1: records, connections, alarms, I&M).
inline constexpr std::string_view kBuiltinRemoteIo = "builtin:remote_io";
inline constexpr std::string_view kBuiltinDpv1Io = "builtin:dpv1_io";

/// The text behind a built-in name; empty when there is none of that name.
std::string_view builtin_gsd(std::string_view name);

}  // namespace dpchip::cli
