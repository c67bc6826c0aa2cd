// SPDX-License-Identifier: Apache-2.0
// Clock synchronisation: network time, Clock_Value (figure 7-22) and Time_AR_Parameter, block type 8 (figure 7-21;
// reference 6.3).
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/core/result.hpp>
#include <dpchip/dp/isom_prm.hpp>

namespace dpchip::dp {

/// Seconds and 2^-32 seconds. On the wire 32 bits of seconds: since 1900, or since 2036 when below 9DFF4400H.
struct NetworkTime {
    std::uint64_t seconds{};   ///< since 1900-01-01 00:00:00, whatever the era
    std::uint32_t fraction{};  ///< 2^-32 s

    friend constexpr auto operator<=>(const NetworkTime&, const NetworkTime&) = default;

    /// The first era's last second is 2036-02-07 06:28:15.
    static constexpr std::uint64_t kEra = std::uint64_t{1} << 32;
    static constexpr std::uint32_t kFirstOfTheFirstEra = 0x9DFF4400u;

    static constexpr NetworkTime from_wire(std::uint32_t seconds, std::uint32_t fraction) {
        return {seconds < kFirstOfTheFirstEra ? kEra + seconds : std::uint64_t{seconds}, fraction};
    }
    constexpr std::uint32_t wire_seconds() const { return static_cast<std::uint32_t>(seconds & 0xFFFFFFFFu); }

    /// Later by `us` microseconds, rounded to the next 2^-32 s below.
    constexpr NetworkTime plus_us(std::uint64_t us) const {
        NetworkTime t{seconds + us / 1'000'000, fraction};
        return t.plus({0, static_cast<std::uint32_t>(((us % 1'000'000) << 32) / 1'000'000)});
    }
    /// Later by `ns` nanoseconds, rounded in the same way; for up to 292 years.
    constexpr NetworkTime plus_ns(std::int64_t ns) const {
        const auto n = static_cast<std::uint64_t>(ns);
        return plus({n / 1'000'000'000, static_cast<std::uint32_t>(((n % 1'000'000'000) << 32) / 1'000'000'000)});
    }
    constexpr NetworkTime plus(const NetworkTime& o) const {
        const std::uint64_t sum = std::uint64_t{fraction} + o.fraction;
        return {seconds + o.seconds + (sum >> 32), static_cast<std::uint32_t>(sum & 0xFFFFFFFFu)};
    }
    /// This minus `o` in nanoseconds, rounded down; within +-292 years.
    constexpr std::int64_t minus_ns(const NetworkTime& o) const {
        const auto s = static_cast<std::int64_t>(seconds - o.seconds);
        const std::int64_t f = std::int64_t{fraction} - std::int64_t{o.fraction};
        return s * 1'000'000'000 + (f * 1'000'000'000 >> 32);
    }
};

constexpr NetworkTime read_time(std::span<const std::uint8_t> d, std::size_t at) {
    return NetworkTime::from_wire(detail::dword_at(d, at), detail::dword_at(d, at + 4));
}
constexpr void write_time(std::span<std::uint8_t> d, std::size_t at, const NetworkTime& t) {
    detail::put_dword(d, at, t.wire_seconds());
    detail::put_dword(d, at + 4, t.fraction);
}

// ---- Clock_Value ----------------------------------------------------------------------------------------------------

inline constexpr std::size_t kClockValueOctets = 18;
/// Function codes of the two telegrams to 127.
inline constexpr std::uint8_t kFcTimeEvent = 0x40, kFcClockValue = 0xC0;

/// CR, the resolution of the time master's clock.
enum class ClockResolution : std::uint8_t { ms_1, ms_10, ms_100, ms_1000 };

struct ClockValue {
    NetworkTime time_event{};       ///< when the Time_Event was sent
    NetworkTime previous{};         ///< when the one before was
    std::int16_t offset_min{};      ///< C and CV: local time minus this time, -930..930 in steps of 30
    bool switching_soon{};          ///< ANH: the hour will change for or from summer time
    bool summer_time{};             ///< SWT
    ClockResolution resolution{};
    bool synchronised = true;       ///< SYF = 0: the time master follows an external clock

    friend constexpr bool operator==(const ClockValue&, const ClockValue&) = default;
};

enum class ClockError : std::uint8_t {
    length,   ///< not 18 octets
    offset,   ///< not a multiple of 30 within 930 minutes
    no_room,
    type,     ///< Time_AR: not a block of type 8
};

constexpr core::Result<ClockValue, ClockError> decode_clock_value(std::span<const std::uint8_t> d) {
    if (d.size() != kClockValueOctets) return ClockError::length;
    const auto steps = static_cast<std::int16_t>(core::slice(d[16], 2, 5) * 30);
    return ClockValue{read_time(d, 0), read_time(d, 8),
                      core::bit(d[16], 7) ? static_cast<std::int16_t>(-steps) : steps, core::bit(d[17], 7), core::bit(d[17], 6),
                      static_cast<ClockResolution>(core::slice(d[17], 3, 2)), !core::bit(d[17], 0)};
}

constexpr core::Result<std::size_t, ClockError> encode(const ClockValue& v, std::span<std::uint8_t> out) {
    if (v.offset_min % 30 != 0 || v.offset_min < -930 || v.offset_min > 930) return ClockError::offset;
    if (out.size() < kClockValueOctets) return ClockError::no_room;
    write_time(out, 0, v.time_event);
    write_time(out, 8, v.previous);
    const auto steps = static_cast<unsigned>((v.offset_min < 0 ? -v.offset_min : v.offset_min) / 30);
    out[16] = static_cast<std::uint8_t>((v.offset_min < 0 ? 0x80u : 0u) | steps << 2);
    out[17] = static_cast<std::uint8_t>((v.switching_soon ? 0x80u : 0u) | (v.summer_time ? 0x40u : 0u) |
                                        static_cast<unsigned>(v.resolution) << 3 | (v.synchronised ? 0u : 1u));
    return kClockValueOctets;
}

// ---- Time_AR --------------------------------------------------------------------------------------------------------

struct TimeAr {
    std::uint16_t interval{};     ///< Clock_Sync_Interval, 10 ms; 0: no clock synchronisation
    NetworkTime delay{};          ///< CS_Delay_Time: a duration, seconds below 2^32
    bool has_delay{};

    friend constexpr bool operator==(const TimeAr&, const TimeAr&) = default;
};

constexpr core::Result<TimeAr, ClockError> decode_time_ar(const PrmBlock& b) {
    if (b.type != static_cast<std::uint8_t>(PrmBlockType::time_ar)) return ClockError::type;
    if (b.data.size() != 2 && b.data.size() != 10) return ClockError::length;
    TimeAr t{.interval = detail::word_at(b.data, 0), .has_delay = b.data.size() == 10};
    if (t.has_delay) t.delay = {detail::dword_at(b.data, 2), detail::dword_at(b.data, 6)};
    return t;
}

constexpr core::Result<std::size_t, ClockError> encode(const TimeAr& t, std::span<std::uint8_t> out) {
    const std::size_t size = t.has_delay ? 14 : 6;
    if (out.size() < size) return ClockError::no_room;
    out[0] = static_cast<std::uint8_t>(size);
    out[1] = static_cast<std::uint8_t>(PrmBlockType::time_ar);
    out[2] = out[3] = 0;
    detail::put_word(out, 4, t.interval);
    if (t.has_delay) write_time(out, 6, t.delay);
    return size;
}

}  // namespace dpchip::dp
