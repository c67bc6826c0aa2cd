// SPDX-License-Identifier: Apache-2.0
// A chip's trace records as golden-trace text: one fact per line, time in ns and, where the rate is known, in bit times.
#pragma once

#include <optional>
#include <string>

#include <dpchip/core/ticks.hpp>
#include <dpchip/core/trace.hpp>
#include <dpchip/fdl/baud.hpp>
#include <dpchip/regmap/fact.hpp>
#include <dpchip/regmap/variant.hpp>

namespace dpchip::trace {

/// "573958.333 ns": three digits are enough to tell any two ticks of 1/60 ns apart.
std::string time_text(core::Ticks at);

/// The words of one fact, without its time: "dp_state WAIT-PRM -> WAIT-CFG". With CS_Supported interrupt bit 0 is Clock_Sync.
std::string fact_words(const core::TraceRecord& record, regmap::Variant variant, bool clock_sync = false);

/// Renders records in the order in which they were made. Behind the time stands the distance in bit times from t0, the
/// end of the last telegram heard, because everything the reference demands is counted from there.
class FactText {
public:
    explicit FactText(regmap::Variant variant) : variant_{variant} {}
    /// One line, no newline at its end.
    std::string line(const core::TraceRecord& record);

private:
    regmap::Variant variant_;
    std::optional<fdl::BaudCode> rate_;   ///< found, or being tried
    std::optional<core::Ticks> t0_;
    bool clock_sync_ = false;             ///< CS_Supported was written
};

}  // namespace dpchip::trace
