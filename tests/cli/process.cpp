// SPDX-License-Identifier: Apache-2.0
// fork, exec, pipes and poll.
#include "cli/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <stdexcept>

namespace dpchip::test {
namespace {

constexpr int kPatienceMs = 60'000;

void write_all(int fd, const std::string& text) {
    for (std::size_t done = 0; done < text.size();) {
        const ssize_t n = ::write(fd, text.data() + done, text.size() - done);
        if (n <= 0) break;
        done += static_cast<std::size_t>(n);
    }
}

}  // namespace

Program::Program(const std::vector<std::string>& arguments, const std::string& input) {
    std::array<int, 2> in{}, out{}, err{};
    if (::pipe2(in.data(), O_CLOEXEC) != 0 || ::pipe2(out.data(), O_CLOEXEC) != 0 || ::pipe2(err.data(), O_CLOEXEC) != 0)
        throw std::runtime_error{"pipe"};
    std::string program = DPCHIP_BINARY_DIR "/bin/dpchip";
    std::vector<std::string> all = arguments;
    std::vector<char*> argv{program.data()};
    for (std::string& a : all) argv.push_back(a.data());
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ < 0) throw std::runtime_error{"fork"};
    if (pid_ == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        ::dup2(in[0], STDIN_FILENO);
        ::dup2(out[1], STDOUT_FILENO);
        ::dup2(err[1], STDERR_FILENO);
        ::execv(program.c_str(), argv.data());
        ::_exit(127);
    }
    ::close(in[0]);
    ::close(out[1]);
    ::close(err[1]);
    out_fd_ = out[0];
    err_fd_ = err[0];
    write_all(in[1], input);  // shorter than a pipe holds
    ::close(in[1]);
}

Program::~Program() {
    if (pid_ > 0) {
        ::kill(pid_, SIGKILL);
        while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {}
    }
    if (out_fd_ >= 0) ::close(out_fd_);
    if (err_fd_ >= 0) ::close(err_fd_);
}

/// False at the end of both, or when nothing comes for too long.
bool Program::read_some() {
    std::array<pollfd, 2> fds{pollfd{out_fd_, POLLIN, 0}, pollfd{err_fd_, POLLIN, 0}};
    if ((out_fd_ < 0 && err_fd_ < 0) || ::poll(fds.data(), 2, kPatienceMs) <= 0) return false;
    std::array<char, 4096> buffer{};
    const auto take = [&](const pollfd& fd, int& own, std::string& into) {
        if (fd.revents == 0) return;
        const ssize_t got = ::read(fd.fd, buffer.data(), buffer.size());
        if (got > 0) {
            into.append(buffer.data(), static_cast<std::size_t>(got));
            return;
        }
        ::close(own);
        own = -1;
    };
    take(fds[0], out_fd_, out_);
    take(fds[1], err_fd_, err_);
    return true;
}

std::string Program::line() {
    while (out_.find('\n') == std::string::npos)
        if (!read_some()) return {};
    const std::size_t end = out_.find('\n');
    std::string first = out_.substr(0, end);
    out_.erase(0, end + 1);
    return first;
}

bool Program::said(const std::string& words) {
    while (err_.find(words) == std::string::npos)
        if (!read_some()) return false;
    return true;
}

void Program::signal(int number) const {
    if (pid_ > 0) ::kill(pid_, number);
}

int Program::wait() {
    if (pid_ <= 0) return code_;
    while (read_some()) {}
    // Still open pipes mean that it did not end in time.
    if (out_fd_ >= 0 || err_fd_ >= 0) ::kill(pid_, SIGKILL);
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {}
    pid_ = -1;
    code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    return code_;
}

Result run(const std::vector<std::string>& arguments, const std::string& input) {
    Program p{arguments, input};
    const int code = p.wait();
    return {code, p.out(), p.err()};
}

}  // namespace dpchip::test
