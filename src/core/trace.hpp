// SPDX-License-Identifier: Apache-2.0
// The 16-byte trace record and its two sinks: none at all, or a ring that the owner reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include <dpchip/core/ticks.hpp>

namespace dpchip::core {

/// One fact. What `what`, `a` and `b` mean is the business of the layer that emits it; dpchip::trace renders it.
struct TraceRecord {
    Ticks at{};
    std::uint16_t what{};
    std::uint16_t a{};
    std::uint32_t b{};
    bool operator==(const TraceRecord&) const = default;
};
static_assert(sizeof(TraceRecord) == 16 && std::is_trivially_copyable_v<TraceRecord>);

/// Swallows everything; the compiler removes the call and the construction of the record.
struct NoTrace {
    template <class Make>
    static constexpr void emit(Make&&) {}
    static constexpr bool active() { return false; }
};

/// Records into memory that the owner provides; the oldest records are overwritten. Not thread-safe.
struct RingTrace {
    TraceRecord* ring = nullptr;  ///< null: nothing is recorded
    std::size_t capacity = 0;
    std::uint64_t count = 0;      ///< records emitted since the ring was attached

    void attach(std::span<TraceRecord> memory) { ring = memory.data(); capacity = memory.size(); count = 0; }

    /// True while somebody looks: then blocks must not be moved in one step.
    bool active() const { return ring != nullptr && capacity != 0; }

    template <class Make>
    void emit(Make&& make) {
        if (!active()) return;
        ring[count++ % capacity] = make();
    }
};

}  // namespace dpchip::core
