// SPDX-License-Identifier: Apache-2.0
// Faults on the line, on purpose: what goes wrong with which transmission. Seeded or scripted, always repeatable.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/fdl/transmission.hpp>
#include <dpchip/segment/station_set.hpp>

namespace dpchip::segment {

enum class FaultKind : std::uint8_t {
    none,
    flip,      ///< bits of one octet are inverted on the line; an odd number of them spoils the parity too
    parity,    ///< one parity bit is inverted
    stop,      ///< one stop bit is 0
    truncate,  ///< nothing follows from one octet on
    gap,       ///< the line is idle for a while before one octet
    late,      ///< the whole transmission begins later
    drop,      ///< nothing reaches the line
    noise,     ///< a few characters that nobody sent follow after a while
};
inline constexpr std::size_t kFaultKinds = 9;
const char* name(FaultKind kind);

struct Fault {
    FaultKind kind = FaultKind::none;
    std::uint16_t octet = 0;  ///< which octet; taken modulo the length. noise: how many characters (1..15)
    std::uint8_t mask = 0x01; ///< flip: which bits; noise: the octet
    std::int64_t bits = 1;    ///< gap, late, noise: how long, in bit times
};

/// Decides about every transmission: a callable Fault(const Transmission&, StationIndex sender, uint64_t number).
/// Numbers count the segment's transmissions from 0.
class FaultRef {
public:
    FaultRef() = default;
    template <class F>
    explicit FaultRef(F& source)
        : object_{&source}, decide_{[](void* o, const fdl::Transmission& t, StationIndex sender, std::uint64_t number) {
              return (*static_cast<F*>(o))(t, sender, number);
          }} {}
    explicit operator bool() const { return decide_ != nullptr; }
    Fault operator()(const fdl::Transmission& t, StationIndex sender, std::uint64_t number) const {
        return decide_(object_, t, sender, number);
    }

private:
    void* object_ = nullptr;
    Fault (*decide_)(void*, const fdl::Transmission&, StationIndex, std::uint64_t) = nullptr;
};

/// A small random generator (splitmix64): the same numbers everywhere.
class Random {
public:
    explicit constexpr Random(std::uint64_t seed) : state_{seed} {}
    constexpr std::uint64_t next() {
        state_ += 0x9E37'79B9'7F4A'7C15u;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xBF58'476D'1CE4'E5B9u;
        z = (z ^ (z >> 27)) * 0x94D0'49BB'1331'11EBu;
        return z ^ (z >> 31);
    }
    /// 0 .. limit-1; limit must not be 0.
    constexpr std::uint64_t below(std::uint64_t limit) { return next() % limit; }

private:
    std::uint64_t state_;
};

/// Faults at random: each kind so many times in a million transmissions (their sum at most a million).
class RandomFaults {
public:
    using Rates = std::array<std::uint32_t, kFaultKinds>;  ///< indexed by FaultKind; [none] is not used
    RandomFaults(std::uint64_t seed, const Rates& per_million) : random_{seed}, per_million_{per_million} {}

    Fault operator()(const fdl::Transmission& t, StationIndex sender, std::uint64_t number);
    /// How often each kind was chosen.
    const std::array<std::uint64_t, kFaultKinds>& counts() const { return counts_; }

private:
    Random random_;
    Rates per_million_;
    std::array<std::uint64_t, kFaultKinds> counts_{};
};

/// Faults by the number of the transmission.
class ScriptedFaults {
public:
    struct Line {
        std::uint64_t number;
        Fault fault;
    };
    /// `script` is not copied and must outlive this.
    explicit ScriptedFaults(std::span<const Line> script) : script_{script} {}
    Fault operator()(const fdl::Transmission&, StationIndex, std::uint64_t number) const {
        for (const Line& line : script_)
            if (line.number == number) return line.fault;
        return {};
    }

private:
    std::span<const Line> script_;
};

}  // namespace dpchip::segment
