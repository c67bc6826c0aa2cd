// SPDX-License-Identifier: Apache-2.0
// A tolerant reader of hexadecimal text.
#include <algorithm>
#include <optional>

#include <dpchip/trace/hex_text.hpp>

namespace dpchip::trace {
namespace {

constexpr std::string_view kBlank = " \t\r\f\v,";

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

constexpr int nibble(char c) {
    if (is_digit(c)) return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

bool all_hex(std::string_view token) {
    return !token.empty() && std::all_of(token.begin(), token.end(), [](char c) { return nibble(c) >= 0; });
}

/// What may stand before the first octet of a line: a time, a date, a label, an arrow, a word, a bracketed remark.
bool is_preamble(std::string_view token) {
    if (token.back() == ':' || token.front() == '[' || token.back() == ']' || token.front() == '(' || token.back() == ')')
        return true;
    const bool digit = std::any_of(token.begin(), token.end(), is_digit);
    const bool letter = std::any_of(token.begin(), token.end(), is_letter);
    if (!digit) return true;  // an arrow or a word; a word of hex digits only has been taken as octets before
    if (letter && token.find('T') == std::string_view::npos && token.back() != 'Z' && token.back() != 's') return false;
    return token.find_first_of(".:-+") != std::string_view::npos;
}

/// One line; `number` is its number from 1.
class Line {
public:
    Line(std::string_view text, std::size_t number, HexText& into) : text_{text}, number_{number}, into_{into} {}

    void read() {
        for (;;) {
            const std::size_t from = text_.find_first_not_of(kBlank, at_);
            if (from == std::string_view::npos) return;
            const std::size_t blanks = from - at_;
            const std::size_t to = end_of_token(from);
            const std::string_view token = text_.substr(from, to - from);
            if (token[0] == '#' || token[0] == ';' || token.starts_with("//") || token[0] == '|') return;
            at_ = to;
            if (octets(token)) { begun_ = true; continue; }
            if (!begun_ && is_preamble(token)) continue;
            if (begun_ && blanks >= 2) return;
            into_.errors.push_back({number_, from + 1, std::string{token.substr(0, 40)}});
            begun_ = true;
        }
    }

private:
    /// A comma ends a token, but not in a time of day such as `12:34:56,789` at the head of a line.
    std::size_t end_of_token(std::size_t from) const {
        const std::size_t to = std::min(text_.find_first_of(kBlank, from), text_.size());
        const bool time = !begun_ && text_.substr(from, to - from).find(':') != std::string_view::npos && to + 1 < text_.size() &&
                          text_[to] == ',' && is_digit(text_[to + 1]);
        return time ? std::min(text_.find_first_of(" \t\r", to), text_.size()) : to;
    }

    bool octets(std::string_view token) {
        const bool colons = token.size() >= 5 && token.size() % 3 == 2 && token[2] == ':' && plausible_octets(token);
        if (colons) {
            for (std::size_t i = 0; i < token.size(); i += 3) add(token.substr(i, 2));
            return true;
        }
        bool prefixed = false;
        if (token.starts_with("0x") || token.starts_with("0X") || token.starts_with("\\x")) {
            token.remove_prefix(2);
            prefixed = true;
        } else if (token.size() == 3 && (token.back() == 'h' || token.back() == 'H')) {
            token.remove_suffix(1);
        }
        if (!all_hex(token)) return false;
        if (token.size() == 1 && prefixed) {
            add(token);
            return true;
        }
        if (token.size() % 2 != 0) return false;
        for (std::size_t i = 0; i < token.size(); i += 2) add(token.substr(i, 2));
        return true;
    }

    /// `10:02:63` is a time when other tokens follow it at the head of a line, otherwise octets with colons.
    bool plausible_octets(std::string_view token) const {
        for (std::size_t i = 0; i < token.size(); ++i)
            if (i % 3 == 2 ? token[i] != ':' : nibble(token[i]) < 0) return false;
        return begun_ || token.size() > 8 || text_.find_first_not_of(kBlank, at_) == std::string_view::npos;
    }

    void add(std::string_view digits) {
        int value = 0;
        for (const char c : digits) value = value * 16 + nibble(c);
        into_.octets.push_back(static_cast<std::uint8_t>(value));
        into_.lines.push_back(number_);
    }

    std::string_view text_;
    std::size_t number_;
    HexText& into_;
    std::size_t at_{};
    bool begun_{};
};

}  // namespace

HexText read_hex(std::string_view text) {
    HexText result;
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        Line{text.substr(0, end), line, result}.read();
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return result;
}

}  // namespace dpchip::trace
