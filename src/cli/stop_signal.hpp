// SPDX-License-Identifier: Apache-2.0
// SIGINT and SIGTERM as something to ask for: whoever runs in virtual time ends in order, and its files are whole.
#pragma once

#include <signal.h>

namespace dpchip::cli {

/// While one of these lives, both signals only set stopped(). One at a time.
class StopSignal {
public:
    StopSignal();
    ~StopSignal();
    StopSignal(const StopSignal&) = delete;
    StopSignal& operator=(const StopSignal&) = delete;

    static bool stopped();

private:
    struct sigaction before_int_ {}, before_term_ {};
};

}  // namespace dpchip::cli
