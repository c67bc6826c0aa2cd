// SPDX-License-Identifier: Apache-2.0
// A system time that goes on with a local clock between the settings by a time master, and learns from them how far the
// local clock's rate is off (VPC3+C 7.3.3: the system time is the user's own; reference 6.3). Integers only.
#pragma once

#include <cstdint>

#include <dpchip/dp/clock.hpp>

namespace dpchip::driver {

/// Local times are nanoseconds of any epoch and must not go back.
class CorrectedTime {
public:
    /// Off: the local clock's rate is taken as it is, and the time is wrong by drift times interval when it is set again.
    /// On (as at first): from the second setting on only by what the rate changes meanwhile. The rate is forgotten.
    void correct_rate(bool on) {
        correct_ = on;
        rate_ = 0;
        rate_known_ = false;
    }
    /// Forgets time and rate.
    void reset() { *this = CorrectedTime{correct_}; }

    /// It is or was `time` at `local_ns`.
    void set(const dp::NetworkTime& time, std::uint64_t local_ns) {
        correction_ = valid_ ? time.minus_ns(at(local_ns)) : 0;
        if (valid_ && correct_) learn(time, local_ns);
        if (!valid_) base_ = {time, local_ns};
        set_ = {time, local_ns};
        valid_ = true;
    }
    bool valid() const { return valid_; }
    /// The time at `local_ns`, which is not before that of the last setting.
    dp::NetworkTime at(std::uint64_t local_ns) const {
        const std::uint64_t ns = corrected(local_ns - set_.local);
        return set_.time.plus({ns / 1'000'000'000u, static_cast<std::uint32_t>((ns % 1'000'000'000u << 32) / 1'000'000'000u)});
    }
    /// How far the time was off when it was set last, in ns: new minus old. 0 at the first setting.
    std::int64_t correction_ns() const { return correction_; }
    /// By how much the local clock is slow against the time master, in parts per billion; 0 until it is known.
    std::int32_t rate_ppb() const { return rate_; }
    bool rate_known() const { return rate_known_; }

    CorrectedTime() = default;

private:
    struct Pair {
        dp::NetworkTime time{};
        std::uint64_t local = 0;
    };
    /// A microsecond is what Receive_Delay_Time can be wrong by: over a second it is one millionth.
    static constexpr std::uint64_t kShortest = 1'000'000'000, kLongest = 86'400 * kShortest;
    static constexpr std::int64_t kSteps = 1'000, kWeight = 4;

    explicit CorrectedTime(bool correct) : correct_{correct} {}

    /// A crystal is never off by a thousandth: that is a time master with another time, and tells nothing about the rate.
    void learn(const dp::NetworkTime& time, std::uint64_t local_ns) {
        const std::uint64_t span = local_ns - base_.local;
        if (span < kShortest) return;
        const auto local = static_cast<std::int64_t>(span);
        const std::int64_t off = time.minus_ns(base_.time) - local;
        base_ = {time, local_ns};
        if (span > kLongest || off > local / kSteps || off < -(local / kSteps)) return;
        const auto measured = static_cast<std::int32_t>(off * 1'000'000 / (local / 1'000));
        rate_ = rate_known_ ? rate_ + static_cast<std::int32_t>((measured - rate_) / kWeight) : measured;
        rate_known_ = true;
    }
    /// Seconds and the rest apart, so that nothing overflows before the nanoseconds do.
    std::uint64_t corrected(std::uint64_t ns) const {
        const auto s = static_cast<std::int64_t>(ns / 1'000'000'000u), rest = static_cast<std::int64_t>(ns % 1'000'000'000u);
        return ns + static_cast<std::uint64_t>(s * rate_ + rest * rate_ / 1'000'000'000);
    }

    bool correct_ = true, valid_ = false, rate_known_ = false;
    std::int32_t rate_ = 0;
    std::int64_t correction_ = 0;
    Pair base_{}, set_{};
};

}  // namespace dpchip::driver
