// SPDX-License-Identifier: Apache-2.0
// Small words for all renderings: hexadecimal numbers as the manuals print them, octet rows, lists.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace dpchip::trace {

/// "4711H": `digits` hexadecimal digits, at most 8.
std::string hex_number(std::uint32_t value, unsigned digits = 2);
/// "68 05 05"; beyond `limit` octets "... (244 octets)" follows.
std::string hex_row(std::span<const std::uint8_t> octets, std::size_t limit = 32);
/// Appends `word` to `list`, with `separator` in between when there is something already.
void add_word(std::string& list, std::string_view word, std::string_view separator = ", ");

}  // namespace dpchip::trace
