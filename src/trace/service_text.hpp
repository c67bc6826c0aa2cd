// SPDX-License-Identifier: Apache-2.0
// The data of the DP services in words (reference 3.3 to 3.10). Used by telegram_text.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <dpchip/dp/saps.hpp>
#include <dpchip/trace/telegram_text.hpp>

namespace dpchip::trace {

/// Words for the one line, and further lines.
struct DataText {
    std::string words;
    std::vector<std::string> details;
};

/// The data of a request, behind the SAP octets.
DataText request_text(dp::Service service, std::span<const std::uint8_t> data);
/// The data of an answer. `station`: who answered.
DataText answer_text(dp::Service service, std::span<const std::uint8_t> data, std::uint8_t station, const DeviceTexts* texts);
/// A diagnosis, header and blocks.
DataText diag_text(std::span<const std::uint8_t> data, std::uint8_t station, const DeviceTexts* texts);

}  // namespace dpchip::trace
