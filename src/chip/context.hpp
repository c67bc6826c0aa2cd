// SPDX-License-Identifier: Apache-2.0
// What the blocks of the chip share: the state, what the variant can do, and where facts go. Not for users; Chip is the door.
#pragma once

#include <cstddef>
#include <cstdint>

#include <dpchip/chip/state.hpp>
#include <dpchip/core/bits.hpp>
#include <dpchip/core/finding.hpp>
#include <dpchip/core/fixed_queue.hpp>
#include <dpchip/core/trace.hpp>
#include <dpchip/regmap/address.hpp>
#include <dpchip/regmap/fact.hpp>
#include <dpchip/regmap/options.hpp>
#include <dpchip/regmap/variant.hpp>

namespace dpchip::chip {

using regmap::Fact;
using regmap::Rule;

/// The Micro Sequencer moved octets of a buffer in the Dual-Port RAM.
struct RamUse {
    Ticks at{};
    std::uint16_t octets{};
};

/// Blocks are sets of functions over a Context; none of them keeps anything of its own.
template <class Trace>
struct Context {
    State s;
    const regmap::Traits* traits;
    regmap::Options options;
    core::FixedQueue<Edge, 64> edges;
    core::FixedQueue<core::Finding, 64> findings;
    core::FixedQueue<RamUse, 32> ram_uses{};  ///< while somebody watches the RAM
    bool ram_watched = false;
    [[no_unique_address]] Trace trace;

    void fact(Fact what, std::uint32_t b) { fact(what, 0, b); }
    void fact(Fact what, std::uint16_t a, std::uint32_t b) {
        trace.emit([&] { return core::TraceRecord{s.now, static_cast<std::uint16_t>(what), a, b}; });
    }
    void ram_used(std::size_t octets) {
        if (ram_watched) ram_uses.push({s.now, static_cast<std::uint16_t>(octets)});
    }
    void find(Rule rule, std::uint32_t detail) {
        findings.push({s.now, regmap::kRules[static_cast<std::size_t>(rule)].kind, static_cast<std::uint16_t>(rule), detail});
        fact(Fact::finding, static_cast<std::uint16_t>(rule), detail);
    }
};

/// Changes a traced octet and tells when it really changed.
template <class Trace, class T>
void change(Context<Trace>& c, Fact what, T& member, T value) {
    if (member == value) return;
    const auto before = static_cast<std::uint16_t>(member);
    member = value;
    c.fact(what, before, static_cast<std::uint32_t>(value));
}

}  // namespace dpchip::chip
