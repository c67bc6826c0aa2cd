// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "fakes.hpp"

namespace dpchip::live {
namespace {

struct Found { bool good; Octets octets; Ticks end; fdl::Reject reason; };

class Stream {
public:
    Stream() : decoder_{50_ms, 2_ms} {}
    Stream& at(Ticks when, std::string_view hex, const Octets& faults = {}) {
        const Octets all = octets(hex);
        std::span<const std::uint8_t> rest{all};
        while (!rest.empty()) {
            rest = rest.subspan(decoder_.feed(rest, faults, when));
            collect(when);
        }
        return *this;
    }
    Stream& silence_until(Ticks when) { collect(when); return *this; }
    std::vector<Octets> good() const {
        std::vector<Octets> result;
        for (const Found& f : found) if (f.good) result.push_back(f.octets);
        return result;
    }
    std::size_t damage() const {
        std::size_t n = 0;
        for (const Found& f : found) if (!f.good) n += f.octets.size();
        return n;
    }
    std::vector<Found> found;
    StreamDecoder& decoder() { return decoder_; }

private:
    void collect(Ticks now) {
        while (const auto p = decoder_.next(now)) found.push_back({p->good, {p->octets.begin(), p->octets.end()}, p->end, p->reason});
    }
    StreamDecoder decoder_;
};

const Octets kStatus = octets("10 02 63 49 AE 16");
const Octets kDiag = octets("68 05 05 68 82 E3 6D 3C 3E 4C 16");

TEST(StreamDecoder, SplitsTelegramsThatCameInOneRead) {
    Stream s;
    s.at(1_ms, "DC 03 02 10 02 63 49 AE 16 E5 68 05 05 68 82 E3 6D 3C 3E 4C 16");
    EXPECT_EQ(s.good(), (std::vector<Octets>{octets("DC 03 02"), kStatus, {0xE5}, kDiag}));
    EXPECT_EQ(s.damage(), 0u);
    EXPECT_EQ(s.decoder().deadline(), core::kNever);
}

TEST(StreamDecoder, JoinsATelegramThatCameOctetByOctetAndEndsItWithItsLastRead) {
    Stream s;
    Ticks t = 1_ms;
    for (const std::uint8_t octet : kDiag) {
        EXPECT_TRUE(s.found.empty());
        const std::string_view digits = "0123456789ABCDEF";
        s.at(t += 1_ms, std::string{digits[octet >> 4], digits[octet & 15]});
    }
    ASSERT_EQ(s.good(), std::vector<Octets>{kDiag});
    EXPECT_EQ(s.found[0].end, t);
}

struct Noise { const char* what; const char* hex; };

class NoiseNeverCosts : public testing::TestWithParam<Noise> {};

TEST_P(NoiseNeverCosts, TheTelegramBehindIt) {
    Stream one_read;
    one_read.at(1_ms, std::string{GetParam().hex} + " 10 02 63 49 AE 16").silence_until(60_ms);
    EXPECT_EQ(one_read.good(), std::vector<Octets>{kStatus});
    EXPECT_EQ(one_read.damage(), octets(GetParam().hex).size());

    Stream after_a_pause;
    after_a_pause.at(1_ms, GetParam().hex).at(4_ms, "10 02 63 49 AE 16");
    EXPECT_EQ(after_a_pause.good(), std::vector<Octets>{kStatus}) << "at once, not after the time to give up";
    EXPECT_EQ(after_a_pause.damage(), octets(GetParam().hex).size());

    Stream long_after;
    long_after.at(1_ms, GetParam().hex).silence_until(51_ms).at(100_ms, "68 05 05 68 82 E3 6D 3C 3E 4C 16");
    EXPECT_EQ(long_after.good(), std::vector<Octets>{kDiag});
    EXPECT_EQ(long_after.damage(), octets(GetParam().hex).size());
}

INSTANTIATE_TEST_SUITE_P(OfAnyKind, NoiseNeverCosts, testing::Values(
    Noise{"zeros", "00 00 00"}, Noise{"a cut SD1", "10 02 63"}, Noise{"a cut SD2", "68 05 05 68 82 E3"},
    Noise{"the head of the longest SD2", "68 F9 F9 68"}, Noise{"one delimiter", "68"}, Noise{"an SD2 head of the very length that follows", "68 04 04 68"},
    Noise{"a cut SD3", "A2 02 63 49"}, Noise{"wrong FCS", "10 02 63 49 AF 16"}, Noise{"wrong ED", "10 02 63 49 AE 17"},
    Noise{"LE differs", "68 05 06 68 82 E3 6D 3C 3E 4C 16"}, Noise{"LE too small", "68 03 03 68 82 E3 6D D2 16"},
    Noise{"delimiters only", "68 68 68 68 10 A2"}, Noise{"SC and a cut token inside noise", "01 E5 DC"}),
    [](const auto& row) {
        std::string id{row.param.what};
        for (char& c : id) if (c == ' ') c = '_';
        return id;
    });

TEST(StreamDecoder, BelievesNoTelegramInsideTheDataOfADamagedOne) {
    Stream s;  // a good SD1 as data of an SD2 whose FCS is wrong
    s.at(1_ms, "68 09 09 68 08 02 7D 10 02 63 49 AE 16 FF 16 E5").silence_until(60_ms);
    EXPECT_EQ(s.good(), std::vector<Octets>{}) << "the E5 right behind damage proves nothing";
    s.at(70_ms, "E5");
    EXPECT_EQ(s.good(), std::vector<Octets>{{0xE5}}) << "after a pause it does";
}

TEST(StreamDecoder, GivesUpAnUnfinishedTelegramWhenTimeIsOver) {
    Stream s;
    s.at(1_ms, "68 05 05 68 82");
    EXPECT_EQ(s.decoder().deadline(), 51_ms);
    EXPECT_EQ(s.decoder().pending(), 5u);
    s.silence_until(50_ms);
    EXPECT_TRUE(s.found.empty());
    s.silence_until(51_ms);
    EXPECT_EQ(s.damage(), 5u);
    ASSERT_FALSE(s.found.empty());
    EXPECT_EQ(s.found[0].reason, fdl::Reject::need_more);
    EXPECT_EQ(s.decoder().pending(), 0u);
}

TEST(StreamDecoder, KeepsASlowTelegramTogetherOverPauses) {
    Stream s;
    s.at(1_ms, "68 05 05 68").at(41_ms, "82 E3 6D").at(81_ms, "3C 3E 4C 16");
    EXPECT_EQ(s.good(), std::vector<Octets>{kDiag});
}

TEST(StreamDecoder, ShowsADamagedCharacterAsDamageOfTheWholeTelegram) {
    Stream s;
    s.at(1_ms, "10 02 63 49 AE 16 68 05 05 68 82 E3 6D 3C 3E 4C 16", {0, 0, fdl::fault_parity});
    EXPECT_EQ(s.good(), std::vector<Octets>{kDiag});
    EXPECT_EQ(s.damage(), 6u);
    EXPECT_EQ(s.found[0].reason, fdl::Reject::parity);
}

TEST(StreamDecoder, GivesTheSamePiecesHoweverAReadIsCutUp) {
    const std::string_view stream = "AA 10 02 63 49 AE 16 E5 68 05 05 68 82 E3 6D 3C 3E 4C 16 DC 03 02 68 04 04 68 10 02 63 49 AE 16 A2";
    Stream whole;
    whole.at(1_ms, stream).silence_until(60_ms);
    const Octets all = octets(stream);
    for (std::size_t chunk = 1; chunk < all.size(); ++chunk) {
        StreamDecoder decoder{50_ms, 2_ms};
        std::vector<Octets> pieces, expected;
        const auto collect = [&](Ticks now) {
            while (const auto p = decoder.next(now)) if (p->good) pieces.emplace_back(p->octets.begin(), p->octets.end());
        };
        for (std::size_t at = 0; at < all.size(); at += chunk) {
            ASSERT_EQ(decoder.feed(std::span{all}.subspan(at, std::min(chunk, all.size() - at)), {}, 1_ms), std::min(chunk, all.size() - at));
            collect(1_ms);
        }
        collect(60_ms);
        EXPECT_EQ(pieces, whole.good()) << chunk;
    }
}

TEST(StreamDecoder, TakesMoreThanItsCapacityInPortions) {
    Stream s;
    std::string hex;
    for (int i = 0; i < 1000; ++i) hex += "10 02 63 49 AE 16 ";
    s.at(1_ms, hex);
    EXPECT_EQ(s.good().size(), 1000u);
}

}  // namespace
}  // namespace dpchip::live
