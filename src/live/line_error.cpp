// SPDX-License-Identifier: Apache-2.0
// From errno to a LineError.
#include <cerrno>
#include <system_error>

#include <dpchip/live/line_error.hpp>

namespace dpchip::live {
namespace {

LineErrorKind kind_of(int code) {
    switch (code) {
    case ENOENT: case ENODEV: case ENXIO: case ENOTDIR: case EADDRNOTAVAIL: case ECONNREFUSED: case EHOSTUNREACH: case ENETUNREACH:
    case ETIMEDOUT:
        return LineErrorKind::missing;
    case EACCES: case EPERM: case EROFS: return LineErrorKind::permission;
    case EBUSY: case EADDRINUSE: case EWOULDBLOCK: case EEXIST: return LineErrorKind::busy;
    case ENOTTY: case EISDIR: case EINVAL: return LineErrorKind::unsuitable;
    case EIO: case EPIPE: case ECONNRESET: case EBADF: return LineErrorKind::gone;
    default: return LineErrorKind::system;
    }
}

}  // namespace

const char* name(LineErrorKind kind) {
    switch (kind) {
    case LineErrorKind::malformed: return "malformed";
    case LineErrorKind::missing: return "missing";
    case LineErrorKind::permission: return "permission";
    case LineErrorKind::busy: return "busy";
    case LineErrorKind::unsuitable: return "unsuitable";
    case LineErrorKind::baud: return "baud";
    case LineErrorKind::gone: return "gone";
    case LineErrorKind::system: return "system";
    }
    return "unknown";
}

void throw_system(const std::string& what, int code) {
    throw LineError{kind_of(code), what + ": " + std::generic_category().message(code)};
}

}  // namespace dpchip::live
