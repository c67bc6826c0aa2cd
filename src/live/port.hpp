// SPDX-License-Identifier: Apache-2.0
// The port of a live line: octets in, octets out, and waiting for them. Everything that touches the operating system
// stands behind this interface, so that a test can put a fake port and a fake time in its place.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <dpchip/core/ticks.hpp>
#include <dpchip/fdl/baud.hpp>
#include <dpchip/live/line_error.hpp>
#include <dpchip/live/uri.hpp>

namespace dpchip::live {

using core::Ticks;

/// What carries the octets: decides whether bit times mean anything on the line.
enum class Medium : std::uint8_t { pty, tcp, serial };
const char* name(Medium medium);

/// Octets that were read in one go from one source.
struct Reception {
    std::array<std::uint8_t, 1024> octets{};
    std::array<std::uint8_t, 1024> faults{};  ///< per octet, mask of fdl::CharacterFault
    std::size_t size{};
    std::size_t source{};                     ///< which of several connections, below Port::kMaxSources

    [[nodiscard]] std::span<const std::uint8_t> bytes() const { return {octets.data(), size}; }
    [[nodiscard]] std::span<const std::uint8_t> damage() const { return {faults.data(), size}; }
};

class Port {
public:
    static constexpr std::size_t kMaxSources = 16;

    virtual ~Port() = default;

    [[nodiscard]] virtual Medium medium() const = 0;
    /// What a visitor opens: a path, or HOST:PORT.
    [[nodiscard]] virtual std::string place() const = 0;
    /// Fetches what has arrived without waiting; false when nothing has. Throws LineError{gone} when the port is gone.
    virtual bool receive(Reception& into) = 0;
    /// Sends all octets in one write; false when that was not possible now (nobody takes them): then none count as sent.
    virtual bool send(std::span<const std::uint8_t> octets) = 0;
    /// A good telegram came from `source`: passes it on to the other connections, where there are several.
    virtual void relay(std::span<const std::uint8_t> octets, std::size_t source);
    /// Waits until something has arrived, at most `at_most`; returns early when wake() is called.
    virtual void wait(Ticks at_most) = 0;
    /// Ends a wait(), the present one or the next. May be called from a signal handler and from other threads.
    virtual void wake() noexcept = 0;
    /// Changes the rate of a UART; false when the device cannot do it. Other media say true and do nothing.
    virtual bool set_baud(fdl::BaudCode baud);
};

/// Opens what a URI names. `baud` matters to serial devices. Throws LineError.
std::unique_ptr<Port> open_port(const Uri& uri, fdl::BaudCode baud);

}  // namespace dpchip::live
