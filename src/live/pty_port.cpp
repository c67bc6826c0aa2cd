// SPDX-License-Identifier: Apache-2.0
// posix_openpt and a symbolic link.
#include <fcntl.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <array>
#include <cerrno>
#include <climits>

#include <dpchip/live/pty_port.hpp>
#include <dpchip/live/tty.hpp>

namespace dpchip::live {
namespace {

/// Where a symbolic link points to; empty when there is none.
std::string target_of(const std::string& link) {
    std::array<char, PATH_MAX> buffer{};
    const ssize_t length = ::readlink(link.c_str(), buffer.data(), buffer.size());
    return length > 0 ? std::string(buffer.data(), static_cast<std::size_t>(length)) : std::string{};
}

/// True when another program serves the pty at `path`: it holds a lock on the tty end.
bool served(const std::string& path) {
    const Descriptor tty{::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)};
    return tty && is_pty(tty.get()) && ::flock(tty.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

}  // namespace

PtyPort::PtyPort(std::string link) : pty_{::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)} {
    if (!pty_ || ::grantpt(pty_.get()) != 0 || ::unlockpt(pty_.get()) != 0) throw_system("pty", errno);
    std::array<char, 128> path{};
    if (::ptsname_r(pty_.get(), path.data(), path.size()) != 0) throw_system("pty", errno);
    tty_path_ = path.data();
    tty_ = Descriptor{::open(tty_path_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC)};
    if (!tty_) throw_system(tty_path_, errno);
    if (::flock(tty_.get(), LOCK_EX | LOCK_NB) != 0) throw_system(tty_path_, errno);
    set_pty_rest(tty_.get());
    if (link.empty()) return;
    link_ = std::move(link);
    make_link();
}

PtyPort::~PtyPort() {
    if (!link_.empty() && target_of(link_) == tty_path_) ::unlink(link_.c_str());
}

void PtyPort::make_link() {
    struct stat s {};
    if (::lstat(link_.c_str(), &s) == 0) {
        const std::string where = link_;
        link_.clear();  // it is not ours: leave it alone
        if (!S_ISLNK(s.st_mode)) throw LineError{LineErrorKind::busy, where + ": exists and is not a symbolic link"};
        if (served(where)) throw LineError{LineErrorKind::busy, where + ": another program serves this pty"};
        link_ = where;
    }
    const std::string fresh = link_ + ".new" + std::to_string(::getpid());
    ::unlink(fresh.c_str());
    if (::symlink(tty_path_.c_str(), fresh.c_str()) != 0) throw_system(std::exchange(link_, {}), errno);
    if (::rename(fresh.c_str(), link_.c_str()) != 0) {
        const int code = errno;
        ::unlink(fresh.c_str());
        throw_system(std::exchange(link_, {}), code);
    }
}

bool PtyPort::receive(Reception& into) {
    const ssize_t got = ::read(pty_.get(), into.octets.data(), into.octets.size());
    if (got < 0 && errno != EAGAIN && errno != EINTR) throw_system(place(), errno);
    if (got <= 0) return false;
    into.size = static_cast<std::size_t>(got);
    into.source = 0;
    into.faults.fill(0);
    if (pty_disturbed(tty_.get())) set_pty_rest(tty_.get());
    return true;
}

bool PtyPort::send(std::span<const std::uint8_t> octets) {
    return ::write(pty_.get(), octets.data(), octets.size()) == static_cast<ssize_t>(octets.size());
}

void PtyPort::wait(Ticks at_most) {
    pollfd fds[]{{pty_.get(), POLLIN, 0}};
    waiting_.wait(fds, at_most);
}

}  // namespace dpchip::live
