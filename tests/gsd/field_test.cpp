// SPDX-License-Identifier: Apache-2.0
// GSD files of real stations: what each of them says, held against a table that was counted by other means, and
// every module's octets held against the reference's formulas.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/dp/cfg.hpp>
#include <dpchip/gsd/configuration.hpp>
#include <dpchip/gsd/describe.hpp>
#include <dpchip/gsd/parse.hpp>
#include <dpchip/gsd/user_prm.hpp>
#include <support/shared.hpp>

namespace gsd = dpchip::gsd;

namespace {

std::string row(const gsd::Summary& s) {
    std::ostringstream out;
    out << std::filesystem::path{s.file}.filename().string() << ' ' << gsd::hex(s.ident_number) << ' ' << s.gsd_revision
        << ' ' << s.modules << ' ' << s.parameters << ' ' << s.prm_texts << ' ' << s.diag_texts << ' '
        << s.unknown_keywords;
    return out.str();
}

/// The table's rows by file name, blanks between columns folded.
std::map<std::string, std::string> table() {
    std::ifstream in{std::string{DPCHIP_SOURCE_DIR} + "/tests/gsd/field_files.txt"};
    EXPECT_TRUE(in);
    std::map<std::string, std::string> rows;
    for (std::string line; std::getline(in, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::istringstream words{line};
        std::string name;
        words >> name;
        std::ostringstream folded;
        folded << name;
        for (std::string word; words >> word;) folded << ' ' << word;
        rows[name] = folded.str();
    }
    return rows;
}

/// The files of shared/gsd; without shared/ none, and a line that says so.
std::vector<gsd::Parsed> field_files() {
    std::vector<gsd::Parsed> files;
    if (const auto folder = dpchip::test::shared_path("gsd", "reading the GSD files of real stations")) {
        std::set<std::filesystem::path> paths;
        for (const auto& entry : std::filesystem::directory_iterator{*folder}) paths.insert(entry.path());
        for (const auto& path : paths) files.push_back(gsd::read(path.string()));
    }
    return files;
}

/// Reference 7.2 and 7.3 once more, written down naively.
void add_lengths(const std::vector<std::uint8_t>& cfg, int& inputs, int& outputs) {
    for (std::size_t i = 0; i < cfg.size();) {
        const int b = cfg[i++];
        if ((b & 0x30) != 0) {
            const int n = ((b & 15) + 1) * ((b & 0x40) != 0 ? 2 : 1);
            if ((b & 0x10) != 0) inputs += n;
            if ((b & 0x20) != 0) outputs += n;
            continue;
        }
        const auto length = [&] {
            const int l = cfg.at(i++);
            return ((l & 63) + 1) * ((l & 0x40) != 0 ? 2 : 1);
        };
        if ((b & 0x80) != 0) outputs += length();
        if ((b & 0x40) != 0) inputs += length();
        i += static_cast<std::size_t>(b & 15);
    }
}

TEST(FieldFiles, each_says_what_the_checked_in_table_says) {
    const auto expected = table();
    EXPECT_EQ(expected.size(), 42u);
    const auto files = field_files();
    std::set<std::string> seen;
    for (const auto& p : files) {
        const std::string text = row(gsd::summarize(p.gsd));
        const std::string name = text.substr(0, text.find(' '));
        seen.insert(name);
        const auto found = expected.find(name);
        EXPECT_EQ(text, found == expected.end() ? "(not in the table)" : found->second);
    }
    if (!files.empty()) { EXPECT_EQ(seen.size(), expected.size()) << "the table names a file that is not there"; }
}

TEST(FieldFiles, all_load_without_errors_and_only_two_with_a_warning) {
    std::ostringstream out;
    for (const auto& p : field_files()) {
        EXPECT_TRUE(p.ok()) << p.gsd.file;
        for (const auto& d : p.diagnostics)
            out << gsd::to_string(d, std::filesystem::path{p.gsd.file}.filename().string()) << '\n';
    }
    const std::string warnings = out.str();
    if (warnings.empty()) return;  // no shared/: field_files() has said so
    EXPECT_EQ(warnings, "SIEM8060.GSD:46:1: warning: keyword with blanks, taken for '24V_Pins'\n"
                        "SIEM8FFF.GSD: warning: no modules\n");
}

TEST(FieldFiles, every_modules_lengths_follow_from_its_octets) {
    std::size_t modules = 0;
    for (const auto& p : field_files()) {
        for (const gsd::Module& m : p.gsd.modules) {
            int inputs = 0, outputs = 0;
            add_lengths(m.cfg, inputs, outputs);
            EXPECT_EQ(m.input_octets, inputs) << p.gsd.file << ": " << m.name;
            EXPECT_EQ(m.output_octets, outputs) << p.gsd.file << ": " << m.name;
            const auto totals = dpchip::dp::cfg_totals(m.cfg, dpchip::dp::CfgUse::get_cfg);
            EXPECT_TRUE(totals.ok() && totals.input_octets == inputs && totals.output_octets == outputs) << m.name;
            ++modules;
        }
    }
    if (modules != 0) { EXPECT_EQ(modules, 1461u); }
}

TEST(FieldFiles, a_station_of_any_one_module_takes_the_parameters_it_proposes) {
    for (const auto& p : field_files()) {
        const gsd::Gsd& g = p.gsd;
        for (std::size_t i = 0; i < g.modules.size(); ++i) {
            gsd::Configuration c;
            c.modules = {i};
            const auto data = gsd::user_prm_data(g, c);
            ASSERT_EQ(data.octets.size(), data.variable.size());
            const auto fault = gsd::check_user_prm(g, data, data.octets);
            EXPECT_FALSE(fault) << g.file << ": " << g.modules[i].name << ": " << fault->message;
            for (std::size_t o = 0; o < data.octets.size(); ++o) {
                auto changed = data.octets;
                changed[o] = static_cast<std::uint8_t>(changed[o] ^ static_cast<std::uint8_t>(~data.variable[o]));
                if (changed == data.octets) continue;
                EXPECT_TRUE(gsd::check_user_prm(g, data, changed)) << g.file << ": constant octet " << o;
            }
        }
    }
}

TEST(FieldFiles, modules_that_fit_the_station_can_be_configured_by_their_position) {
    std::size_t configured = 0, refused = 0;
    for (const auto& p : field_files()) {
        for (std::size_t i = 0; i < p.gsd.modules.size(); ++i) {
            try {
                const auto c = gsd::configure_modules(p.gsd, {i});
                EXPECT_EQ(c.cfg, p.gsd.modules[i].cfg);
                ++configured;
            } catch (const gsd::GsdError&) { ++refused; }
        }
    }
    if (configured != 0) { EXPECT_EQ(refused, 0u); }
}

}  // namespace
