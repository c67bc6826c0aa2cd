// SPDX-License-Identifier: Apache-2.0
// `dpchip sim --vcd` and `dpchip bench --uart` as people use them.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "cli/process.hpp"

namespace {

using dpchip::test::Program;
using dpchip::test::Result;
using dpchip::test::run;

const std::string kScenario = DPCHIP_SOURCE_DIR "/examples/scenario.toml";

std::string path_of(const std::string& name) {
    const std::filesystem::path folder = std::filesystem::path{DPCHIP_BINARY_DIR} / "tests";
    std::filesystem::create_directories(folder);
    return (folder / name).string();
}
std::string read(const std::string& path) {
    std::ifstream in{path, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

/// What a strict reader would find: ids declared, times that grow, values that fit.
struct Dump {
    std::set<std::string> names, texts;
    long long first = -1, last = -1;
    std::size_t changes = 0;
    bool whole = false;

    explicit Dump(const std::string& text) {
        std::istringstream in{text};
        std::set<std::string> ids;
        std::string word;
        while (in >> word && word != "$enddefinitions")
            if (word == "$var") {
                std::string type, width, id, name;
                in >> type >> width >> id >> name;
                EXPECT_TRUE(ids.insert(id).second);
                names.insert(name);
            }
        EXPECT_EQ(word, "$enddefinitions");
        in >> word;
        while (in >> word) {
            if (word == "$dumpvars" || word == "$end") continue;
            if (word[0] == '#') {
                const long long at = std::stoll(word.substr(1));
                EXPECT_GT(at, last);
                if (first < 0) first = at;
                last = at;
                continue;
            }
            ++changes;
            std::string id = word.substr(1);
            if (word[0] == 's') texts.insert(word.substr(1));
            if (word[0] == 'b' || word[0] == 's') in >> id;
            EXPECT_EQ(ids.count(id), 1u) << word;
        }
        whole = !text.empty() && text.back() == '\n';
    }
};

TEST(SimVcd, draws_the_line_the_pins_and_the_state_machines_of_every_slave) {
    const std::string file = path_of("all.vcd");
    const Result r = run({"sim", kScenario, "--cycles", "3", "--vcd", file});
    ASSERT_EQ(r.code, 0) << r.err;
    const Dump d{read(file)};
    for (const char* name : {"level", "TXD", "RXD", "RTS", "X_INT", "XDATAEXCH_SYNC", "WD_State", "DP_State", "Dout_Buffer_SM", "New_Prm_Data", "Go_Leave_DATA_EXCH"})
        EXPECT_EQ(d.names.count(name), 1u) << name;
    for (const char* state : {"BAUD_SEARCH", "BAUD_CONTROL", "DP_CONTROL", "WAIT-PRM", "WAIT-CFG", "DATA-EXCH", "12M"}) EXPECT_EQ(d.texts.count(state), 1u) << state;
    EXPECT_EQ(d.first, 0);
    EXPECT_GT(d.changes, 3000u);
    const std::string again = path_of("again.vcd");
    ASSERT_EQ(run({"sim", kScenario, "--cycles", "3", "--vcd", again}).code, 0);
    EXPECT_EQ(read(file), read(again)) << "the same scenario draws the same picture";
}

TEST(SimVcd, a_window_with_chosen_signals_and_a_coarser_scale) {
    const std::string file = path_of("window.vcd");
    const Result r = run({"sim", kScenario, "--cycles", "3", "--vcd", file, "--signals", "line.*,Press.?XD", "--signals", "Oven.DP_State", "--from", "2ms", "--to", "3ms", "--vcd-timescale", "10ns"});
    ASSERT_EQ(r.code, 0) << r.err;
    const Dump d{read(file)};
    EXPECT_EQ(d.names, (std::set<std::string>{"level", "TXD", "RXD", "DP_State"}));
    EXPECT_EQ(d.first, 200'000);
    EXPECT_LE(d.last, 300'000);
    EXPECT_NE(read(file).find("$timescale 10 ns $end"), std::string::npos);
}

TEST(SimVcd, a_slave_without_power_is_unknown) {
    const std::string file = path_of("power.vcd");
    ASSERT_EQ(run({"sim", kScenario, "--vcd", file, "--signals", "Oven.DP_State", "--from", "499ms"}).code, 0);
    const std::string text = read(file);
    const std::size_t dark = text.find("s? ");
    ASSERT_NE(dark, std::string::npos);
    EXPECT_NE(text.find("#500000000000\ns? "), std::string::npos) << text;
    EXPECT_NE(text.find("sDATA-EXCH", dark), std::string::npos);
}

TEST(SimVcd, wrong_arguments_are_refused_with_what_would_be_right) {
    struct Row { std::vector<std::string> more; const char* words; };
    const std::string file = path_of("never.vcd");
    for (const Row& row : std::vector<Row>{
             {{"--vcd", file, "--signals", "Presse.*"}, "There are:"},
             {{"--vcd", file, "--vcd-timescale", "3ns"}, "100ns"},
             {{"--vcd", file, "--from", "soon"}, "2ms"},
             {{"--vcd", file, "--from", "3ms", "--to", "2ms"}, "not before"},
             {{"--from", "3ms"}, "--vcd FILE"},
             {{"--signals", "line.*"}, "--vcd FILE"},
         }) {
        std::vector<std::string> all{"sim", kScenario, "--cycles", "1"};
        all.insert(all.end(), row.more.begin(), row.more.end());
        const Result r = run(all);
        EXPECT_EQ(r.code, 2) << r.err;
        EXPECT_NE(r.err.find(row.words), std::string::npos) << r.err;
    }
    EXPECT_EQ(run({"sim", kScenario, "--cycles", "1", "--vcd", "/no/such/folder/x.vcd"}).code, 1);
}

TEST(SimVcd, an_interrupted_simulation_leaves_a_whole_file) {
    const std::string file = path_of("interrupted.vcd");
    const std::string scenario = path_of("long.toml");
    std::ofstream{scenario} << "baud = \"12M\"\nduration = \"3600s\"\n[[master]]\naddress = 1\n[[slave]]\nname = \"Press\"\ngsd = \"" DPCHIP_SOURCE_DIR
                               "/examples/remote_io.gsd\"\nmodules = [\"16 DI / 16 DO\"]\naddress = 5\n[[event]]\nat = \"5ms\"\ndo = \"global_control\"\ncommand = [\"Sync\"]\ngroups = 0\n";
    Program p{{"sim", scenario, "--vcd", file, "--to", "4ms"}};
    ASSERT_TRUE(p.said("global_control"));
    p.signal(SIGINT);
    static_cast<void>(p.wait());
    EXPECT_NE(p.err().find("stopped after"), std::string::npos) << p.err();
    const Dump d{read(file)};
    EXPECT_TRUE(d.whole);
    EXPECT_EQ(d.last, 4'000'000'000);
}

TEST(BenchUart, draws_the_picture_of_the_docs) {
    const std::string file = path_of("uart_tolerance.svg");
    const Result r = run({"bench", "--uart", "--svg", file});
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_NE(r.out.find("without distortion: -2.0 % to 2.2 % of the rate; at the exact rate: -25 % to 50 % of a bit"), std::string::npos) << r.out;
    EXPECT_EQ(read(file), read(DPCHIP_SOURCE_DIR "/docs/uart_tolerance.svg"));
    EXPECT_EQ(run({"bench", "--svg", file}).code, 2);
}

}  // namespace
