// SPDX-License-Identifier: Apache-2.0
// Random faults and the words for faults.
#include <dpchip/segment/fault.hpp>

namespace dpchip::segment {

const char* name(FaultKind kind) {
    switch (kind) {
    case FaultKind::none: return "none";
    case FaultKind::flip: return "flipped bits";
    case FaultKind::parity: return "wrong parity";
    case FaultKind::stop: return "stop bit missing";
    case FaultKind::truncate: return "cut short";
    case FaultKind::gap: return "gap";
    case FaultKind::late: return "late";
    case FaultKind::drop: return "lost";
    case FaultKind::noise: return "noise";
    }
    return "unknown";
}

Fault RandomFaults::operator()(const fdl::Transmission& t, StationIndex, std::uint64_t) {
    std::uint64_t dice = random_.below(1'000'000);
    const std::uint64_t details = random_.next();
    for (std::size_t kind = 1; kind < kFaultKinds; ++kind) {
        if (dice >= per_million_[kind]) {
            dice -= per_million_[kind];
            continue;
        }
        ++counts_[kind];
        Fault fault;
        fault.kind = static_cast<FaultKind>(kind);
        fault.octet = static_cast<std::uint16_t>((details & 0xFFFFu) % t.length);
        fault.mask = static_cast<std::uint8_t>(1u << (details >> 16 & 7u) | 1u << (details >> 19 & 7u));
        fault.bits = static_cast<std::int64_t>(1 + (details >> 24) % 300);
        return fault;
    }
    return {};
}

}  // namespace dpchip::segment
