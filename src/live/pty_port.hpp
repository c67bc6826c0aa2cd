// SPDX-License-Identifier: Apache-2.0
// A new pty: masters open its tty end as if it were a serial port, come and go as they like.
#pragma once

#include <string>

#include <dpchip/live/descriptor.hpp>
#include <dpchip/live/port.hpp>
#include <dpchip/live/waiting.hpp>

namespace dpchip::live {

class PtyPort final : public Port {
public:
    /// `link`: symbolic link to the tty end, removed at the end; empty: none. A link that a dead program left is replaced.
    explicit PtyPort(std::string link);
    ~PtyPort() override;
    PtyPort(const PtyPort&) = delete;
    PtyPort& operator=(const PtyPort&) = delete;

    Medium medium() const override { return Medium::pty; }
    /// The link, or the tty end itself.
    std::string place() const override { return link_.empty() ? tty_path_ : link_; }
    /// The tty end itself: /dev/pts/N.
    const std::string& tty_path() const { return tty_path_; }
    bool receive(Reception& into) override;
    bool send(std::span<const std::uint8_t> octets) override;
    void wait(Ticks at_most) override;
    void wake() noexcept override { waiting_.wake(); }

private:
    void make_link();

    Descriptor pty_, tty_;  ///< the tty end stays open, so that the pty lives on between two masters
    std::string tty_path_, link_;
    Waiting waiting_;
};

}  // namespace dpchip::live
