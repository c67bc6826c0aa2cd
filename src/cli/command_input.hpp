// SPDX-License-Identifier: Apache-2.0
// Lines of commands that come in while the program does something else: from stdin, a FIFO or a file. Never waits.
#pragma once

#include <optional>
#include <string>

#include <dpchip/cli/failure.hpp>
#include <dpchip/live/descriptor.hpp>

namespace dpchip::cli {

class CommandInput {
public:
    /// "-": stdin. A path that is not there becomes a FIFO and is removed again at the end. Throws Failure.
    explicit CommandInput(const std::string& path);
    ~CommandInput();
    CommandInput(const CommandInput&) = delete;
    CommandInput& operator=(const CommandInput&) = delete;

    /// The next whole line; nothing when there is none yet. Blank lines and those that begin with # are left out.
    std::optional<std::string> line();
    /// Where the last line stood.
    Place place() const { return {path_, number_, 1}; }

private:
    void read_some();

    std::string path_;
    live::Descriptor own_;   ///< not for stdin
    int fd_ = -1;            ///< -1: at its end
    bool made_ = false;      ///< the FIFO is ours
    std::string text_;
    std::uint32_t number_ = 0;
};

}  // namespace dpchip::cli
