// SPDX-License-Identifier: Apache-2.0
// Properties of the codec (reference 2.1, 2.4): identity, prefixes, and a Hamming distance of four. The seed is printed.
#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <dpchip/fdl/assembler.hpp>
#include <dpchip/fdl/baud.hpp>
#include <dpchip/fdl/telegram.hpp>

namespace {

using namespace dpchip::fdl;
using Octets = std::vector<std::uint8_t>;

rc::Gen<Octets> data_unit(int largest) {
    return rc::gen::mapcat(rc::gen::inRange(0, largest + 1), [](int n) {
        return rc::gen::container<Octets>(static_cast<std::size_t>(n), rc::gen::arbitrary<std::uint8_t>());
    });
}

Octets encoded(std::uint8_t da, std::uint8_t sa, std::uint8_t fc, const Octets& unit) {
    Octets out(kMaxTelegram);
    out.resize(encode(out, da, sa, fc, unit));
    return out;
}

RC_GTEST_PROP(Codec, decodes_what_it_encoded, (std::uint8_t da, std::uint8_t sa, std::uint8_t fc)) {
    const Octets unit = *data_unit(246);
    const Octets out = encoded(da, sa, fc, unit);
    const auto telegram = decode(out);
    RC_ASSERT(static_cast<bool>(telegram));
    RC_ASSERT(telegram->da == da && telegram->sa == sa && telegram->fc.octet == fc && telegram->size == out.size());
    RC_ASSERT(std::ranges::equal(telegram->unit, unit));
    RC_ASSERT(encoded(telegram->da, telegram->sa, telegram->fc.octet, {telegram->unit.begin(), telegram->unit.end()}) ==
              out);
}

RC_GTEST_PROP(Codec, decodes_saps_and_data_it_encoded, ()) {
    const Octets data = *data_unit(244);
    const auto da = *rc::gen::inRange<int>(0, 128), sa = *rc::gen::inRange<int>(0, 127);
    const auto dsap = *rc::gen::inRange<int>(0, 64), ssap = *rc::gen::inRange<int>(0, 64);
    const auto u8 = [](int v) { return static_cast<std::uint8_t>(v); };
    Octets out(kMaxTelegram);
    out.resize(encode(out, SapTelegram{u8(da), u8(sa), 0x6D, u8(dsap), u8(ssap), data}));
    const auto telegram = decode(out);
    RC_ASSERT(telegram && telegram->saps_present() && telegram->has_dsap() && telegram->has_ssap());
    RC_ASSERT(telegram->destination() == da && telegram->source() == sa);
    RC_ASSERT(telegram->dsap() == dsap && telegram->ssap() == ssap);
    RC_ASSERT(std::ranges::equal(telegram->data(), data));
}

RC_GTEST_PROP(Codec, needs_more_for_every_strict_prefix, (std::uint8_t da, std::uint8_t sa, std::uint8_t fc)) {
    const Octets out = encoded(da, sa, fc, *data_unit(246));
    for (std::size_t n = 0; n < out.size(); ++n) {
        const auto telegram = decode(std::span{out}.first(n));
        RC_ASSERT(!telegram);
        RC_ASSERT(telegram.error() == Reject::need_more);
    }
}

RC_GTEST_PROP(Codec, does_not_look_behind_the_telegram, (std::uint8_t da, std::uint8_t sa, std::uint8_t fc)) {
    Octets out = encoded(da, sa, fc, *data_unit(246));
    const std::size_t size = out.size();
    for (const std::uint8_t octet : *data_unit(20)) out.push_back(octet);
    const auto telegram = decode(out);
    RC_ASSERT(telegram && telegram->size == size);
}

RC_GTEST_PROP(Codec, is_total_and_never_takes_more_than_it_was_given, ()) {
    Octets in = *data_unit(300);
    if (!in.empty() && *rc::gen::arbitrary<bool>()) in[0] = *rc::gen::element(kSd1, kSd2, kSd3, kSd4, kSc);
    const auto telegram = decode(in);
    if (telegram) {
        RC_ASSERT(telegram->size <= in.size());
        return;
    }
    if (telegram.error() != Reject::need_more) RC_ASSERT(resync(in) >= 1 && resync(in) <= in.size());
}

// ---- damage on the line ------------------------------------------------------------------------------------------

/// A telegram as line bits: 11 per character, start bit first.
class Bits {
public:
    explicit Bits(const Octets& octets) {
        for (const std::uint8_t o : octets) {
            const unsigned parity = even_parity(o) ? 1u : 0u;
            words_.push_back(static_cast<std::uint16_t>(unsigned{o} << 1 | parity << 9 | 1u << 10));
        }
    }
    void flip(std::size_t bit) { words_[bit / 11] = static_cast<std::uint16_t>(words_[bit / 11] ^ (1u << (bit % 11))); }
    std::size_t size() const { return words_.size() * 11; }

