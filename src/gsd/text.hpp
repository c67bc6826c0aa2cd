// SPDX-License-Identifier: Apache-2.0
// GSD text -> logical lines of tokens: character set, comments, continuation, strings, positions. Used by the parser.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <dpchip/gsd/diagnostic.hpp>

namespace dpchip::gsd {

/// UTF-8 of a GSD's octets: as they are when they are UTF-8 with at least one character beyond ASCII, else taken for
/// Latin-1. A byte order mark is removed.
std::string to_utf8(std::string_view octets);

/// Blanks at both ends removed.
std::string_view trim(std::string_view text);
/// ASCII lower case.
std::string lower(std::string_view text);
/// For comparing names: lower case, runs of blanks are one blank, none at the ends.
std::string folded(std::string_view text);
/// A number as GSD files write it: decimal (leading zeros allowed), 0x.., ..h; with sign. Nothing when it is none,
/// or has more than 48 bits.
std::optional<std::int64_t> to_number(std::string_view text);

struct Token {
    enum class Kind : std::uint8_t {
        word,    ///< anything else up to a blank or a sign
        string,  ///< text between quotes
        sign,    ///< one of = , ( ) -
    };
    Kind kind{};
    std::string text;  ///< without quotes
    Position at{};
    std::size_t begin{};  ///< where it begins in Line::text

    bool is(char sign) const { return kind == Kind::sign && text[0] == sign; }
};

/// A logical line: continuation lines joined, comment removed. Never empty.
struct Line {
    std::string text;
    std::vector<Token> tokens;
};

/// Splits text into logical lines. Keeps a view of the text.
class LineReader {
public:
    LineReader(std::string_view utf8, std::vector<Diagnostic>& diagnostics) : rest_{utf8}, diagnostics_{diagnostics} {}

    /// The next line that has tokens; false at the end.
    bool next(Line& line);

private:
    std::string_view physical_line();
    void scan(std::string_view content, Line& line);
    void scan_string(char c, Line& line);
    void end_string(Line& line);

    std::string_view rest_;
    std::vector<Diagnostic>& diagnostics_;
    std::uint32_t number_{};
    bool in_string_{};
    bool in_word_{};
};

}  // namespace dpchip::gsd
