// SPDX-License-Identifier: Apache-2.0
// A folder for one test, named after it and gone with it.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include <unistd.h>

#include <gtest/gtest.h>

namespace dpchip::test {

struct Folder {
    std::filesystem::path path = std::filesystem::temp_directory_path() /
                                 ("dpchip_cli_" + std::to_string(::getpid()) + '_' + testing::UnitTest::GetInstance()->current_test_info()->name());
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() {
        std::error_code error;
        std::filesystem::remove_all(path, error);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    /// Writes a file; returns its path.
    std::string file(const std::string& name, const std::string& text) const {
        std::ofstream(path / name, std::ios::binary) << text;
        return (path / name).string();
    }
};

}  // namespace dpchip::test
