// SPDX-License-Identifier: Apache-2.0
// ppoll(2) and an eventfd.
#include <sys/eventfd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include <dpchip/live/line_error.hpp>
#include <dpchip/live/waiting.hpp>

namespace dpchip::live {
namespace {

constexpr std::size_t kMost = 32;

}  // namespace

Waiting::Waiting() : event_{::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)} {
    if (!event_) throw_system("eventfd", errno);
}

void Waiting::wait(std::span<pollfd> fds, core::Ticks at_most) {
    std::array<pollfd, kMost + 1> all{};
    const std::size_t count = std::min(fds.size(), kMost);
    std::copy_n(fds.begin(), count, all.begin());
    all[count] = {event_.get(), POLLIN, 0};
    // Rounded up: waking a moment too early would only mean one more round.
    const std::int64_t ns = std::clamp<std::int64_t>((at_most.n + core::kTicksPerNs - 1) / core::kTicksPerNs, 0, 3'600'000'000'000);
    const timespec limit{ns / 1'000'000'000, ns % 1'000'000'000};
    if (::ppoll(all.data(), count + 1, &limit, nullptr) < 0 && errno != EINTR) throw_system("poll", errno);
    std::copy_n(all.begin(), count, fds.begin());
    if ((all[count].revents & POLLIN) != 0) {
        std::uint64_t woken = 0;
        [[maybe_unused]] const auto got = ::read(event_.get(), &woken, sizeof woken);
    }
}

void Waiting::wake() noexcept {
    const int before = errno;
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto put = ::write(event_.get(), &one, sizeof one);
    errno = before;
}

}  // namespace dpchip::live
