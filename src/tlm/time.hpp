// SPDX-License-Identifier: Apache-2.0
// Ticks of 1/60 ns and sc_time. Both count from the start of the simulation, and only absolute times are converted, never
// differences that somebody adds up: the error stays below one unit of SystemC's resolution, 1 ps unless set, for ever.
//
// Ticks to sc_time round up and sc_time to ticks rounds down. So whatever is due at a tick has happened when the kernel
// stands at its sc_time, and an access at that sc_time is one at that tick.
#pragma once

#include <cstdint>
#include <limits>

#include <systemc>

namespace dpchip::tlm {

/// 1/60 ns, absolute: as in dpchip.h.
using Ticks = std::int64_t;

inline constexpr Ticks kNever = std::numeric_limits<Ticks>::max();

namespace detail {

__extension__ using Wide = unsigned __int128;
inline constexpr std::uint64_t kTicksPerSecond = 60'000'000'000;

/// The sc_time units of a second; fixes the time resolution, as every other sc_time does.
inline std::uint64_t units_per_second() {
    static const std::uint64_t units = sc_core::sc_time{1, sc_core::SC_SEC}.value();
    return units;
}

constexpr std::uint64_t units_from_ticks(Ticks ticks, std::uint64_t units_per_s) {
    if (ticks <= 0) return 0;
    const Wide units = (static_cast<Wide>(ticks) * units_per_s + (kTicksPerSecond - 1)) / kTicksPerSecond;
    constexpr Wide latest = std::numeric_limits<std::uint64_t>::max();
    return static_cast<std::uint64_t>(units < latest ? units : latest);
}

constexpr Ticks ticks_from_units(std::uint64_t units, std::uint64_t units_per_s) {
    const Wide ticks = static_cast<Wide>(units) * kTicksPerSecond / units_per_s;
    return static_cast<Ticks>(ticks < static_cast<Wide>(kNever - 1) ? ticks : static_cast<Wide>(kNever - 1));
}

}  // namespace detail

/// The earliest sc_time that is not before `ticks`. kNever gives sc_max_time().
inline sc_core::sc_time to_sc_time(Ticks ticks) {
    if (ticks == kNever) return sc_core::sc_max_time();
    return sc_core::sc_time::from_value(detail::units_from_ticks(ticks, detail::units_per_second()));
}

/// The last tick that is not after `time`.
inline Ticks to_ticks(const sc_core::sc_time& time) {
    return detail::ticks_from_units(time.value(), detail::units_per_second());
}

}  // namespace dpchip::tlm
