// SPDX-License-Identifier: Apache-2.0
// sigrok's UART decoder on waveforms of `dpchip sim --vcd`: somebody else reads the same octets.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include <dpchip/fdl/baud.hpp>
#include <dpchip/fdl/telegram.hpp>
#include <dpchip/trace/pcapng.hpp>

#include "cli/process.hpp"

namespace {

using dpchip::fdl::BaudCode;
using dpchip::test::run;
using Octets = std::vector<std::uint8_t>;
namespace fdl = dpchip::fdl;
namespace trace = dpchip::trace;

/// sigrok-cli is a tool of developers; without it these tests say loudly what they left out.
bool have_sigrok() {
    if (std::system("command -v sigrok-cli >/dev/null 2>&1") == 0) return true;
    std::puts("left out: waveforms against sigrok's UART decoder, because sigrok-cli is not installed");
    return false;
}

std::string path_of(const std::string& name) {
    const std::filesystem::path folder = std::filesystem::path{DPCHIP_BINARY_DIR} / "tests";
    std::filesystem::create_directories(folder);
    return (folder / name).string();
}

std::vector<std::string> lines_of(const std::string& command) {
    std::vector<std::string> lines;
    FILE* pipe = ::popen(command.c_str(), "r");
    if (pipe == nullptr) return lines;
    std::string text;
    std::array<char, 4096> buffer{};
    for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) text.append(buffer.data(), n);
    EXPECT_EQ(::pclose(pipe), 0) << command << '\n' << text;
    for (std::size_t from = 0, to = 0; (to = text.find('\n', from)) != std::string::npos; from = to + 1) lines.push_back(text.substr(from, to - from));
    return lines;
}

/// A simulation of one master and one slave, its waveforms and what the model says was on the line.
struct Recorded {
    std::string vcd;
    Octets file;
    trace::Capture capture;
    Octets line, answers;  ///< octets of everything, and of the slave

    Recorded(const std::string& name, BaudCode rate, const std::string& timescale, const std::string& events) {
        const std::string scenario = path_of(name + ".toml"), pcapng = path_of(name + ".pcapng");
        vcd = path_of(name + ".vcd");
        std::ofstream{scenario} << "baud = " << fdl::baud(rate).bits_per_s << "\n[[master]]\naddress = 1\n[[slave]]\nname = \"Press\"\ngsd = \"" DPCHIP_SOURCE_DIR
                                   "/examples/remote_io.gsd\"\nmodules = [\"16 DI / 16 DO\"]\naddress = 5\nio = \"counter\"\n"
                                   "options = { baud_probe_ms = [1,1,1,1,2,4,8,16,31,59] }\n"
                                << events;
        const auto r = run({"sim", scenario, "--cycles", "20", "--trace", pcapng, "--vcd", vcd, "--vcd-timescale", timescale, "--signals", "Press.?XD"});
        EXPECT_EQ(r.code, 0) << r.err;
        std::ifstream in{pcapng, std::ios::binary};
        file.assign(std::istreambuf_iterator<char>{in}, {});
        capture = trace::read_pcapng(file);
        EXPECT_EQ(capture.error, trace::PcapngError::none);
        for (const trace::CapturedPacket& p : capture.packets) {
            line.insert(line.end(), p.octets.begin(), p.octets.end());
            const auto t = fdl::decode(p.octets);
            const bool slaves = t && (t->sd == fdl::kSc || (t->has_fc() && t->source() == 5));
            if (slaves) answers.insert(answers.end(), p.octets.begin(), p.octets.end());
        }
    }
};

std::string uart(const Recorded& r, const std::string& pin, BaudCode rate, const std::string& show) {
    return "sigrok-cli -I vcd -i '" + r.vcd + "' -P uart:rx=" + pin + ":baudrate=" + std::to_string(fdl::baud(rate).bits_per_s) +
           ":parity=even:format=hex -A uart=" + show + " --protocol-decoder-samplenum 2>&1";
}

