// SPDX-License-Identifier: Apache-2.0
// Field archive: what is written comes back, and everything else is refused with its reason.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <dpchip/core/archive.hpp>
#include <gtest/gtest.h>

namespace {

using namespace dpchip::core;

enum class Colour : std::uint8_t { red, green };
struct Example {
    std::uint16_t counter = 0x1234;
    Colour colour = Colour::green;
    std::array<std::uint8_t, 3> octets{9, 8, 7};
    std::int64_t time = -5;
    bool operator==(const Example&) const = default;
};

template <class Visitor, class State>
void describe(Visitor& visit, State&& state) {
    visit("counter", state.counter);
    visit("colour", state.colour);
    visit("octets", state.octets);
    visit("time", state.time);
}

std::vector<std::uint8_t> written(const Example& example) {
    std::vector<std::uint8_t> bytes(100);
    FieldWriter writer{bytes};
    describe(writer, example);
    EXPECT_EQ(writer.error, ArchiveError::none);
    bytes.resize(writer.size);
    return bytes;
}

TEST(Archive, what_was_written_is_read_back) {
    const Example before{.counter = 7, .colour = Colour::green, .octets{1, 2, 3}, .time = 1LL << 60};
    const auto bytes = written(before);
    EXPECT_EQ(bytes.size(), 4 * 4 + 2 + 1 + 3 + 8u);
    Example after{.counter = 0, .colour = Colour::red, .octets{}, .time = 0};
    FieldReader reader{bytes};
    describe(reader, after);
    EXPECT_EQ(reader.error, ArchiveError::none);
    EXPECT_EQ(reader.at, bytes.size());
    EXPECT_EQ(after, before);
}

TEST(Archive, a_field_is_its_names_hash_its_size_and_its_octets_lowest_first) {
    std::array<std::uint8_t, 8> bytes{};
    FieldWriter writer{bytes};
    writer("a", std::uint16_t{0x1234});
    EXPECT_EQ(writer.size, 6u);
    EXPECT_EQ(bytes, (std::array<std::uint8_t, 8>{0x20, 0xCD, 2, 0, 0x34, 0x12, 0, 0}));
}

TEST(Archive, a_buffer_of_any_smaller_size_is_refused_and_never_overrun) {
    const auto full = written({});
    for (std::size_t size = 0; size < full.size(); ++size) {
        std::vector<std::uint8_t> bytes(size);
        FieldWriter writer{bytes};
        describe(writer, Example{});
        EXPECT_EQ(writer.error, ArchiveError::too_short) << size;
        EXPECT_LE(writer.size, size);
    }
}

TEST(Archive, every_cut_is_refused) {
    const auto full = written({});
    for (std::size_t size = 0; size < full.size(); ++size) {
        const std::vector<std::uint8_t> cut(full.begin(), full.begin() + static_cast<std::ptrdiff_t>(size));
        Example example;
        FieldReader reader{cut};
        describe(reader, example);
        EXPECT_EQ(reader.error, ArchiveError::too_short) << size;
        EXPECT_LE(reader.at, size);
    }
}

TEST(Archive, a_field_of_another_name_or_size_is_refused_and_left_alone) {
    const auto bytes = written({});
    std::uint16_t counter = 99;
    FieldReader other_name{bytes};
    other_name("kounter", counter);
    EXPECT_EQ(other_name.error, ArchiveError::field);
    EXPECT_EQ(counter, 99);
    std::uint32_t wide = 99;
    FieldReader other_size{bytes};
    other_size("counter", wide);
    EXPECT_EQ(other_size.error, ArchiveError::field);
    EXPECT_EQ(wide, 99u);
}

TEST(Archive, after_an_error_nothing_more_is_read) {
    const auto bytes = written({});
    FieldReader reader{bytes};
    std::uint32_t wrong{};
    reader("counter", wrong);
    Example example;
    describe(reader, example);
    EXPECT_EQ(reader.error, ArchiveError::field);
    EXPECT_EQ(example, Example{});
}

TEST(Archive, crc_and_hash_are_the_published_ones) {
    constexpr std::array<std::uint8_t, 9> digits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
    static_assert(crc32(digits) == 0xCBF4'3926u);
    EXPECT_EQ(crc32({}), 0u);
    // FNV-1a of "", "a" and "foobar": 811C9DC5, E40C292C and BF9CF968, halves folded together.
    EXPECT_EQ(name_hash(""), 0x811C ^ 0x9DC5);
    EXPECT_EQ(name_hash("a"), 0xE40C ^ 0x292C);
    EXPECT_EQ(name_hash("foobar"), 0xBF9C ^ 0xF968);
}

TEST(Archive, the_crc_sees_every_single_flipped_bit) {
    auto bytes = written({});
    const std::uint32_t good = crc32(bytes);
    for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
        bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
        EXPECT_NE(crc32(bytes), good) << bit;
        bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
    }
}

}  // namespace
