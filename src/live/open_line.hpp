// SPDX-License-Identifier: Apache-2.0
// A live line from its URI: port, clock and line in one object.
#pragma once

#include <memory>
#include <string_view>

#include <dpchip/live/line.hpp>
#include <dpchip/live/port.hpp>
#include <dpchip/live/time_source.hpp>
#include <dpchip/live/uri.hpp>

namespace dpchip::live {

class OpenLine {
public:
    /// Throws LineError.
    OpenLine(std::string_view uri, Role role, const LineOptions& options = {})
        : port_{open_port(parse_uri(uri, role), options.baud)}, line_{*port_, time_, options} {}

    LiveLine& line() { return line_; }
    Port& port() { return *port_; }
    const TimeSource& time() const { return time_; }

private:
    MonotonicTime time_;
    std::unique_ptr<Port> port_;
    LiveLine line_;
};

}  // namespace dpchip::live
