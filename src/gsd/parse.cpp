// SPDX-License-Identifier: Apache-2.0
#include <dpchip/gsd/parse.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <limits>
#include <unordered_map>

#include <dpchip/gsd/check.hpp>
#include <dpchip/gsd/parser.hpp>

namespace dpchip::gsd {

// ---- cursor -------------------------------------------------------------------------------------------------------

bool Cursor::accept(char sign) {
    if (end() || !tokens_[at_].is(sign)) return false;
    ++at_;
    return true;
}

std::optional<std::int64_t> Cursor::number() {
    if (end()) return std::nullopt;
    const bool negative = tokens_[at_].is('-');
    const std::size_t word = at_ + (negative ? 1 : 0);
    if (word >= tokens_.size() || tokens_[word].kind != Token::Kind::word) return std::nullopt;
    const auto value = to_number(tokens_[word].text);
    if (!value) return std::nullopt;
    at_ = word + 1;
    return negative ? -*value : *value;
}

const Token* Cursor::string() {
    if (end() || tokens_[at_].kind != Token::Kind::string) return nullptr;
    return &tokens_[at_++];
}

Position Cursor::at() const {
    if (tokens_.empty()) return {};
    return tokens_[std::min(at_, tokens_.size() - 1)].at;
}

// ---- helpers ------------------------------------------------------------------------------------------------------

std::string quoted(std::string_view text) {
    constexpr std::size_t limit = 48;
    if (text.size() <= limit) return "'" + std::string{text} + "'";
    std::size_t end = limit;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0u) == 0x80u) --end;
    return "'" + std::string{text.substr(0, end)} + "...'";
}

void Parser::warn(Position at, std::string message) {
    out_.diagnostics.push_back({Severity::warning, at, std::move(message)});
}
void Parser::error(Position at, std::string message) {
    out_.diagnostics.push_back({Severity::error, at, std::move(message)});
}

std::optional<std::int64_t> Parser::number(Statement& s, const char* what, std::int64_t min, std::int64_t max) {
    const Position at = s.value.end() ? s.at : s.value.at();
    auto n = s.value.number();
    if (!n) {
        const Token* t = s.value.peek();
        if (t != nullptr && t->kind == Token::Kind::string) n = to_number(trim(t->text));
        if (!n) {
            error(at, std::string{what} + ": number expected" + (t != nullptr ? ", not " + quoted(t->text) : ""));
            while (!s.value.end()) s.value.skip();
            return std::nullopt;
        }
        warn(at, std::string{what} + ": number in quotes");
        s.value.skip();
    }
    if (*n >= min && *n <= max) return n;
    error(at, std::string{what} + ": " + std::to_string(*n) + " is not in " + std::to_string(min) + ".." +
                  std::to_string(max));
    return std::nullopt;
}

std::optional<std::string> Parser::text(Statement& s) {
    if (const Token* t = s.value.string()) return std::string{trim(t->text)};
    if (s.rest.empty()) {
        error(s.at, s.name + ": text expected");
        return std::nullopt;
    }
    warn(s.value.at(), s.name + ": text without quotes");
    while (!s.value.end()) s.value.skip();
    return std::string{s.rest};
}

std::vector<std::uint8_t> Parser::octets(Statement& s) {
    std::vector<std::uint8_t> out;
    while (!s.value.end()) {
        const auto n = number(s, s.name.c_str(), 0, 255);
        if (!n) {
            while (!s.value.end()) s.value.skip();
            return out;
        }
        out.push_back(static_cast<std::uint8_t>(*n));
        const Position at = s.value.at();
        if (s.value.accept(',')) {
            if (s.value.end()) warn(at, s.name + ": comma at the end");
        } else if (!s.value.end()) {
            warn(at, s.name + ": comma missing between octets");
        }
    }
    return out;
}

