// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <dpchip/trace/hex_text.hpp>

namespace dpchip::trace {
namespace {

using Octets = std::vector<std::uint8_t>;

struct Good { const char* text; Octets octets; };

class HexIsRead : public testing::TestWithParam<Good> {};

TEST_P(HexIsRead, WithoutErrors) {
    const HexText text = read_hex(GetParam().text);
    EXPECT_EQ(text.octets, GetParam().octets);
    EXPECT_TRUE(text.errors.empty()) << text.errors.front().text;
    EXPECT_EQ(text.lines.size(), text.octets.size());
}

INSTANTIATE_TEST_SUITE_P(AsPeopleWriteIt, HexIsRead, testing::Values(
    Good{"10 02 63 49 AE 16", {0x10, 0x02, 0x63, 0x49, 0xAE, 0x16}},
    Good{"10026349ae16", {0x10, 0x02, 0x63, 0x49, 0xAE, 0x16}},
    Good{"0x10,0x02,\t0X63", {0x10, 0x02, 0x63}},
    Good{"0x5 0xE5", {0x05, 0xE5}},
    Good{"\\x10 \\x02", {0x10, 0x02}},
    Good{"10h 02H E5h", {0x10, 0x02, 0xE5}},
    Good{"10:02:63:49:AE:16", {0x10, 0x02, 0x63, 0x49, 0xAE, 0x16}},
    Good{"E5", {0xE5}},
    Good{"12:34:56.789 10 02", {0x10, 0x02}},
    Good{"12:34:56 10 02", {0x10, 0x02}},
    Good{"2024-05-06 12:34:56,123456 10 02", {0x10, 0x02}},
    Good{"2024-05-06T12:34:56Z 10 02", {0x10, 0x02}},
    Good{"0.001234 10 02", {0x10, 0x02}},
    Good{"[   1.5] TX -> 10 02", {0x10, 0x02}},
    Good{"[12:00] master: 10 02", {0x10, 0x02}},
    Good{"00000010: 6805 0568  h..h", {0x68, 0x05, 0x05, 0x68}},
    Good{"0000  68 05 |h.|", {0x00, 0x00, 0x68, 0x05}},
    Good{"10 02 # a request\n; nothing\n// nothing\n\nE5\r\n", {0x10, 0x02, 0xE5}},
    Good{"", {}}, Good{"\n\n", {}}));

TEST(HexText, NamesWhatIsNotAnOctetByLineAndColumn) {
    const HexText text = read_hex("10 02\n63 4G AE\n1 16");
    EXPECT_EQ(text.octets, (Octets{0x10, 0x02, 0x63, 0xAE, 0x16}));
    EXPECT_EQ(text.lines, (std::vector<std::size_t>{1, 1, 2, 2, 3}));
    ASSERT_EQ(text.errors.size(), 2u);
    EXPECT_EQ(text.errors[0].line, 2u);
    EXPECT_EQ(text.errors[0].column, 4u);
    EXPECT_EQ(text.errors[0].text, "4G");
    EXPECT_EQ(text.errors[1].line, 3u);
    EXPECT_EQ(text.errors[1].column, 1u);
}

TEST(HexText, TakesAnyTextWithoutHarm) {
    std::string text;
    for (int i = 0; i < 2048; ++i) text += static_cast<char>(i * 37 + i / 256);
    const HexText read = read_hex(text);
    EXPECT_EQ(read.lines.size(), read.octets.size());
}

}  // namespace
}  // namespace dpchip::trace
