// SPDX-License-Identifier: Apache-2.0
// tools/wireshark/profibus.lua, run by tshark on captures that our own writer made.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <dpchip/trace/pcapng.hpp>

#include "octets.hpp"

namespace dpchip::trace {
namespace {

std::vector<std::string> output_lines(const std::string& command) {
    std::vector<std::string> lines;
    FILE* pipe = ::popen(command.c_str(), "r");
    if (pipe == nullptr) return lines;
    std::string text;
    std::array<char, 4096> buffer{};
    for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) text.append(buffer.data(), n);
    EXPECT_EQ(::pclose(pipe), 0) << command << '\n' << text;
    for (std::size_t from = 0, to = 0; (to = text.find('\n', from)) != std::string::npos; from = to + 1)
        lines.push_back(text.substr(from, to - from));
    return lines;
}

/// tshark is a tool of developers; without it these tests say what they left out.
bool have_tshark() {
    if (std::system("command -v tshark >/dev/null 2>&1") == 0) return true;
    std::puts("left out: the Wireshark dissector, because tshark is not installed");
    return false;
}

const char* const kStartUp[]{
    "10 08 02 49 53 16",                                        // FDL_Status
    "10 02 08 00 0A 16",                                        //
    "68 05 05 68 88 82 6D 3C 3E F1 16",                         // Slave_Diag
    "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 47 11 EA 16",       //
    "68 0C 0C 68 88 82 5D 3D 3E 88 01 0A 0B 47 11 00 D8 16",    // Set_Prm
    "E5",                                                       //
    "68 06 06 68 88 82 7D 3E 3E 31 34 16",                      // Chk_Cfg
    "E5",                                                       //
    "68 05 05 68 88 82 5D 3C 3E E1 16",                         // Slave_Diag
    "68 0B 0B 68 82 88 08 3E 3C 00 0C 00 02 47 11 F2 16",       //
    "68 05 05 68 08 02 7D 12 34 CD 16",                         // Data_Exchange
    "68 05 05 68 02 08 0A AB CD 8C 16",                         //
    "68 07 07 68 FF 82 46 3A 3E 02 00 41 16",                   // Global_Control
    "10 08 02 7D 87 16",                                        // Data_Exchange without outputs
    "10 02 08 03 0D 16",                                        // refused
    "DC 02 02",                                                 // token
    "10 08 02 49 54 16",                                        // wrong FCS
    "68 03 03 68",                                              // wrong LE
};

std::string recorded(LinkType type, const char* name) {
    const std::filesystem::path folder = std::filesystem::path{DPCHIP_BINARY_DIR} / "tests";
    std::filesystem::create_directories(folder);
    const std::string file = (folder / name).string();
    std::ofstream out{file, std::ios::binary};
    PcapngWriter writer{out};
    const auto line = writer.add_interface(type, "line");
    std::int64_t time = 1'700'000'000'000'000'001;
    for (const char* hex : kStartUp) {
        const auto telegram = octets(hex);
        EXPECT_TRUE(writer.write({time += 1'000'001, telegram, Direction::unknown, {}, line}));
    }
    return file;
}

std::string tshark(const std::string& file, const std::string& rest) {
    return "tshark -X lua_script:" DPCHIP_SOURCE_DIR "/tools/wireshark/profibus.lua -r '" + file + "' " + rest + " 2>/dev/null";
}

TEST(Wireshark, NamesTelegramServiceAndStateOfAStartUp) {
    if (!have_tshark()) return;
    const std::string file = recorded(LinkType::user0, "start_up_user0.pcapng");
    const std::vector<std::string> expected{
        "PROFIBUS|FDL_Status", "PROFIBUS|OK FDL_Status", "PROFIBUS|SRD high Slave_Diag",
        "PROFIBUS|DL Slave_Diag Station_Not_Ready, Prm_Req, no master, ident 4711H",
        "PROFIBUS|SRD high Set_Prm Lock_Req, WD_On, WD 100 ms, ident 4711H", "PROFIBUS|SC Set_Prm acknowledged",
        "PROFIBUS|SRD high Chk_Cfg 31", "PROFIBUS|SC Chk_Cfg acknowledged", "PROFIBUS|SRD high Slave_Diag",
        "PROFIBUS|DL Slave_Diag WD_On, master 2, ident 4711H", "PROFIBUS|SRD high Data_Exchange 12 34", "PROFIBUS|DH Data_Exchange AB CD",
        "PROFIBUS|SDN high Global_Control Clear_Data", "PROFIBUS|SRD high Data_Exchange", "PROFIBUS|RS Data_Exchange", "PROFIBUS|token",
        "PROFIBUS|rejected: wrong FCS", "PROFIBUS|rejected: LE outside 4..249"};
    EXPECT_EQ(output_lines(tshark(file, "-T fields -E separator='|' -e _ws.col.Protocol -e _ws.col.Info")), expected);
}

TEST(Wireshark, ShowsEveryFieldUnderItsName) {
    if (!have_tshark()) return;
    const std::string file = recorded(LinkType::user0, "fields_user0.pcapng");
    const std::vector<std::string> names{
        "format", "da", "sa", "dsap", "ssap", "fc.request", "fc.fcb", "fc.fcv", "fc.station_type", "function", "service", "state", "data", "reject",
        "ident", "diag.station_not_ready", "diag.prm_req", "diag.wd_on", "diag.master_add", "prm.lock_req", "prm.sync_req", "prm.wd_ms",
        "prm.min_tsdr", "prm.group_ident", "gc.clear_data", "gc.sync", "gc.group_select"};
    std::string arguments = "-T fields -E separator='|'";
    for (const std::string& name : names) arguments += " -e profibus_dp." + name;
    const auto frames = output_lines(tshark(file, arguments));
    ASSERT_EQ(frames.size(), std::size(kStartUp));
    /// The values of some fields in frame `number` (from 1).
    const auto fields = [&](std::size_t number, std::string_view wanted) {
        std::vector<std::string> values;
        std::istringstream row{frames[number - 1] + '|'};
        for (std::string value; std::getline(row, value, '|');) values.push_back(value);
        std::string result;
        std::istringstream list{std::string{wanted}};
        for (std::string name; list >> name;) {
            const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
            if (!result.empty()) result += '|';
            result += at < values.size() ? values[at] : name;
        }
        return result;
    };
    EXPECT_EQ(fields(3, "format da sa dsap ssap fc.request fc.fcb fc.fcv function service"), "SD2|8|2|60|62|1|1|0|SRD high|Slave_Diag");
    EXPECT_EQ(fields(4, "diag.station_not_ready diag.prm_req diag.wd_on diag.master_add ident state"), "1|1|0|255|0x4711|WAIT-PRM");
    EXPECT_EQ(fields(5, "prm.lock_req prm.sync_req prm.wd_ms prm.min_tsdr prm.group_ident ident"), "1|0|100|11|0x00|0x4711");
    EXPECT_EQ(fields(6, "format service state"), "SC|Set_Prm|WAIT-PRM");
    EXPECT_EQ(fields(10, "diag.station_not_ready diag.wd_on diag.master_add state"), "0|1|2|DATA-EXCH");
    EXPECT_EQ(fields(12, "function service data state fc.station_type"), "DH|Data_Exchange|abcd|DATA-EXCH|0");
    EXPECT_EQ(fields(13, "da gc.clear_data gc.sync gc.group_select"), "127|1|0|0x00");
    EXPECT_EQ(fields(15, "function service state"), "RS|Data_Exchange|WAIT-PRM");
    EXPECT_EQ(fields(17, "reject"), "wrong FCS");
}

TEST(Wireshark, OpensLinkType257AndNanosecondTimesToo) {
    if (!have_tshark()) return;
    const std::string file = recorded(LinkType::profibus_dl, "start_up_257.pcapng");
    const auto lines = output_lines(tshark(file, "-Y frame.number==4 -T fields -E separator='|' -e profibus_dp.service -e frame.time_epoch"));
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0], "Slave_Diag|1700000000.004000005");
}

}  // namespace
}  // namespace dpchip::trace
