// SPDX-License-Identifier: Apache-2.0
// A line over TCP: raw octets. The listener is a hub: what a slave says goes to everybody, good telegrams of one
// visitor to the others. No encryption, no authentication: it binds the loopback unless told otherwise.
#pragma once

#include <array>
#include <string>

#include <dpchip/live/descriptor.hpp>
#include <dpchip/live/port.hpp>
#include <dpchip/live/waiting.hpp>

namespace dpchip::live {

class TcpListenPort final : public Port {
public:
    TcpListenPort(const std::string& host, std::uint16_t port);

    Medium medium() const override { return Medium::tcp; }
    std::string place() const override { return place_; }
    bool receive(Reception& into) override;
    bool send(std::span<const std::uint8_t> octets) override;
    void relay(std::span<const std::uint8_t> octets, std::size_t source) override;
    void wait(Ticks at_most) override;
    void wake() noexcept override { waiting_.wake(); }
    /// Visitors connected now.
    [[nodiscard]] std::size_t visitors() const;

private:
    void accept_all();

    Descriptor listener_;
    std::array<Descriptor, kMaxSources> visitors_{};
    std::size_t turn_{};
    std::string place_;
    Waiting waiting_;
};

/// The visitor's end.
class TcpConnectPort final : public Port {
public:
    TcpConnectPort(const std::string& host, std::uint16_t port);

    Medium medium() const override { return Medium::tcp; }
    std::string place() const override { return place_; }
    bool receive(Reception& into) override;
    bool send(std::span<const std::uint8_t> octets) override;
    void wait(Ticks at_most) override;
    void wake() noexcept override { waiting_.wake(); }

private:
    Descriptor socket_;
    std::string place_;
    Waiting waiting_;
};

}  // namespace dpchip::live
