// SPDX-License-Identifier: Apache-2.0
// What the command line and its files can have wrong: a message that names it, and the exit code for it.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "cli/folder.hpp"
#include "cli/process.hpp"
#include "support/golden.hpp"

namespace {

using dpchip::test::Folder;
using dpchip::test::Program;
using dpchip::test::Result;
using dpchip::test::run;
namespace fs = std::filesystem;

struct Case {
    const char* what;
    std::vector<std::string> arguments;
    int code;
    const char* words;
};

const std::string kGsd = "builtin:remote_io";

TEST(BadCommandLine, is_refused_with_its_reason_and_exit_code) {
    const std::vector<Case> cases{
        {"no subcommand", {}, 2, "subcommand"},
        {"unknown subcommand", {"dance"}, 2, "subcommand"},
        {"unknown option", {"serve", "--dance"}, 2, "--dance"},
        {"nothing to serve", {"serve"}, 2, "no slave"},
        {"module that does not exist", {"serve", "--gsd", kGsd, "--module", "9 DI", "--address", "5"}, 2, "8 DI"},
        {"no module where there are several", {"serve", "--gsd", kGsd, "--address", "5"}, 2, "which modules"},
        {"address above 126", {"serve", "--gsd", kGsd, "--module", "8 DI", "--address", "127"}, 2, "0 to 126"},
        {"address that is no number", {"serve", "--gsd", kGsd, "--module", "8 DI", "--address", "five"}, 2, "a number"},
        {"no address", {"serve", "--gsd", kGsd, "--module", "8 DI"}, 2, "--address"},
        {"address twice", {"serve", "--gsd", kGsd, "--module", "8 DI", "--address", "5", "--gsd", kGsd, "--module", "8 DO", "--address", "5"}, 2, "twice"},
        {"module before its slave", {"serve", "--module", "8 DI"}, 2, "--gsd"},
        {"chip that does not exist", {"serve", "--gsd", kGsd, "--chip", "spc4"}, 2, "vpc3+c"},
        {"behaviour that does not exist", {"serve", "--gsd", kGsd, "--io", "dance"}, 2, "echo"},
        {"behaviour with more octets than inputs", {"serve", "--gsd", kGsd, "--module", "8 DI", "--address", "5", "--io", "hold:0102"}, 2, "inputs"},
        {"rate that does not exist", {"serve", "--gsd", kGsd, "--module", "8 DI", "--address", "5", "--baud", "115200"}, 2, "115200"},
        {"option that does not exist", {"serve", "--gsd", kGsd, "--module", "8 DI", "--address", "5", "--option", "speed=1"}, 2, "t_proc_clk"},
        {"option out of range", {"serve", "--gsd", kGsd, "--module", "8 DI", "--address", "5", "--option", "allow_gap_tbits=70000"}, 2, "0..65535"},
        {"malformed URI", {"serve", "--gsd", kGsd, "--module", "8 DI", "--address", "5", "--line", "smoke:signals"}, 2, "smoke:signals"},
        {"GSD that is not there", {"serve", "--gsd", "/nowhere/x.gsd", "--address", "5"}, 4, "/nowhere/x.gsd"},
        {"built-in GSD that is not there", {"serve", "--gsd", "builtin:x", "--address", "5"}, 4, "builtin:remote_io"},
        {"device that is not there", {"serve", "--gsd", kGsd, "--module", "8 DI", "--address", "5", "--line", "serial:/dev/nowhere"}, 5, "/dev/nowhere"},
        {"line that is not there", {"master", "scan", "--line", "/dev/nowhere"}, 5, "/dev/nowhere"},
        {"master without line", {"master", "run", "--gsd", kGsd, "--module", "8 DI", "--address", "5"}, 2, "--line"},
        {"parameter that does not exist", {"master", "run", "--line", "/dev/nowhere", "--gsd", kGsd, "--module", "8 DI", "--address", "5", "--parameter", "Colour=1"}, 2, "Colour"},
        {"scenario that is not there", {"sim", "/nowhere/s.toml"}, 4, "/nowhere/s.toml"},
        {"octets that are none", {"decode", "zz"}, 4, "zz"},
    };
    for (const Case& c : cases) {
        const Result r = run(c.arguments);
        EXPECT_EQ(r.code, c.code) << c.what << '\n' << r.err;
        EXPECT_NE(r.err.find(c.words), std::string::npos) << c.what << '\n' << r.err;
        EXPECT_EQ(r.out, "") << c.what;
    }
}

TEST(BadToml, is_refused_with_file_line_and_column) {
    struct TomlCase {
        const char* text;
        const char* place;
        const char* words;
    };
    const TomlCase cases[]{
        {"line = \"pty\"\ncolour = 1\n", ":2:1: error:", "unknown key \"colour\""},
        {"[[slave]]\ngsd = \"builtin:remote_io\"\naddress = 5\nmodule = \"8 DI\"\n", ":4:1: error:", "modules"},
        {"baud = 115200\n", ":1:8: error:", "ten rates"},
        {"baud = \n", ":1:", "error:"},
        {"[[slave]]\ngsd = \"builtin:remote_io\"\naddress = 127\n", ":3:11: error:", "0 .. 126"},
        {"[[slave]]\ngsd = \"builtin:remote_io\"\n", ":1:1: error:", "address"},
        {"[[slave]]\ngsd = \"builtin:remote_io\"\nmodules = [\"9 DI\"]\naddress = 5\n", ":1:1: error:", "does not exist"},
        {"[[slave]]\ngsd = \"builtin:remote_io\"\nmodules = [\"8 DI\"]\naddress = 5\n[[slave]]\ngsd = \"builtin:remote_io\"\nmodules = [\"8 DI\"]\naddress = 5\n", ":5:1: error:", "twice"},
        {"[[slave]]\ngsd = \"missing.gsd\"\naddress = 5\n", ":1:1: note:", "missing.gsd"},
        {"[[slave]]\ngsd = \"builtin:remote_io\"\naddress = 5\noptions = { speed = 1 }\n", ":4:", "speed"},
        {"[[event]]\nat = \"1ms\"\ndo = \"dance\"\n", ":3:6: error:", "power_off"},
        {"[[event]]\nat = \"soon\"\ndo = \"mode\"\n", ":2:6: error:", "250us"},
        {"[[master]]\naddress = 126\n", ":2:11: error:", "0 .. 125"},
        {"slave = 3\n", ":1:9: error:", "[[slave]]"},
    };
    const Folder folder;
    for (const TomlCase& c : cases) {
        const std::string file = folder.file("line.toml", c.text);
        const Result r = run({"serve", file});
        EXPECT_EQ(r.code, 4) << c.text << r.err;
        EXPECT_NE(r.err.find(file + c.place), std::string::npos) << c.text << r.err;
        EXPECT_NE(r.err.find(c.words), std::string::npos) << c.text << r.err;
    }
}

/// The demonstration station without Set_Slave_Add.
std::string without_set_slave_add() {
    std::string text = dpchip::test::read_file(DPCHIP_SOURCE_DIR "/examples/remote_io.gsd");
    const std::string key = "Set_Slave_Add_supp  = 1";
    const std::size_t at = text.find(key);
    return at == std::string::npos ? std::string{} : text.replace(at, key.size(), "Set_Slave_Add_supp  = 0");
}

TEST(BadInput, address_126_is_for_stations_that_know_set_slave_add) {
    const Folder folder;
    const std::string text = without_set_slave_add();
    ASSERT_FALSE(text.empty());
    const Result r = run({"serve", "--gsd", folder.file("fixed.gsd", text), "--module", "8 DI", "--address", "126"});
    EXPECT_EQ(r.code, 2);
    EXPECT_NE(r.err.find("Set_Slave_Add_supp"), std::string::npos) << r.err;
    Program good{{"serve", "--gsd", kGsd, "--module", "8 DI", "--address", "126"}};
    EXPECT_TRUE(good.line().starts_with("ready pty="));
}

TEST(BadInput, a_gsd_with_errors_is_named_by_line_and_column) {
    const Folder folder;
    std::string text = dpchip::test::read_file(DPCHIP_SOURCE_DIR "/examples/remote_io.gsd");
    const std::size_t at = text.find("Ident_Number        = 0xFFF0");
    ASSERT_NE(at, std::string::npos);
    text.replace(at, 28, "Ident_Number        = banana");
    const std::string file = folder.file("bad.gsd", text);
    for (const auto& arguments : {std::vector<std::string>{"gsd", file}, {"serve", "--gsd", file, "--module", "8 DI", "--address", "5"}}) {
        const Result r = run(arguments);
        EXPECT_EQ(r.code, 4);
        EXPECT_NE(r.err.find(file + ":"), std::string::npos) << r.err;
        EXPECT_NE(r.err.find("error:"), std::string::npos) << r.err;
    }
}

TEST(BadInput, a_pty_that_another_program_serves_is_busy) {
    const Folder folder;
    const std::string line = "pty:" + (folder.path / "dp0").string();
    const std::vector<std::string> arguments{"serve", "--gsd", kGsd, "--module", "8 DI", "--address", "5", "--line", line};
    Program first{arguments};
    ASSERT_EQ(first.line(), "ready pty=" + (folder.path / "dp0").string());
    const Result second = run(arguments);
    EXPECT_EQ(second.code, 5);
    EXPECT_NE(second.err.find("dp0"), std::string::npos) << second.err;
}

TEST(Help, teaches_every_subcommand_with_an_example_and_the_exit_codes) {
    for (const auto& arguments : std::vector<std::vector<std::string>>{{"serve"}, {"sim"}, {"master", "run"}, {"master", "diag"}, {"master", "scan"}, {"gsd"}, {"decode"}, {"regs"}, {"demo"}}) {
        std::vector<std::string> asked = arguments;
        asked.emplace_back("--help");
        const Result r = run(asked);
        EXPECT_EQ(r.code, 0) << arguments.front();
        EXPECT_NE(r.out.find("Example:\n  dpchip " + arguments.front()), std::string::npos) << r.out;
        EXPECT_NE(r.out.find("Exit codes:"), std::string::npos) << r.out;
    }
    EXPECT_EQ(run({"--version"}).code, 0);
}

}  // namespace
