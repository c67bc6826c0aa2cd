// SPDX-License-Identifier: Apache-2.0
// Waiting for descriptors with a way to be woken from a signal handler.
#pragma once

#include <poll.h>

#include <span>

#include <dpchip/core/ticks.hpp>
#include <dpchip/live/descriptor.hpp>

namespace dpchip::live {

class Waiting {
public:
    Waiting();
    /// Waits for the events in `fds`, wake(), or the end of `at_most`. Fills revents.
    void wait(std::span<pollfd> fds, core::Ticks at_most);
    /// Async-signal-safe.
    void wake() noexcept;

private:
    Descriptor event_;
};

}  // namespace dpchip::live