    /// What a receiver says that samples characters where they should be; nothing when all is taken as good.
    std::optional<Reject> verdict() const {
        Octets octets;
        for (const unsigned w : words_) {
            const auto octet = static_cast<std::uint8_t>(w >> 1);
            if ((w & 1u) != 0) return Reject::gap;  // no start bit where one must be
            if (even_parity(octet) != ((w >> 9 & 1u) != 0)) return Reject::parity;
            if ((w >> 10 & 1u) == 0) return Reject::stop_bit;
            octets.push_back(octet);
            const auto telegram = decode(octets);
            if (!telegram && telegram.error() != Reject::need_more) return telegram.error();
        }
        const auto telegram = decode(octets);
        if (!telegram) return telegram.error();
        return std::nullopt;
    }

private:
    std::vector<std::uint16_t> words_;
};

Reject expected_for_single(std::size_t bit) {
    const std::size_t place = bit % 11;
    return place == 0 ? Reject::gap : place == 10 ? Reject::stop_bit : Reject::parity;
}

const std::vector<Octets>& samples() {
    static const std::vector<Octets> all{encoded(8, 2, 0x49, {}), encoded(8, 2, 0x7D, {0x12, 0x34}),
                                         encoded(0x82, 0xE3, 0x6D, {0x3C, 0x3E}),
                                         {0xA2, 8, 2, 0x5D, 1, 2, 3, 4, 5, 6, 7, 8, 0x8B, 0x16}};
    return all;
}

TEST(SingleBitError, anywhere_is_rejected_for_the_right_reason) {
    std::vector<Octets> all = samples();
    all.push_back({0xDC, 3, 2});
    all.push_back({0xE5});
    all.push_back(encoded(1, 2, 0x08, Octets(246, 0x55)));
    for (const Octets& octets : all) {
        Bits bits{octets};
        ASSERT_FALSE(bits.verdict());
        for (std::size_t i = 0; i < bits.size(); ++i) {
            bits.flip(i);
            ASSERT_EQ(bits.verdict(), expected_for_single(i)) << "bit " << i;
            bits.flip(i);
        }
    }
}

TEST(DoubleBitError, anywhere_in_a_telegram_with_checksum_is_rejected) {
    for (const Octets& octets : samples()) {
        Bits bits{octets};
        for (std::size_t i = 0; i < bits.size(); ++i) {
            bits.flip(i);
            for (std::size_t j = i + 1; j < bits.size(); ++j) {
                bits.flip(j);
                ASSERT_TRUE(bits.verdict()) << i << ' ' << j;
                bits.flip(j);
            }
            bits.flip(i);
        }
    }
}

TEST(DoubleBitError, in_the_data_bits_of_one_character_is_what_the_checks_behind_parity_are_for) {
    const Octets good = encoded(8, 2, 0x7D, {0x12, 0x34});
    // SD2 LE LEr SD2 DA SA FC data data FCS ED: who notices when parity cannot
    const std::vector<std::vector<Reject>> noticed{
        {Reject::start_delimiter},
        {Reject::length_mismatch, Reject::length_range},
        {Reject::length_mismatch},
        {Reject::second_start_delimiter},
        {Reject::checksum}, {Reject::checksum}, {Reject::checksum}, {Reject::checksum}, {Reject::checksum},
        {Reject::checksum},
        {Reject::end_delimiter}};
    ASSERT_EQ(noticed.size(), good.size());
    for (std::size_t octet = 0; octet < good.size(); ++octet) {
        for (unsigned a = 0; a < 8; ++a) {
            for (unsigned b = a + 1; b < 8; ++b) {
                Octets bad = good;
                bad[octet] = static_cast<std::uint8_t>(bad[octet] ^ (1u << a | 1u << b));
                const auto telegram = decode(bad);
                ASSERT_FALSE(telegram);
                EXPECT_NE(std::ranges::find(noticed[octet], telegram.error()), noticed[octet].end())
                    << "octet " << octet << ": " << name(telegram.error());
            }
        }
    }
}

TEST(TripleBitError, anywhere_in_an_sd1_telegram_is_rejected_so_the_hamming_distance_is_four) {
    Bits bits{samples()[0]};
    for (std::size_t i = 0; i < bits.size(); ++i) {
        bits.flip(i);
        for (std::size_t j = i + 1; j < bits.size(); ++j) {
            bits.flip(j);
            for (std::size_t k = j + 1; k < bits.size(); ++k) {
                bits.flip(k);
                ASSERT_TRUE(bits.verdict()) << i << ' ' << j << ' ' << k;
                bits.flip(k);
            }
            bits.flip(j);
        }
        bits.flip(i);
    }
}

TEST(QuadrupleBitError, can_go_unnoticed_so_the_distance_is_not_five) {
    Bits swapped{encoded(8, 2, 0x7D, {0x01, 0x02})};
    for (const std::size_t octet : {7u, 8u})
        for (const std::size_t bit : {1u, 2u}) swapped.flip(octet * 11 + bit);  // 01h and 02h change places
    EXPECT_FALSE(swapped.verdict());
}

RC_GTEST_PROP(DoubleBitError, in_long_telegrams_is_rejected, (std::uint8_t da, std::uint8_t sa, std::uint8_t fc)) {
    Bits bits{encoded(da, sa, fc, *data_unit(246))};
    const auto last = static_cast<int>(bits.size());
    for (int n = 0; n < 200; ++n) {
        const auto a = static_cast<std::size_t>(*rc::gen::inRange(0, last));
        const auto b = static_cast<std::size_t>(*rc::gen::inRange(0, last));
        if (a == b) continue;
        bits.flip(a);
        bits.flip(b);
        RC_ASSERT(bits.verdict().has_value());
        bits.flip(a);
        bits.flip(b);
    }
}

RC_GTEST_PROP(Assembler, gives_the_same_as_decode_for_any_octets_back_to_back, ()) {
    Octets in = *data_unit(270);
    if (*rc::gen::arbitrary<bool>()) in = encoded(1, 2, 0x7D, *data_unit(246));
    Assembler assembler;
    Ticks at{};
    const Ticks bit = baud(BaudCode::mbit_3).bit;
    std::span<const std::uint8_t> rest{in};
    std::size_t from = 0;
    for (std::size_t i = 0; i < in.size() && assembler.synchronous(); ++i) {
        const Character c{at, bit, in[i], fault_none};
        at = c.end();
        const auto step = assembler.push(c);
        const auto whole = decode(rest.subspan(from, i + 1 - from));
        RC_ASSERT(static_cast<bool>(step) == static_cast<bool>(whole));
        if (!whole) RC_ASSERT(step.error() == whole.error());
        if (whole) from = i + 1;
    }
}

}  // namespace
