// SPDX-License-Identifier: Apache-2.0
// A serial device, or the tty end of somebody's pty.
//
// Direction control of an RS-485 adapter is the driver's or the adapter's business; nothing here waits to switch it.
#pragma once

#include <string>

#include <dpchip/live/descriptor.hpp>
#include <dpchip/live/port.hpp>
#include <dpchip/live/time_source.hpp>
#include <dpchip/live/uart_stream.hpp>
#include <dpchip/live/waiting.hpp>

namespace dpchip::live {

class DevicePort final : public Port {
public:
    /// Which devices are taken: a serial one only, or the tty end of a pty as well.
    enum class Accept : std::uint8_t { serial_only, pty_too };

    /// Opens `device` for this program alone and sets 8E1 at `baud`.
    DevicePort(std::string device, fdl::BaudCode baud, Accept accept);

    Medium medium() const override { return pty_ ? Medium::pty : Medium::serial; }
    std::string place() const override { return device_; }
    bool receive(Reception& into) override;
    bool send(std::span<const std::uint8_t> octets) override;
    void wait(Ticks at_most) override;
    void wake() noexcept override { waiting_.wake(); }
    bool set_baud(fdl::BaudCode baud) override;

private:
    void lock();

    std::string device_;
    Descriptor tty_;
    bool pty_{};
    bool lost_{};  ///< poll says that the device is gone; shown by the next receive()
    fdl::BaudCode baud_;
    ParityMarks marks_;
    EchoFilter echo_;
    MonotonicTime time_;
    Waiting waiting_;
};

}  // namespace dpchip::live
