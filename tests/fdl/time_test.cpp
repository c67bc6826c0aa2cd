// SPDX-License-Identifier: Apache-2.0
// Baud rates (reference 1.2), bus times (1.6), characters (1.1) and their place in time.
#include <bit>

#include <gtest/gtest.h>

#include <dpchip/fdl/baud.hpp>
#include <dpchip/fdl/bus_times.hpp>
#include <dpchip/fdl/transmission.hpp>

namespace {

using namespace dpchip::fdl;
using dpchip::core::kClk;

struct Row {
    BaudCode code;
    std::int64_t clk;           // per bit, reference 1.2
    std::int64_t tsyn_ns_x4;    // 33 bit times in quarter nanoseconds
    std::int64_t tqui, tset, max_tsdr, tsl, tid1, tid2, publisher;
};
// clang-format off
constexpr Row kRows[]{
    {BaudCode::mbit_12,       4,       11'000, 9, 16, 800, 1000, 76, 800, 78},
    {BaudCode::mbit_6,        8,       22'000, 6,  8, 450,  600, 57, 450, 59},
    {BaudCode::mbit_3,       16,       44'000, 3,  4, 250,  400, 46, 250, 48},
    {BaudCode::mbit_1_5,     32,       88'000, 0,  1, 150,  300, 37, 150, 39},
    {BaudCode::kbit_500,     96,      264'000, 0,  1, 100,  200, 37, 100, 39},
    {BaudCode::kbit_187_5,  256,      704'000, 0,  1,  60,  100, 37,  60, 39},
    {BaudCode::kbit_93_75,  512,    1'408'000, 0,  1,  60,  100, 37,  60, 39},
    {BaudCode::kbit_45_45, 1056,    2'904'000, 0,  1,  60,  100, 37,  60, 39},
    {BaudCode::kbit_19_2,  2500,    6'875'000, 0,  1,  60,  100, 37,  60, 39},
    {BaudCode::kbit_9_6,   5000,   13'750'000, 0,  1,  60,  100, 37,  60, 39},
};
// clang-format on

TEST(Baud, has_exact_bit_times_in_clk_and_in_nanoseconds) {
    for (const Row& row : kRows) {
        const Baud& b = baud(row.code);
        EXPECT_EQ(b.bit, kClk * row.clk) << b.name;
        EXPECT_EQ(b.bit.n * 33 * 4, row.tsyn_ns_x4 * dpchip::core::kTicksPerNs) << b.name;
        EXPECT_EQ(b.code, row.code);
    }
}

TEST(Baud, is_found_by_the_number_people_write) {
    for (const Baud& b : kBaud) EXPECT_EQ(baud_from_bits_per_s(b.bits_per_s), b.code) << b.name;
    for (const std::uint32_t n : {45'450u, 45'454u, 45'455u}) EXPECT_EQ(baud_from_bits_per_s(n), BaudCode::kbit_45_45);
    for (const std::uint32_t n : {0u, 31'250u, 19'199u, 115'200u}) EXPECT_FALSE(baud_from_bits_per_s(n)) << n;
}

TEST(BusTimes, follow_the_default_profile) {
    for (const Row& row : kRows) {
        const BusTimes t = bus_times(row.code);
        EXPECT_EQ(t.tqui, row.tqui);
        EXPECT_EQ(t.tset, row.tset);
        EXPECT_EQ(t.min_tsdr, 11);
        EXPECT_EQ(t.max_tsdr, row.max_tsdr);
        EXPECT_EQ(t.tsl, row.tsl);
        EXPECT_EQ(t.tid1(), row.tid1);
        EXPECT_EQ(t.tid2(), row.tid2);
        EXPECT_EQ(t.publisher_min_tsdr(), row.publisher);
    }
    EXPECT_EQ(bus_times(BaudCode::not_found).tsl, 100);
}

/// The bits of a character as they follow each other on the line.
unsigned line_bits(const Character& c) {
    const bool parity = ((std::popcount(c.octet) & 1) != 0) != ((c.faults & fault_parity) != 0);
    const bool stop = (c.faults & fault_stop) == 0;
    return static_cast<unsigned>(c.octet) << 1 | (parity ? 1u << 9 : 0u) | (stop ? 1u << 10 : 0u);
}

TEST(Character, ends_its_last_low_bit_where_the_bits_say) {
    const Ticks bit = baud(BaudCode::kbit_500).bit;
    for (const unsigned faults : {0u, 1u, 2u, 3u}) {
        for (unsigned octet = 0; octet < 256; ++octet) {
            const Character c{Ticks{1000}, bit, static_cast<std::uint8_t>(octet), static_cast<std::uint8_t>(faults)};
            std::int64_t last_low = 0;
            for (unsigned i = 0; i < 11; ++i)
                if (((line_bits(c) >> i) & 1u) == 0) last_low = i;
            EXPECT_EQ(c.last_low_end(), c.start + bit * (last_low + 1)) << octet << " faults " << faults;
            EXPECT_EQ(c.end(), c.start + bit * 11);
        }
    }
}

TEST(Character, has_even_parity_over_data_and_parity_bit) {
    for (unsigned octet = 0; octet < 256; ++octet)
        EXPECT_EQ((std::popcount(octet) + (even_parity(static_cast<std::uint8_t>(octet)) ? 1 : 0)) % 2, 0);
}

TEST(Transmission, puts_characters_back_to_back) {
    Transmission t{};
    const std::uint8_t octets[]{0xDC, 2, 2};
    const Ticks bit = baud(BaudCode::mbit_12).bit;
    t.assign(Ticks{77}, bit, octets);
    EXPECT_EQ(t.end(), Ticks{77} + bit * 33);
    EXPECT_EQ(t.character(0).start, Ticks{77});
    EXPECT_EQ(t.character(2).end(), t.end());
    EXPECT_EQ(t.character(1).start, t.character(0).end());
    EXPECT_EQ(t.character(1).octet, 2);
    EXPECT_EQ(t.character(1).faults, fault_none);
    t.damaged = true;
    t.faults.fill(fault_none);
    t.faults[1] = fault_parity;
    EXPECT_EQ(t.character(1).faults, fault_parity);
}

}  // namespace
