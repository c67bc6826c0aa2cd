// SPDX-License-Identifier: Apache-2.0
// A handler that sets a flag.
#include <atomic>

#include <dpchip/cli/stop_signal.hpp>

namespace dpchip::cli {
namespace {

std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void on_signal(int) { stop_asked = true; }

}  // namespace

StopSignal::StopSignal() {
    stop_asked = false;
    struct sigaction action {};
    action.sa_handler = on_signal;
    sigemptyset(&action.sa_mask);
    ::sigaction(SIGINT, &action, &before_int_);
    ::sigaction(SIGTERM, &action, &before_term_);
}

StopSignal::~StopSignal() {
    ::sigaction(SIGINT, &before_int_, nullptr);
    ::sigaction(SIGTERM, &before_term_, nullptr);
}

bool StopSignal::stopped() { return stop_asked.load(std::memory_order_relaxed); }

}  // namespace dpchip::cli
