// SPDX-License-Identifier: Apache-2.0
// Choosing signals by name: * stands for any characters, ? for one, everything else for itself.
#pragma once

#include <cstddef>
#include <string_view>

namespace dpchip::waves {

/// Whether the whole of `text` is what `pattern` says. Never more than their lengths multiplied.
constexpr bool fits(std::string_view pattern, std::string_view text) {
    std::size_t p = 0, t = 0, star = std::string_view::npos, tried = 0;
    while (t < text.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            star = p++;
            tried = t;
        } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
            ++p;
            ++t;
        } else if (star != std::string_view::npos) {
            p = star + 1;
            t = ++tried;
        } else {
            return false;
        }
    }
    while (p < pattern.size() && pattern[p] == '*') ++p;
    return p == pattern.size();
}

}  // namespace dpchip::waves
