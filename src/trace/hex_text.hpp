// SPDX-License-Identifier: Apache-2.0
// Octets as people paste them: `68 05 05 68`, `0x68,0x05`, `68050568`, lines of a log or a hex dump.
//
// A line may begin with things that are not octets: a time, a date, a label that ends in a colon, a bracketed remark,
// an arrow, a word. `#`, `;` and `//` begin a comment; two blanks and something that is not hex end a line (the text
// column of a dump). Everything else that is not an octet is an error with line and column.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace dpchip::trace {

/// A piece of text that is neither an octet nor something to ignore.
struct HexError {
    std::size_t line{}, column{};  ///< both count from 1
    std::string text;
};

struct HexText {
    std::vector<std::uint8_t> octets;
    std::vector<std::size_t> lines;  ///< line of each octet, from 1
    std::vector<HexError> errors;
};

/// Total: any text gives a result; octets around an error are kept.
HexText read_hex(std::string_view text);

}  // namespace dpchip::trace
