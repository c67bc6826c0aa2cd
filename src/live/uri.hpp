// SPDX-License-Identifier: Apache-2.0
// The names of live lines: pty[:LINK], serial:DEVICE, tcp:HOST:PORT, and what a master opens: tty:PATH, tcp+connect:HOST:PORT.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace dpchip::live {

enum class Scheme : std::uint8_t {
    pty,          ///< makes a new pty
    serial,       ///< opens a serial device
    tty,          ///< opens the tty end of somebody's pty, or a serial device
    tcp_listen,   ///< waits for connections
    tcp_connect,  ///< connects
};

/// Which end of the line a program wants to be: the one that makes the meeting place or the one that comes to it.
enum class Role : std::uint8_t { serve, visit };

struct Uri {
    Scheme scheme{};
    std::string path;         ///< pty: link to make, may be empty; serial, tty: device
    std::string host;         ///< tcp: never empty
    std::uint16_t port{};     ///< tcp: 0 lets the system choose (tcp_listen only)
};

/// Reads a URI; throws LineError{malformed} in words that say what is wrong.
/// For Role::visit, `pty:PATH` means tty:PATH, `tcp:` means tcp+connect:, and a bare path beginning with / means tty:PATH.
/// A missing host (`tcp:9000`, `tcp::9000`) is 127.0.0.1. IPv6 hosts stand in brackets.
Uri parse_uri(std::string_view text, Role role = Role::serve);

}  // namespace dpchip::live
