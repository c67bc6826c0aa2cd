// SPDX-License-Identifier: Apache-2.0
// The judge: looks at a segment and names what breaks the rules of the bus (reference 1.1, 1.6, 2.1, 2.2, 2.6).
//
// Times are those at the sender's place on the line. Not judged: token rotation, the meaning of data units.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <dpchip/fdl/bus_times.hpp>
#include <dpchip/fdl/telegram.hpp>
#include <dpchip/segment/observer.hpp>

namespace dpchip::segment {

using core::Ticks;

enum class Violation : std::uint8_t {
    early_answer,       ///< less than min TSDR between request and answer
    late_answer,        ///< more than max TSDR between request and answer
    short_idle,         ///< a request before TID1 (after an answer or a token) was over
    short_idle_sdn,     ///< a request before TID2 (after a telegram without answer) was over
    impatient,          ///< a request while the slot time of the one before was running
    out_of_turn,        ///< an answer nobody asked for, or from or to somebody else
    malformed,          ///< octets that are no telegram
    gap,                ///< idle time inside a telegram
    parity,             ///< a character with wrong parity
    stop_bit,           ///< a character without stop bit
    collision,          ///< two at once
    address,            ///< a source address above 126
    rate,               ///< a bit time that is none of the ten rates
};
inline constexpr std::size_t kViolations = 13;
const char* name(Violation violation);

struct Violated {
    Violation rule{};
    Ticks at{};                     ///< start of the transmission that broke it
    StationIndex sender = kNobody;
    std::int64_t bits = 0;          ///< the time in question in bit times, rounded down; 0 when none is
};

class Judge {
public:
    /// Judges by the default profile of the rate it sees.
    Judge() = default;
    /// Judges by these bus times, whatever the rate.
    explicit Judge(const fdl::BusTimes& times) : times_{times} {}

    void see(const Sighting& s);

    bool clean() const { return total_ == 0; }
    std::uint64_t total() const { return total_; }
    std::uint64_t count(Violation v) const { return counts_[static_cast<std::size_t>(v)]; }
    /// The first violations, in order; at most 64 are kept, all are counted.
    std::span<const Violated> violations() const { return {kept_.data(), kept_count_}; }
    std::uint64_t telegrams() const { return telegrams_; }
    std::uint64_t answers() const { return answers_; }
    /// Requests whose slot time passed without an answer. No violation: a slave may be absent.
    std::uint64_t unanswered() const { return unanswered_; }
    /// Forgets violations and counts, not what is going on.
    void clear();

private:
    enum class Before : std::uint8_t { nothing, request, answer, token, no_answer, garbage };

    void broken(Violation v, const Sighting& s, Ticks time = {});
    void damaged(const Sighting& s);
    void request(const Sighting& s, const fdl::Telegram& t);
    void answer(const Sighting& s, const fdl::Telegram& t);
    void idle_before_request(const Sighting& s);
    fdl::BusTimes times(const Sighting& s);

    std::optional<fdl::BusTimes> times_;
    Before before_ = Before::nothing;
    Ticks before_end_{};
    std::uint8_t asked_ = 0;   ///< who is to answer
    std::uint8_t asker_ = 0;
    bool multicast_ = false;   ///< the answer goes to everybody (MSRD)
    std::uint64_t total_ = 0, telegrams_ = 0, answers_ = 0, unanswered_ = 0;
    std::array<std::uint64_t, kViolations> counts_{};
    std::array<Violated, 64> kept_{};
    std::size_t kept_count_ = 0;
};

}  // namespace dpchip::segment
