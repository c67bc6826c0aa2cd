// SPDX-License-Identifier: Apache-2.0
// Modules in slots, and user parameters: what a slave and a master make of a GSD.
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/gsd/configuration.hpp>
#include <dpchip/gsd/describe.hpp>
#include <dpchip/gsd/parse.hpp>
#include <dpchip/gsd/user_prm.hpp>

namespace gsd = dpchip::gsd;
using Octets = std::vector<std::uint8_t>;
using Names = std::vector<std::string>;
using Settings = std::vector<gsd::PrmSetting>;

namespace {

/// The message of the GsdError that `f` throws.
std::string refusal(const std::function<void()>& f) {
    try {
        f();
    } catch (const gsd::GsdError& e) { return e.what(); }
    return "not refused";
}
bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

class RemoteIo : public testing::Test {
protected:
    const gsd::Gsd g = gsd::load(std::string{DPCHIP_SOURCE_DIR} + "/examples/remote_io.gsd");
    gsd::Configuration plug(const Names& names) const { return gsd::configure(g, names); }
    std::string plug_refusal(const Names& names) const {
        return refusal([&] { static_cast<void>(plug(names)); });
    }
    std::string set_refusal(const gsd::Configuration& c, const Settings& s) const {
        return refusal([&] { static_cast<void>(gsd::user_prm_data(g, c, s)); });
    }
};

TEST_F(RemoteIo, the_shipped_file_has_no_warnings) {
    const auto p = gsd::read(std::string{DPCHIP_SOURCE_DIR} + "/examples/remote_io.gsd");
    EXPECT_TRUE(p.diagnostics.empty());
    EXPECT_EQ(g.ident_number, 0xFFF0);
    for (std::size_t i = 0; i < gsd::kRates; ++i)
        EXPECT_EQ(g.rates[i].supported, static_cast<gsd::Rate>(i) != gsd::Rate::kbit_31_25);
}

TEST_F(RemoteIo, modules_are_found_by_name_position_reference_and_unique_beginning) {
    EXPECT_EQ(gsd::find_module(g, "8 DI"), 1u);
    EXPECT_EQ(gsd::find_module(g, "  8   di "), 1u);
    EXPECT_EQ(gsd::find_module(g, "#3"), 2u);
    EXPECT_EQ(gsd::find_module(g, "10"), 9u) << "its reference number";
    EXPECT_EQ(gsd::find_module(g, "counter"), 9u);
    const std::string ambiguous = refusal([&] { static_cast<void>(gsd::find_module(g, "32 ")); });
    EXPECT_TRUE(has(ambiguous, "could be one of") && has(ambiguous, "32 DI") && has(ambiguous, "32 DO")) << ambiguous;
    const std::string unknown = refusal([&] { static_cast<void>(gsd::find_module(g, "64 DI")); });
    EXPECT_TRUE(has(unknown, "does not exist") && has(unknown, "8 DI") && has(unknown, "Counter")) << unknown;
    EXPECT_TRUE(has(refusal([&] { static_cast<void>(gsd::find_module(g, "#11")); }), "does not exist"));
    EXPECT_TRUE(has(refusal([&] { static_cast<void>(gsd::find_module(g, "")); }), "does not exist"));
}

// proves: APC3 A.3-01
TEST_F(RemoteIo, a_configuration_has_the_octets_and_lengths_of_its_modules) {
    const auto c = plug({"32 DI", "Empty slot", "16 DI / 16 DO", "Counter", "2 AI"});
    EXPECT_EQ(c.modules, (std::vector<std::size_t>{2, 0, 5, 9, 6}));
    EXPECT_EQ(c.cfg, (Octets{0x13, 0x00, 0x31, 0xC2, 0x41, 0xC3, 0x44, 0x50, 0xD1}));
    EXPECT_EQ(c.input_octets, 4 + 2 + 8 + 4);
    EXPECT_EQ(c.output_octets, 2 + 4);
}

TEST_F(RemoteIo, limits_of_the_station_are_kept) {
    EXPECT_TRUE(has(plug_refusal(Names(17, "8 DI")), "17 modules, but Max_Module is 16"));
    EXPECT_EQ(plug(Names(3, "64 octets")).input_octets, 192);
    EXPECT_TRUE(has(plug_refusal(Names(4, "64 octets")), "more than 244 octets of inputs"));
    EXPECT_TRUE(has(plug_refusal({}), "which modules?"));
    EXPECT_TRUE(has(refusal([&] { static_cast<void>(gsd::configure_modules(g, {99})); }), "no module #100"));
}

TEST_F(RemoteIo, user_parameters_are_the_devices_then_the_modules_in_slot_order) {
    const auto c = plug({"8 DI", "8 DO", "2 AI"});
    const auto data = gsd::user_prm_data(g, c);
    EXPECT_EQ(data.octets, (Octets{0, 0, 0, 0x01, 0x00, 0x64, 0x03, 0, 0, 0, 0}));
    EXPECT_EQ(data.variable, (Octets{0, 0, 0, 0x07, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0xFF, 0xFF}));
    ASSERT_EQ(data.fields.size(), 7u);
    EXPECT_EQ(data.fields[2].value, 100);
    EXPECT_EQ(data.fields[3].slot, 1u);
    EXPECT_EQ(data.fields[4].slot, 3u);
    EXPECT_EQ(data.fields[6].offset, 9u);
    EXPECT_TRUE(has(gsd::describe_parameters(g, data), "Extended diagnosis = 1 (On)  [0..1]"));
}

TEST_F(RemoteIo, settings_go_by_text_number_slot_and_value_text) {
    const auto c = plug({"8 DI", "8 DI", "2 AI"});
    const Settings settings{gsd::prm_setting("outputs on fail-safe=Keep last value"), gsd::prm_setting("3=0x200"),
                            gsd::prm_setting("2:Input filter [ms]=20"),
                            gsd::prm_setting("3:Range channel 1 = 4 .. 20 mA"),
                            gsd::prm_setting("Zero correction@10=-2")};
    const auto data = gsd::user_prm_data(g, c, settings);
    EXPECT_EQ(data.octets, (Octets{0, 0, 0, 0x03, 0x02, 0x00, 0x03, 0x14, 0x30, 0, 0xFF, 0xFE}));
    EXPECT_EQ(data.fields.back().value, -2);
    EXPECT_FALSE(gsd::check_user_prm(g, data, data.octets));
}

TEST_F(RemoteIo, settings_that_mean_nothing_are_refused_with_what_there_is) {
    const auto c = plug({"8 DI", "8 DI", "2 AI"});
    EXPECT_TRUE(has(set_refusal(c, {gsd::prm_setting("Input filter [ms]=20")}), "could be one of"));
    EXPECT_TRUE(has(set_refusal(c, {gsd::prm_setting("Nothing=20")}), "does not exist; there are"));
    EXPECT_TRUE(has(set_refusal(c, {gsd::prm_setting("1:Input filter [ms]=2")}), "allowed: 0, 1, 3, 10, 20"));
    EXPECT_TRUE(has(set_refusal(c, {gsd::prm_setting("3=70000")}), "allowed: 10..10000"));
    EXPECT_TRUE(has(set_refusal(c, {gsd::prm_setting("2=Sometimes")}), "Keep last value"));
    EXPECT_TRUE(has(refusal([] { static_cast<void>(gsd::prm_setting("no value")); }), "VALUE expected"));
    EXPECT_TRUE(has(refusal([] { static_cast<void>(gsd::prm_setting("= 5")); }), "VALUE expected"));
}

TEST_F(RemoteIo, what_a_master_sent_is_held_against_length_constants_and_ranges) {
    using Kind = gsd::PrmFault::Kind;
    const auto data = gsd::user_prm_data(g, plug({"8 DI", "2 AI"}));
    const auto fault = [&](const Octets& received) { return gsd::check_user_prm(g, data, received); };
    EXPECT_FALSE(fault({0, 0, 0, 0x00, 0x27, 0x10, 0x14, 0x33, 0, 0xFE, 0x0C}));
    const auto kind = [&](std::size_t at, std::uint8_t value) {
        Octets received = data.octets;
        received[at] = value;
        const auto f = fault(received);
        return f ? std::pair{static_cast<int>(f->kind), static_cast<int>(f->offset)} : std::pair{-1, -1};
    };
    const auto constant = static_cast<int>(Kind::constant), range = static_cast<int>(Kind::range);
    EXPECT_EQ(kind(0, 0x80), (std::pair{constant, 0}));
    EXPECT_EQ(kind(3, 0x09), (std::pair{constant, 3})) << "an unused bit beside parameters";
    EXPECT_EQ(kind(3, 0x06), (std::pair{range, 3}));
    EXPECT_EQ(kind(4, 0x27), (std::pair{range, 4})) << "10084 of 10..10000";
    EXPECT_EQ(kind(6, 0x02), (std::pair{range, 6}));
    EXPECT_EQ(kind(7, 0x40), (std::pair{range, 7}));
    EXPECT_EQ(kind(8, 0x01), (std::pair{constant, 8}));
    EXPECT_EQ(kind(9, 0x80), (std::pair{range, 9})) << "-32768";
    Octets cut = data.octets;
    cut.pop_back();
    ASSERT_TRUE(fault(cut));
    EXPECT_EQ(fault(cut)->kind, Kind::length);
    EXPECT_EQ(fault(cut)->message, "10 octets of user parameters, not 11");
}

class GrammarStation : public testing::Test {
protected:
    const gsd::Gsd g = gsd::load(std::string{DPCHIP_SOURCE_DIR} + "/tests/gsd/data/grammar.gsd");
};

TEST_F(GrammarStation, without_names_the_preset_modules_are_plugged) {
    const auto c = gsd::configure(g);
    EXPECT_EQ(c.modules, (std::vector<std::size_t>{2}));
    EXPECT_EQ(c.cfg, (Octets{0xC2, 0x01, 0x03, 0x11, 0x22}));
}

// proves: APC3 A.3-02
TEST_F(GrammarStation, fixed_preset_modules_come_first_named_or_not) {
    gsd::Gsd fixed = g;
    fixed.fix_preset_modules = true;
    EXPECT_EQ(gsd::configure(fixed, Names{"In 4, out 2", "#1"}).modules, (std::vector<std::size_t>{2, 0}));
    EXPECT_EQ(gsd::configure(fixed, Names{"#1", "#2"}).modules, (std::vector<std::size_t>{2, 0, 1}));
}

TEST_F(GrammarStation, slot_rules_are_kept_and_name_what_is_allowed) {
    EXPECT_NO_THROW(static_cast<void>(gsd::configure(g, Names{"#1", "#2"})));
    const std::string text = refusal([&] { static_cast<void>(gsd::configure(g, Names{"#2"})); });
    EXPECT_TRUE(has(text, "may not be in slot 1") && has(text, "#1  In  4") && has(text, "#3")) << text;
}

TEST_F(GrammarStation, values_of_every_type_are_big_endian_and_signed_ones_come_back_signed) {
    const auto data = gsd::user_prm_data(g, gsd::configure(g, Names{"#1", "#2"}));
    EXPECT_EQ(data.octets, (Octets{0, 0, 0,    0xFF, 0xAA, 0x14, 0x10, 0x01, 0x02, 1, 2,
                                   3, 4, 0xFF, 0xFF, 0xFE, 0xFF, 0xFF, 0xFF, 0xFD, 9, 0}));
    std::vector<std::int64_t> values;
    for (const auto& f : data.fields) values.push_back(f.value);
    EXPECT_EQ(values, (std::vector<std::int64_t>{1, 5, 16, 258, 0x01020304, -1, -2, -3, 9}));
}

TEST_F(GrammarStation, DPV1_status_bits_of_a_DP_V1_slave_are_the_masters) {
    const auto data = gsd::user_prm_data(g, gsd::configure(g));
    EXPECT_EQ(Octets(data.variable.begin(), data.variable.begin() + 3), (Octets{0xE7, 0xFD, 0x9F}));
    Octets received = data.octets;
    received[0] = 0xC4;
    EXPECT_FALSE(gsd::check_user_prm(g, data, received));
    received[0] = 0x08;
    EXPECT_TRUE(gsd::check_user_prm(g, data, received)) << "a reserved bit";
}

TEST_F(GrammarStation, a_parameter_that_is_not_changeable_keeps_its_default) {
    const auto c = gsd::configure(g, Names{"#1", "#2"});
    EXPECT_TRUE(
        has(refusal([&] { static_cast<void>(gsd::user_prm_data(g, c, Settings{gsd::prm_setting("Fixed=8")})); }),
            "not changeable"));
    EXPECT_NO_THROW(static_cast<void>(gsd::user_prm_data(g, c, Settings{gsd::prm_setting("Fixed=9")})));
}

TEST(OldFiles, User_Prm_Data_is_taken_when_there_is_no_Ext_form) {
    const auto p = gsd::parse("#Profibus_DP\nIdent_Number=1\nUser_Prm_Data_Len=2\nUser_Prm_Data=0x11,0x22\n"
                              "Module=\"A\" 0x10,0x20\nEndModule\n");
    ASSERT_TRUE(p.ok());
    const auto c = gsd::configure(p.gsd);
    EXPECT_EQ(c.cfg, (Octets{0x10, 0x20}));
    const auto data = gsd::user_prm_data(p.gsd, c);
    EXPECT_EQ(data.octets, (Octets{0x11, 0x22}));
    EXPECT_EQ(data.variable, (Octets{0, 0}));
    EXPECT_TRUE(has(refusal([&] { static_cast<void>(gsd::configure(p.gsd, Names{"A", "A"})); }), "compact station"));
}

TEST(SetExtPrm, the_X_keywords_are_a_telegram_of_their_own) {
    const auto p = gsd::parse("#Profibus_DP\nIdent_Number=1\nX_Prm_SAP_supp=1\nX_Max_User_Prm_Data_Len=5\n"
                              "X_Ext_User_Prm_Data_Const(0)=5,0x81,0,0,7\nModule=\"A\" 0x10\nEndModule\n");
    ASSERT_TRUE(p.ok());
    EXPECT_TRUE(p.gsd.dpv2.x_prm_sap);
    const auto c = gsd::configure(p.gsd);
    EXPECT_TRUE(gsd::user_prm_data(p.gsd, c).octets.empty());
    EXPECT_EQ(gsd::user_prm_data(p.gsd, c, {}, gsd::PrmTelegram::set_ext_prm).octets, (Octets{5, 0x81, 0, 0, 7}));
}

TEST(Limits, parameters_that_do_not_fit_are_refused) {
    std::string text = "#Profibus_DP\nIdent_Number=1\nModular_Station=1\nMax_Module=3\nMax_User_Prm_Data_Len=5\n"
                       "Module=\"A\" 0x10\nExt_Module_Prm_Data_Len=3\nEndModule\n";
    const auto p = gsd::parse(text);
    ASSERT_TRUE(p.ok());
    EXPECT_EQ(gsd::user_prm_data(p.gsd, gsd::configure(p.gsd)).octets.size(), 3u);
    EXPECT_TRUE(has(refusal([&] {
                        static_cast<void>(gsd::user_prm_data(p.gsd, gsd::configure(p.gsd, Names{"A", "A"})));
                    }),
                    "take 6 octets, but 5 are the limit"));
}

}  // namespace