std::vector<ValueRange> Parser::ranges(Statement& s) {
    constexpr auto limit = std::numeric_limits<std::uint32_t>::max();
    std::vector<ValueRange> out;
    while (!s.value.end()) {
        const auto min = number(s, s.name.c_str(), -std::int64_t{limit}, limit);
        if (!min) break;
        auto max = min;
        if (s.value.accept('-')) max = number(s, s.name.c_str(), -std::int64_t{limit}, limit);
        if (!max) break;
        if (*max < *min) warn(s.at, s.name + ": empty range " + std::to_string(*min) + "-" + std::to_string(*max));
        out.push_back({*min, *max});
        if (!s.value.accept(',')) break;
    }
    return out;
}

void Parser::done(Statement& s) {
    if (const Token* t = s.value.peek()) warn(t->at, s.name + ": " + quoted(t->text) + " and what follows is ignored");
}

// ---- one value ----------------------------------------------------------------------------------------------------

template <class T>
void Parser::assign_number(Statement& s, T& target) {
    if (const auto n = number(s, s.name.c_str(), 0, std::numeric_limits<T>::max())) target = static_cast<T>(*n);
}

void Parser::assign(Statement& s, bool& target) {
    const Position at = s.value.end() ? s.at : s.value.at();
    const auto n = number(s, s.name.c_str(), 0, std::numeric_limits<std::uint32_t>::max());
    if (!n) return;
    if (*n > 1) warn(at, s.name + ": " + std::to_string(*n) + " is taken for 1");
    target = *n != 0;
}

void Parser::assign(Statement& s, std::string& target) {
    const bool family = s.key == "slave_family";  // not in quotes: number and sub-fields, separated by '@'
    if (family) {
        target = std::string{s.rest};
        while (!s.value.end()) s.value.skip();
    } else if (const auto t = text(s)) {
        target = *t;
    }
}

void Parser::scalar(Statement& s, const Target& target) {
    struct Visitor {
        Parser& p;
        Statement& s;
        void operator()(bool* t) const { p.assign(s, *t); }
        void operator()(std::uint16_t* t) const { p.assign_number(s, *t); }
        void operator()(std::uint32_t* t) const { p.assign_number(s, *t); }
        void operator()(std::optional<std::uint16_t>* t) const { p.assign_number(s, t->emplace()); }
        void operator()(std::optional<std::uint32_t>* t) const { p.assign_number(s, t->emplace()); }
        void operator()(std::string* t) const { p.assign(s, *t); }
    };
    if (!s.assigns) warn(s.at, s.name + ": '=' is missing");
    std::visit(Visitor{*this, s}, target);
    done(s);
}

void Parser::ident_number(Statement& s) {
    assign_number(s, gsd_.ident_number);
    has_ident_ = true;
    done(s);
}

void Parser::user_prm_data(Statement& s) { gsd_.user_prm_data = octets(s); }

void Parser::keep(Statement& s) {
    std::optional<std::size_t> in;
    if (in_module_) in = gsd_.modules.size() - 1;
    std::string name = s.name;
    if (s.index) { name += "(" + std::to_string(*s.index) + (s.index2 ? "-" + std::to_string(*s.index2) : "") + ")"; }
    gsd_.keywords.push_back({std::move(name), std::string{s.rest}, is_standard_keyword(s.key), in, s.at});
}

// ---- lines --------------------------------------------------------------------------------------------------------

