// SPDX-License-Identifier: Apache-2.0
// Sockets of a TCP line.
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <memory>

#include <dpchip/live/tcp_port.hpp>

namespace dpchip::live {
namespace {

struct FreeAddresses {
    void operator()(addrinfo* list) const { ::freeaddrinfo(list); }
};
using Addresses = std::unique_ptr<addrinfo, FreeAddresses>;

std::string place_of(const std::string& host, std::uint16_t port) {
    return (host.find(':') != std::string::npos ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

Addresses resolve(const std::string& host, std::uint16_t port, int flags) {
    addrinfo hints{};
    hints.ai_family = AF_UNSPEC;
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = flags | AI_NUMERICSERV;
    addrinfo* list = nullptr;
    const int error = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &list);
    if (error != 0) throw LineError{LineErrorKind::missing, "tcp:" + place_of(host, port) + ": " + ::gai_strerror(error)};
    return Addresses{list};
}

/// Telegrams are short and answers urgent: no waiting for more octets.
void make_prompt(int fd) {
    const int on = 1;
    ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) | O_NONBLOCK);
}

std::uint16_t bound_port(int fd) {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    if (::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
    if (address.ss_family == AF_INET6) return ntohs(reinterpret_cast<const sockaddr_in6*>(&address)->sin6_port);
    return ntohs(reinterpret_cast<const sockaddr_in*>(&address)->sin_port);
}

/// EWOULDBLOCK is the same number as EAGAIN.
bool would_block(int code) { return code == EAGAIN || code == EINTR; }

enum class Got : std::uint8_t { octets, nothing, closed };

Got receive_from(int fd, Reception& into) {
    const ssize_t got = ::recv(fd, into.octets.data(), into.octets.size(), MSG_DONTWAIT);
    if (got == 0 || (got < 0 && !would_block(errno))) return Got::closed;
    if (got < 0) return Got::nothing;
    into.size = static_cast<std::size_t>(got);
    into.faults.fill(0);
    return Got::octets;
}

bool send_to(int fd, std::span<const std::uint8_t> octets) {
    return ::send(fd, octets.data(), octets.size(), MSG_NOSIGNAL | MSG_DONTWAIT) == static_cast<ssize_t>(octets.size());
}

}  // namespace

TcpListenPort::TcpListenPort(const std::string& host, std::uint16_t port) {
    const Addresses list = resolve(host, port, AI_PASSIVE);
    int code = 0;
    for (const addrinfo* a = list.get(); a != nullptr && !listener_; a = a->ai_next) {
        Descriptor fd{::socket(a->ai_family, a->ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK, a->ai_protocol)};
        const int on = 1;
        if (fd) ::setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
        if (fd && ::bind(fd.get(), a->ai_addr, a->ai_addrlen) == 0 && ::listen(fd.get(), 8) == 0) listener_ = std::move(fd);
        else code = errno;
    }
    if (!listener_) throw_system("tcp:" + place_of(host, port), code);
    place_ = place_of(host, bound_port(listener_.get()));
}

void TcpListenPort::accept_all() {
    for (;;) {
        Descriptor visitor{::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK)};
        if (!visitor) return;
        const auto free = std::find_if(visitors_.begin(), visitors_.end(), [](const Descriptor& d) { return !d; });
        if (free == visitors_.end()) continue;  // the house is full: closed again at once
        make_prompt(visitor.get());
        *free = std::move(visitor);
    }
}

bool TcpListenPort::receive(Reception& into) {
    accept_all();
    for (std::size_t n = 0; n < visitors_.size(); ++n) {
        turn_ = (turn_ + 1) % visitors_.size();
        Descriptor& visitor = visitors_[turn_];
        if (!visitor) continue;
        const Got got = receive_from(visitor.get(), into);
        if (got == Got::closed) visitor.close();
        if (got != Got::octets) continue;
        into.source = turn_;
        return true;
    }
    return false;
}

bool TcpListenPort::send(std::span<const std::uint8_t> octets) {
    bool anybody = false;
    for (Descriptor& visitor : visitors_) {
        if (!visitor) continue;
        if (send_to(visitor.get(), octets)) anybody = true;
        else visitor.close();  // it took a part or does not read: its stream is spoilt
    }
    return anybody;
}

void TcpListenPort::relay(std::span<const std::uint8_t> octets, std::size_t source) {
    for (std::size_t i = 0; i < visitors_.size(); ++i)
        if (i != source && visitors_[i] && !send_to(visitors_[i].get(), octets)) visitors_[i].close();
}

void TcpListenPort::wait(Ticks at_most) {
    std::array<pollfd, kMaxSources + 1> fds{};
    std::size_t count = 0;
    fds[count++] = {listener_.get(), POLLIN, 0};
    for (const Descriptor& visitor : visitors_)
        if (visitor) fds[count++] = {visitor.get(), POLLIN, 0};
    waiting_.wait(std::span{fds}.first(count), at_most);
}

std::size_t TcpListenPort::visitors() const {
    return static_cast<std::size_t>(std::count_if(visitors_.begin(), visitors_.end(), [](const Descriptor& d) { return static_cast<bool>(d); }));
}

TcpConnectPort::TcpConnectPort(const std::string& host, std::uint16_t port) : place_{place_of(host, port)} {
    const Addresses list = resolve(host, port, 0);
    int code = 0;
    for (const addrinfo* a = list.get(); a != nullptr && !socket_; a = a->ai_next) {
        Descriptor fd{::socket(a->ai_family, a->ai_socktype | SOCK_CLOEXEC, a->ai_protocol)};
        if (fd && ::connect(fd.get(), a->ai_addr, a->ai_addrlen) == 0) socket_ = std::move(fd);
        else code = errno;
    }
    if (!socket_) throw_system("tcp:" + place_, code);
    make_prompt(socket_.get());
}

bool TcpConnectPort::receive(Reception& into) {
    const Got got = receive_from(socket_.get(), into);
    if (got == Got::closed) throw LineError{LineErrorKind::gone, "tcp:" + place_ + ": the connection was closed"};
    into.source = 0;
    return got == Got::octets;
}

bool TcpConnectPort::send(std::span<const std::uint8_t> octets) { return send_to(socket_.get(), octets); }

void TcpConnectPort::wait(Ticks at_most) {
    pollfd fds[]{{socket_.get(), POLLIN, 0}};
    waiting_.wait(fds, at_most);
}

}  // namespace dpchip::live
