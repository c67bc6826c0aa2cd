// SPDX-License-Identifier: Apache-2.0
// Quantities as people write them on a command line or in TOML: rates, times, octets; and back into text.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <dpchip/core/ticks.hpp>
#include <dpchip/fdl/baud.hpp>

namespace dpchip::cli {

using core::Ticks;

/// "19200", "19.2", "12M", "1.5M", "93.75k", "45450". Nothing when it is none of the ten rates.
std::optional<fdl::BaudCode> parse_baud(std::string_view text);

/// "250us", "2.5ms", "1s", "800ns"; a bare number has no meaning here. Not negative, below ten days.
std::optional<Ticks> parse_duration(std::string_view text);

/// A slot time: bit times of the line's rate, or a duration.
struct SlotTime {
    std::int64_t tbit{};  ///< when not 0
    Ticks time{};
    Ticks at(fdl::BaudCode rate) const { return tbit != 0 ? fdl::baud(rate).bit * tbit : time; }
};
/// "300" and "300tbit" are bit times, "200ms" a duration.
std::optional<SlotTime> parse_slot_time(std::string_view text);

/// "00 11 ff", "0011FF". Nothing when a digit is missing or there is something else.
std::optional<std::vector<std::uint8_t>> parse_hex(std::string_view text);

/// "00 11 FF"; more than `limit` octets end in "...".
std::string hex_text(std::span<const std::uint8_t> octets, std::size_t limit = 16);
/// "1.234 ms": the unit that fits, three digits behind the point.
std::string time_text(Ticks t);

}  // namespace dpchip::cli
