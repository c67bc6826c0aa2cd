// SPDX-License-Identifier: Apache-2.0
// The GSD keywords: those that are one value of a Gsd member, and those of the standard that are only kept.
// Used by the parser.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include <dpchip/gsd/gsd.hpp>

namespace dpchip::gsd {

/// Where the value of a keyword goes.
using Target = std::variant<bool*, std::uint16_t*, std::uint32_t*, std::optional<std::uint16_t>*,
                            std::optional<std::uint32_t>*, std::string*>;

/// The member that keyword `key` (lower case) sets, if it sets exactly one.
std::optional<Target> scalar_target(Gsd& gsd, std::string_view key);

/// True for keywords of the GSD standard without a member in Gsd (lower case).
bool is_standard_keyword(std::string_view key);

}  // namespace dpchip::gsd
