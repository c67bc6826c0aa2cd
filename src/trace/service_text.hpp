// SPDX-License-Identifier: Apache-2.0
// The data of the DP services in words (reference 3.3 to 3.10). Used by telegram_text.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <dpchip/dp/diag.hpp>
#include <dpchip/dp/initiate.hpp>
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

/// A PDU of MS1 or MS2; empty octets of a request are a poll.
DataText acyclic_text(dp::AcyclicDirection way, std::span<const std::uint8_t> pdu);
/// "Diagnostic_Alarm slot 1 Seq_Nr 3 appears: 01 02".
std::string alarm_text(const dp::AlarmStatus& alarm);
/// The fields of an I&M record, a line each; none for an index that is not I&M0 to I&M4.
std::vector<std::string> im_record_text(std::uint16_t im_index, std::span<const std::uint8_t> record);

}  // namespace dpchip::trace
