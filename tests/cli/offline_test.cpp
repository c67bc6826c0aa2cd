// SPDX-License-Identifier: Apache-2.0
// Subcommands that need no line: sim, gsd, decode, regs, demo; and quantities as text.
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <dpchip/cli/line_config.hpp>
#include <dpchip/cli/units.hpp>
#include <dpchip/regmap/variant.hpp>

#include "cli/process.hpp"

namespace {

using dpchip::cli::parse_baud;
using dpchip::cli::parse_duration;
using dpchip::cli::parse_hex;
using dpchip::cli::parse_line_config;
using dpchip::cli::parse_slot_time;
using dpchip::fdl::BaudCode;
using dpchip::test::Result;
using dpchip::test::run;
using Json = nlohmann::json;
namespace core = dpchip::core;

// ---- quantities --------------------------------------------------------------------------------------------------

TEST(Rates, are_read_as_people_write_them) {
    for (const auto& [text, code] : std::vector<std::pair<const char*, BaudCode>>{
             {"9600", BaudCode::kbit_9_6}, {"9.6", BaudCode::kbit_9_6}, {"19.2k", BaudCode::kbit_19_2}, {"45.45", BaudCode::kbit_45_45}, {"45450", BaudCode::kbit_45_45},
             {"93.75", BaudCode::kbit_93_75}, {"187500", BaudCode::kbit_187_5}, {"500k", BaudCode::kbit_500}, {"1.5M", BaudCode::mbit_1_5}, {"12M", BaudCode::mbit_12}, {"12000000", BaudCode::mbit_12}})
        EXPECT_EQ(parse_baud(text), code) << text;
    for (const char* text : {"", "115200", "12 M", "fast", "-9600", "12m", "1e6", "inf", "99999999999M", "9600 "}) EXPECT_FALSE(parse_baud(text)) << text;
}

TEST(Durations, need_a_unit) {
    EXPECT_EQ(parse_duration("2.5ms"), core::microseconds(2500));
    EXPECT_EQ(parse_duration("1s"), core::seconds(1));
    EXPECT_EQ(parse_duration("250us"), core::microseconds(250));
    EXPECT_EQ(parse_duration("800ns"), core::nanoseconds(800));
    for (const char* text : {"", "5", "5 ms", "ms", "-1ms", "1e3ms", "99999999s", "nan", "1h"}) EXPECT_FALSE(parse_duration(text)) << text;
}

TEST(SlotTime, is_bit_times_or_a_duration) {
    EXPECT_EQ(parse_slot_time("300")->at(BaudCode::kbit_9_6), dpchip::fdl::baud(BaudCode::kbit_9_6).bit * 300);
    EXPECT_EQ(parse_slot_time("300tbit")->at(BaudCode::mbit_12), dpchip::fdl::baud(BaudCode::mbit_12).bit * 300);
    EXPECT_EQ(parse_slot_time("200ms")->at(BaudCode::mbit_12), core::milliseconds(200));
    for (const char* text : {"", "0", "0ms", "-3", "300bit", "1.5"}) EXPECT_FALSE(parse_slot_time(text)) << text;
}

TEST(Hex, is_pairs_of_digits) {
    EXPECT_EQ(parse_hex("01 A0ff"), (std::vector<std::uint8_t>{1, 0xA0, 0xFF}));
    EXPECT_EQ(parse_hex(""), std::vector<std::uint8_t>{});
    for (const char* text : {"1", "0 1", "xy", "0x01"}) EXPECT_FALSE(parse_hex(text)) << text;
}

// ---- files -------------------------------------------------------------------------------------------------------

TEST(LineToml, says_everything_that_the_command_line_can) {
    const auto c = parse_line_config(R"(
line = "tcp:9000"
baud = 500000
slot_time = 300
pace = "wire"
trace = "t.pcapng"
link_type = 257
state_dir = "state"
[[master]]
address = 3
cycle = "5ms"
max_retry = 2
[[slave]]
name = "A"
gsd = "x/a.gsd"
modules = ["m", "n"]
address = 7
chip = "apc3"
io = "hold:01"
min_tsdr = 40
options = { baud_probe_ms = [1,2,3,4,5,6,7,8,9,10], gc_triggers_wd = true }
parameters = { "2:Filter" = 3 }
watchdog_ms = 250
group = 5
sync = true
[[event]]
at = "10ms"
do = "fault"
fault = "drop"
from = "slave"
slave = "A"
[[event]]
at = "5ms"
do = "global_control"
command = ["Sync", "Freeze"]
groups = 5
)", "dir/line.toml");
    EXPECT_EQ(c.line, "tcp:9000");
    EXPECT_EQ(c.baud, BaudCode::kbit_500);
    EXPECT_EQ(c.pace, dpchip::live::Pace::wire);
    EXPECT_EQ(c.trace, "dir/t.pcapng");
    EXPECT_EQ(c.state_dir, "dir/state");
    ASSERT_EQ(c.slaves.size(), 1u);
    const auto& s = c.slaves[0];
    EXPECT_EQ(s.gsd, "dir/x/a.gsd");
    EXPECT_EQ(s.modules, (std::vector<std::string>{"m", "n"}));
    EXPECT_EQ(s.chip, dpchip::regmap::Variant::apc3);
    EXPECT_EQ(s.min_tsdr, 40);
    EXPECT_EQ(s.options.baud_probe_ms[9], 10u);
    EXPECT_TRUE(s.options.gc_triggers_wd);
    ASSERT_EQ(s.parameters.size(), 1u);
    EXPECT_EQ(s.parameters[0].slot, 2u);
    EXPECT_EQ(s.watchdog_ms, 250u);
    EXPECT_TRUE(s.sync && s.group == 5 && !s.freeze);
    ASSERT_EQ(c.masters.size(), 1u);
    EXPECT_EQ(c.masters[0].min_cycle, core::milliseconds(5));
    ASSERT_EQ(c.events.size(), 2u);
    EXPECT_EQ(c.events[0].command, 0x28) << "events are in the order of their times";
    EXPECT_EQ(c.events[1].fault.kind, dpchip::segment::FaultKind::drop);
    EXPECT_EQ(c.events[1].sender, 0u);
}

// ---- sim ---------------------------------------------------------------------------------------------------------

std::string bus(unsigned slaves, const std::string& head, const std::string& modules = "\"64 octets in / 64 out\"") {
    std::string text = head + "\n[[master]]\naddress = 0\n";
    for (unsigned n = 1; n <= slaves; ++n)
        text += "[[slave]]\ngsd = \"builtin:remote_io\"\nmodules = [" + modules + "]\naddress = " + std::to_string(n) + "\n";
    return text;
}

TEST(Sim, runs_125_slaves_for_1000_cycles_at_12_Mbit_and_every_input_follows) {
    const Result r = run({"sim", "-", "--cycles", "1000", "--json", "-q"}, bus(125, "baud = \"12M\""));
    ASSERT_EQ(r.code, 0) << r.err << r.out;
    const Json j = Json::parse(r.out);
    EXPECT_EQ(j["cycles"], 1000);
    EXPECT_EQ(j["cycle_ticks"]["min"], j["cycle_ticks"]["max"]);
    EXPECT_EQ(j["retries"], 0);
    EXPECT_EQ(j["violations"], 0);
    ASSERT_EQ(j["slaves"].size(), 125u);
    for (const Json& s : j["slaves"]) {
        EXPECT_GE(s["compared"], 995) << s;
        EXPECT_EQ(s["wrong"], 0) << s;
    }
}

TEST(Sim, gives_the_same_report_every_time) {
    const auto report = [] {
        Json j = Json::parse(run({"sim", DPCHIP_SOURCE_DIR "/examples/scenario.toml", "--json", "-q"}).out);
        j.erase("wall_s");
        return j;
    };
    EXPECT_EQ(report(), report());
}

TEST(Sim, of_the_shipped_scenario_ends_well_and_loses_only_the_slave_without_power) {
    const Result r = run({"sim", DPCHIP_SOURCE_DIR "/examples/scenario.toml", "--json"});
    ASSERT_EQ(r.code, 0) << r.err;
    const Json j = Json::parse(r.out);
    EXPECT_EQ(j["faults"], 1);
    EXPECT_EQ(j["violations"], 0);
    EXPECT_EQ(j["slaves"][0]["lost"], 0);
    EXPECT_EQ(j["slaves"][1]["lost"], 1);
}

TEST(Sim, ends_with_1_when_a_slave_is_not_there_at_the_end) {
    const Result r = run({"sim", "-", "--for", "100ms"},
                         bus(1, "", "\"8 DI\"") + "[[event]]\nat = \"20ms\"\ndo = \"unplug\"\nslave = 1\n[[event]]\nat = \"99.9ms\"\ndo = \"plug\"\nslave = 1\n");
    EXPECT_EQ(r.code, 1) << r.out;
    EXPECT_NE(r.err.find("slave 1: not in data exchange"), std::string::npos) << r.err;
}

TEST(Sim, refuses_events_that_cannot_happen) {
    const Result r = run({"sim", "-", "--for", "10ms"}, bus(1, "", "\"8 DI\"") + "[[event]]\nat = \"5ms\"\ndo = \"power_on\"\nslave = 1\n");
    EXPECT_EQ(r.code, 4);
    EXPECT_NE(r.err.find("has power already"), std::string::npos) << r.err;
}

// ---- decode, gsd, regs, demo -------------------------------------------------------------------------------------

TEST(Decode, explains_the_recorded_diagnosis) {
    const Result r = run({"decode", "--json", "68", "05", "05", "68", "82", "E3", "6D", "3C", "3E", "4C", "16", "680B0B68E382083E3C020500FF0CDAD316"});
    ASSERT_EQ(r.code, 0) << r.err;
    const Json j = Json::parse(r.out);
    ASSERT_EQ(j.size(), 2u);
    EXPECT_NE(j[0]["text"].get<std::string>().find("Slave_Diag"), std::string::npos);
    EXPECT_NE(j[1]["text"].get<std::string>().find("0CDAH"), std::string::npos);
}

TEST(Decode, names_damage_and_goes_on) {
    const Result r = run({"decode", "-"}, "10 02 63 49 AF 16   # wrong FCS\n10 02 63 49 AE 16\n");
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_NE(r.out.find("FDL_Status"), std::string::npos) << r.out;
    EXPECT_NE(r.err.find("1 damaged"), std::string::npos) << r.err;
    const Result bad = run({"decode", "-"}, "10 02 63 49 AE 16\n10 02 banana!\n");
    EXPECT_EQ(bad.code, 4);
    EXPECT_NE(bad.err.find("-:2:7: error:"), std::string::npos) << bad.err;
}

TEST(Decode, adds_the_texts_of_a_gsd) {
    const Result r = run({"decode", "-", "--gsd", "builtin:remote_io", "--details"}, "68 05 05 68 85 81 6D 3C 3E ED 16\n68 0E 0E 68 81 85 08 3E 3C 08 0C 00 01 FF F0 03 01 00 90 16\n");
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_NE(r.out.find("Load voltage missing"), std::string::npos) << r.out;
}

TEST(Gsd, plugs_modules_and_shows_octets_and_parameters) {
    const Result r = run({"gsd", "builtin:remote_io", "--module", "8 DI", "--module", "2 AI, consistent", "--json"});
    ASSERT_EQ(r.code, 0) << r.err;
    const Json j = Json::parse(r.out);
    EXPECT_EQ(j["ident"], "0xFFF0");
    EXPECT_EQ(j["station"]["cfg"], "10 D1");
    EXPECT_EQ(j["station"]["inputs"], 5);
    EXPECT_EQ(j["modules"].size(), 10u);
    EXPECT_EQ(run({"gsd", "builtin:remote_io", "--module", "9 DI"}).code, 2);
    EXPECT_EQ(run({"gsd", "-"}, "#Profibus_DP\nGSD_Revision = x\n").code, 4);
    EXPECT_EQ(Json::parse(run({"gsd", "builtin:remote_io", DPCHIP_SOURCE_DIR "/examples/remote_io.gsd", "--json"}).out).size(), 2u);
}

TEST(Regs, prints_every_chip_in_every_format_and_marks_those_without_manual) {
    for (const dpchip::regmap::Traits& t : dpchip::regmap::kTraits) {
        const std::string chip{t.name};
        const Result text = run({"regs", "--chip", chip});
        EXPECT_EQ(text.code, 0);
        EXPECT_NE(text.out.find("Next_Dout_Buffer_Cmd"), std::string::npos) << chip;
        const Result markdown = run({"regs", "--chip", chip, "--format", "markdown"});
        EXPECT_TRUE(markdown.out.starts_with("# Registers of " + chip)) << chip;
        for (const std::string& out : {text.out, markdown.out}) EXPECT_EQ(out.find("No manual of this chip at hand") == std::string::npos, t.documented) << chip;
        const Json j = Json::parse(run({"regs", "--chip", chip, "--format", "json"}).out);
        EXPECT_EQ(j["documented"], t.documented) << chip;
        EXPECT_GE(j["control_parameters"].size(), 25u) << chip;
    }
}

TEST(ShowOptions, lists_each_option_with_default_and_section) {
    const Result r = run({"serve", "--show-options"});
    EXPECT_EQ(r.code, 0);
    for (const char* word : {"t_proc_clk", "default 144", "reference 1.6", "dummy_octet|sd1|sc"}) EXPECT_NE(r.out.find(word), std::string::npos) << word;
}

TEST(Demo, ends_by_itself_and_says_what_it_did) {
    const Result r = run({"demo"});
    EXPECT_EQ(r.code, 0) << r.out << r.err;
    for (const char* word : {"100 cycles", " 0 wrong", "served 1 slave", "Now try:"}) EXPECT_NE(r.out.find(word), std::string::npos) << word;
}

}  // namespace
