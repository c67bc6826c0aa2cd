// SPDX-License-Identifier: Apache-2.0
// The GSD parser's insides: statements, and what each keyword does. For parse.cpp and blocks.cpp only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <dpchip/gsd/gsd.hpp>
#include <dpchip/gsd/keywords.hpp>
#include <dpchip/gsd/parse.hpp>
#include <dpchip/gsd/text.hpp>

namespace dpchip::gsd {

inline constexpr std::size_t kMaxDiagnostics = 1000;
inline constexpr std::int64_t kMaxPrmOffset = 243;

/// Reads tokens one after another.
class Cursor {
public:
    explicit Cursor(std::span<const Token> tokens) : tokens_{tokens} {}

    bool end() const { return at_ == tokens_.size(); }
    const Token* peek() const { return end() ? nullptr : &tokens_[at_]; }
    void skip() {
        if (!end()) ++at_;
    }
    bool accept(char sign);
    /// A word that is a number, with sign; nothing is taken when there is none.
    std::optional<std::int64_t> number();
    const Token* string();
    /// Where the next token is; at the end, where the last one was.
    Position at() const;

private:
    std::span<const Token> tokens_;
    std::size_t at_{};
};

/// A line, taken apart: name [ (index [- index2]) ] [=] value.
struct Statement {
    std::string name;  ///< as written
    std::string key;   ///< lower case
    Position at{};
    std::optional<std::int64_t> index{}, index2{};
    bool assigns{};         ///< there was a '='
    std::string_view rest;  ///< text of the value, trimmed
    Cursor value;
};

class Parser {
public:
    explicit Parser(Parsed& out) : out_{out}, gsd_{out.gsd} {}
    void run(std::string_view utf8);

private:
    using Handler = void (Parser::*)(Statement&);
    static Handler handler(const std::string& key);

    // parse.cpp
    void line(const Line& line);
    Statement split(const Line& line);
    void statement(Statement& s);
    void scalar(Statement& s, const Target& target);
    void assign(Statement& s, std::string& target);
    void assign(Statement& s, bool& target);
    template <class T>
    void assign_number(Statement& s, T& target);
    void keep(Statement& s);
    void ident_number(Statement& s);
    void user_prm_data(Statement& s);
    void missing_keywords();
    void close_blocks(std::string_view because, Position at);
    std::optional<std::int64_t> number(Statement& s, const char* what, std::int64_t min, std::int64_t max);
    std::optional<std::string> text(Statement& s);
    std::vector<std::uint8_t> octets(Statement& s);
    std::vector<ValueRange> ranges(Statement& s);
    void done(Statement& s);
    void warn(Position at, std::string message);
    void error(Position at, std::string message);

    // blocks.cpp
    void prm_text(Statement& s);
    void prm_text_line(Statement& s);
    void end_prm_text(Statement& s);
    void ext_user_prm_data(Statement& s);
    void data_type(Statement& s);
    void prm_text_ref(Statement& s);
    void changeable(Statement& s);
    void visible(Statement& s);
    void end_ext_user_prm_data(Statement& s);
    void module(Statement& s);
    void module_reference(Statement& s);
    void module_prm_length(Statement& s);
    void preset(Statement& s);
    void info_text(Statement& s);
    void end_module(Statement& s);
    void prm_const(Statement& s);
    void prm_ref(Statement& s);
    void slot_definition(Statement& s);
    void slot(Statement& s);
    void end_slot_definition(Statement& s);
    void unit_diag_bit(Statement& s);
    void unit_diag_bit_help(Statement& s);
    void unit_diag_area(Statement& s);
    void area_value(Statement& s);
    void unit_diag_area_end(Statement& s);
    void unit_diag_type(Statement& s);
    void end_unit_diag_type(Statement& s);
    void channel_diag(Statement& s);
    DiagTexts& diag();
    UserPrm& user_prm(const Statement& s);

    Parsed& out_;
    Gsd& gsd_;
    bool profibus_dp_{};
    bool has_ident_{};
    // Open blocks: the last element of its list is being filled.
    bool in_prm_text_{}, in_parameter_{}, in_module_{}, in_slots_{}, in_area_{}, in_diag_type_{};
    bool has_type_{};  ///< the open parameter's type line has been seen
};

/// The token or text shortened for a message.
std::string quoted(std::string_view text);

}  // namespace dpchip::gsd
