// SPDX-License-Identifier: Apache-2.0
// A conversation on a line: pairs answers with requests and recognises repetitions (reference 2.5), telegram by telegram.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <dpchip/trace/telegram_text.hpp>

namespace dpchip::trace {

/// One telegram, or damage, out of a row of octets.
struct Utterance {
    std::size_t offset{};                    ///< in the octets given
    std::span<const std::uint8_t> octets{};
    bool good{};
    fdl::Reject reason{};                    ///< when not good
};

/// Cuts octets into telegrams and damage, in order; every octet belongs to one of them.
std::vector<Utterance> split(std::span<const std::uint8_t> octets);

/// Explains telegrams in the order in which they were on the line.
class Dialogue {
public:
    /// `texts` may be null and must outlive the dialogue.
    explicit Dialogue(const DeviceTexts* texts = nullptr) : texts_{texts} {}

    Explanation next(const fdl::Telegram& telegram);
    /// Octets that should be exactly one telegram; anything else is explained as damage.
    Explanation next(std::span<const std::uint8_t> octets);
    /// The request that waits for its answer.
    [[nodiscard]] const Request& open_request() const { return open_; }

private:
    struct FrameCount { bool valid{}; std::uint8_t sa{}; bool fcb{}; };

    bool repeated(const fdl::Telegram& telegram);

    const DeviceTexts* texts_;
    Request open_{};
    std::array<FrameCount, 128> frame_count_{};  ///< per responder
};

}  // namespace dpchip::trace
