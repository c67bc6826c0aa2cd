// SPDX-License-Identifier: Apache-2.0
// DP-V1 with the program: `serve` with records, identification, alarms and commands in one process, the verbs of `master`
// in others, over a pty; alarms in `sim`; what TOML files can have wrong.
#include <csignal>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/folder.hpp"
#include "cli/process.hpp"

namespace {

using dpchip::test::Folder;
using dpchip::test::Program;
using dpchip::test::Result;
using dpchip::test::run;
using Json = nlohmann::json;
namespace fs = std::filesystem;

const std::string kGsd = "builtin:dpv1_io";
const std::string kModule = "8 DI / 8 DO";

/// `serve` with one DP-V1 station at address 5, records and identification from a TOML file.
struct Station : testing::Test {
    Folder folder;
    std::string commands = (folder.path / "commands").string();
    std::unique_ptr<Program> server;
    std::string path;

    std::string toml() const {
        return "baud = \"12M\"\n[[slave]]\ngsd = \"builtin:dpv1_io\"\nmodules = [\"8 DI / 8 DO\"]\naddress = 5\nname = \"Pump\"\n"
               "[[slave.record]]\nslot = 1\nindex = 4\noctets = \"01 02 03 04\"\n"
               "[[slave.record]]\nslot = 1\nindex = 5\naccess = \"ro\"\ntext = \"dpchip\"\n"
               "[[slave.record]]\nslot = 1\nindex = 6\naccess = \"wo\"\nmax = 8\n"
               "[[slave.record]]\nslot = 2\nindex = 7\nfile = \"long.bin\"\n"
               "[slave.identification]\nmanufacturer_id = 0x1234\norder_id = \"PUMP-7\"\nserial_number = \"SN 42\"\n"
               "software_revision = \"V4.5.6\"\ntag_function = \"cooling\"\ntag_location = \"hall 3\"\n";
    }
    void SetUp() override {
        folder.file("long.bin", std::string(240, 'x'));
        server = std::make_unique<Program>(std::vector<std::string>{"serve", folder.file("line.toml", toml()), "--commands", commands});
        const std::string ready = server->line();
        ASSERT_TRUE(ready.starts_with("ready pty=")) << server->err();
        path = ready.substr(10);
    }
    void TearDown() override {
        server->signal(SIGTERM);
        EXPECT_EQ(server->wait(), 0) << server->err();
        EXPECT_FALSE(fs::exists(commands)) << "the FIFO stays behind";
    }
    Result master(const std::string& verb, const std::vector<std::string>& more) const {
        std::vector<std::string> all{"master", verb, "--line", path, "--baud", "12M", "--timeout", "20", "--address", "5"};
        all.insert(all.end(), more.begin(), more.end());
        return run(all);
    }
    void command(const std::string& words) const { std::ofstream(commands) << words << '\n'; }
};

const std::vector<std::vector<std::string>>& both_classes() {
    static const std::vector<std::vector<std::string>> all{
        {"--class", "1", "--gsd", kGsd, "--module", kModule}, {"--class", "1"}, {"--class", "2"}, {"--class", "2", "--gsd", kGsd, "--module", kModule}};
    return all;
}

std::vector<std::string> with(std::vector<std::string> a, const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

TEST_F(Station, is_read_and_written_with_class_1_and_class_2_with_and_without_its_GSD) {
    int n = 0;
    for (const auto& how : both_classes()) {
        SCOPED_TRACE(n);
        const Result text = master("read", with(how, {"--slot", "1", "--index", "5"}));
        EXPECT_EQ(text.code, 0) << text.err;
        EXPECT_EQ(text.out, "64 70 63 68 69 70\n");
        const std::string octets = "A0B1C2D" + std::to_string(n++);
        const Result written = master("write", with(how, {"--slot", "1", "--index", "4", "--data", octets}));
        EXPECT_EQ(written.code, 0) << written.err;
        EXPECT_EQ(written.out, "4 octets taken\n");
        const Result back = master("read", with(how, {"--slot", "1", "--index", "4", "--json"}));
        ASSERT_EQ(back.code, 0) << back.err;
        const Json j = Json::parse(back.out);
        EXPECT_EQ(j["length"], 4);
        EXPECT_EQ(j["octets"], "A0 B1 C2 D" + std::to_string(n - 1));
    }
    const Result file = master("read", {"--class", "2", "--slot", "2", "--index", "7", "--json"});
    EXPECT_EQ(Json::parse(file.out)["length"], 240) << file.err;
    EXPECT_EQ(master("read", {"--class", "2", "--slot", "2", "--index", "7", "--length", "3"}).out, "78 78 78\n");
}

TEST_F(Station, says_in_words_and_octets_why_it_refuses) {
    struct Refusal {
        const char* verb;
        std::vector<std::string> what;
        const char* words;
    };
    const Refusal refusals[]{
        {"read", {"--slot", "1", "--index", "99"}, "slave 5: DS_Read slot 1 index 99: refused: invalid index (access; 80H B0H 00H)"},
        {"read", {"--slot", "9", "--index", "1"}, "DS_Read slot 9 index 1: refused: invalid slot (access; 80H B2H 00H)"},
        {"read", {"--slot", "1", "--index", "6"}, "refused: access denied (access; 80H B6H 00H)"},
        {"read", {"--slot", "0", "--index", "255"}, "refused: state conflict (access; 80H B5H 00H)"},
        {"write", {"--slot", "1", "--index", "5", "--data", "00"}, "DS_Write slot 1 index 5: refused: access denied (access; 80H B6H 00H)"},
        {"write", {"--slot", "1", "--index", "6", "--data", "000000000000000000"}, "refused: write length error (access; 80H B1H 00H)"},
        {"identify", {"--slot", "3"}, "I&M0: refused: invalid index (access; 80H B0H 00H)"},
    };
    for (const Refusal& r : refusals)
        for (const char* service_class : {"1", "2"}) {
            const Result result = master(r.verb, with(r.what, {"--class", service_class}));
            EXPECT_EQ(result.code, 1) << r.words;
            EXPECT_NE(result.err.find(r.words), std::string::npos) << result.err;
            EXPECT_EQ(result.out, "");
        }
}

TEST_F(Station, tells_who_it_is) {
    for (const char* service_class : {"1", "2"}) {
        const Result r = master("identify", {"--class", service_class});
        ASSERT_EQ(r.code, 0) << r.err;
        for (const char* words : {"I&M0", "PUMP-7", "SN 42", "V4.5.6", "1234H", "I&M1", "cooling", "hall 3"})
            EXPECT_NE(r.out.find(words), std::string::npos) << words << '\n' << r.out;
    }
    const Json j = Json::parse(master("identify", {"--class", "2", "--json"}).out);
    EXPECT_TRUE(j.contains("I&M0") && j.contains("I&M3"));
    EXPECT_TRUE(j["I&M0"]["octets"].get<std::string>().find("12 34") != std::string::npos) << j["I&M0"];
}

TEST_F(Station, is_found_by_a_scan) {
    const Result r = run({"master", "scan", "--line", path, "--baud", "12M", "--json"});
    ASSERT_EQ(r.code, 0) << r.err;
    const Json found = Json::parse(r.out);
    ASSERT_EQ(found.size(), 1u) << r.out;
    EXPECT_EQ(found[0]["address"], 5);
    EXPECT_EQ(found[0]["ident"], "0xFFF1");
}

/// A line of `master alarms --json`.
Json next_alarm(Program& alarms) {
    const std::string line = alarms.line();
    return line.empty() ? Json{} : Json::parse(line, nullptr, false);
}

TEST_F(Station, raises_updates_and_clears_alarms_on_command_and_the_master_acknowledges_them) {
    Program alarms{{"master", "alarms", "--line", path, "--baud", "12M", "--address", "5", "--gsd", kGsd, "--module", kModule, "--json", "--count", "4"}};
    ASSERT_TRUE(alarms.said("its alarms are enabled")) << alarms.err();
    command("# a comment, and a blank line\n\nalarm slave=5 type=diagnostic slot=1 specifier=appears octets=\"01 00\"");
    const Json appears = next_alarm(alarms);
    EXPECT_EQ(appears["text"], "Diagnostic_Alarm slot 1 Seq_Nr 0 appears: 01 00");
    EXPECT_EQ(appears["octets"], "01 00");
    EXPECT_EQ(appears["details"], Json::array({"bit 24 \"Load voltage missing\""}));
    command("alarm slave=Pump type=update slot=1 octets=0300");
    EXPECT_TRUE(next_alarm(alarms)["text"].get<std::string>().starts_with("Update_Alarm slot 1 Seq_Nr 1"));
    command("alarm slave=5 type=diagnostic slot=1 specifier=disappears");
    EXPECT_TRUE(next_alarm(alarms)["text"].get<std::string>().starts_with("Diagnostic_Alarm slot 1 Seq_Nr 2 disappears"));
    command("status slave=5 type=modul_status octets=04");
    const Json status = next_alarm(alarms);
    EXPECT_EQ(status["kind"], "status");
    EXPECT_TRUE(status["text"].get<std::string>().starts_with("Modul_Status")) << status;
    EXPECT_EQ(alarms.wait(), 0) << alarms.err();
    EXPECT_TRUE(server->said("Diagnostic_Alarm slot 1 Seq_Nr 2 acknowledged")) << server->err();
    EXPECT_NE(server->err().find("Update_Alarm slot 1 Seq_Nr 1 acknowledged"), std::string::npos) << server->err();
}

TEST_F(Station, sets_and_clears_its_diagnosis_on_command) {
    command("diagnosis slave=5 module_status=ok,fault,no_module identifiers=1 octets=\"81 42 26\"");
    ASSERT_TRUE(server->said("diagnosis set")) << server->err();
    const auto diagnosis = [&] { return run({"master", "diag", "--line", path, "--baud", "12M", "--station", "5", "--timeout", "60"}); };
    const Result set = diagnosis();
    EXPECT_EQ(set.code, 0) << set.err;
    for (const char* words : {"Ext_Diag", "Modul_Status", "no module", "line break"}) EXPECT_NE(set.out.find(words), std::string::npos) << words << '\n' << set.out;
    command("diagnosis slave=5");
    ASSERT_TRUE(server->said("diagnosis cleared")) << server->err();
    EXPECT_EQ(diagnosis().out.find("Ext_Diag"), std::string::npos);
}

TEST_F(Station, says_what_is_wrong_with_a_command_and_goes_on) {
    const std::pair<const char*, const char*> bad[]{
        {"dance slave=5", "\"dance\" is none of"},
        {"alarm slave=6 type=diagnostic", "neither the address nor the name"},
        {"alarm slave=5", "needs type"},
        {"alarm slave=5 type=diagnostic slot=255", "255 is not in 0 .. 254"},
        {"alarm slave=5 type=pump", "\"pump\" is none of"},
        {"alarm slave=5 type=diagnostic specifier=maybe", "appears"},
        {"alarm slave=5 type=diagnostic colour=red", "unknown key \"colour\""},
        {"alarm slave=5 type=diagnostic octets=0", "hexadecimal"},
        {"alarm slave=5 type", "KEY=VALUE"},
        {"alarm slave=\"5", "quote"},
        {"alarm slave=5 type=process octets=" , "no data exchange with DPV1_Enable"},
        {"alarm slave=5 type=127", "\"127\" is none of"},
        {"power_off slave=5", "is no command"},
        {"diagnosis slave=5 octets=00112233445566778899AABBCCDDEEFF00112233445566778899AABBCCDDEEFF", "kept for alarms"},
    };
    for (const auto& [words, answer] : bad) {
        command(words);
        EXPECT_TRUE(server->said(answer)) << words << '\n' << server->err();
    }
    EXPECT_NE(server->err().find(commands + ":1:1: error:"), std::string::npos) << server->err();
}

TEST(Serve, does_the_events_of_its_slaves_and_leaves_the_masters_out) {
    Program server{{"serve", "-", "--line", "pty"},
                   "[[slave]]\ngsd = \"builtin:dpv1_io\"\nmodules = [\"8 DI / 8 DO\"]\naddress = 5\n"
                   "[[event]]\nat = \"1ms\"\ndo = \"diagnosis\"\nslave = 5\nchannels = [{ identifier = 1, channel = 2, direction = \"input\", type = \"bit\", error = \"short circuit\" }]\n"
                   "[[event]]\nat = \"2ms\"\ndo = \"alarm\"\nslave = 5\ntype = \"plug\"\n"
                   "[[event]]\nat = \"3ms\"\ndo = \"io\"\nslave = 5\nio = \"counter\"\n"
                   "[[event]]\nat = \"4ms\"\ndo = \"mode\"\nmode = \"clear\"\n"};
    ASSERT_TRUE(server.line().starts_with("ready pty="));
    EXPECT_TRUE(server.said("io counter")) << server.err();
    for (const char* words : {"diagnosis set", "Plug_Alarm", "nobody hears it", "serve leaves it out"}) EXPECT_NE(server.err().find(words), std::string::npos) << words << server.err();
    server.signal(SIGTERM);
    EXPECT_EQ(server.wait(), 0);
}

TEST_F(Station, is_driven_by_master_run_which_acknowledges_its_alarms) {
    std::string slave = toml();
    slave.insert(slave.find("name ="), "alarms = \"all\"\nalarm_sequence = 2\n");
    Program driving{{"master", "run", folder.file("master.toml", slave), "--line", path}};
    ASSERT_TRUE(driving.said("data exchange")) << driving.err();
    // Before the first Data_Exchange nobody hears anything: status messages tell when it has come.
    for (int slot = 0; slot < 255 && server->err().find(" raised") == std::string::npos; ++slot) {
        command("status slave=5 type=32 slot=" + std::to_string(slot));
        ASSERT_TRUE(server->said("slot " + std::to_string(slot))) << server->err();
    }
    for (int n = 0; n < 5; ++n) {
        command("alarm slave=5 type=process slot=" + std::to_string(n));
        ASSERT_TRUE(driving.said("Process_Alarm slot " + std::to_string(n) + " Seq_Nr " + std::to_string(n))) << driving.err();
        ASSERT_TRUE(server->said("Process_Alarm slot " + std::to_string(n) + " Seq_Nr " + std::to_string(n) + " acknowledged")) << server->err();
    }
    driving.signal(SIGINT);
    EXPECT_EQ(driving.wait(), 0) << driving.err();
}

TEST(Serve, gives_a_newcomer_a_record_on_the_command_line) {
    Program server{{"serve", "--gsd", kGsd, "--module", kModule, "--address", "7", "--record", "1:4=01020304", "--baud", "12M", "--line", "pty"}};
    const std::string path = server.line().substr(10);
    const Result r = run({"master", "read", "--line", path, "--baud", "12M", "--address", "7", "--slot", "1", "--index", "4", "--class", "2"});
    EXPECT_EQ(r.out, "01 02 03 04\n") << r.err;
    for (const char* bad : {"1:4", "1=00", "255:1=00", "1:256=00", "1:4=", "1:4=0", "1:4=zz"}) {
        const Result refused = run({"serve", "--gsd", kGsd, "--module", kModule, "--address", "7", "--record", bad});
        EXPECT_EQ(refused.code, 2) << bad;
        EXPECT_NE(refused.err.find("SLOT:INDEX=HEX"), std::string::npos) << refused.err;
    }
}

TEST(Master, asks_nothing_of_a_station_without_DP_V1) {
    Program server{{"serve", "--gsd", "builtin:remote_io", "--module", "8 DI", "--address", "5", "--baud", "12M", "--line", "pty"}};
    const std::string path = server.line().substr(10);
    const std::vector<std::string> read{"master", "read", "--line", path, "--baud", "12M", "--timeout", "5", "--address", "5", "--slot", "1", "--index", "4"};
    const Result known = run(with(read, {"--gsd", "builtin:remote_io", "--module", "8 DI"}));
    EXPECT_EQ(known.code, 1);
    EXPECT_NE(known.err.find("has no acyclic services of class 1"), std::string::npos) << known.err;
    const Result unknown = run(with(read, {"--class", "2"}));
    EXPECT_EQ(unknown.code, 1);
    EXPECT_NE(unknown.err.find("the SAP is closed (RS)"), std::string::npos) << unknown.err;
    const Result absent = run({"master", "read", "--line", path, "--baud", "12M", "--timeout", "1", "--address", "9", "--slot", "1", "--index", "4"});
    EXPECT_EQ(absent.code, 1);
    EXPECT_NE(absent.err.find("slave 9: does not answer"), std::string::npos) << absent.err;
}

// ---- in virtual time ---------------------------------------------------------------------------------------------

std::string scenario(const std::string& slave, const std::string& events) {
    return "baud = \"12M\"\nduration = \"100ms\"\n[[slave]]\ngsd = \"builtin:dpv1_io\"\nmodules = [\"8 DI / 8 DO\"]\naddress = 5\nname = \"Pump\"\n" + slave + events;
}
std::string event(const std::string& at, const std::string& deed) { return "[[event]]\nat = \"" + at + "\"\nslave = 5\n" + deed; }

TEST(SimAlarms, are_received_acknowledged_and_told_in_words) {
    const Result r = run({"sim", "-"}, scenario("alarms = \"all\"\n", event("50ms", "do = \"alarm\"\ntype = \"diagnostic\"\nslot = 1\nspecifier = \"appears\"\noctets = \"01 00\"\n") +
                                                                        event("55ms", "do = \"alarm\"\ntype = \"update\"\nslot = 1\n") +
                                                                        event("60ms", "do = \"alarm\"\ntype = \"diagnostic\"\nslot = 1\nspecifier = \"disappears\"\n") +
                                                                        event("70ms", "do = \"status\"\ntype = \"status_message\"\n")));
    ASSERT_EQ(r.code, 0) << r.err;
    for (const char* words : {"slave 5 (Pump): Diagnostic_Alarm slot 1 Seq_Nr 0 appears: 01 00", "Load voltage missing", "Update_Alarm slot 1 Seq_Nr 1",
                              "Diagnostic_Alarm slot 1 Seq_Nr 2 disappears", "Status_Message", "3 alarms received, 3 acknowledged; 1 status messages; 0 that"})
        EXPECT_NE(r.out.find(words), std::string::npos) << words << '\n' << r.out;
    EXPECT_NE(r.err.find("Seq_Nr 2 acknowledged"), std::string::npos) << r.err;
}

TEST(SimAlarms, of_the_shipped_scenario_are_all_acknowledged) {
    const Result r = run({"sim", DPCHIP_SOURCE_DIR "/examples/dpv1.toml", "--json", "-q"});
    ASSERT_EQ(r.code, 0) << r.err;
    const Json j = Json::parse(r.out);
    EXPECT_TRUE(j["ok"]);
    EXPECT_EQ(j["alarms_acknowledged"], 4);
    std::vector<std::string> alarms;
    for (const Json& a : j["alarms"])
        if (a["kind"] == "alarm") alarms.push_back(a["text"]);
    EXPECT_EQ(alarms, (std::vector<std::string>{"Diagnostic_Alarm slot 1 Seq_Nr 0 appears: 01 00", "Diagnostic_Alarm slot 1 Seq_Nr 1 disappears",
                                                "Pull_Alarm slot 2 Seq_Nr 2 appears", "Plug_Alarm slot 2 Seq_Nr 3 disappears"}));
    EXPECT_TRUE(j["alarms"].back()["text"].get<std::string>().starts_with("Status_Message")) << j["alarms"];
    EXPECT_EQ(j["slaves"][0]["lost"], 0);
}

TEST(SimAlarms, wait_for_each_other_in_type_mode_and_not_in_sequence_mode) {
    std::string burst;
    for (int n = 0; n < 6; ++n) burst += event("50ms", "do = \"alarm\"\ntype = \"process\"\nslot = " + std::to_string(n) + "\n");
    for (const char* mode : {"alarms = [\"process\"]\n", "alarms = [\"process\"]\nalarm_sequence = 4\n"}) {
        const Result r = run({"sim", "-", "--json", "-q"}, scenario(mode, burst));
        ASSERT_EQ(r.code, 0) << r.err;
        const Json j = Json::parse(r.out);
        ASSERT_EQ(j["alarms"].size(), 6u);
        EXPECT_EQ(j["alarms_acknowledged"], 6);
        for (std::size_t n = 0; n < 6; ++n)
            EXPECT_TRUE(j["alarms"][n]["text"].get<std::string>().starts_with("Process_Alarm slot " + std::to_string(n) + " Seq_Nr " + std::to_string(n))) << j["alarms"][n];
    }
}

TEST(SimAlarms, that_nobody_has_enabled_are_counted_as_unheard) {
    const Result r = run({"sim", "-"}, scenario("alarms = [\"process\"]\n", event("50ms", "do = \"alarm\"\ntype = \"pull\"\n") + event("50us", "do = \"alarm\"\ntype = \"process\"\n")));
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_NE(r.err.find("the master has not enabled this type"), std::string::npos) << r.err;
    EXPECT_NE(r.err.find("nobody hears it"), std::string::npos) << r.err;
    EXPECT_NE(r.out.find("0 alarms received, 0 acknowledged; 0 status messages; 2 that the master did not hear of"), std::string::npos) << r.out;
}

TEST(SimDiagnosis, says_which_modules_and_channels) {
    const Folder folder;
    const std::string trace = (folder.path / "trace.pcapng").string();
    const Result r = run({"sim", "-", "-q", "--trace", trace},
                         scenario("", event("50ms", "do = \"diagnosis\"\nmodule_status = [\"ok\", \"wrong_module\"]\nidentifiers = [0, 9]\n"
                                                    "channels = [{ identifier = 9, channel = 3, direction = \"both\", type = \"word\", error = 16 }]\n")));
    EXPECT_EQ(r.code, 0) << r.err;
    const Result decoded = run({"decode", trace, "--details", "--gsd", kGsd});
    for (const char* words : {"Modul_Status", "wrong module", "Reference value out of range"})
        EXPECT_NE(decoded.out.find(words), std::string::npos) << words << decoded.err;
}

// ---- files -------------------------------------------------------------------------------------------------------

TEST(BadDpv1Toml, is_refused_with_file_line_and_column) {
    const std::string slave = "[[slave]]\ngsd = \"builtin:dpv1_io\"\nmodules = [\"8 DI / 8 DO\"]\naddress = 5\n";
    const std::string plain = "[[slave]]\ngsd = \"builtin:remote_io\"\nmodules = [\"8 DI\"]\naddress = 5\n";
    const std::string at = "[[event]]\nat = \"1ms\"\nslave = 5\n";
    struct TomlCase {
        std::string text;
        const char* place;
        const char* words;
    };
    const TomlCase cases[]{
        {slave + "[[slave.record]]\noctets = \"00\"\n", ":5:1: error:", "without index"},
        {slave + "[[slave.record]]\nindex = 256\noctets = \"00\"\n", ":6:9: error:", "0 .. 255"},
        {slave + "[[slave.record]]\nslot = 255\nindex = 1\noctets = \"00\"\n", ":6:8: error:", "0 .. 254"},
        {slave + "[[slave.record]]\nindex = 1\noctets = \"0\"\n", ":7:10: error:", "hexadecimal"},
        {slave + "[[slave.record]]\nindex = 1\n", ":5:1: error:", "needs octets, text, file or max"},
        {slave + "[[slave.record]]\nindex = 1\noctets = \"00\"\ntext = \"a\"\n", ":5:1: error:", "not several of them"},
        {slave + "[[slave.record]]\nindex = 1\noctets = \"0011\"\nmax = 1\n", ":8:7: error:", "the record is longer"},
        {slave + "[[slave.record]]\nindex = 1\naccess = \"none\"\nmax = 1\n", ":7:10: error:", "ro, rw, wo"},
        {slave + "[[slave.record]]\nindex = 1\ntext = \"" + std::string(241, 'a') + "\"\n", ":5:1: error:", "240 are possible"},
        {slave + "[[slave.record]]\nindex = 1\nmax = 1\n[[slave.record]]\nindex = 1\nmax = 1\n", ":8:1: error:", "a record already"},
        {slave + "[[slave.record]]\nindex = 1\nfile = \"missing.bin\"\n", "", "missing.bin"},
        {slave + "[[slave.record]]\nindex = 1\nmax = 1\ncolour = 1\n", ":8:1: error:", "unknown key \"colour\" in [[slave.record]]"},
        {slave + "[slave.identification]\norder_id = \"123456789012345678901\"\n", ":6:12: error:", "more than 20 letters"},
        {slave + "[slave.identification]\nsoftware_revision = \"1.2\"\n", ":6:21: error:", "V1.0.2"},
        {slave + "[slave.identification]\nmanufacturer_id = 65536\n", ":6:19: error:", "0 .. 65535"},
        {slave + "[slave.identification]\ncolour = 1\n", ":6:1: error:", "unknown key"},
        {slave + "alarms = \"some\"\n", ":5:10: error:", "pull_plug"},
        {slave + "alarm_sequence = 4\n", ":5:18: error:", "without alarms"},
        {slave + "alarms = \"all\"\nalarm_sequence = 5\n", ":6:18: error:", "2, 4, 8, 12, 16, 24 and 32"},
        {plain + "alarms = \"all\"\n", ":5:10: error:", "supports none"},
        {slave + at + "do = \"alarm\"\n", ":5:1: error:", "needs type"},
        {slave + at + "do = \"alarm\"\ntype = 7\n", ":9:8: error:", "32 .. 126"},
        {slave + at + "do = \"alarm\"\ntype = 32\nslot = 255\n", ":10:8: error:", "0 .. 254"},
        {slave + at + "do = \"alarm\"\ntype = 32\nspecifier = 1\n", ":10:13: error:", "text in quotes"},
        {slave + at + "do = \"status\"\ntype = \"red\"\n", ":9:8: error:", "modul_status"},
        {slave + at + "do = \"status\"\ntype = 32\nadd_ack = true\n", ":10:1: error:", "unknown key"},
        {slave + at + "do = \"diagnosis\"\nmodule_status = \"fine\"\n", ":9:17: error:", "wrong_module"},
        {slave + at + "do = \"diagnosis\"\nidentifiers = [0, 300]\n", ":9:19: error:", "0 .. 243"},
        {slave + at + "do = \"diagnosis\"\nchannels = [{ identifier = 1 }]\n", ":9:13: error:", "without error"},
        {slave + at + "do = \"diagnosis\"\nchannels = [{ error = \"boredom\" }]\n", ":9:23: error:", "line break"},
        {plain + at + "do = \"alarm\"\ntype = 32\n", ":5:1: error:", "has no alarms"},
    };
    const Folder folder;
    for (const TomlCase& c : cases) {
        const std::string file = folder.file("line.toml", c.text);
        const Result r = run({"sim", file, "--for", "10ms"});
        EXPECT_EQ(r.code, 4) << c.text << r.err;
        EXPECT_NE(r.err.find(std::string{*c.place != 0 ? file : ""} + c.place), std::string::npos) << c.text << r.err;
        EXPECT_NE(r.err.find(c.words), std::string::npos) << c.text << r.err;
    }
}

}  // namespace
