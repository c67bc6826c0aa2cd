// SPDX-License-Identifier: Apache-2.0
// Finds the material that lies beside a checkout and is not part of it: GSD files of real stations, manuals.
//
// A clone without it passes its tests too, and says what they left out.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>

namespace dpchip::test {

/// `relative` below $DPCHIP_SHARED, or else below ../shared beside the checkout. When it is not there: nothing, and
/// a line on stdout that names what `left_out` is not tested.
inline std::optional<std::filesystem::path> shared_path(std::string_view relative, std::string_view left_out) {
    const char* told = std::getenv("DPCHIP_SHARED");
    const auto root = told != nullptr ? std::filesystem::path(told)
                                      : std::filesystem::path(DPCHIP_SOURCE_DIR) / ".." / "shared";
    std::error_code error;
    if (std::filesystem::exists(root / relative, error)) return root / relative;
    std::printf("left out, because there is no shared/%.*s: %.*s\n", static_cast<int>(relative.size()), relative.data(),
                static_cast<int>(left_out.size()), left_out.data());
    return std::nullopt;
}

}  // namespace dpchip::test
