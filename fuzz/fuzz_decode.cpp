// SPDX-License-Identifier: Apache-2.0
// Any octets into the telegram codec: it never reads past its input, always makes progress, and agrees with itself,
// with encode() and with the receiver that works character by character.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/fdl/assembler.hpp>
#include <dpchip/fdl/baud.hpp>
#include <dpchip/fdl/telegram.hpp>

namespace {

using namespace dpchip::fdl;

void require(bool condition) {
    if (!condition) __builtin_trap();
}

void encodes_back(const Telegram& telegram, std::span<const std::uint8_t> octets) {
    std::array<std::uint8_t, kMaxTelegram> out{};
    std::size_t size = 0;
    if (telegram.sd == kSd4) size = encode_token(out, telegram.da, telegram.sa);
    else if (telegram.sd == kSd1 || telegram.sd == kSd2)
        size = encode(out, telegram.da, telegram.sa, telegram.fc.octet, telegram.unit);
    else return;
    require(std::ranges::equal(octets.first(telegram.size), std::span{out}.first(size)));
}

void walk(std::span<const std::uint8_t> in) {
    while (!in.empty()) {
        const auto telegram = decode(in);
        std::size_t step = 0;
        if (telegram) {
            require(telegram->size >= 1 && telegram->size <= in.size());
            if (telegram->saps_present()) require(telegram->data().size() + telegram->sap_octets() == telegram->unit.size());
            encodes_back(*telegram, in);
            step = telegram->size;
        } else if (telegram.error() == Reject::need_more) {
            require(in.size() < kMaxTelegram);
            return;
        } else {
            require(name(telegram.error()) != nullptr);
            step = resync(in);
        }
        require(step >= 1 && step <= in.size());
        in = in.subspan(step);
    }
}

/// Two octets a character: its octet, and what is wrong with it or how long it waits.
void listen(std::span<const std::uint8_t> in) {
    Assembler assembler;
    Ticks at{};
    const Ticks bit = baud(BaudCode::mbit_12).bit;
    for (; in.size() >= 2; in = in.subspan(2)) {
        at += Ticks{bit.n / 8 * (in[1] >> 3)};
        const Character c{at, bit, in[0], static_cast<std::uint8_t>(in[1] & 7u)};
        at = c.end();
        const auto telegram = assembler.push(c);
        if (!telegram) continue;
        const auto again = decode(assembler.bytes());
        require(again && again->size == assembler.bytes().size() && again->size == telegram->size);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    walk({data, size});
    listen({data, size});
    return 0;
}
