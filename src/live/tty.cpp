// SPDX-License-Identifier: Apache-2.0
// The kernel's own terminal interface; <termios.h> must not be included beside it.
#include <asm/termbits.h>
#include <linux/major.h>
#include <linux/serial.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <cerrno>

#include <dpchip/live/line_error.hpp>
#include <dpchip/live/tty.hpp>

namespace dpchip::live {
namespace {

termios2 settings(int fd, const std::string& device) {
    termios2 t{};
    if (::ioctl(fd, TCGETS2, &t) != 0) {
        if (errno == ENOTTY) throw LineError{LineErrorKind::unsuitable, device + ": not a terminal"};
        throw_system(device, errno);
    }
    return t;
}

void make_raw(termios2& t) {
    t.c_iflag = 0;
    t.c_oflag = 0;
    t.c_lflag = 0;
    t.c_cflag = (t.c_cflag & ~static_cast<tcflag_t>(CSIZE | CSTOPB | PARENB | PARODD | CRTSCTS)) | CS8 | CREAD | CLOCAL;
    t.c_cc[VMIN] = 1;
    t.c_cc[VTIME] = 0;
}

void set_rate(termios2& t, tcflag_t constant, std::uint32_t bits_per_s) {
    // Input bits 0 mean: the same as output.
    t.c_cflag = (t.c_cflag & ~static_cast<tcflag_t>(CBAUD | (CBAUD << IBSHIFT))) | constant;
    t.c_ispeed = bits_per_s;
    t.c_ospeed = bits_per_s;
}

}  // namespace

void set_uart(int fd, const std::string& device, fdl::BaudCode code) {
    const fdl::Baud& baud = fdl::baud(code);
    termios2 t = settings(fd, device);
    make_raw(t);
    t.c_iflag = PARMRK | INPCK;
    t.c_cflag |= PARENB;
    set_rate(t, BOTHER, baud.bits_per_s);
    const std::string wanted = device + ": " + std::string{baud.name};
    if (::ioctl(fd, TCSETS2, &t) != 0)
        throw LineError{LineErrorKind::baud, wanted + " is refused by the device"};
    const termios2 got = settings(fd, device);
    if ((got.c_cflag & PARENB) == 0 || (got.c_cflag & CSIZE) != CS8)
        throw LineError{LineErrorKind::unsuitable, device + ": the device does not do 8 data bits with even parity"};
    if (!rate_close(got.c_ospeed, baud.bits_per_s) || !rate_close(got.c_ispeed, baud.bits_per_s))
        throw LineError{LineErrorKind::baud, wanted + " is more than 2 % off: the device does " + std::to_string(got.c_ospeed) + " bit/s"};
}

void set_visitor(int fd, const std::string& device) {
    termios2 t = settings(fd, device);
    make_raw(t);
    t.c_cflag |= PARENB;
    set_rate(t, B19200, 19200);
    if (::ioctl(fd, TCSETS2, &t) != 0) throw_system(device, errno);
}

void set_pty_rest(int fd) {
    termios2 t = settings(fd, "pty");
    make_raw(t);
    set_rate(t, B50, 50);
    if (::ioctl(fd, TCSETS2, &t) != 0) throw_system("pty", errno);
}

bool pty_disturbed(int fd) {
    termios2 t{};
    return ::ioctl(fd, TCGETS2, &t) == 0 && (t.c_cflag & CBAUD) != B50;
}

bool enable_rs485(int fd) {
    serial_rs485 rs485{};
    if (::ioctl(fd, TIOCGRS485, &rs485) != 0) return false;
    constexpr auto kOff = static_cast<std::uint32_t>(SER_RS485_RTS_AFTER_SEND | SER_RS485_RX_DURING_TX);
    rs485.flags = (rs485.flags & ~kOff) | static_cast<std::uint32_t>(SER_RS485_ENABLED | SER_RS485_RTS_ON_SEND);
    return ::ioctl(fd, TIOCSRS485, &rs485) == 0;
}

void enable_low_latency(int fd) {
    serial_struct serial{};
    if (::ioctl(fd, TIOCGSERIAL, &serial) != 0) return;
    serial.flags = static_cast<int>(static_cast<unsigned>(serial.flags) | ASYNC_LOW_LATENCY);
    [[maybe_unused]] const int ignored = ::ioctl(fd, TIOCSSERIAL, &serial);
}

bool is_pty(int fd) {
    struct stat s {};
    if (::fstat(fd, &s) != 0 || !S_ISCHR(s.st_mode)) return false;
    const unsigned number = major(s.st_rdev);
    return number >= UNIX98_PTY_SLAVE_MAJOR && number < UNIX98_PTY_SLAVE_MAJOR + UNIX98_PTY_MAJOR_COUNT;
}

}  // namespace dpchip::live
