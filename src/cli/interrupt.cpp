// SPDX-License-Identifier: Apache-2.0
// Signal handlers.
#include <atomic>

#include <dpchip/cli/interrupt.hpp>

namespace dpchip::cli {
namespace {

std::atomic<live::LiveLine*> stopped_by_signal{nullptr};
static_assert(std::atomic<live::LiveLine*>::is_always_lock_free);

void on_signal(int) {
    if (live::LiveLine* const line = stopped_by_signal.load()) line->stop();
}

}  // namespace

Interrupt::Interrupt(live::LiveLine& line) {
    stopped_by_signal = &line;
    struct sigaction action {};
    action.sa_handler = on_signal;
    sigemptyset(&action.sa_mask);
    ::sigaction(SIGINT, &action, &before_int_);
    ::sigaction(SIGTERM, &action, &before_term_);
}

Interrupt::~Interrupt() {
    ::sigaction(SIGINT, &before_int_, nullptr);
    ::sigaction(SIGTERM, &before_term_, nullptr);
    stopped_by_signal = nullptr;
}

}  // namespace dpchip::cli
