// SPDX-License-Identifier: Apache-2.0
// Any octets, in any portions and with any pauses, through the live line's stream decoder: every octet comes out once and
// in order, a good piece is a telegram, and silence always ends what is unfinished.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <dpchip/live/stream_decoder.hpp>

namespace {

using namespace dpchip;
using live::StreamDecoder;

void require(bool condition) {
    if (!condition) __builtin_trap();
}

constexpr core::Ticks kGiveUp = core::milliseconds(50), kPause = core::milliseconds(2);

struct Listener {
    StreamDecoder decoder{kGiveUp, kPause};
    std::vector<std::uint8_t> in, out;

    void collect(core::Ticks now) {
        while (const auto piece = decoder.next(now)) {
            require(!piece->octets.empty() && piece->octets.size() == piece->faults.size() && piece->end <= now);
            if (piece->good) {
                const auto telegram = fdl::decode(piece->octets);
                require(telegram && telegram->size == piece->octets.size());
                for (const std::uint8_t fault : piece->faults) require(fault == 0);
            }
            out.insert(out.end(), piece->octets.begin(), piece->octets.end());
        }
        require(decoder.deadline() > now && decoder.pending() < 256);
        require(out.size() + decoder.pending() == in.size());
    }
    void feed(std::span<const std::uint8_t> octets, std::uint8_t fault, core::Ticks now) {
        in.insert(in.end(), octets.begin(), octets.end());
        const std::array<std::uint8_t, 64> faults{fault};
        std::span<const std::uint8_t> marks{faults};
        while (!octets.empty()) {
            const std::size_t taken = decoder.feed(octets, marks.first(octets.size()), now);
            require(taken > 0);
            octets = octets.subspan(taken);
            marks = marks.subspan(taken);
            while (const auto piece = decoder.next(now)) out.insert(out.end(), piece->octets.begin(), piece->octets.end());
        }
        collect(now);
    }
};

}  // namespace

/// A portion is an octet that says how long it is and how long the line was silent before it, then its octets.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::array<core::Ticks, 4> kSilences{core::Ticks{}, core::milliseconds(1), core::milliseconds(3), core::milliseconds(60)};
    std::span<const std::uint8_t> rest{data, size};
    Listener listener;
    core::Ticks now{};
    while (rest.size() > 1) {
        const std::uint8_t head = rest[0];
        const std::size_t length = std::min<std::size_t>(rest.size() - 1, 1 + (head & 0x1Fu));
        now += kSilences[(head >> 5) & 3u];
        listener.collect(now);
        listener.feed(rest.subspan(1, length), head >> 7, now);
        rest = rest.subspan(1 + length);
    }
    listener.collect(now + kGiveUp);
    require(listener.decoder.pending() == 0 && listener.out == listener.in);
    return 0;
}
