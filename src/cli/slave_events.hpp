// SPDX-License-Identifier: Apache-2.0
// Events of a slave's own side - a diagnosis, an alarm, a status message, another I/O behaviour - done to a virtual slave.
#pragma once

#include <string>

#include <dpchip/cli/line_config.hpp>
#include <dpchip/slave/virtual_slave.hpp>

namespace dpchip::cli {

/// What came of an event, in words; `good` is false when the master will not hear of it, and why stands in `words`.
struct Deed {
    bool good = true;
    std::string words;
};
/// Does it, event.kind being is_of_the_slave(). Throws Failure when this slave can never do it: too long, no DP-V1.
Deed do_to(slave::VirtualSlave& slave, const EventEntry& event);

}  // namespace dpchip::cli
