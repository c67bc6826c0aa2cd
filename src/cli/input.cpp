// SPDX-License-Identifier: Apache-2.0
// Reading files with the C library, which tells a folder from a file.
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include <dpchip/cli/failure.hpp>
#include <dpchip/cli/input.hpp>

namespace dpchip::cli {

std::string read_all(const std::string& path) {
    struct Close {
        void operator()(std::FILE* f) const {
            if (f != stdin) std::fclose(f);
        }
    };
    const std::unique_ptr<std::FILE, Close> file{path == "-" ? stdin : std::fopen(path.c_str(), "rbe")};
    if (!file) refuse({path, 0, 0}, std::strerror(errno));
    std::string text;
    std::array<char, 16384> buffer{};
    for (std::size_t got = 0; (got = std::fread(buffer.data(), 1, buffer.size(), file.get())) != 0;) text.append(buffer.data(), got);
    if (std::ferror(file.get()) != 0) refuse({path, 0, 0}, std::strerror(errno));
    return text;
}

}  // namespace dpchip::cli
