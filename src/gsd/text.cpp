// SPDX-License-Identifier: Apache-2.0
#include <dpchip/gsd/text.hpp>

#include <algorithm>

namespace dpchip::gsd {
namespace {

bool blank(char c) { return static_cast<unsigned char>(c) <= ' '; }
bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u; }

/// Octets of the UTF-8 character that begins with `c`; 0 when none does.
std::size_t utf8_length(unsigned char c) {
    if (c < 0x80) return 1;
    if (c >= 0xC2 && c < 0xE0) return 2;
    if (c >= 0xE0 && c < 0xF0) return 3;
    return c >= 0xF0 && c < 0xF5 ? 4 : 0;
}

/// True for UTF-8 that holds more than ASCII.
bool is_utf8_beyond_ascii(std::string_view s) {
    bool beyond = false;
    for (std::size_t i = 0; i < s.size();) {
        const std::size_t n = utf8_length(static_cast<unsigned char>(s[i]));
        if (n == 0 || n > s.size() - i) return false;
        for (std::size_t k = 1; k < n; ++k)
            if (!continues_character(s[i + k])) return false;
        beyond = beyond || n > 1;
        i += n;
    }
    return beyond;
}

/// The part of a physical line in front of its comment. `in_string`: the line begins inside a string.
std::string_view without_comment(std::string_view line, bool in_string) {
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"') in_string = !in_string;
        if (line[i] == ';' && !in_string) return line.substr(0, i);
    }
    return line;
}

std::string_view trim_end(std::string_view s) {
    while (!s.empty() && blank(s.back())) s.remove_suffix(1);
    return s;
}

}  // namespace

std::string to_utf8(std::string_view octets) {
    if (octets.starts_with("\xEF\xBB\xBF")) octets.remove_prefix(3);
    if (is_utf8_beyond_ascii(octets)) return std::string{octets};
    std::string out;
    out.reserve(octets.size());
    for (const char c : octets) {
        const auto u = static_cast<unsigned char>(c);
        if (u < 0x80) {
            out.push_back(c);
        } else {
            out.push_back(static_cast<char>(0xC0u | (u >> 6)));
            out.push_back(static_cast<char>(0x80u | (u & 0x3Fu)));
        }
    }
    return out;
}

std::string_view trim(std::string_view text) {
    text = trim_end(text);
    while (!text.empty() && blank(text.front())) text.remove_prefix(1);
    return text;
}

std::string lower(std::string_view text) {
    std::string out{text};
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return out;
}

std::string folded(std::string_view text) {
    std::string out;
    for (const char c : lower(trim(text))) {
        if (!blank(c)) out.push_back(c);
        else if (out.back() != ' ') out.push_back(' ');
    }
    return out;
}

std::optional<std::int64_t> to_number(std::string_view text) {
    const bool negative = text.starts_with('-');
    if (negative || text.starts_with('+')) text.remove_prefix(1);
    int base = 10;
    if (text.starts_with("0x") || text.starts_with("0X")) {
        base = 16;
        text.remove_prefix(2);
    } else if (text.ends_with('h') || text.ends_with('H')) {
        base = 16;
        text.remove_suffix(1);
    }
    if (text.empty()) return std::nullopt;
    std::int64_t value = 0;
    for (const char c : text) {
        int digit = 99;
        if (c >= '0' && c <= '9') digit = c - '0';
        else if (c >= 'a' && c <= 'f') digit = c - 'a' + 10;
        else if (c >= 'A' && c <= 'F') digit = c - 'A' + 10;
        if (digit >= base) return std::nullopt;
        value = value * base + digit;
        if (value >= (std::int64_t{1} << 48)) return std::nullopt;
    }
    return negative ? -value : value;
}

std::string_view LineReader::physical_line() {
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end);
    if (rest_.starts_with("\r\n")) rest_.remove_prefix(2);
    else if (!rest_.empty()) rest_.remove_prefix(1);
    ++number_;
    return line;
}

void LineReader::end_string(Line& line) {
    in_string_ = false;
    line.text.push_back('"');
}

void LineReader::scan_string(char c, Line& line) {
    if (c == '"') return end_string(line);
    const char shown = blank(c) ? ' ' : c;
    line.tokens.back().text.push_back(shown);
    line.text.push_back(shown);
}

void LineReader::scan(std::string_view content, Line& line) {
    std::uint32_t column = 0;
    in_word_ = false;
    bool layout = true;  // blanks in front of a continued line
    for (const char c : content) {
        if (!continues_character(c)) ++column;
        if (layout && blank(c)) continue;
        layout = false;
        if (in_string_) {
            scan_string(c, line);
            continue;
        }
        const Position at{number_, column};
        const std::size_t begin = line.text.size();
        line.text.push_back(blank(c) ? ' ' : c);
        if (blank(c)) {
            in_word_ = false;
        } else if (c == '"') {
            line.tokens.push_back({Token::Kind::string, "", at, begin});
            in_string_ = true;
            in_word_ = false;
        } else if (std::string_view{"=,()-"}.find(c) != std::string_view::npos) {
            line.tokens.push_back({Token::Kind::sign, std::string(1, c), at, begin});
            in_word_ = false;
        } else if (in_word_) {
            line.tokens.back().text.push_back(c);
        } else {
            line.tokens.push_back({Token::Kind::word, std::string(1, c), at, begin});
            in_word_ = true;
        }
    }
}

bool LineReader::next(Line& line) {
    line.text.clear();
    line.tokens.clear();
    in_string_ = false;
    while (!rest_.empty()) {
        std::string_view content = trim_end(without_comment(physical_line(), in_string_));
        const bool continued = content.ends_with('\\');
        if (continued) content.remove_suffix(1);
        scan(content, line);
        if (continued && !rest_.empty()) {
            if (!in_string_) line.text.push_back(' ');
            continue;
        }
        if (in_string_) {
            diagnostics_.push_back({Severity::error, line.tokens.back().at, "string without closing quote"});
            end_string(line);
        }
        if (!line.tokens.empty()) return true;
        line.text.clear();
    }
    return false;
}

}  // namespace dpchip::gsd
