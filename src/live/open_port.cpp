// SPDX-License-Identifier: Apache-2.0
// From a URI to a port.
#include <dpchip/live/device_port.hpp>
#include <dpchip/live/port.hpp>
#include <dpchip/live/pty_port.hpp>
#include <dpchip/live/tcp_port.hpp>

namespace dpchip::live {

const char* name(Medium medium) {
    switch (medium) {
    case Medium::pty: return "pty";
    case Medium::tcp: return "tcp";
    case Medium::serial: return "serial";
    }
    return "unknown";
}

void Port::relay(std::span<const std::uint8_t>, std::size_t) {}
bool Port::set_baud(fdl::BaudCode) { return true; }

std::unique_ptr<Port> open_port(const Uri& uri, fdl::BaudCode baud) {
    switch (uri.scheme) {
    case Scheme::pty: return std::make_unique<PtyPort>(uri.path);
    case Scheme::serial: return std::make_unique<DevicePort>(uri.path, baud, DevicePort::Accept::serial_only);
    case Scheme::tty: return std::make_unique<DevicePort>(uri.path, baud, DevicePort::Accept::pty_too);
    case Scheme::tcp_listen: return std::make_unique<TcpListenPort>(uri.host, uri.port);
    case Scheme::tcp_connect: return std::make_unique<TcpConnectPort>(uri.host, uri.port);
    }
    throw LineError{LineErrorKind::malformed, "unknown kind of line"};
}

}  // namespace dpchip::live
