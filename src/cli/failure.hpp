// SPDX-License-Identifier: Apache-2.0
// How the program ends: exit codes, and the exception that carries one to main().
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace dpchip::cli {

/// docs/config.md and every --help list these.
enum class ExitCode : std::uint8_t {
    ok = 0,
    failed = 1,    ///< the job itself: a slave not reached, a value that did not follow
    usage = 2,     ///< the command line
    packages = 3,  ///< only ./run and ./test: packages are missing
    input = 4,     ///< a file that is wrong: GSD, TOML, pcapng, hex text
    line = 5,      ///< the port: busy, missing, gone, unsuitable
};
inline constexpr const char* kExitCodes = "Exit codes: 0 ok, 1 the job failed, 2 usage, 4 bad input file, 5 line or port\n"
                                          "(3: ./run and ./test miss packages).";

/// where in a file; no file: the command line.
struct Place {
    std::string file;
    std::uint32_t line{}, column{};
};
/// "file:line:column"; empty without file.
std::string to_string(const Place& at);

class Failure : public std::runtime_error {
public:
    Failure(ExitCode code, const std::string& message) : std::runtime_error{message}, code_{code} {}
    ExitCode code() const { return code_; }

private:
    ExitCode code_;
};

/// Something asked for cannot be: a bad file when it stands in one, else a bad command line. Lines of `message` that name
/// no place of their own get `at`.
[[noreturn]] void refuse(const Place& at, const std::string& message);

}  // namespace dpchip::cli
