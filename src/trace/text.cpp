// SPDX-License-Identifier: Apache-2.0
// Numbers and lists as text.
#include <algorithm>

#include <dpchip/trace/text.hpp>

namespace dpchip::trace {
namespace {

constexpr char kDigits[] = "0123456789ABCDEF";

}  // namespace

std::string hex_number(std::uint32_t value, unsigned digits) {
    std::string text;
    for (unsigned i = std::min(digits, 8u); i-- > 0;) text += kDigits[(value >> (4 * i)) & 0xFu];
    return text + 'H';
}

std::string hex_row(std::span<const std::uint8_t> octets, std::size_t limit) {
    std::string text;
    for (const std::uint8_t octet : octets.first(std::min(limit, octets.size()))) {
        if (!text.empty()) text += ' ';
        text += kDigits[octet >> 4];
        text += kDigits[octet & 0xFu];
    }
    if (octets.size() > limit) text += "... (" + std::to_string(octets.size()) + " octets)";
    return text;
}

void add_word(std::string& list, std::string_view word, std::string_view separator) {
    if (word.empty()) return;
    if (!list.empty()) list += separator;
    list += word;
}

}  // namespace dpchip::trace
