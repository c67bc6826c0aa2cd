// SPDX-License-Identifier: Apache-2.0
// GSD text -> value: the grammar, sloppy files, exact positions of errors, any octets.
#include <algorithm>
#include <cstdint>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/gsd/describe.hpp>
#include <dpchip/gsd/parse.hpp>
#include <dpchip/gsd/text.hpp>

namespace gsd = dpchip::gsd;

namespace {

std::string data_file(const std::string& name) { return std::string{DPCHIP_SOURCE_DIR} + "/tests/gsd/data/" + name; }

std::string contents(const std::string& path) {
    std::ifstream in{path, std::ios::binary};
    EXPECT_TRUE(in) << path;
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
}

/// Diagnostics as "line:column:E|W: message", a line each.
std::string listed(const gsd::Parsed& p) {
    std::ostringstream out;
    for (const auto& d : p.diagnostics)
        out << d.at.line << ':' << d.at.column << (d.severity == gsd::Severity::error ? ":E: " : ":W: ") << d.message
            << '\n';
    return out.str();
}

class Grammar : public testing::Test {
protected:
    const gsd::Parsed parsed = gsd::read(data_file("grammar.gsd"));
    const gsd::Gsd& g = parsed.gsd;
};

TEST_F(Grammar, loads_with_one_warning) {
    EXPECT_TRUE(parsed.ok());
    EXPECT_EQ(listed(parsed), "18:1:W: keyword with blanks, taken for '24V_Pins'\n");
}

TEST_F(Grammar, Latin_1_and_continued_strings_become_UTF_8) {
    EXPECT_EQ(g.vendor_name, "Gr\u00F6\u00DFer; & S\u00F6hne");
    EXPECT_EQ(g.model_name, "Grammar");
    EXPECT_EQ(g.revision, "V1.0") << "blanks at the end are padding";
}

TEST_F(Grammar, scalars_are_read_in_any_spelling) {
    EXPECT_EQ(g.gsd_revision, 5u);
    EXPECT_EQ(g.ident_number, 0xFFF1);
    EXPECT_EQ(g.slave_family, "3@TdF@Grammar - Test");
    EXPECT_EQ(g.pins_24v, 2u);
    EXPECT_TRUE(g.fail_safe && g.fail_safe_required && g.dpv1.slave && g.dpv1.wd_base_1ms && g.dpv2.publisher);
    EXPECT_FALSE(g.freeze_mode || g.sync_mode || g.dpv2.subscriber);
    EXPECT_EQ(g.max_module, 3u);
    EXPECT_EQ(g.max_diag_data_len, 40u);
}

TEST_F(Grammar, rates_and_their_response_times) {
    using gsd::Rate;
    EXPECT_TRUE(g.rate(Rate::kbit_9_6).supported && g.rate(Rate::kbit_187_5).supported &&
                g.rate(Rate::mbit_12).supported);
    EXPECT_FALSE(g.rate(Rate::kbit_19_2).supported);
    EXPECT_EQ(g.rate(Rate::kbit_9_6).max_tsdr, 60);
    EXPECT_EQ(g.rate(Rate::mbit_12).max_tsdr, 95);
    EXPECT_EQ(g.rate(Rate::kbit_187_5).max_tsdr, std::nullopt);
    EXPECT_STREQ(gsd::name(Rate::kbit_31_25), "31.25");
    EXPECT_EQ(gsd::bits_per_second(Rate::mbit_1_5), 1'500'000u);
}

TEST_F(Grammar, parameters_of_every_type) {
    struct Row {
        std::int64_t number;
        const char* name;
        gsd::DataType type;
        int first, last;
        std::int64_t value;
        std::vector<gsd::ValueRange> allowed;
    };
    using T = gsd::DataType;
    const std::vector<Row> rows{{1, "A bit", T::bit, 7, 7, 1, {{0, 1}}},
                                {2, "An area", T::bit_area, 2, 4, 5, {{0, 0}, {2, 5}}},
                                {3, "U8", T::unsigned8, 0, 0, 16, {{0, 255}}},
                                {4, "U16", T::unsigned16, 0, 0, 258, {{0, 65535}}},
                                {5, "U32", T::unsigned32, 0, 0, 0x01020304, {{0, 0xFFFFFFFF}}},
                                {6, "S8", T::signed8, 0, 0, -1, {{-128, 127}}},
                                {7, "S16", T::signed16, 0, 0, -2, {{-300, -2}, {5, 5}}},
                                {8, "S32", T::signed32, 0, 0, -3, {{-2147483648, 2147483647}}},
                                {9, "Fixed", T::unsigned8, 0, 0, 9, {{0, 20}}}};
    ASSERT_EQ(g.parameters.size(), rows.size());
    for (const Row& r : rows) {
        const gsd::Parameter* p = g.parameter(r.number);
        ASSERT_NE(p, nullptr) << r.name;
        EXPECT_EQ(p->name, r.name);
        EXPECT_EQ(p->type, r.type) << r.name;
        EXPECT_EQ(p->first_bit, r.first) << r.name;
        EXPECT_EQ(p->last_bit, r.last) << r.name;
        EXPECT_EQ(p->default_value, r.value) << r.name;
        EXPECT_EQ(p->allowed, r.allowed) << r.name;
    }
    EXPECT_FALSE(g.parameter(9)->changeable || g.parameter(9)->visible);
    EXPECT_TRUE(g.parameter(1)->changeable && g.parameter(1)->visible);
    EXPECT_EQ(g.value_text(*g.parameter(1), 1), "Yes");
    EXPECT_EQ(g.value_text(*g.parameter(6), -1), "Minus one");
    EXPECT_EQ(g.value_text(*g.parameter(6), 0), "");
    EXPECT_EQ(g.value_text(*g.parameter(3), 0), "");
    EXPECT_EQ(g.parameter(10), nullptr);
}

TEST_F(Grammar, a_value_is_allowed_when_range_and_type_allow_it) {
    const gsd::Parameter& area = *g.parameter(2);
    for (std::int64_t v = -2; v < 10; ++v) EXPECT_EQ(area.allows(v), v == 0 || (v >= 2 && v <= 5)) << v;
    const gsd::Parameter& s16 = *g.parameter(7);
    for (std::int64_t v : {-300, -2, 5}) EXPECT_TRUE(s16.allows(v)) << v;
    for (std::int64_t v : {-301, -1, 4, 6}) EXPECT_FALSE(s16.allows(v)) << v;
    gsd::Parameter any;
    EXPECT_TRUE(any.allows(255) && !any.allows(256) && !any.allows(-1)) << "without ranges the type decides";
}

TEST_F(Grammar, modules_with_octets_lengths_references_and_their_own_things) {
    ASSERT_EQ(g.modules.size(), 3u);
    EXPECT_EQ(g.modules[0].name, "In  4");
    EXPECT_EQ(g.modules[0].cfg, (std::vector<std::uint8_t>{0x13}));
    EXPECT_EQ(g.modules[0].input_octets, 4);
    EXPECT_EQ(g.modules[0].reference, 1);
    EXPECT_EQ(g.modules[1].reference, 2);
    EXPECT_EQ(g.modules[1].output_octets, 4);
    EXPECT_EQ(g.modules[1].info_text, "A module's own text");
    EXPECT_EQ(g.modules[1].prm.length, 16);
    EXPECT_EQ(g.modules[1].prm.refs.size(), 7u);
    EXPECT_EQ(g.modules[1].diag.bits.at(0).text, "Module's bit");
    EXPECT_EQ(g.modules[2].cfg, (std::vector<std::uint8_t>{0xC2, 0x01, 0x03, 0x11, 0x22}));
    EXPECT_EQ(g.modules[2].input_octets, 4);
    EXPECT_EQ(g.modules[2].output_octets, 2);
    EXPECT_TRUE(g.modules[2].preset);
    ASSERT_EQ(g.slots.size(), 2u);
    EXPECT_TRUE(g.slots[0].allows(1) && !g.slots[0].allows(2) && g.slots[0].allows(3));
}

TEST_F(Grammar, diagnosis_texts_of_device_types_and_channels) {
    EXPECT_EQ(g.diag.bits.at(0).text, "Zero");
    EXPECT_EQ(g.diag.bits.at(0).help, "Help for zero");
    EXPECT_EQ(g.diag.not_bits.size(), 2u) << "both spellings of Unit_Diag_Not_Bit";
    EXPECT_EQ(g.diag.areas.at(0).values.at(16), "Sixteen");
    EXPECT_EQ(g.diag.channel.at(16), "Own error");
    ASSERT_EQ(g.unit_diag_types.size(), 1u);
    EXPECT_EQ(g.unit_diag_types[0].type, 130);
    EXPECT_EQ(g.unit_diag_types[0].texts.size(), 3u);
    using Octets = std::vector<std::uint8_t>;
    using Texts = std::vector<std::string>;
    EXPECT_EQ(gsd::diag_texts(g, Octets{0x04, 0x01, 0x10, 0x00}), (Texts{"Zero", "Not one", "Not two", "Sixteen"}));
    EXPECT_EQ(gsd::diag_texts(g, Octets{0x03, 0x06, 0x00}), Texts{});
    EXPECT_EQ(gsd::diag_texts(g, Octets{0x07, 0x82, 0, 0, 0x03, 0, 0x01}), (Texts{"Forty", "Slot 1: none"}));
    EXPECT_EQ(gsd::diag_texts(g, Octets{0x01}), Texts{});
    EXPECT_EQ(gsd::channel_error_text(g, 16), "Own error");
    EXPECT_EQ(gsd::channel_error_text(g, 1), "short circuit");
}

TEST_F(Grammar, other_keywords_are_kept_with_line_and_module) {
    ASSERT_EQ(g.keywords.size(), 5u);
    EXPECT_EQ(g.keywords[0].name, "My_Own_Keyword");
    EXPECT_EQ(g.keywords[0].value, "\"x\", 5");
    EXPECT_EQ(g.keywords[0].at.line, 31u);
    EXPECT_FALSE(g.keywords[0].known);
    EXPECT_EQ(g.keywords[1].name, "My_Own_Text(7)");
    EXPECT_TRUE(g.keywords[2].known);
    EXPECT_EQ(g.keywords[2].module, 1u);
    EXPECT_EQ(gsd::summarize(g).unknown_keywords, 2u);
    EXPECT_EQ(gsd::describe_keywords(g), "31     My_Own_Keyword = \"x\", 5\n32     My_Own_Text(7) = \"y\"\n");
}

TEST(Parse, errors_are_all_found_and_carry_line_and_column) {
    const gsd::Parsed p = gsd::read(data_file("errors.gsd"));
    EXPECT_FALSE(p.ok());
    EXPECT_EQ(listed(p), contents(data_file("errors.expected")));
    try {
        static_cast<void>(gsd::load(data_file("errors.gsd")));
        FAIL() << "load() must refuse";
    } catch (const gsd::GsdError& e) {
        EXPECT_EQ(e.diagnostics().size(), static_cast<std::size_t>(std::ranges::count(
                                              p.diagnostics, gsd::Severity::error, &gsd::Diagnostic::severity)));
        EXPECT_NE(std::string{e.what()}.find("errors.gsd:2:15: error: string without closing quote"),
                  std::string::npos);
    }
}

TEST(Parse, sloppy_text_is_understood_with_warnings) {
    const gsd::Parsed p = gsd::read(data_file("sloppy.gsd"));
    EXPECT_TRUE(p.ok());
    EXPECT_EQ(listed(p), contents(data_file("sloppy.expected")));
    const gsd::Gsd& g = p.gsd;
    EXPECT_EQ(g.vendor_name, "plain words");
    EXPECT_EQ(g.gsd_revision, 2u);
    EXPECT_EQ(g.ident_number, 0xFFF2);
    EXPECT_TRUE(g.rate(gsd::Rate::kbit_500).supported);
    EXPECT_EQ(g.prm_text(7)->texts.at(0), "b");
    EXPECT_EQ(g.parameter(3)->name, "Again");
    EXPECT_EQ(g.user_prm_data, (std::vector<std::uint8_t>{1, 2}));
    EXPECT_EQ(g.modules.size(), 2u);
    EXPECT_EQ(g.modules[0].reference, 1);
}

TEST(Parse, a_file_that_cannot_be_read_says_so) {
    EXPECT_THROW(static_cast<void>(gsd::read(data_file("does_not_exist.gsd"))), gsd::GsdError);
    EXPECT_THROW(static_cast<void>(gsd::load(std::string{DPCHIP_SOURCE_DIR})), gsd::GsdError) << "a folder";
}

TEST(Parse, an_empty_text_lacks_everything_but_does_no_harm) {
    const gsd::Parsed p = gsd::parse("");
    EXPECT_FALSE(p.ok());
    EXPECT_NE(listed(p).find("Ident_Number is missing"), std::string::npos);
}

TEST(Parse, line_ends_and_byte_order_mark_do_not_matter) {
    const std::string unix_text = contents(data_file("errors.gsd"));
    const std::string expected = contents(data_file("errors.expected"));
    for (const std::string end : {"\r\n", "\r"}) {
        std::string text, marked = "\xEF\xBB\xBF";
        for (const char c : unix_text) c == '\n' ? text += end : text += c;
        marked += text;
        EXPECT_EQ(listed(gsd::parse(text)), expected);
        EXPECT_EQ(listed(gsd::parse(marked)), expected);
    }
}

TEST(Parse, UTF_8_stays_and_columns_count_characters) {
    const gsd::Parsed p = gsd::parse("#Profibus_DP\nVendor_Name = \"\u00C4\u00D6\u00DC\" rest\nIdent_Number=1\n");
    EXPECT_EQ(p.gsd.vendor_name, "\u00C4\u00D6\u00DC");
    EXPECT_NE(listed(p).find("2:21:W: Vendor_Name: 'rest' and what follows is ignored"), std::string::npos)
        << listed(p);
}

TEST(Parse, numbers_are_decimal_or_hexadecimal_and_bounded) {
    const std::vector<std::pair<const char*, std::optional<std::int64_t>>> rows{{"0", 0},
                                                                                {"0012", 12},
                                                                                {"0x1F", 31},
                                                                                {"0X1f", 31},
                                                                                {"1Fh", 31},
                                                                                {"-5", -5},
                                                                                {"+5", 5},
                                                                                {"4294967295", 4294967295},
                                                                                {"", {}},
                                                                                {"0x", {}},
                                                                                {"h", {}},
                                                                                {"-", {}},
                                                                                {"1.5", {}},
                                                                                {"12A", {}},
                                                                                {"0xG", {}},
                                                                                {"--1", {}},
                                                                                {"99999999999999999999", {}},
                                                                                {"0xFFFFFFFFFFFFFFFFFFFFFFFF", {}}};
    for (const auto& [text, value] : rows) EXPECT_EQ(gsd::to_number(text), value) << text;
}

TEST(Parse, the_number_of_diagnostics_is_bounded_and_an_error_is_never_lost) {
    std::string text = "#Profibus_DP\nIdent_Number=1\n";
    for (int i = 0; i < 5000; ++i) text += "Text(0)=\"outside\"\n";
    text += "GSD_Revision = x\n";
    const gsd::Parsed p = gsd::parse(text);
    EXPECT_EQ(p.diagnostics.size(), 1000u);
    EXPECT_FALSE(p.ok());
}

TEST(Parse, damaged_files_are_read_without_harm) {
    const std::vector<std::string> seeds{contents(data_file("grammar.gsd")), contents(data_file("sloppy.gsd")),
                                         contents(std::string{DPCHIP_SOURCE_DIR} + "/examples/remote_io.gsd")};
    std::mt19937 random{4711};
    for (int round = 0; round < 600; ++round) {
        const std::string& seed = seeds[random() % seeds.size()];
        std::vector<char> text{seed.begin(), seed.end()};
        for (auto n = random() % 40; n > 0 && text.size() > 100; --n) {
            const auto at = text.begin() + static_cast<std::ptrdiff_t>(random() % (text.size() - 60));
            switch (random() % 4) {
            case 0: *at = static_cast<char>(random()); break;
            case 1: text.erase(at, at + static_cast<std::ptrdiff_t>(random() % 30)); break;
            case 2: text.insert(at, "\"();,-=\\\n#0x"[random() % 12]); break;
            default: {
                const std::vector<char> piece{at, at + static_cast<std::ptrdiff_t>(random() % 60)};
                text.insert(text.end(), piece.begin(), piece.end());
                break;
            }
            }
        }
        const gsd::Parsed p = gsd::parse({text.data(), text.size()}, "damaged");
        ASSERT_LE(p.diagnostics.size(), 1000u);
        ASSERT_FALSE(gsd::describe(p.gsd).empty());
        for (const gsd::Module& m : p.gsd.modules) ASSERT_LE(m.input_octets, 244);
    }
}

}  // namespace
