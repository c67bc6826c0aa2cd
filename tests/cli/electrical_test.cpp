// SPDX-License-Identifier: Apache-2.0
// `dpchip regs --electrical`: every figure of chapter 10 is printed, in every format.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli/process.hpp"

namespace {

using Json = nlohmann::json;
using Row = std::vector<std::string>;
using dpchip::test::run;

/// Words between bars.
Row cells(const std::string& line) {
    Row row;
    for (std::size_t at = 0; at <= line.size();) {
        const std::size_t bar = std::min(line.find(" | ", at), line.size());
        row.push_back(line.substr(at, bar - at));
        at = bar + 3;
    }
    return row;
}

/// The manuals' rows by chip and figure, in their order.
std::map<std::pair<std::string, std::string>, std::vector<Row>> typed() {
    std::map<std::pair<std::string, std::string>, std::vector<Row>> all;
    std::ifstream file{DPCHIP_SOURCE_DIR "/tests/cli/electrical.txt"};
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        const Row r = cells(line);
        EXPECT_EQ(r.size(), 7u) << line;
        all[{r[0], r[1]}].emplace_back(r.begin() + 2, r.end());
    }
    return all;
}

Json printed(const std::string& chip) { return Json::parse(run({"regs", "--electrical", "--chip", chip, "--format", "json"}).out); }

const Json& table(const Json& all, const std::string& place) {
    for (const Json& t : all["tables"])
        if (t["place"] == place) return t;
    static const Json none;
    ADD_FAILURE() << "no table of " << place;
    return none;
}

/// symbol, min, typ, max, unit of a printed row.
Row figures(const Json& t, const Json& row) {
    const bool package = t["columns"][3] == "nom";
    return {row[0], row[2], row[3], row[4], package ? "mm" : row[5].get<std::string>()};
}

// proves: VPC3C 10.1-02..05, VPC3C 10.2-02..09, VPC3C 10.3-02..10, VPC3C 10.5-02..17, VPC3C 10.6-02..17, VPC3C 10.8-03,
// APC3 1-10, APC3 7-03
TEST(Electrical, Every_figure_is_the_one_that_the_manuals_print) {
    std::size_t compared = 0;
    for (const auto& [key, rows] : typed()) {
        SCOPED_TRACE(key.first + ", " + key.second);
        const Json all = printed(key.first);
        const Json& t = table(all, key.second);
        std::vector<Row> have;
        for (const Json& row : t["rows"]) have.push_back(figures(t, row));
        EXPECT_EQ(have, rows);
        compared += rows.size();
    }
    EXPECT_EQ(compared, 83u);
}

TEST(Electrical, Prints_the_59_parameters_with_the_columns_that_the_chip_has) {
    for (const std::string chip : {"vpc3+c", "apc3"}) {
        const Json all = printed(chip);
        std::size_t parameters = 0;
        for (const char* figure : {"figure 10-11", "figure 10-14", "figure 10-17", "figure 10-20"}) {
            const Json& t = table(all, figure);
            parameters += t["rows"].size();
            EXPECT_EQ(t["columns"].size(), chip == "apc3" ? 8u : 10u) << "APC3 has no 5 V";
        }
        EXPECT_EQ(parameters, 59u);
        EXPECT_EQ(all.contains("note"), chip == "apc3") << "its manual has no figures of timing";
    }
    const Json all = printed("vpc3+c");
    EXPECT_EQ(table(all, "figure 10-17")["rows"][0], (Json{"31", "R W", "E_CLOCK pulse width", "E_CLOCK rises", "E_CLOCK falls", "136.7", "-", "136.7", "-", "processor"}));
}

TEST(Electrical, Text_and_markdown_hold_the_same_rows_for_every_chip) {
    for (const std::string chip : {"vpc3+c", "vpc3+b", "vpc3+", "apc3", "spc3"}) {
        const auto text = run({"regs", "--electrical", "--chip", chip}), markdown = run({"regs", "--electrical", "--chip", chip, "--format", "markdown"});
        EXPECT_EQ(text.code, 0);
        EXPECT_EQ(markdown.code, 0);
        const Json all = printed(chip);
        EXPECT_EQ(all["chip"], chip);
        EXPECT_EQ(table(all, chip == "apc3" || chip == "spc3" ? "table 2.1" : "figure 3-1")["rows"].size(), 44u);
        for (const Json& t : all["tables"])
            for (const Json& row : t["rows"]) {
                std::string line = "|";
                for (const Json& cell : row) line += ' ' + cell.get<std::string>() + " |";
                ASSERT_NE(markdown.out.find(line), std::string::npos) << line;
                ASSERT_NE(text.out.find(row[0].get<std::string>()), std::string::npos);
            }
    }
}

}  // namespace
