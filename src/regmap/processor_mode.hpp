// SPDX-License-Identifier: Apache-2.0
// The four processor interfaces and the two supplies (8.1.2, 10.7; figure 8-1).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace dpchip::regmap {

/// XINT/MOT is bit 1 of the value, MODE bit 0.
enum class ProcessorMode : std::uint8_t { async_intel = 0, sync_intel = 1, async_motorola = 2, sync_motorola = 3 };
inline constexpr std::size_t kProcessorModes = 4;

/// As the straps select it.
constexpr ProcessorMode processor_mode(bool xint_mot, bool mode) {
    return static_cast<ProcessorMode>((xint_mot ? 2u : 0u) | (mode ? 1u : 0u));
}

inline constexpr std::array<std::string_view, kProcessorModes> kProcessorModeNames{
    "async-intel", "sync-intel", "async-motorola", "sync-motorola"};
constexpr std::string_view name(ProcessorMode m) { return kProcessorModeNames[static_cast<std::size_t>(m)]; }

constexpr bool synchronous(ProcessorMode m) { return (static_cast<unsigned>(m) & 1u) != 0; }
constexpr bool motorola(ProcessorMode m) { return (static_cast<unsigned>(m) & 2u) != 0; }

/// Supply: 3.0 to 3.6 V, or 4.5 to 5.5 V.
enum class Supply : std::uint8_t { v3_3, v5 };
inline constexpr std::size_t kSupplies = 2;
constexpr std::string_view name(Supply s) { return s == Supply::v3_3 ? "3.3 V" : "5 V"; }

}  // namespace dpchip::regmap