Parser::Handler Parser::handler(const std::string& key) {
    using P = Parser;
    // clang-format off
    static const std::unordered_map<std::string, Handler> handlers{
        {"ident_number", &P::ident_number}, {"user_prm_data", &P::user_prm_data}, {"info_text", &P::info_text},
        {"prmtext", &P::prm_text}, {"text", &P::prm_text_line}, {"endprmtext", &P::end_prm_text},
        {"extuserprmdata", &P::ext_user_prm_data}, {"prm_text_ref", &P::prm_text_ref}, {"changeable", &P::changeable},
        {"visible", &P::visible}, {"endextuserprmdata", &P::end_ext_user_prm_data},
        {"bit", &P::data_type}, {"bitarea", &P::data_type}, {"unsigned8", &P::data_type}, {"unsigned16", &P::data_type},
        {"unsigned32", &P::data_type}, {"signed8", &P::data_type}, {"signed16", &P::data_type}, {"signed32", &P::data_type},
        {"module", &P::module}, {"ext_module_prm_data_len", &P::module_prm_length},
        {"x_ext_module_prm_data_len", &P::module_prm_length}, {"preset", &P::preset}, {"endmodule", &P::end_module},
        {"ext_user_prm_data_const", &P::prm_const}, {"x_ext_user_prm_data_const", &P::prm_const},
        {"ext_user_prm_data_ref", &P::prm_ref}, {"x_ext_user_prm_data_ref", &P::prm_ref},
        {"slotdefinition", &P::slot_definition}, {"slot", &P::slot}, {"endslotdefinition", &P::end_slot_definition},
        {"unit_diag_bit", &P::unit_diag_bit}, {"x_unit_diag_bit", &P::unit_diag_bit},
        {"unit_diag_not_bit", &P::unit_diag_bit}, {"x_unit_diag_not_bit", &P::unit_diag_bit},
        {"unit_diag_!bit", &P::unit_diag_bit}, {"x_unit_diag_!bit", &P::unit_diag_bit},
        {"unit_diag_bit_help", &P::unit_diag_bit_help}, {"x_unit_diag_bit_help", &P::unit_diag_bit_help},
        {"unit_diag_not_bit_help", &P::unit_diag_bit_help}, {"x_unit_diag_not_bit_help", &P::unit_diag_bit_help},
        {"unit_diag_area", &P::unit_diag_area}, {"x_unit_diag_area", &P::unit_diag_area},
        {"value", &P::area_value}, {"x_value", &P::area_value},
        {"unit_diag_area_end", &P::unit_diag_area_end}, {"x_unit_diag_area_end", &P::unit_diag_area_end},
        {"unitdiagtype", &P::unit_diag_type}, {"endunitdiagtype", &P::end_unit_diag_type},
        {"channel_diag", &P::channel_diag},
    };
    // clang-format on
    const auto found = handlers.find(key);
    return found == handlers.end() ? nullptr : found->second;
}

Statement Parser::split(const Line& line) {
    const std::span<const Token> tokens{line.tokens};
    std::size_t at = 1;
    Statement s{tokens[0].text, "", tokens[0].at, {}, {}, false, {}, Cursor{{}}};
    // Words in front of '=': one keyword, written with blanks ("24V Pins").
    std::size_t words = 1;
    while (words < tokens.size() && tokens[words].kind == Token::Kind::word) ++words;
    if (words > 1 && words < tokens.size() && tokens[words].is('=')) {
        for (; at < words; ++at) s.name += "_" + tokens[at].text;
        warn(s.at, "keyword with blanks, taken for " + quoted(s.name));
    }
    s.key = lower(s.name);
    Cursor head{tokens.subspan(at)};
    if (at < tokens.size() && tokens[at].is('(')) {
        const std::size_t open = at;
        while (at < tokens.size() && !tokens[at].is(')')) ++at;
        Cursor inside{tokens.subspan(open + 1, at - open - 1)};
        s.index = inside.number();
        if (s.index && inside.accept('-')) s.index2 = inside.number();
        if (at == tokens.size()) error(tokens[open].at, s.name + ": ')' is missing");
        else if (!s.index || !inside.end()) error(tokens[open].at, s.name + ": number in parentheses expected");
        if (at < tokens.size()) ++at;
    }
    if (at < tokens.size() && tokens[at].is('=')) {
        s.assigns = true;
        ++at;
    }
    if (at < tokens.size()) s.rest = trim(std::string_view{line.text}.substr(tokens[at].begin));
    s.value = Cursor{tokens.subspan(at)};
    return s;
}

void Parser::line(const Line& line) {
    const Token& first = line.tokens[0];
    if (first.kind != Token::Kind::word) {
        error(first.at, "keyword expected, not " +
                            quoted(first.kind == Token::Kind::string ? "\"" + first.text + "\"" : first.text));
        return;
    }
    if (first.text[0] == '#') {
        if (lower(first.text) == "#profibus_dp") profibus_dp_ = true;
        else warn(first.at, "unknown section " + quoted(first.text));
        return;
    }
    Statement s = split(line);
    if (in_module_ && !s.assigns && to_number(s.name)) return module_reference(s);
    statement(s);
}

