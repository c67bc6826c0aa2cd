// SPDX-License-Identifier: Apache-2.0
// A set of stations of one segment, as bits; walked in index order, which is the order of everything at one tick.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace dpchip::segment {

/// Number of a station on its segment: its place in the order of attaching.
using StationIndex = std::uint16_t;

inline constexpr std::size_t kMaxStations = 256;
inline constexpr StationIndex kNobody = 0xFFFF;  ///< sender of noise

class StationSet {
public:
    constexpr void add(StationIndex i) { words_[i / 64u] |= std::uint64_t{1} << (i % 64u); }
    constexpr void remove(StationIndex i) { words_[i / 64u] &= ~(std::uint64_t{1} << (i % 64u)); }
    constexpr void set(StationIndex i, bool in) { in ? add(i) : remove(i); }
    constexpr bool has(StationIndex i) const { return (words_[i / 64u] >> (i % 64u) & 1u) != 0; }
    constexpr void operator|=(const StationSet& other) {
        for (std::size_t w = 0; w < kWords; ++w) words_[w] |= other.words_[w];
    }
    bool operator==(const StationSet&) const = default;

    /// Calls `visit(StationIndex)` for each member as it is now, lowest index first.
    template <class Visit>
    constexpr void each(Visit&& visit) const {
        for (std::size_t w = 0; w < kWords; ++w)
            for (std::uint64_t rest = words_[w]; rest != 0; rest &= rest - 1)
                visit(static_cast<StationIndex>(w * 64 + static_cast<std::size_t>(std::countr_zero(rest))));
    }

private:
    static constexpr std::size_t kWords = kMaxStations / 64;
    std::array<std::uint64_t, kWords> words_{};
};

}  // namespace dpchip::segment
