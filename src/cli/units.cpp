// SPDX-License-Identifier: Apache-2.0
// Reading and writing quantities.
#include <charconv>
#include <cmath>
#include <array>

#include <fmt/format.h>

#include <dpchip/cli/units.hpp>

namespace dpchip::cli {
namespace {

/// A decimal number at the beginning of `text`, which is shortened by it.
std::optional<double> take_number(std::string_view& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
    if (error != std::errc{} || value < 0) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
}

int digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

}  // namespace

std::optional<fdl::BaudCode> parse_baud(std::string_view text) {
    const auto number = take_number(text);
    if (!number) return std::nullopt;
    if (text != "M" && text != "k" && !text.empty()) return std::nullopt;
    const bool kilo = text == "k" || (text.empty() && *number < 1000);  // 19.2, as GSD keywords have it
    const double scale = text == "M" ? 1e6 : kilo ? 1e3 : 1;
    const double rate = *number * scale;
    if (rate > 12e6) return std::nullopt;
    return fdl::baud_from_bits_per_s(static_cast<std::uint32_t>(std::lround(rate)));
}

std::optional<Ticks> parse_duration(std::string_view text) {
    const auto number = take_number(text);
    if (!number) return std::nullopt;
    double ns = 0;
    if (text == "s") ns = 1e9;
    else if (text == "ms") ns = 1e6;
    else if (text == "us") ns = 1e3;
    else if (text == "ns") ns = 1;
    else return std::nullopt;
    const double ticks = *number * ns * static_cast<double>(core::kTicksPerNs);
    if (ticks > 864'000e9 * static_cast<double>(core::kTicksPerNs)) return std::nullopt;
    return Ticks{std::llround(ticks)};
}

std::optional<SlotTime> parse_slot_time(std::string_view text) {
    if (const auto duration = parse_duration(text)) {
        if (*duration == Ticks{}) return std::nullopt;
        return SlotTime{0, *duration};
    }
    std::int64_t tbit = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), tbit);
    const std::string_view unit{end, static_cast<std::size_t>(text.data() + text.size() - end)};
    if (error != std::errc{} || tbit <= 0 || tbit > 100'000'000 || (!unit.empty() && unit != "tbit")) return std::nullopt;
    return SlotTime{tbit, {}};
}

std::optional<std::vector<std::uint8_t>> parse_hex(std::string_view text) {
    std::vector<std::uint8_t> octets;
    int high = -1;
    for (const char c : text) {
        if (c == ' ' && high < 0) continue;
        const int d = digit(c);
        if (d < 0) return std::nullopt;
        if (high < 0) {
            high = d;
            continue;
        }
        octets.push_back(static_cast<std::uint8_t>(high << 4 | d));
        high = -1;
    }
    if (high >= 0) return std::nullopt;
    return octets;
}

std::string hex_text(std::span<const std::uint8_t> octets, std::size_t limit) {
    std::string text;
    for (std::size_t i = 0; i < octets.size() && i < limit; ++i) text += fmt::format("{}{:02X}", i == 0 ? "" : " ", octets[i]);
    if (octets.size() > limit) text += " ...";
    return text;
}

std::string time_text(Ticks t) {
    const double ns = static_cast<double>(t.n) / static_cast<double>(core::kTicksPerNs);
    if (ns >= 1e9) return fmt::format("{:.3f} s", ns / 1e9);
    if (ns >= 1e6) return fmt::format("{:.3f} ms", ns / 1e6);
    if (ns >= 1e3) return fmt::format("{:.3f} us", ns / 1e3);
    return fmt::format("{:.3f} ns", ns);
}

}  // namespace dpchip::cli
