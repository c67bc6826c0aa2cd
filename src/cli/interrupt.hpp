// SPDX-License-Identifier: Apache-2.0
// SIGINT and SIGTERM end a live line's run() instead of the program, so that it can say what it did and tidy up.
#pragma once

#include <signal.h>

#include <dpchip/live/line.hpp>

namespace dpchip::cli {

/// While one of these lives, both signals stop its line. One at a time.
class Interrupt {
public:
    explicit Interrupt(live::LiveLine& line);
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

private:
    struct sigaction before_int_ {}, before_term_ {};
};

}  // namespace dpchip::cli
