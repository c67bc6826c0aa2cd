// SPDX-License-Identifier: Apache-2.0
// Reads waveforms back as a strict viewer would: ids declared once, times that grow, values only of signals that there are.
#pragma once

#include <cstdint>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace dpchip::test {

struct Vcd {
    struct Change {
        std::int64_t at;
        std::string value;
        bool operator==(const Change&) const = default;
    };
    using Wave = std::vector<Change>;

    std::string timescale;
    std::map<std::string, Wave> waves;  ///< by SCOPE.NAME; the first change is the initial value
    std::int64_t first = -1, last = -1;

    explicit Vcd(const std::string& path) {
        std::ifstream file{path, std::ios::binary};
        const std::string all{std::istreambuf_iterator<char>{file}, {}};
        EXPECT_FALSE(all.empty()) << path;
        EXPECT_TRUE(all.empty() || all.back() == '\n') << "cut off";
        std::istringstream in{all};
        std::map<std::string, std::string> names;
        header(in, names);
        body(in, names);
    }

    /// The value at `at`, changes of that moment included; "" before the first one.
    std::string at(const std::string& name, std::int64_t at) const {
        std::string value;
        for (const Change& c : wave(name))
            if (c.at <= at) value = c.value;
        return value;
    }
    const Wave& wave(const std::string& name) const {
        static const Wave none;
        const auto found = waves.find(name);
        EXPECT_NE(found, waves.end()) << name;
        return found == waves.end() ? none : found->second;
    }

private:
    void header(std::istream& in, std::map<std::string, std::string>& names) {
        std::string word, scope;
        while (in >> word && word != "$enddefinitions") {
            if (word == "$timescale") {
                std::string number, unit;
                in >> number >> unit;
                timescale = number + unit;
            } else if (word == "$scope") {
                std::string kind, name;
                in >> kind >> name;
                scope += name + '.';
            } else if (word == "$upscope") {
                scope.resize(scope.rfind('.', scope.size() - 2) == std::string::npos ? 0 : scope.rfind('.', scope.size() - 2) + 1);
            } else if (word == "$var") {
                std::string type, width, id, name;
                in >> type >> width >> id >> name;
                EXPECT_TRUE(names.emplace(id, scope + name).second) << id;
                waves[scope + name] = {};
            }
        }
        EXPECT_EQ(word, "$enddefinitions");
        in >> word;
    }
    void body(std::istream& in, const std::map<std::string, std::string>& names) {
        std::string word;
        while (in >> word) {
            if (word[0] == '$') continue;
            if (word[0] == '#') {
                const std::int64_t at = std::stoll(word.substr(1));
                EXPECT_GT(at, last);
                if (first < 0) first = at;
                last = at;
                continue;
            }
            const bool wide = word[0] == 'b' || word[0] == 's';
            std::string id = word.substr(1);
            if (wide) in >> id;
            const auto name = names.find(id);
            ASSERT_NE(name, names.end()) << word;
            waves[name->second].push_back({last, wide ? word.substr(1) : word.substr(0, 1)});
        }
    }
};

}  // namespace dpchip::test