void Parser::statement(Statement& s) {
    if (const Handler h = handler(s.key)) return (this->*h)(s);
    if (const auto target = scalar_target(gsd_, s.key)) return scalar(s, *target);
    // A word alone may begin or end a block of the vendor's own.
    if (!s.assigns && !s.rest.empty()) warn(s.at, quoted(s.name) + " is no keyword that is known, and '=' is missing");
    keep(s);
}

void Parser::close_blocks(std::string_view because, Position at) {
    const auto close = [&](bool& open, const char* end) {
        if (open) warn(at, std::string{end} + " is missing before " + std::string{because});
        open = false;
    };
    close(in_prm_text_, "EndPrmText");
    if (in_parameter_ && !has_type_) error(gsd_.parameters.back().at, "parameter without type");
    close(in_parameter_, "EndExtUserPrmData");
    close(in_slots_, "EndSlotDefinition");
    close(in_area_, "Unit_Diag_Area_End");
    close(in_diag_type_, "EndUnitDiagType");
    close(in_module_, "EndModule");
}

void Parser::missing_keywords() {
    if (!profibus_dp_) warn({}, "#Profibus_DP is missing");
    if (!has_ident_) error({}, "Ident_Number is missing");
    if (gsd_.vendor_name.empty()) warn({}, "Vendor_Name is missing");
    if (gsd_.model_name.empty()) warn({}, "Model_Name is missing");
    if (gsd_.protocol_ident != 0) warn({}, "Protocol_Ident is not 0 (DP)");
    if (gsd_.station_type != 0) warn({}, "Station_Type is not 0: the file does not describe a slave");
    if (std::ranges::none_of(gsd_.rates, &RateSupport::supported)) warn({}, "no transmission rate is supported");
}

void Parser::run(std::string_view utf8) {
    LineReader reader{utf8, out_.diagnostics};
    Line l;
    while (reader.next(l)) line(l);
    close_blocks("the end of the file", {});
    missing_keywords();
}

// ---- public -------------------------------------------------------------------------------------------------------

bool Parsed::ok() const {
    return std::ranges::none_of(diagnostics, [](const Diagnostic& d) { return d.severity == Severity::error; });
}

Parsed parse(std::string_view text, std::string file) {
    Parsed out;
    out.gsd.file = std::move(file);
    Parser{out}.run(to_utf8(text));
    check(out.gsd, out.diagnostics);
    std::ranges::stable_sort(out.diagnostics, [](const Diagnostic& a, const Diagnostic& b) {
        return a.at.line != b.at.line ? a.at.line < b.at.line : a.at.column < b.at.column;
    });
    if (out.diagnostics.size() > kMaxDiagnostics) {
        // What is cut off must not turn a bad file into a good one.
        const bool ok = out.ok();
        out.diagnostics.resize(kMaxDiagnostics - 1);
        out.diagnostics.push_back({ok ? Severity::warning : Severity::error, {}, "and many more"});
    }
    return out;
}

Parsed read(const std::string& path) {
    constexpr std::size_t limit = std::size_t{16} << 20;
    std::ifstream in{path, std::ios::binary};
    if (!in) throw GsdError{path + ": cannot be opened"};
    std::string text;
    char chunk[65536];
    while (in.read(chunk, sizeof chunk) || in.gcount() > 0) {
        text.append(chunk, static_cast<std::size_t>(in.gcount()));
        if (text.size() > limit) throw GsdError{path + ": larger than 16 MiB"};
    }
    if (in.bad()) throw GsdError{path + ": cannot be read"};
    return parse(text, path);
}

Gsd load(const std::string& path) {
    Parsed parsed = read(path);
    if (!parsed.ok()) {
        std::erase_if(parsed.diagnostics, [](const Diagnostic& d) { return d.severity != Severity::error; });
        throw GsdError{path, std::move(parsed.diagnostics)};
    }
    return std::move(parsed.gsd);
}

}  // namespace dpchip::gsd
