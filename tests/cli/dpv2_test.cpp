// SPDX-License-Identifier: Apache-2.0
// DP-V2 from TOML: publishers and links, isochronous cycles, clocks, Simple Sync Mode, a switch-over (docs/config.md).
#include <csignal>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <dpchip/cli/line_config.hpp>

#include "cli/process.hpp"

namespace {

using dpchip::test::Program;
using dpchip::test::Result;
using dpchip::test::run;
using Json = nlohmann::json;

TEST(SimDpv2, the_shipped_scenario_measures_samples_SYNCHs_and_clocks_over_a_switch_over) {
    const Result r = run({"sim", DPCHIP_SOURCE_DIR "/examples/drives.toml", "--json", "-q"});
    ASSERT_EQ(r.code, 0) << r.err << r.out;
    const Json j = Json::parse(r.out);
    EXPECT_EQ(j["violations"], 0);
    ASSERT_EQ(j["slaves"].size(), 3u);
    for (const Json& s : j["slaves"]) {
        EXPECT_EQ(s["lost"], 0) << s;
        EXPECT_EQ(s["wrong"], 0) << s;
        EXPECT_GT(s["compared"], 1900) << s;
        EXPECT_GE(s["dpv2"]["clock"]["times_set"], 18) << s;
        EXPECT_LT(std::abs(s["dpv2"]["clock"]["error_ns"].get<int>()), 2'000) << s;
    }
    EXPECT_NEAR(j["slaves"][0]["dpv2"]["clock"]["crystal_ppb"], 100'000, 2'000);
    EXPECT_NEAR(j["slaves"][1]["dpv2"]["clock"]["crystal_ppb"], -50'000, 2'000);
    for (const std::size_t drive : {0u, 1u}) EXPECT_GT(j["slaves"][drive]["dpv2"]["synchs"], 1900);
    for (const std::size_t subscriber : {1u, 2u}) {
        EXPECT_EQ(j["slaves"][subscriber]["dpv2"]["links"], 1);
        EXPECT_GT(j["slaves"][subscriber]["dpv2"]["samples"], 1900);
        EXPECT_EQ(j["slaves"][subscriber]["dpv2"]["link_errors"], 0);
    }
    EXPECT_EQ(j["slaves"][2]["dpv2"]["role"], "primary");
}

TEST(SimDpv2, tells_it_in_words_too) {
    const Result r = run({"sim", DPCHIP_SOURCE_DIR "/examples/drives.toml", "-q"});
    ASSERT_EQ(r.code, 0) << r.err;
    for (const char* words : {"publisher", "over 1 links, 0 times broken", "SYNCHs", "0 late", "clock ", "times outputs with a SYNCH", "primary"})
        EXPECT_NE(r.out.find(words), std::string::npos) << words << '\n' << r.out;
}

TEST(SimDpv2, refuses_what_the_GSD_does_not_have_and_links_to_nobody) {
    const std::string gsd = std::string{"gsd = \""} + DPCHIP_SOURCE_DIR + "/examples/";
    const std::string drive = "[[slave]]\n" + gsd + "drive.gsd\"\naddress = 5\n", io = "[[slave]]\n" + gsd + "remote_io.gsd\"\nmodules = [\"8 DI\"]\naddress = 6\n";
    struct Row { std::string text; const char* words; };
    for (const Row& row : {Row{io + "publisher = true\n", "Publisher_supp"}, Row{io + "[[slave.link]]\npublisher = 5\n", "Subscriber_supp"},
                           Row{drive + "prm_cmd = \"backup\"\n", "PrmCmd_supp"}, Row{drive + "simple_sync = true\n", "Isochron_Mode_supp"},
                           Row{drive + "[[slave.link]]\npublisher = 9\n", "slave 9 publishes nothing"},
                           Row{io + drive + "[[slave.link]]\npublisher = 6\noffset = 1\n", "1 octets only"},
                           Row{drive + "[[slave.link]]\noffset = 1\n", "without publisher"},
                           Row{drive + "[[master]]\nisochron = \"300us\"\n", "TDP_MIN"}, Row{drive + "[[master]]\njitter = \"1us\"\n", "needs isochron"},
                           Row{drive + "[[master]]\nclock_sync = \"15ms\"\n", "multiples of 10 ms"}}) {
        const Result r = run({"sim", "-", "--for", "10ms"}, row.text);
        EXPECT_EQ(r.code, 4) << row.text << r.out;
        EXPECT_NE(r.err.find(row.words), std::string::npos) << row.words << '\n' << r.err;
    }
}

const std::string kPublisherAndSubscriber = R"(
[[slave]]
name = "Axis"
gsd = ")" DPCHIP_SOURCE_DIR R"(/examples/dxb_station.gsd"
modules = ["8 in, 8 out"]
address = 10
publisher = true
io = "counter"
[[slave]]
name = "Gripper"
gsd = ")" DPCHIP_SOURCE_DIR R"(/examples/dxb_station.gsd"
modules = ["8 in, 8 out"]
address = 20
[[slave.link]]
publisher = 10
)";

TEST(LiveDpv2, a_subscriber_on_a_pty_hears_a_publisher_that_the_master_polls) {
    Program server{{"serve", "-", "--baud", "12M"}, kPublisherAndSubscriber};
    const std::string path = server.line().substr(10);
    const Result r = run({"master", "run", "-", "--line", path, "--baud", "12M", "--cycles", "30", "-q"}, kPublisherAndSubscriber);
    EXPECT_EQ(r.code, 0) << r.err << r.out;
    server.signal(SIGINT);
    EXPECT_EQ(server.wait(), 0);
    EXPECT_NE(server.out().find("publisher"), std::string::npos) << server.out();
    EXPECT_NE(server.out().find("samples over 1 links, 0 times broken"), std::string::npos) << server.out();
    EXPECT_EQ(server.out().find(" 0 samples"), std::string::npos) << server.out();
}

TEST(LiveDpv2, exact_time_is_refused_on_a_live_line) {
    for (const char* key : {"isochron = \"1ms\"", "clock_sync = \"100ms\""}) {
        const Result r = run({"master", "run", "-", "--line", "tcp:127.0.0.1:1"}, std::string{"[[master]]\naddress = 1\n"} + key + "\n" + kPublisherAndSubscriber);
        EXPECT_EQ(r.code, 4) << r.err;
        EXPECT_NE(r.err.find("exact time"), std::string::npos) << r.err;
    }
}

}  // namespace