struct Annotation {
    std::int64_t from = 0, to = 0;
    std::string text;
};
std::vector<Annotation> annotations(const std::string& command) {
    std::vector<Annotation> out;
    for (const std::string& line : lines_of(command)) {
        Annotation a;
        std::array<char, 64> text{};
        long long from = 0, to = 0;
        if (std::sscanf(line.c_str(), "%lld-%lld uart-1: %63[^\n]", &from, &to, text.data()) == 3) {
            out.push_back({from, to, text.data()});
        } else {
            ADD_FAILURE() << line;
        }
    }
    return out;
}

Octets octets_of(const std::vector<Annotation>& all) {
    Octets out;
    for (const Annotation& a : all) out.push_back(static_cast<std::uint8_t>(std::stoul(a.text, nullptr, 16)));
    return out;
}

struct Case {
    const char* name;
    BaudCode rate;
    const char* timescale;
    std::int64_t unit_ns;
};
constexpr std::array<Case, 3> kCases{{{"sigrok_9k6", BaudCode::kbit_9_6, "100ns", 100}, {"sigrok_500k", BaudCode::kbit_500, "10ns", 10}, {"sigrok_12M", BaudCode::mbit_12, "1ns", 1}}};

// proves: VPC3C 8.3-03
TEST(Sigrok, decodes_RXD_and_TXD_of_a_start_up_octet_by_octet_as_the_model_sent_them) {
    if (!have_sigrok()) return;
    for (const Case& c : kCases) {
        SCOPED_TRACE(c.name);
        const Recorded r{c.name, c.rate, c.timescale, ""};
        ASSERT_GT(r.answers.size(), 100u);
        EXPECT_EQ(octets_of(annotations(uart(r, "RXD", c.rate, "rx-data"))), r.line);
        EXPECT_EQ(octets_of(annotations(uart(r, "TXD", c.rate, "rx-data"))), r.answers);
        EXPECT_TRUE(annotations(uart(r, "RXD", c.rate, "rx-parity-err:rx-warnings")).empty());
    }
}

TEST(Sigrok, finds_an_injected_parity_error_at_its_place) {
    if (!have_sigrok()) return;
    for (const Case& c : kCases) {
        SCOPED_TRACE(c.name);
        const std::string name = std::string{c.name} + "_parity";
        const std::string at = c.rate == BaudCode::mbit_12 ? "1300us" : c.rate == BaudCode::kbit_500 ? "16ms" : "250ms";
        const Recorded r{name, c.rate, c.timescale, "[[event]]\nat = \"" + at + "\"\ndo = \"fault\"\nfault = \"parity\"\nfrom = \"slave\"\nslave = \"Press\"\noctet = 3\n"};
        const auto damaged = std::find_if(r.capture.packets.begin(), r.capture.packets.end(), [](const trace::CapturedPacket& p) { return !p.comment.empty(); });
        ASSERT_NE(damaged, r.capture.packets.end());
        const std::vector<Annotation> errors = annotations(uart(r, "RXD", c.rate, "rx-parity-err"));
        ASSERT_EQ(errors.size(), 1u);
        // The parity bit is the tenth of its octet's bits; packets carry the time of their end, in whole nanoseconds.
        const std::size_t behind = damaged->octets.size() - 3 % damaged->octets.size();
        const double bit = static_cast<double>(fdl::baud(c.rate).bit.n) / 60.0 / static_cast<double>(c.unit_ns);
        const double end = static_cast<double>(damaged->time_ns) / static_cast<double>(c.unit_ns);
        const double begin = end - bit * (11.0 * static_cast<double>(behind) - 9.0);
        EXPECT_NEAR(static_cast<double>(errors[0].from), begin, 0.1 * bit + 2.0);
        EXPECT_NEAR(static_cast<double>(errors[0].to), begin + bit, 0.1 * bit + 2.0);
        EXPECT_EQ(annotations(uart(r, "TXD", c.rate, "rx-parity-err")).size(), 1u);
    }
}

}  // namespace
