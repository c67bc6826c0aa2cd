// SPDX-License-Identifier: Apache-2.0
// POSIX side of CommandInput.
#include <dpchip/cli/command_input.hpp>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace dpchip::cli {
namespace {

/// A line longer than this is none.
constexpr std::size_t kLongestLine = 4096;

[[noreturn]] void fail(const std::string& path) {
    throw Failure{ExitCode::input, "--commands " + path + ": " + std::generic_category().message(errno)};
}

}  // namespace

CommandInput::CommandInput(const std::string& path) : path_{path} {
    if (path == "-") {
        fd_ = STDIN_FILENO;
        return;
    }
    struct stat about {};
    if (::stat(path.c_str(), &about) != 0) {
        if (errno != ENOENT || ::mkfifo(path.c_str(), 0600) != 0) fail(path);
        made_ = true;
    }
    const bool fifo = made_ || S_ISFIFO(about.st_mode);
    // Held open for writing too: a FIFO then has no end when its last writer leaves.
    own_ = live::Descriptor{::open(path.c_str(), (fifo ? O_RDWR : O_RDONLY) | O_NONBLOCK | O_CLOEXEC)};
    if (!own_) fail(path);
    fd_ = own_.get();
}

CommandInput::~CommandInput() {
    if (made_) ::unlink(path_.c_str());
}

void CommandInput::read_some() {
    while (fd_ >= 0 && text_.size() <= kLongestLine) {
        pollfd waiting{fd_, POLLIN, 0};
        if (::poll(&waiting, 1, 0) <= 0) return;
        std::array<char, 1024> buffer{};
        const ssize_t got = ::read(fd_, buffer.data(), buffer.size());
        if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
        if (got <= 0) {
            if (!text_.empty() && text_.back() != '\n') text_ += '\n';
            fd_ = -1;
            return;
        }
        text_.append(buffer.data(), static_cast<std::size_t>(got));
    }
}

std::optional<std::string> CommandInput::line() {
    for (;;) {
        std::size_t end = text_.find('\n');
        if (end == std::string::npos) {
            read_some();
            end = text_.find('\n');
        }
        if (end == std::string::npos && text_.size() <= kLongestLine) return std::nullopt;
        const std::string one = text_.substr(0, end);
        text_.erase(0, end == std::string::npos ? end : end + 1);
        ++number_;
        const std::size_t first = one.find_first_not_of(" \t\r");
        if (first != std::string::npos && one[first] != '#') return one.substr(first);
    }
}

}  // namespace dpchip::cli
