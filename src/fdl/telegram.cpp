// SPDX-License-Identifier: Apache-2.0
// Words for the reasons to reject a telegram.
#include <dpchip/fdl/telegram.hpp>

namespace dpchip::fdl {

const char* name(Reject reason) {
    switch (reason) {
    case Reject::need_more: return "incomplete";
    case Reject::start_delimiter: return "no start delimiter";
    case Reject::length_mismatch: return "LE and LEr differ";
    case Reject::length_range: return "LE outside 4..249";
    case Reject::second_start_delimiter: return "second start delimiter missing";
    case Reject::checksum: return "wrong FCS";
    case Reject::end_delimiter: return "wrong ED";
    case Reject::parity: return "parity error";
    case Reject::stop_bit: return "stop bit missing";
    case Reject::gap: return "gap between characters";
    case Reject::collision: return "collision";
    }
    return "unknown";
}

}  // namespace dpchip::fdl
