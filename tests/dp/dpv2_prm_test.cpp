// SPDX-License-Identifier: Apache-2.0
// The blocks and PDUs of DP-V2: figures 7-8 to 7-10, 7-21, 7-22; IsoM and PrmCmd blocks (reference 6.1 to 6.4).
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/dp/clock.hpp>
#include <dpchip/dp/dxb_prm.hpp>
#include <dpchip/dp/isom_prm.hpp>
#include <dpchip/dp/redundancy.hpp>

namespace dpchip::dp {
namespace {

using Octets = std::vector<std::uint8_t>;

/// The only block in `octets`.
PrmBlock block(const Octets& octets) {
    PrmBlockWalker walker{octets};
    PrmBlock b;
    EXPECT_TRUE(walker.next(b));
    PrmBlock more;
    EXPECT_FALSE(walker.next(more));
    EXPECT_EQ(walker.error(), PrmBlockError::none);
    return b;
}

template <class Encoded>
Octets octets(const Encoded& size, const std::array<std::uint8_t, 256>& out) {
    EXPECT_TRUE(size);
    return size ? Octets(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(*size)) : Octets{};
}

// ---- DXB --------------------------------------------------------------------------------------------------------------

constexpr std::array<DxbLink, 2> kLinks{DxbLink{9, 4, 1, 2, 0, 0}, DxbLink{125, 244, 0, 244, 0, 0}};

// proves: VPC3C 7.3.1-04, VPC3C 7.3.1-19
TEST(DxbLinktable, figure_7_8_reads_back_as_it_was_written) {
    std::array<std::uint8_t, 256> out{};
    const Octets written = octets(encode_dxb(PrmBlockType::dxb_linktable, kLinks, out), out);
    EXPECT_EQ(written, (Octets{0x0D, 0x03, 0, 0, 1, 9, 4, 1, 2, 125, 244, 0, 244}));
    const auto table = DxbTable::of(block(written));
    ASSERT_TRUE(table);
    EXPECT_FALSE(table->subscribertable());
    ASSERT_EQ(table->size(), 2u);
    EXPECT_EQ((*table)[0], kLinks[0]);
    EXPECT_EQ((*table)[1], kLinks[1]);
}

// proves: VPC3C 7.3.1-05, VPC3C 7.3.1-21
TEST(DxbSubscribertable, figure_7_9_has_a_place_for_the_sample_too) {
    const std::array<DxbLink, 1> links{DxbLink{9, 4, 1, 2, 3, 16}};
    std::array<std::uint8_t, 256> out{};
    const Octets written = octets(encode_dxb(PrmBlockType::dxb_subscribertable, links, out), out);
    EXPECT_EQ(written, (Octets{0x0B, 0x07, 0, 0, 1, 9, 4, 1, 3, 16, 2}));
    const auto table = DxbTable::of(block(written));
    ASSERT_TRUE(table);
    EXPECT_TRUE(table->subscribertable());
    EXPECT_EQ((*table)[0], links[0]);
}

// proves: VPC3C 7.3.1-20
TEST(DxbTable, twenty_nine_links_are_the_most) {
    std::vector<DxbLink> links(29, kLinks[0]);
    std::array<std::uint8_t, 256> out{};
    EXPECT_EQ(DxbTable::of(block(octets(encode_dxb(PrmBlockType::dxb_linktable, links, out), out)))->size(), 29u);
    links.push_back(kLinks[0]);
    EXPECT_EQ(encode_dxb(PrmBlockType::dxb_linktable, links, out).error(), DxbError::length);
    Octets thirty{5 + 4 * 30, 3, 0, 0, 1};
    thirty.resize(5 + 4 * 30, 1);
    EXPECT_EQ(DxbTable::of(block(thirty)).error(), DxbError::length);
}

// proves: VPC3C 7.3.1-22, E083
TEST(DxbTable, twenty_nine_links_fit_into_a_subscribertable_too) {
    const std::vector<DxbLink> links(29, DxbLink{9, 4, 1, 2, 3, 16});
    std::array<std::uint8_t, 256> out{};
    const Octets written = octets(encode_dxb(PrmBlockType::dxb_subscribertable, links, out), out);
    EXPECT_EQ(written.size(), 5u + 6 * 29) << "octet 120 of figure 7-9 is in the middle of the twentieth entry";
    const auto table = DxbTable::of(block(written));
    ASSERT_TRUE(table);
    ASSERT_EQ(table->size(), 29u);
    EXPECT_EQ((*table)[28], links[28]);
}

TEST(DxbTable, a_block_that_is_none_is_refused_with_the_reason) {
    struct Row { Octets block; DxbError error; };
    for (const Row& row : {Row{{9, 4, 0, 0, 1, 9, 4, 1, 2}, DxbError::type}, Row{{9, 3, 0, 0, 2, 9, 4, 1, 2}, DxbError::version},
                           Row{{5, 3, 0, 0, 1}, DxbError::length}, Row{{8, 3, 0, 0, 1, 9, 4, 1}, DxbError::length},
                           Row{{9, 7, 0, 0, 1, 9, 4, 1, 2}, DxbError::length}}) {
        const auto table = DxbTable::of(block(row.block));
        ASSERT_FALSE(table);
        EXPECT_EQ(table.error(), row.error);
    }
}

TEST(DxbLink, plausibility_follows_the_reference) {
    struct Row { DxbLink link; DxbError error; };
    for (const Row& row : {Row{{125, 244, 243, 1}, DxbError::none}, Row{{126, 4, 0, 1}, DxbError::publisher},
                           Row{{9, 0, 0, 1}, DxbError::published}, Row{{9, 245, 0, 1}, DxbError::published},
                           Row{{9, 4, 4, 1}, DxbError::sample}, Row{{9, 4, 3, 2}, DxbError::sample},
                           Row{{9, 4, 0, 0}, DxbError::sample}, Row{{9, 4, 1, 255}, DxbError::sample}})
        EXPECT_EQ(check(row.link), row.error);
    std::array<std::uint8_t, 256> out{};
    const std::array<DxbLink, 1> bad{DxbLink{126, 4, 0, 1}};
    EXPECT_EQ(encode_dxb(PrmBlockType::dxb_linktable, bad, out).error(), DxbError::publisher);
    EXPECT_EQ(encode_dxb(PrmBlockType::dxb_linktable, kLinks, std::span{out}.first(12)).error(), DxbError::no_room);
    EXPECT_EQ(encode_dxb(PrmBlockType::isom, kLinks, out).error(), DxbError::type);
}

// proves: VPC3C 7.3.1-06, VPC3C 7.3.1-26..32
TEST(DxbStatus, figure_7_10_starts_with_every_link_inactive) {
    std::array<std::uint8_t, 256> out{};
    ASSERT_EQ(encode_dxb_status(kLinks, out), 8u);
    EXPECT_EQ(Octets(out.begin(), out.begin() + 8), (Octets{8, 0x83, 0, 0, 9, 0, 125, 0}));
    EXPECT_EQ(encode_dxb_status(kLinks, std::span{out}.first(7)), 0u);
}

// ---- IsoM -------------------------------------------------------------------------------------------------------------

constexpr IsoMPrm kIsoM{.slot = 2, .version = 1, .tbase_dp = 1500, .t_dp = 8, .t_mapc = 1, .tbase_io = 1500, .t_i = 2,
                        .t_o = 3, .t_dx = 6000, .t_pll_w = 12, .t_pll_d = 24};

TEST(IsoMPrm, reads_back_as_it_was_written) {
    std::array<std::uint8_t, 256> out{};
    const Octets written = octets(encode(kIsoM, out), out);
    EXPECT_EQ(written, (Octets{0x1C, 4, 2, 0, 1, 0, 0, 0x05, 0xDC, 0, 8, 1, 0, 0, 0x05, 0xDC, 0, 2, 0, 3, 0, 0, 0x17, 0x70, 0, 12, 0, 24}));
    const auto read = decode_isom(block(written));
    ASSERT_TRUE(read);
    EXPECT_EQ(*read, kIsoM);
    EXPECT_EQ(read->cycle(), 12'000u) << "1 ms in 1/12 us";
}

TEST(IsoMPrm, other_blocks_lengths_and_a_cycle_of_nothing_are_refused) {
    std::array<std::uint8_t, 256> out{};
    Octets written = octets(encode(kIsoM, out), out);
    Octets other = written;
    other[1] = 5;
    EXPECT_EQ(decode_isom(block(other)).error(), IsoMError::type);
    Octets shorter(written.begin(), written.end() - 1);
    shorter[0] = 27;
    EXPECT_EQ(decode_isom(block(shorter)).error(), IsoMError::length);
    written[9] = written[10] = 0;
    EXPECT_EQ(decode_isom(block(written)).error(), IsoMError::cycle);
    EXPECT_EQ(encode(IsoMPrm{}, out).error(), IsoMError::cycle);
    EXPECT_EQ(encode(kIsoM, std::span{out}.first(27)).error(), IsoMError::no_room);
}

// ---- clock ------------------------------------------------------------------------------------------------------------

// proves: VPC3C 7.3.3-03, VPC3C 7.3.3-19..21, VPC3C 7.3.3-37..38, VPC3C 7.3.3-40..41, VPC3C 7.3.3-43..44
TEST(ClockValue, figure_7_22_reads_back_as_it_was_written) {
    const ClockValue value{.time_event = NetworkTime::from_wire(0xC3123456, 0x80000000), .previous = NetworkTime::from_wire(0xC312344C, 0x80000000),
                           .offset_min = -570, .switching_soon = true, .summer_time = true, .resolution = ClockResolution::ms_100, .synchronised = false};
    std::array<std::uint8_t, 256> out{};
    const Octets written = octets(encode(value, out), out);
    EXPECT_EQ(written, (Octets{0xC3, 0x12, 0x34, 0x56, 0x80, 0, 0, 0, 0xC3, 0x12, 0x34, 0x4C, 0x80, 0, 0, 0, 0x80 | 19 << 2, 0xD1}));
    EXPECT_EQ(*decode_clock_value(written), value);
}

// proves: VPC3C 7.3.3-37..44
TEST(ClockValue, every_status_octet_pair_is_read) {
    Octets d(18);
    for (unsigned s1 = 0; s1 < 256; ++s1)
        for (unsigned s2 = 0; s2 < 256; ++s2) {
            d[16] = static_cast<std::uint8_t>(s1);
            d[17] = static_cast<std::uint8_t>(s2);
            std::array<std::uint8_t, 256> out{};
            const Octets again = octets(encode(*decode_clock_value(d), out), out);
            const bool minus_zero = (s1 & 0xFC) == 0x80;
            EXPECT_EQ(again[16], minus_zero ? 0 : s1 & 0xFC);
            EXPECT_EQ(again[17], s2 & 0xD9);
        }
}

TEST(ClockValue, other_lengths_and_offsets_are_refused) {
    for (std::size_t n = 0; n < 40; ++n) EXPECT_EQ(static_cast<bool>(decode_clock_value(Octets(n))), n == 18);
    std::array<std::uint8_t, 256> out{};
    for (const int offset : {-960, -15, 1, 960})
        EXPECT_EQ(encode(ClockValue{.offset_min = static_cast<std::int16_t>(offset)}, out).error(), ClockError::offset);
    EXPECT_EQ(encode(ClockValue{}, std::span{out}.first(17)).error(), ClockError::no_room);
}

// proves: VPC3C 7.3.3-18
TEST(NetworkTime, goes_on_into_the_era_of_2036) {
    const NetworkTime last = NetworkTime::from_wire(0xFFFFFFFF, 0xFFFFFFFF);
    const NetworkTime next = NetworkTime::from_wire(0x00000000, 0);
    EXPECT_LT(last, next);
    EXPECT_EQ(next.seconds - last.seconds, 1u);
    EXPECT_EQ(next.minus_ns(last), 0) << "a quarter nanosecond, rounded down";
    EXPECT_EQ(last.plus_us(1), NetworkTime::from_wire(0, 4293));
    EXPECT_EQ(last.plus_us(1).wire_seconds(), 0u);
    EXPECT_EQ(NetworkTime::from_wire(0x9DFF4400, 0).seconds, 0x9DFF4400u) << "the oldest second of the first era";
    EXPECT_EQ(NetworkTime::from_wire(0x9DFF43FF, 0).seconds, 0x19DFF43FFu) << "and the youngest of the second";
}

TEST(NetworkTime, adds_and_subtracts) {
    const NetworkTime t = NetworkTime::from_wire(0xC3123456, 0x80000000);
    EXPECT_EQ(t.plus_us(500'000), NetworkTime::from_wire(0xC3123457, 0));
    EXPECT_EQ(t.plus_us(1).minus_ns(t), 999) << "2^-32 s below a microsecond";
    EXPECT_EQ(t.minus_ns(t.plus_us(250'000)), -250'000'000);
    EXPECT_EQ(t.plus_us(3'600'000'000).minus_ns(t), 3'600'000'000'000);
    EXPECT_EQ(t.plus({1, 0x80000000}), NetworkTime::from_wire(0xC3123458, 0));
}

// proves: VPC3C 7.3.3-02, VPC3C 7.3.3-16..17
TEST(TimeAr, figure_7_21_with_and_without_delay) {
    std::array<std::uint8_t, 256> out{};
    const TimeAr with{.interval = 1000, .delay = {0, 4295}, .has_delay = true}, without{.interval = 1000};
    const Octets long_block = octets(encode(with, out), out);
    EXPECT_EQ(long_block, (Octets{14, 8, 0, 0, 0x03, 0xE8, 0, 0, 0, 0, 0, 0, 0x10, 0xC7}));
    EXPECT_EQ(*decode_time_ar(block(long_block)), with);
    const Octets short_block = octets(encode(without, out), out);
    EXPECT_EQ(short_block, (Octets{6, 8, 0, 0, 0x03, 0xE8}));
    EXPECT_EQ(*decode_time_ar(block(short_block)), without);
    EXPECT_EQ(decode_time_ar(block({7, 8, 0, 0, 0x03, 0xE8, 0})).error(), ClockError::length);
    EXPECT_EQ(decode_time_ar(block({6, 9, 0, 0, 0x03, 0xE8})).error(), ClockError::type);
    EXPECT_EQ(encode(with, std::span{out}.first(13)).error(), ClockError::no_room);
}

// ---- redundancy -------------------------------------------------------------------------------------------------------

TEST(PrmCmd, reads_back_as_it_was_written) {
    const PrmCmd cmd{.slot = 1, .seq_nr = 31, .primary_request = true, .msac1s = Msac1sControl::start, .check_properties = true,
                     .master_state_clear = true, .properties = kRedPrimaryReqUsed | kRedStartStopUsed, .output_hold_time = 0x1234};
    std::array<std::uint8_t, 256> out{};
    const Octets written = octets(encode(cmd, out), out);
    EXPECT_EQ(written, (Octets{8, 2, 1, 0xF8, 0x5A, 0x03, 0x12, 0x34}));
    EXPECT_EQ(*decode_prm_cmd(block(written)), cmd);
}

TEST(PrmCmd, every_function_octet_is_read_or_refused) {
    for (unsigned f = 0; f < 256; ++f) {
        const Octets o{8, 2, 0, 0, static_cast<std::uint8_t>(f), 0, 0, 0};
        const auto cmd = decode_prm_cmd(block(o));
        if ((f & 0xA0) != 0) EXPECT_EQ(cmd.error(), PrmCmdError::reserved);
        else if ((f & 3) == 3) EXPECT_EQ(cmd.error(), PrmCmdError::conflict);
        else EXPECT_EQ(function(*cmd), f);
    }
    EXPECT_EQ(decode_prm_cmd(block({8, 2, 0, 0, 0, 0x10, 0, 0})).error(), PrmCmdError::reserved);
    EXPECT_EQ(decode_prm_cmd(block({7, 2, 0, 0, 0, 0, 0})).error(), PrmCmdError::length);
    EXPECT_EQ(decode_prm_cmd(block({8, 3, 0, 0, 0, 0, 0, 0})).error(), PrmCmdError::type);
    std::array<std::uint8_t, 256> out{};
    EXPECT_EQ(encode(PrmCmd{.seq_nr = 32}, out).error(), PrmCmdError::seq_nr);
    EXPECT_EQ(encode(PrmCmd{.backup_request = true, .primary_request = true}, out).error(), PrmCmdError::conflict);
    EXPECT_EQ(encode(PrmCmd{.properties = 0x10}, out).error(), PrmCmdError::reserved);
    EXPECT_EQ(encode(PrmCmd{}, std::span{out}.first(7)).error(), PrmCmdError::no_room);
}

TEST(RedStatus, acknowledges_a_PrmCmd_or_tells_the_state) {
    const RedStatus ack{.acknowledges = true, .seq_nr = 5, .function = 0x02, .red_state_1 = kRedPrimary | kRedDataExchange | kRedBaudrateFound,
                        .red_state_2 = kRedBackup};
    std::array<std::uint8_t, 256> out{};
    const Octets written = octets(encode(ack, out), out);
    EXPECT_EQ(written, (Octets{0x08, 0x9E, 0x00, 0x28, 0x02, 0x2A, 0x01, 0x00}));
    EXPECT_EQ(*decode_red_status(written), ack);
    const RedStatus state{.red_state_1 = kRedBackup};
    const Octets by_itself = octets(encode(state, out), out);
    EXPECT_EQ(by_itself[1], 0x9F);
    EXPECT_EQ(*decode_red_status(by_itself), state);
    EXPECT_EQ(decode_red_status(Octets{8, 0x81, 0, 0, 0, 0, 0, 0}).error(), PrmCmdError::type);
    EXPECT_EQ(decode_red_status(Octets{8, 0x9E, 0, 0, 0, 0, 0}).error(), PrmCmdError::length);
    EXPECT_EQ(encode(RedStatus{.seq_nr = 32}, out).error(), PrmCmdError::seq_nr);
    EXPECT_EQ(encode(ack, std::span{out}.first(7)).error(), PrmCmdError::no_room);
}

}  // namespace
}  // namespace dpchip::dp
