// SPDX-License-Identifier: Apache-2.0
// Options: one table, its defaults, its ranges and what it refuses (engineering reference 9.1).
#include <gtest/gtest.h>

#include <set>
#include <string>

#include <dpchip/regmap/options.hpp>

namespace dpchip::regmap {
namespace {

bool same(const Options& a, const Options& b) {
    return a.start_window_samples == b.start_window_samples && a.allow_gap_tbits == b.allow_gap_tbits &&
           a.rts_lead_clk == b.rts_lead_clk && a.rts_trail_clk == b.rts_trail_clk && a.t_proc_clk == b.t_proc_clk &&
           a.baud_probe_ms == b.baud_probe_ms && a.initial_din_sm == b.initial_din_sm &&
           a.initial_dout_sm == b.initial_dout_sm && a.initial_dxb_sm == b.initial_dxb_sm &&
           a.initial_diag_sm == b.initial_diag_sm && a.dx_len_error_answer == b.dx_len_error_answer &&
           a.dh_without_inputs == b.dh_without_inputs && a.gc_reserved_sets_not_supported == b.gc_reserved_sets_not_supported &&
           a.gc_requires_prm_req == b.gc_requires_prm_req && a.gc_triggers_wd == b.gc_triggers_wd &&
           a.quirk_keep_master_add == b.quirk_keep_master_add && a.leave_master_stops_wd == b.leave_master_stops_wd &&
           a.apc3_reset_dis_start == b.apc3_reset_dis_start && a.ident_lsap_answer == b.ident_lsap_answer &&
           a.sync_pulse_delay_clk == b.sync_pulse_delay_clk && a.ram_after_reset == b.ram_after_reset;
}

TEST(Options, TableNamesAreUniqueAndEveryRowIsComplete) {
    std::set<std::string_view> names;
    for (const OptionInfo& o : option_table()) {
        EXPECT_TRUE(names.insert(o.name).second) << o.name;
        EXPECT_FALSE(o.values.empty() || o.default_text.empty() || o.section.empty() || o.meaning.empty()) << o.name;
    }
    EXPECT_EQ(names.size(), 21u);
}

TEST(Options, SettingEveryDefaultTextGivesTheDefaults) {
    Options options;
    for (const OptionInfo& o : option_table()) EXPECT_TRUE(set_option(options, o.name, o.default_text)) << o.name;
    EXPECT_TRUE(same(options, Options{}));
}

TEST(Options, EveryRowChangesSomethingWhenGivenAnotherValue) {
    const std::pair<const char*, const char*> changes[]{
        {"start_window_samples", "2"}, {"allow_gap_tbits", "0x10"}, {"rts_lead_clk", "8"}, {"rts_trail_clk", "9"},
        {"t_proc_clk", "0"}, {"baud_probe_ms", "1"}, {"initial_din_sm", "0x27"}, {"initial_dout_sm", "0x27"},
        {"initial_dxb_sm", "39"}, {"initial_diag_sm", "6"}, {"dx_len_error_answer", "rr"}, {"dh_without_inputs", "sd1"},
        {"gc_reserved_sets_not_supported", "true"}, {"gc_requires_prm_req", "on"}, {"gc_triggers_wd", "1"},
        {"quirk_keep_master_add", "true"}, {"leave_master_stops_wd", "false"}, {"apc3_reset_dis_start", "off"},
        {"ident_lsap_answer", "none"}, {"sync_pulse_delay_clk", "65535"}, {"ram_after_reset", "ones"}};
    EXPECT_EQ(std::size(changes), option_table().size());
    for (const auto& [name, text] : changes) {
        Options options;
        EXPECT_TRUE(set_option(options, name, text)) << name;
        EXPECT_FALSE(same(options, Options{})) << name;
    }
}

struct Refusal {
    const char* name;
    const char* text;
    OptionError error;
};

TEST(Options, WhatIsWrongIsRefusedAndNamed) {
    const Refusal refusals[]{
        {"", "1", OptionError::unknown_name},
        {"T_proc_clk", "1", OptionError::unknown_name},
        {"t_proc_clk", "", OptionError::bad_value},
        {"t_proc_clk", "12 ", OptionError::bad_value},
        {"t_proc_clk", "-1", OptionError::bad_value},
        {"t_proc_clk", "0x", OptionError::bad_value},
        {"t_proc_clk", "48000001", OptionError::out_of_range},
        {"t_proc_clk", "99999999999999999999999", OptionError::out_of_range},
        {"start_window_samples", "4", OptionError::out_of_range},
        {"initial_din_sm", "0x00", OptionError::out_of_range},
        {"initial_din_sm", "0xE4", OptionError::out_of_range},
        {"initial_din_sm", "0x1E1", OptionError::out_of_range},
        {"initial_diag_sm", "0x0A", OptionError::out_of_range},
        {"gc_triggers_wd", "yes", OptionError::bad_value},
        {"dh_without_inputs", "", OptionError::bad_value},
        {"dh_without_inputs", "dummy", OptionError::bad_value},
        {"dh_without_inputs", "dummy_octet|sd1", OptionError::bad_value},
        {"baud_probe_ms", "", OptionError::bad_value},
        {"baud_probe_ms", "1,2", OptionError::bad_value},
        {"baud_probe_ms", "1,2,3,4,5,6,7,8,9,10,11", OptionError::bad_value},
        {"baud_probe_ms", "1,2,3,4,5,6,7,8,9,", OptionError::bad_value},
        {"baud_probe_ms", "3600001", OptionError::out_of_range},
    };
    for (const Refusal& refusal : refusals) {
        Options options;
        const auto result = set_option(options, refusal.name, refusal.text);
        ASSERT_FALSE(result) << refusal.name << "=" << refusal.text;
        EXPECT_EQ(result.error(), refusal.error) << refusal.name << "=" << refusal.text;
        EXPECT_TRUE(same(options, Options{}));
    }
}

TEST(Options, BaudProbeTakesOneNumberOrTen) {
    Options options;
    ASSERT_TRUE(set_option(options, "baud_probe_ms", "7"));
    for (const std::uint32_t ms : options.baud_probe_ms) EXPECT_EQ(ms, 7u);
    ASSERT_TRUE(set_option(options, "baud_probe_ms", "1,2,3,4,5,6,7,8,9,0x0A"));
    for (std::uint32_t i = 0; i < 10; ++i) EXPECT_EQ(options.baud_probe_ms[i], i + 1);
}

TEST(Options, ExactlyTwelveThreeBufferStatesAreAccepted) {
    unsigned accepted = 0;
    for (unsigned sm = 0; sm < 256; ++sm) {
        Options options;
        if (set_option(options, "initial_din_sm", std::to_string(sm))) ++accepted;
    }
    EXPECT_EQ(accepted, 12u);
}

}  // namespace
}  // namespace dpchip::regmap
