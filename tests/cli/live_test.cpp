// SPDX-License-Identifier: Apache-2.0
// The program against itself: `serve` in one process, `master` in another, over a pty and over TCP.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>

#include <unistd.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <dpchip/gsd/configuration.hpp>
#include <dpchip/gsd/parse.hpp>

#include "cli/process.hpp"
#include "support/shared.hpp"

namespace {

using dpchip::test::Program;
using dpchip::test::Result;
using dpchip::test::run;
using Json = nlohmann::json;
namespace fs = std::filesystem;
namespace gsd = dpchip::gsd;

/// Serves and drives the same slaves; both sides get `slaves`. What the master reports, as JSON.
struct Pair {
    Pair(const std::vector<std::string>& slaves, const std::string& line, const std::vector<std::string>& master, const std::string& baud = "12M") {
        std::vector<std::string> serve{"serve", "--line", line, "--baud", baud};
        serve.insert(serve.end(), slaves.begin(), slaves.end());
        Program server{serve};
        ready = server.line();
        const std::string place = ready.substr(ready.find('=') + 1);
        std::vector<std::string> drive{"master", "run", "--json", "--timeout", "60", "--baud", baud, "--line", ready.starts_with("ready tcp=") ? "tcp:" + place : place};
        drive.insert(drive.end(), slaves.begin(), slaves.end());
        drive.insert(drive.end(), master.begin(), master.end());
        const Result driven = run(drive);
        code = driven.code;
        words = driven.err;
        if (!driven.out.empty()) report = Json::parse(driven.out, nullptr, false);
        server.signal(SIGTERM);
        server_code = server.wait();
        summary = server.out();
    }
    /// Every slave exchanged data, its inputs were looked at and right, and no request was given up.
    void expect_good(std::size_t slaves, std::uint64_t cycles) const {
        ASSERT_EQ(code, 0) << words << summary;
        ASSERT_TRUE(report.is_object());
        EXPECT_TRUE(report["ok"]);
        EXPECT_GE(report["cycles"], cycles);
        ASSERT_EQ(report["slaves"].size(), slaves);
        for (const Json& s : report["slaves"]) {
            EXPECT_TRUE(s["data_exchange"]) << s;
            EXPECT_GE(s["exchanges"], cycles) << s;
            EXPECT_EQ(s["lost"], 0) << s;
            EXPECT_EQ(s["wrong"], 0) << s;
            const bool has_inputs = !s["inputs"].get<std::string>().empty();
            EXPECT_GE(s["compared"], has_inputs ? cycles - 5 : 0) << s;
        }
        EXPECT_EQ(server_code, 0);
    }

