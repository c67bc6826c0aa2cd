// SPDX-License-Identifier: Apache-2.0
// The frame count bit towards one station (reference 2.5): the first request says so, then the bit alternates; after
// silence it starts anew.
#pragma once

#include <cstdint>

#include <dpchip/fdl/function_code.hpp>

namespace dpchip::master {

class FrameCount {
public:
    /// FC of the next request. The same again for a repetition.
    std::uint8_t fc(fdl::Request r) const { return fdl::request_fc(r, fcb_, counting_); }
    /// A request with frame count bit was answered, or given up.
    void count(bool answered) {
        fcb_ = !answered || !fcb_;
        counting_ = answered;
    }

private:
    bool counting_ = false;  ///< the bit is agreed on
    bool fcb_ = true;
};

}  // namespace dpchip::master
