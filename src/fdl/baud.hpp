// SPDX-License-Identifier: Apache-2.0
// The ten baud rates of the chips, each with its exact bit time (VPC3+C 5.2, figure 5-7).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <dpchip/core/ticks.hpp>

namespace dpchip::fdl {

using core::Ticks;

/// The code in Status Register bits 11..8. Lower case: firmware headers #define upper-case names.
enum class BaudCode : std::uint8_t {
    mbit_12, mbit_6, mbit_3, mbit_1_5, kbit_500, kbit_187_5, kbit_93_75, kbit_45_45, kbit_19_2, kbit_9_6,
    not_found = 15,  ///< after reset and during baud rate search
};

struct Baud {
    BaudCode code{};
    std::uint32_t bits_per_s{};  ///< rounded down; only 45.45 kbit/s (500000/11) is not whole
    Ticks bit{};                 ///< one bit time, exact: a multiple of 4 CLK
    std::string_view name;       ///< "12 Mbit/s"
    std::string_view gsd;        ///< the rate as GSD keywords spell it: "12M"
};

namespace detail {
consteval Baud baud(BaudCode code, std::int64_t num, std::int64_t den, std::string_view name, std::string_view gsd) {
    return {code, static_cast<std::uint32_t>(num / den), core::exact(den, num), name, gsd};
}
}  // namespace detail

inline constexpr std::size_t kBaudRates = 10;

/// In the order of the codes, which is the order of the chip's search: fastest first.
inline constexpr std::array<Baud, kBaudRates> kBaud{
    detail::baud(BaudCode::mbit_12, 12'000'000, 1, "12 Mbit/s", "12M"),
    detail::baud(BaudCode::mbit_6, 6'000'000, 1, "6 Mbit/s", "6M"),
    detail::baud(BaudCode::mbit_3, 3'000'000, 1, "3 Mbit/s", "3M"),
    detail::baud(BaudCode::mbit_1_5, 1'500'000, 1, "1.5 Mbit/s", "1.5M"),
    detail::baud(BaudCode::kbit_500, 500'000, 1, "500 kbit/s", "500"),
    detail::baud(BaudCode::kbit_187_5, 187'500, 1, "187.5 kbit/s", "187.5"),
    detail::baud(BaudCode::kbit_93_75, 93'750, 1, "93.75 kbit/s", "93.75"),
    detail::baud(BaudCode::kbit_45_45, 500'000, 11, "45.45 kbit/s", "45.45"),
    detail::baud(BaudCode::kbit_19_2, 19'200, 1, "19.2 kbit/s", "19.2"),
    detail::baud(BaudCode::kbit_9_6, 9'600, 1, "9.6 kbit/s", "9.6"),
};
static_assert([] {
    for (std::size_t i = 0; i < kBaudRates; ++i)
        if (kBaud[i].bit.n % (4 * core::kClk.n) != 0 || kBaud[i].code != static_cast<BaudCode>(i)) return false;
    return true;
}(), "every bit time is a whole number of quarter-bit samples on CLK");

/// The entry of a found rate. `code` must not be not_found.
constexpr const Baud& baud(BaudCode code) { return kBaud[static_cast<std::size_t>(code)]; }

/// The rate of a number as people write it: 19200, 45450 and 45454 both mean 45.45 kbit/s.
constexpr std::optional<BaudCode> baud_from_bits_per_s(std::uint32_t bits_per_s) {
    if (bits_per_s == 45'450 || bits_per_s == 45'455) return BaudCode::kbit_45_45;
    for (const Baud& b : kBaud)
        if (b.bits_per_s == bits_per_s) return b.code;
    return std::nullopt;
}

}  // namespace dpchip::fdl