    std::string ready, words, summary;
    int code = -1, server_code = -1;
    Json report;
};

const std::vector<std::string> kRemoteIo{"--gsd", DPCHIP_SOURCE_DIR "/examples/remote_io.gsd", "--module", "16 DI / 16 DO", "--module", "2 AI, consistent",
                                         "--module", "2 AO, consistent", "--address", "5", "--io", "echo"};

TEST(ServeAndMaster, exchange_data_over_a_pty) {
    const Pair pair{kRemoteIo, "pty", {"--cycles", "100"}};
    EXPECT_TRUE(pair.ready.starts_with("ready pty=/dev/pts/")) << pair.ready;
    pair.expect_good(1, 100);
}

TEST(ServeAndMaster, exchange_data_at_the_default_rate_after_the_search) {
    const Pair pair{kRemoteIo, "pty", {"--cycles", "10"}, "19200"};
    pair.expect_good(1, 10);
}

TEST(ServeAndMaster, exchange_data_over_tcp) {
    const Pair pair{kRemoteIo, "tcp:127.0.0.1:0", {"--cycles", "100"}};
    EXPECT_TRUE(pair.ready.starts_with("ready tcp=127.0.0.1:")) << pair.ready;
    pair.expect_good(1, 100);
}

TEST(Serve, ends_on_a_signal_with_a_summary_and_without_its_link) {
    const fs::path link = fs::temp_directory_path() / ("dpchip_link_" + std::to_string(::getpid()));
    for (const int signal : {SIGTERM, SIGINT}) {
        Program server{{"serve", "--line", "pty:" + link.string(), "--gsd", "builtin:remote_io", "--module", "8 DI", "--address", "5"}};
        ASSERT_EQ(server.line(), "ready pty=" + link.string());
        EXPECT_TRUE(fs::is_symlink(link));
        server.signal(signal);
        EXPECT_EQ(server.wait(), 0);
        EXPECT_TRUE(server.out().starts_with("served 1 slave for ")) << server.out();
        EXPECT_FALSE(fs::exists(fs::symlink_status(link)));
    }
}

TEST(MasterRun, ends_with_1_when_a_slave_is_not_reached) {
    Program server{{"serve", "--baud", "12M", "--gsd", "builtin:remote_io", "--module", "8 DI", "--address", "5"}};
    const std::string path = server.line().substr(10);
    const Result r = run({"master", "run", "--line", path, "--baud", "12M", "--timeout", "2", "--gsd", "builtin:remote_io", "--module", "8 DI", "--address", "6"});
    EXPECT_EQ(r.code, 1);
    EXPECT_NE(r.err.find("does not answer"), std::string::npos) << r.err;
}

TEST(MasterRun, says_why_a_slave_refuses_its_configuration) {
    Program server{{"serve", "--baud", "12M", "--gsd", "builtin:remote_io", "--module", "8 DI", "--address", "5"}};
    const std::string path = server.line().substr(10);
    const Result r = run({"master", "run", "--line", path, "--baud", "12M", "--timeout", "5", "--gsd", "builtin:remote_io", "--module", "32 DI", "--address", "5"});
    EXPECT_EQ(r.code, 1);
    EXPECT_NE(r.err.find("configuration refused"), std::string::npos) << r.err;
}

TEST(MasterDiag, explains_a_slave_that_waits_for_its_parameters) {
    Program server{{"serve", "--baud", "12M", "--gsd", "builtin:remote_io", "--module", "8 DI", "--address", "5"}};
    const std::string path = server.line().substr(10);
    const Result r = run({"master", "diag", "--line", path, "--baud", "12M", "--station", "5", "--timeout", "60"});
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_NE(r.out.find("Prm_Req"), std::string::npos) << r.out;
    EXPECT_NE(r.out.find("FFF0H"), std::string::npos) << r.out;
    EXPECT_EQ(run({"master", "diag", "--line", path, "--baud", "12M", "--station", "9", "--timeout", "1"}).code, 1);
}

TEST(MasterScan, lists_stations_with_ident_numbers) {
    Program server{{"serve", "--baud", "12M", "--gsd", "builtin:remote_io", "--module", "8 DI", "--address", "5", "--gsd", "builtin:remote_io", "--module", "8 DO", "--address", "17"}};
    const std::string path = server.line().substr(10);
    const Result r = run({"master", "scan", "--line", path, "--baud", "12M", "--json"});
    ASSERT_EQ(r.code, 0) << r.err;
    const Json found = Json::parse(r.out, nullptr, false);
    ASSERT_EQ(found.size(), 2u) << r.out;
    EXPECT_EQ(found[0]["address"], 5);
    EXPECT_EQ(found[1]["address"], 17);
    EXPECT_EQ(found[1]["ident"], "0xFFF0");
}

TEST(Trace, of_a_live_line_is_read_back_by_decode) {
    const fs::path trace = fs::temp_directory_path() / ("dpchip_trace_" + std::to_string(::getpid()) + ".pcapng");
    Program server{{"serve", "--baud", "12M", "--trace", trace.string(), "--gsd", "builtin:remote_io", "--module", "8 DI", "--module", "8 DO", "--address", "5"}};
    const std::string path = server.line().substr(10);
    EXPECT_EQ(run({"master", "run", "--line", path, "--baud", "12M", "--cycles", "3", "--gsd", "builtin:remote_io", "--module", "8 DI", "--module", "8 DO", "--address", "5"}).code, 0);
    server.signal(SIGTERM);
    EXPECT_EQ(server.wait(), 0);
    const Result r = run({"decode", trace.string()});
    fs::remove(trace);
    EXPECT_EQ(r.code, 0) << r.err;
    for (const char* word : {"Set_Prm", "Chk_Cfg", "Slave_Diag", "Data_Exchange"}) EXPECT_NE(r.out.find(word), std::string::npos) << word;
    EXPECT_NE(r.err.find(" 0 damaged"), std::string::npos) << r.err;
}

// ---- real GSD files ----------------------------------------------------------------------------------------------

std::vector<std::string> slave_arguments(const std::string& file, const std::vector<std::string>& modules, int address) {
    std::vector<std::string> a{"--gsd", file};
    for (const std::string& m : modules) a.insert(a.end(), {"--module", m});
    a.insert(a.end(), {"--address", std::to_string(address), "--io", "echo"});
    return a;
}

struct Field {
    const char* file;
    const char* what;
    std::vector<std::string> modules;
    unsigned least_octets;
};

/// Files of the shared folder with modules chosen by number, and how much I/O that must give.
const std::vector<Field>& field_stations() {
    static const std::vector<Field> all{
        {"EASY4711.gsd", "EASY4711", {}, 1},
        {"SIEM000A.GSE", "ET 200B 16DI/16DO, compact", {}, 4},
        {"SIEM8008.GSE", "ET 200U, modular", {"#2", "#14", "#15", "#20", "#9"}, 20},
        {"SI0280B5.GSE", "MICROMASTER 4, a drive", {"#2"}, 24},
        {"SIE_2150.gse", "CPU 215-2, more than 100 octets", {"#4"}, 128},
        {"SIEM8070.GSD", "DP/DP Coupler, many modules", {"#5", "#10", "#5", "#10", "#15", "#20", "#5", "#10"}, 128},
    };
    return all;
}

TEST(FieldStations, reach_cyclic_exchange_over_a_pty_with_values_checked) {
    const auto folder = dpchip::test::shared_path("gsd", "cyclic exchange of EASY4711, ET 200B, ET 200U, a drive and a large station");
    if (!folder) return;
    for (const Field& f : field_stations()) {
        SCOPED_TRACE(f.what);
        const std::string file = (*folder / f.file).string();
        const gsd::Gsd g = gsd::load(file);
        const gsd::Configuration c = gsd::configure(g, f.modules);
        EXPECT_GE(c.input_octets + c.output_octets, f.least_octets);
        const Pair pair{slave_arguments(file, f.modules, 9), "pty", {"--cycles", "20"}};
        pair.expect_good(1, 20);
    }
}

/// The first module that makes a station with data of this file, or nothing where several have to work together.
std::optional<std::vector<std::string>> some_modules(const gsd::Gsd& g) {
    const auto fits = [&](const std::vector<std::string>& names) {
        try {
            const gsd::Configuration c = gsd::configure(g, names);
            return c.input_octets + c.output_octets != 0;
        } catch (const gsd::GsdError&) {
            return false;
        }
    };
    if (fits({})) return std::vector<std::string>{};
    for (std::size_t i = 1; i <= g.modules.size(); ++i)
        if (std::vector<std::string> one{"#" + std::to_string(i)}; fits(one)) return one;
    return std::nullopt;
}

std::string toml_slave(const std::string& file, const std::vector<std::string>& modules, int address) {
    std::string text = "[[slave]]\ngsd = \"" + file + "\"\naddress = " + std::to_string(address) + "\nio = \"echo\"\nmodules = [";
    for (const std::string& m : modules) text += '"' + m + "\",";
    return text + "]\nwatchdog_ms = 60000\n\n";
}

TEST(ThirtyTwoSlaves, on_one_pty_run_100_cycles_without_a_loss) {
    const auto folder = dpchip::test::shared_path("gsd", "GSD files from the field among the 32 slaves; the project's own are used");
    std::string text = "baud = \"12M\"\n\n[[master]]\naddress = 1\nmax_retry = 3\n\n";
    int address = 2;
    std::vector<fs::path> files;
    if (folder)
        for (const auto& entry : fs::directory_iterator(*folder)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) {
        if (address == 34) break;
        const gsd::Parsed parsed = gsd::read(file.string());
        const auto modules = parsed.ok() && parsed.gsd.station_type == 0 ? some_modules(parsed.gsd) : std::nullopt;
        if (modules) text += toml_slave(file.string(), *modules, address++);
    }
    EXPECT_TRUE(!folder || address == 34) << "only " << address - 2 << " files have a station of one module";
    const std::vector<std::string> own{"8 DI", "32 DI", "8 DO", "32 DO", "16 DI / 16 DO", "2 AI, consistent", "2 AO, consistent", "64 octets in / 64 out"};
    for (std::size_t n = 0; address < 34; ++n) text += toml_slave(DPCHIP_SOURCE_DIR "/examples/remote_io.gsd", {own[n % own.size()]}, address++);
    const fs::path file = fs::temp_directory_path() / ("dpchip_32_" + std::to_string(::getpid()) + ".toml");
    std::ofstream(file) << text;
    const Pair pair{{file.string()}, "pty", {"--cycles", "100"}};
    fs::remove(file);
    pair.expect_good(32, 100);
}

}  // namespace
