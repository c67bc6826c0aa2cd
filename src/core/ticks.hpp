// SPDX-License-Identifier: Apache-2.0
// Time as one integer: 60 ticks per nanosecond.
//
// 48 MHz CLK is 1250 ticks, and every PROFIBUS bit time, every figure of chapter 10.7 of the
// VPC3+C manual and every picosecond multiple of 50/3 is a whole number of ticks, so the model
// never rounds. An int64 of ticks spans 4.87 years. See docs/time.md.
#pragma once

#include <compare>
#include <cstdint>
#include <limits>

namespace dpchip::core {

/// A point in time or a duration, in 1/60 ns. No implicit conversion from or to integers.
struct Ticks {
    std::int64_t n{};

    auto operator<=>(const Ticks&) const = default;
    constexpr Ticks& operator+=(Ticks d) { n += d.n; return *this; }
    constexpr Ticks& operator-=(Ticks d) { n -= d.n; return *this; }
    friend constexpr Ticks operator+(Ticks a, Ticks b) { return {a.n + b.n}; }
    friend constexpr Ticks operator-(Ticks a, Ticks b) { return {a.n - b.n}; }
    friend constexpr Ticks operator*(Ticks a, std::int64_t k) { return {a.n * k}; }
    friend constexpr Ticks operator*(std::int64_t k, Ticks a) { return {a.n * k}; }
    /// How many whole `b` fit into `a`.
    friend constexpr std::int64_t operator/(Ticks a, Ticks b) { return a.n / b.n; }
    friend constexpr Ticks operator%(Ticks a, Ticks b) { return {a.n % b.n}; }
};

inline constexpr std::int64_t kTicksPerNs = 60;
inline constexpr std::int64_t kTicksPerSecond = kTicksPerNs * 1'000'000'000;

/// Later than everything: the deadline of a timer that does not run.
inline constexpr Ticks kNever{std::numeric_limits<std::int64_t>::max()};

namespace detail {
// Neither is defined: constant evaluation that comes to one of them stops with its name. A throw would do, too, but
// firmware compiles this without exceptions.
void not_a_whole_number_of_ticks();
void only_decimal_digits_in_a_time();
}  // namespace detail

/// `num/den` seconds. Does not compile when that is not a whole number of ticks.
consteval Ticks exact(std::int64_t num, std::int64_t den) {
    if (den <= 0 || (kTicksPerSecond * num) % den != 0) detail::not_a_whole_number_of_ticks();
    return {kTicksPerSecond * num / den};
}

/// One period of the 48 MHz system clock CLK (VPC3+C manual 8.1.1).
inline constexpr Ticks kClk = exact(1, 48'000'000);
static_assert(kClk.n == 1250);

constexpr Ticks nanoseconds(std::int64_t ns) { return {ns * kTicksPerNs}; }
constexpr Ticks microseconds(std::int64_t us) { return {us * kTicksPerNs * 1'000}; }
constexpr Ticks milliseconds(std::int64_t ms) { return {ms * kTicksPerNs * 1'000'000}; }
constexpr Ticks seconds(std::int64_t s) { return {s * kTicksPerSecond}; }

/// Whole nanoseconds in `t`, rounded down.
constexpr std::int64_t to_ns(Ticks t) {
    return t.n / kTicksPerNs - (t.n % kTicksPerNs < 0 ? 1 : 0);
}

namespace detail {
/// Reads a decimal literal exactly; `unit` is the literal's unit in ticks.
consteval Ticks parse(const char* text, std::int64_t unit) {
    std::int64_t whole = 0, fraction = 0, scale = 1;
    bool point = false;
    for (; *text != '\0'; ++text) {
        if (*text == '\'') continue;
        if (*text == '.') { point = true; continue; }
        if (*text < '0' || *text > '9') only_decimal_digits_in_a_time();
        if (point) { fraction = fraction * 10 + (*text - '0'); scale *= 10; }
        else whole = whole * 10 + (*text - '0');
    }
    if ((fraction * unit) % scale != 0) not_a_whole_number_of_ticks();
    return {whole * unit + fraction * unit / scale};
}
}  // namespace detail

/// `6.25_ns`, `3_us`, `100_ms`, `2_s`, `4_clk`: exact, or a compile error. No floating point is involved.
namespace literals {
consteval Ticks operator""_ns(const char* s) { return detail::parse(s, kTicksPerNs); }
consteval Ticks operator""_us(const char* s) { return detail::parse(s, kTicksPerNs * 1'000); }
consteval Ticks operator""_ms(const char* s) { return detail::parse(s, kTicksPerNs * 1'000'000); }
consteval Ticks operator""_s(const char* s) { return detail::parse(s, kTicksPerSecond); }
consteval Ticks operator""_clk(const char* s) { return detail::parse(s, kClk.n); }
}  // namespace literals

}  // namespace dpchip::core
