// SPDX-License-Identifier: Apache-2.0
// Golden files: readable text under tests/golden that a test's output must equal.
//
// When it differs, what the test produced is left in BUILD/golden/NAME.actual; tools/approve.py shows the difference
// and takes it over when told to.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace dpchip::test {

/// The file's octets; empty when there is no such file.
inline std::string read_file(const std::filesystem::path& path) {
    std::ostringstream out;
    out << std::ifstream(path, std::ios::binary).rdbuf();
    return out.str();
}

/// `text` against tests/golden/`name`. Use as EXPECT_TRUE(matches_golden("fdl/start_up.trace", text)).
inline testing::AssertionResult matches_golden(std::string_view name, std::string_view text) {
    const auto golden = std::filesystem::path(DPCHIP_SOURCE_DIR) / "tests" / "golden" / name;
    auto actual = std::filesystem::path(DPCHIP_BINARY_DIR) / "golden" / name;
    actual += ".actual";
    if (std::filesystem::exists(golden) && read_file(golden) == text) {
        std::filesystem::remove(actual);
        return testing::AssertionSuccess();
    }
    std::filesystem::create_directories(actual.parent_path());
    std::ofstream(actual, std::ios::binary) << text;
    return testing::AssertionFailure() << "tests/golden/" << name << " differs; see tools/approve.py --build "
                                       << DPCHIP_BINARY_DIR << ' ' << name;
}

}  // namespace dpchip::test
