// SPDX-License-Identifier: Apache-2.0
// Opening, reading and writing a serial device.
#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>

#include <dpchip/live/device_port.hpp>
#include <dpchip/live/tty.hpp>

namespace dpchip::live {
namespace {

/// How long after the last stop bit an echo may still be under way through a USB adapter.
constexpr Ticks kEchoLatency = core::milliseconds(50);

}  // namespace

DevicePort::DevicePort(std::string device, fdl::BaudCode baud, Accept accept)
    : device_{std::move(device)}, tty_{::open(device_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)}, baud_{baud} {
    if (!tty_) throw_system(device_, errno);
    pty_ = accept == Accept::pty_too && is_pty(tty_.get());
    if (pty_) {
        set_visitor(tty_.get(), device_);
        return;
    }
    lock();
    if (!is_pty(tty_.get())) set_uart(tty_.get(), device_, baud_);
    else throw LineError{LineErrorKind::unsuitable, device_ + ": the tty end of a pty is no serial device; use tty:" + device_};
    enable_rs485(tty_.get());
    enable_low_latency(tty_.get());
}

/// For this program alone: by the advisory lock that terminal programs use.
void DevicePort::lock() {
    if (::flock(tty_.get(), LOCK_EX | LOCK_NB) != 0) throw LineError{LineErrorKind::busy, device_ + ": another program uses it"};
}

bool DevicePort::receive(Reception& into) {
    std::array<std::uint8_t, 512> raw{};
    const ssize_t got = ::read(tty_.get(), raw.data(), raw.size());
    if (got < 0 && errno != EAGAIN && errno != EINTR) throw_system(device_, errno);
    if (got == 0 || (got < 0 && lost_)) throw LineError{LineErrorKind::gone, device_ + ": the device is gone"};
    if (got < 0) return false;
    into.size = 0;
    into.source = 0;
    const Ticks now = time_.now();
    const auto take = [&](std::uint8_t octet, std::uint8_t faults) {
        if (!pty_ && echo_.drops(octet, now)) return;
        into.octets[into.size] = octet;
        into.faults[into.size++] = faults;
    };
    for (std::size_t i = 0; i < static_cast<std::size_t>(got); ++i)
        if (pty_) take(raw[i], 0);
        else marks_.feed(raw[i], take);
    return into.size != 0;
}

bool DevicePort::send(std::span<const std::uint8_t> octets) {
    if (::write(tty_.get(), octets.data(), octets.size()) != static_cast<ssize_t>(octets.size())) return false;
    const Ticks length = fdl::baud(baud_).bit * (fdl::kCharacterBits * static_cast<std::int64_t>(octets.size()));
    if (!pty_) echo_.sent(octets, time_.now() + length + kEchoLatency);
    return true;
}

void DevicePort::wait(Ticks at_most) {
    pollfd fds[]{{tty_.get(), POLLIN, 0}};
    waiting_.wait(fds, at_most);
    lost_ = (fds[0].revents & (POLLHUP | POLLERR)) != 0 && (fds[0].revents & POLLIN) == 0;
}

bool DevicePort::set_baud(fdl::BaudCode baud) {
    if (pty_ || baud == baud_) return true;
    try {
        set_uart(tty_.get(), device_, baud);
    } catch (const LineError& error) {
        if (error.kind() != LineErrorKind::baud) throw;
        set_uart(tty_.get(), device_, baud_);
        return false;
    }
    baud_ = baud;
    return true;
}

}  // namespace dpchip::live
