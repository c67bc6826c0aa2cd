// SPDX-License-Identifier: Apache-2.0
// Terminal settings that termios(3) cannot express: any rate (termios2, BOTHER), RS-485 direction, low latency.
#pragma once

#include <cstdint>
#include <string>

#include <dpchip/fdl/baud.hpp>

namespace dpchip::live {

/// Raw mode, 8 data bits, even parity, 1 stop bit, damaged characters marked (PARMRK, INPCK), at `baud`.
/// Reads the rate back: throws LineError{baud} when it is more than 2 % off, {unsuitable} without even parity.
void set_uart(int fd, const std::string& device, fdl::BaudCode baud);

/// Raw mode for the tty end of a pty, as a master's program would set it: 8E1 at a standard rate, nothing marked.
void set_visitor(int fd, const std::string& device);

/// Raw mode at B50, a rate no master uses. A pty keeps no parity, and refuses a request that changes nothing else: the
/// next master that asks for 8E1 at its own rate changes at least the rate.
void set_pty_rest(int fd);
/// True when the rate of the tty end is not B50 any more.
bool pty_disturbed(int fd);

/// Direction by the driver (TIOCSRS485), where it can; true when it does.
bool enable_rs485(int fd);
/// Asks the driver not to collect octets before it hands them over; nothing happens where it cannot.
void enable_low_latency(int fd);
/// True for the tty end of a pty.
bool is_pty(int fd);

/// |got - wanted| <= 2 % of wanted.
constexpr bool rate_close(std::uint32_t got, std::uint32_t wanted) {
    const std::uint32_t off = got > wanted ? got - wanted : wanted - got;
    return std::uint64_t{off} * 50 <= wanted;
}

}  // namespace dpchip::live
