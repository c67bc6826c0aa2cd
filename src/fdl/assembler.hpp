// SPDX-License-Identifier: Apache-2.0
// Characters to telegrams: the receiver's view of layer 2 (reference 1.3, 1.4). For whoever listens to a line that is
// not always well: judges, masters, ports. The chip has a receiver of its own, with its options.
//
// Not modelled: bit sampling. A character that begins more than a quarter of a bit early or late is a gap.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/core/result.hpp>
#include <dpchip/core/ticks.hpp>
#include <dpchip/fdl/character.hpp>
#include <dpchip/fdl/telegram.hpp>
#include <dpchip/fdl/transmission.hpp>

namespace dpchip::fdl {

/// Collects characters. After an error it stays deaf until the line was idle for TSYN.
class Assembler {
public:
    /// Takes the next character. The telegram it completes (valid until the next push), or why the octets so far are
    /// none; need_more when nothing is decided yet and while the receiver waits for TSYN.
    constexpr core::Result<Telegram, Reject> push(const Character& c) {
        const bool idle = !heard_ || c.start - last_low_end_ >= c.bit * kTsynBits;
        const Ticks drift = c.start - last_end_;
        const bool gap = size_ != 0 && (drift * 4 > c.bit || drift * -4 > c.bit);
        heard_ = true;
        last_low_end_ = c.last_low_end();
        last_end_ = c.end();
        if (idle && size_ != 0) { ++abandoned_; size_ = 0; }
        if (idle) synchronous_ = true;
        if (!synchronous_) return Reject::need_more;
        if (size_ != 0 && gap) return lose(Reject::gap);
        if ((c.faults & fault_collision) != 0) return lose(Reject::collision);
        if ((c.faults & fault_parity) != 0) return lose(Reject::parity);
        if ((c.faults & fault_stop) != 0) return lose(Reject::stop_bit);
        octets_[size_++] = c.octet;
        return judge();
    }

    /// False from an error until TSYN.
    constexpr bool synchronous() const { return synchronous_; }
    /// Octets of the telegram begun or, right after push() gave one, of that telegram.
    constexpr std::span<const std::uint8_t> bytes() const { return {octets_.data(), size_ != 0 ? size_ : complete_}; }
    /// Telegrams that stopped in the middle and were followed by idle time.
    constexpr std::uint64_t abandoned() const { return abandoned_; }
    /// An undamaged telegram went by that ended at `end`: the receiver is synchronous behind it.
    constexpr void synchronise(Ticks end) {
        heard_ = synchronous_ = true;
        size_ = complete_ = 0;
        last_low_end_ = last_end_ = end;
    }

private:
    constexpr core::Result<Telegram, Reject> judge() {
        const auto telegram = decode({octets_.data(), size_});
        if (telegram) {
            complete_ = size_;
            size_ = 0;
        } else if (telegram.error() != Reject::need_more) {
            return lose(telegram.error());
        }
        return telegram;
    }
    constexpr Reject lose(Reject reason) {
        size_ = complete_ = 0;
        synchronous_ = false;
        return reason;
    }

    std::array<std::uint8_t, kMaxTelegram> octets_{};
    std::size_t size_ = 0;      ///< of the telegram begun
    std::size_t complete_ = 0;  ///< of the telegram just completed
    Ticks last_low_end_{}, last_end_{};
    bool heard_ = false;        ///< before the first character the line has been idle for ever
    bool synchronous_ = true;
    std::uint64_t abandoned_ = 0;
};

}  // namespace dpchip::fdl
