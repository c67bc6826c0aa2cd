// SPDX-License-Identifier: Apache-2.0
// Findings: what the model noticed and did not like. Data, not text; counted and traced, never printed by the model.
#pragma once

#include <cstdint>

#include <dpchip/core/ticks.hpp>

namespace dpchip::core {

/// The four kinds of doubt.
enum class FindingKind : std::uint8_t {
    misuse,            ///< the processor did what the manual forbids
    unusual,           ///< allowed, but firmware rarely means it
    unverified,        ///< the manuals are silent; the model follows the reference's decision
    timing_violation,  ///< a limit of chapter 10.7 was broken
};

struct Finding {
    Ticks at{};
    FindingKind kind{};
    std::uint16_t rule{};    ///< which rule: an enumerator of the layer that found it
    std::uint32_t detail{};  ///< address, value or parameter number, as the rule says
};

}  // namespace dpchip::core
