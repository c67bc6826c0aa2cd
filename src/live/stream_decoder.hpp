// SPDX-License-Identifier: Apache-2.0
// Cuts a stream of octets into telegrams and damage (reference 1.4, 2.1), for lines that have no bit timing.
//
// A real receiver finds a beginning by 33 bit times of silence. A pty or a TCP connection shows silence only roughly,
// so a beginning is also found inside damage, but there only a telegram with a frame check sequence is believed:
// a lone E5 or DC in noise is noise. An unfinished telegram is given up after a time without octets, or at once when a
// good telegram begins behind a pause.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <dpchip/core/ticks.hpp>
#include <dpchip/fdl/telegram.hpp>

namespace dpchip::live {

using core::Ticks;

/// A telegram, or octets that are none.
struct Piece {
    bool good{};                             ///< octets are exactly one telegram
    fdl::Reject reason{};                    ///< why not, when not good
    Ticks end{};                             ///< when its last octet was read
    std::span<const std::uint8_t> octets{};  ///< valid until the next call of the decoder
    std::span<const std::uint8_t> faults{};  ///< per octet, mask of fdl::CharacterFault
};

/// Not thread-safe, allocates nothing.
class StreamDecoder {
public:
    /// give_up: silence after which an unfinished telegram is damage.
    /// pause: silence behind which a good telegram proves that the unfinished one before it is over.
    StreamDecoder(Ticks give_up, Ticks pause) : give_up_{give_up}, pause_{pause} {}

    /// Takes octets that were read at `at` (never earlier than before), with their faults (empty: none), and says how
    /// many it took. Fetch the pieces with next() and offer the rest again.
    std::size_t feed(std::span<const std::uint8_t> octets, std::span<const std::uint8_t> faults, Ticks at);
    /// The next piece that is certain at `now`, in the order of the stream.
    std::optional<Piece> next(Ticks now);
    /// When next() will give up an unfinished telegram; kNever when there is none.
    [[nodiscard]] Ticks deadline() const;
    /// Octets of an unfinished telegram.
    [[nodiscard]] std::size_t pending() const { return size_ - begin_; }

private:
    struct Step { std::size_t octets; bool good; fdl::Reject reason; };  ///< octets == 0: nothing is certain yet

    Step examine(bool final) const;
    Step broken(fdl::Reject reason, std::size_t frame) const;
    Step unfinished(bool final) const;
    bool credible(std::size_t at) const;
    std::size_t next_start(std::size_t from) const;
    std::span<const std::uint8_t> octets(std::size_t from) const { return {octets_.data() + from, size_ - from}; }

    static constexpr std::size_t kCapacity = 1024;

    Ticks give_up_, pause_;
    std::size_t begin_{}, size_{};
    bool in_damage_{};  ///< the last piece was damage
    Ticks last_{};      ///< when the last octet of the last piece was read
    std::array<std::uint8_t, kCapacity> octets_{};
    std::array<std::uint8_t, kCapacity> faults_{};
    std::array<Ticks, kCapacity> at_{};
};

}  // namespace dpchip::live
