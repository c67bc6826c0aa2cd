// SPDX-License-Identifier: Apache-2.0
// Reading line URIs.
#include <charconv>
#include <optional>

#include <dpchip/live/line_error.hpp>
#include <dpchip/live/uri.hpp>

namespace dpchip::live {
namespace {

constexpr std::string_view kLoopback = "127.0.0.1";

[[noreturn]] void malformed(std::string_view text, const char* why) {
    throw LineError{LineErrorKind::malformed, std::string{"line \""} + std::string{text} + "\": " + why};
}

std::uint16_t parse_port(std::string_view digits, std::string_view text) {
    unsigned value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size() || value > 65535)
        malformed(text, "the port must be a number from 0 to 65535");
    return static_cast<std::uint16_t>(value);
}

Uri parse_tcp(std::string_view rest, std::string_view text, Scheme scheme) {
    std::string_view host, port;
    if (rest.starts_with('[')) {
        const std::size_t bracket = rest.find(']');
        if (bracket == std::string_view::npos) malformed(text, "the bracket before the IPv6 address is not closed");
        if (bracket + 1 >= rest.size() || rest[bracket + 1] != ':') malformed(text, "a port must follow the host, as in tcp:[::1]:9000");
        host = rest.substr(1, bracket - 1);
        port = rest.substr(bracket + 2);
    } else {
        const std::size_t colon = rest.rfind(':');
        host = colon == std::string_view::npos ? std::string_view{} : rest.substr(0, colon);
        port = colon == std::string_view::npos ? rest : rest.substr(colon + 1);
        if (host.find(':') != std::string_view::npos) malformed(text, "an IPv6 address needs brackets, as in tcp:[::1]:9000");
    }
    Uri uri{scheme, {}, std::string{host.empty() ? kLoopback : host}, parse_port(port, text)};
    if (scheme == Scheme::tcp_connect && uri.port == 0) malformed(text, "port 0 cannot be connected to");
    return uri;
}

Uri parse_device(std::string_view rest, std::string_view text, Scheme scheme) {
    if (rest.empty()) malformed(text, "a device must follow, as in serial:/dev/ttyUSB0");
    if (rest.find('\0') != std::string_view::npos) malformed(text, "a path cannot contain a zero octet");
    return {scheme, std::string{rest}, {}, 0};
}

}  // namespace

Uri parse_uri(std::string_view text, Role role) {
    if (text.empty()) malformed(text, "empty; use pty[:LINK], serial:DEVICE or tcp:HOST:PORT");
    const bool visit = role == Role::visit;
    if (visit && text.starts_with('/')) return parse_device(text, text, Scheme::tty);
    const std::size_t colon = text.find(':');
    const std::string_view scheme = text.substr(0, colon);
    const bool bare = colon == std::string_view::npos;
    const std::string_view rest = bare ? std::string_view{} : text.substr(colon + 1);
    if (scheme == "pty") {
        if (visit) return parse_device(rest, text, Scheme::tty);
        if (!bare && rest.empty()) malformed(text, "nothing follows the colon; plain pty needs none");
        return bare ? Uri{Scheme::pty, {}, {}, 0} : parse_device(rest, text, Scheme::pty);
    }
    if (scheme == "serial") return parse_device(rest, text, Scheme::serial);
    if (scheme == "tty") return parse_device(rest, text, Scheme::tty);
    if (scheme == "tcp") return parse_tcp(rest, text, visit ? Scheme::tcp_connect : Scheme::tcp_listen);
    if (scheme == "tcp+connect") return parse_tcp(rest, text, Scheme::tcp_connect);
    malformed(text, "unknown kind of line; use pty[:LINK], serial:DEVICE or tcp:HOST:PORT");
}

}  // namespace dpchip::live
