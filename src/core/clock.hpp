// SPDX-License-Identifier: Apache-2.0
// A station's own clock: local ticks of its crystal against ticks of the line, exact and without drift of the arithmetic.
#pragma once

#include <cstdint>

#include <dpchip/core/assert.hpp>
#include <dpchip/core/ticks.hpp>

namespace dpchip::core {

/// Converts between line time and the local time of a crystal that runs `ppb` parts per billion fast.
/// Local to line rounds up, line to local rounds down, so that a local event is never seen early.
class Clock {
public:
    /// ppb: crystal error, -1'000'000 .. 1'000'000 (0.1 %). origin: line time at which local time is 0.
    constexpr explicit Clock(std::int32_t ppb = 0, Ticks origin = {}) : ppb_{ppb}, origin_{origin} {
        DPCHIP_ASSERT(ppb >= -1'000'000 && ppb <= 1'000'000);
    }

    constexpr Ticks local(Ticks line) const {
        if (line == kNever) return kNever;
        const std::int64_t d = line.n - origin_.n;
        if (ppb_ == 0) return {d};
        return {floor_div(static_cast<Wide>(d) * (kBillion + ppb_), kBillion)};
    }
    constexpr Ticks line(Ticks local) const {
        if (local == kNever) return kNever;
        if (ppb_ == 0) return {local.n + origin_.n};
        const Wide num = static_cast<Wide>(local.n) * kBillion;
        return {-floor_div(-num, kBillion + ppb_) + origin_.n};
    }
    constexpr std::int64_t ppb() const { return ppb_; }

private:
    __extension__ using Wide = __int128;
    static constexpr std::int64_t kBillion = 1'000'000'000;

    static constexpr std::int64_t floor_div(Wide a, std::int64_t b) {
        const Wide q = a / b;
        return static_cast<std::int64_t>(a % b < 0 ? q - 1 : q);
    }

    std::int64_t ppb_;
    Ticks origin_;
};

}  // namespace dpchip::core
