// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <sstream>

#include <dpchip/trace/pcapng.hpp>

#include "octets.hpp"

namespace dpchip::trace {
namespace {

using Octets = std::vector<std::uint8_t>;

Octets file_of(const std::ostringstream& out) {
    const std::string text = out.str();
    return {text.begin(), text.end()};
}

Octets recorded() {
    std::ostringstream out;
    PcapngWriter writer{out};
    const auto line = writer.add_interface(LinkType::user0, "pty:/dp0", "19200 bit/s");
    const Octets request = octets("10 02 63 49 AE 16"), answer = octets("E5");
    EXPECT_TRUE(writer.write({1'234'567'890'123'456'789, request, Direction::inbound, "first", line}));
    EXPECT_TRUE(writer.write({1'234'567'890'123'456'999, answer, Direction::outbound, {}, line}));
    return file_of(out);
}

TEST(Pcapng, ReadsBackWhatItWroteToTheNanosecond) {
    const Octets file = recorded();
    const Capture capture = read_pcapng(file);
    EXPECT_EQ(capture.error, PcapngError::none);
    EXPECT_EQ(capture.offset, file.size());
    ASSERT_EQ(capture.packets.size(), 2u);
    const CapturedPacket& first = capture.packets[0];
    EXPECT_EQ(first.time_ns, 1'234'567'890'123'456'789);
    EXPECT_EQ(first.link_type, 147);
    EXPECT_EQ(first.direction, Direction::inbound);
    EXPECT_EQ(first.comment, "first");
    EXPECT_EQ(Octets(first.octets.begin(), first.octets.end()), octets("10 02 63 49 AE 16"));
    EXPECT_EQ(capture.packets[1].time_ns - first.time_ns, 210);
    EXPECT_EQ(capture.packets[1].octets[0], 0xE5);
}

TEST(Pcapng, WritesTheBlocksOfTheSpecification) {
    const Octets file = recorded();
    ASSERT_GT(file.size(), 28u);
    EXPECT_EQ(Octets(file.begin(), file.begin() + 4), octets("0A 0D 0D 0A"));
    EXPECT_EQ(Octets(file.begin() + 8, file.begin() + 24), octets("4D 3C 2B 1A 01 00 00 00 FF FF FF FF FF FF FF FF"));
    const std::size_t idb = file[4];
    EXPECT_EQ(Octets(file.begin() + static_cast<long>(idb), file.begin() + static_cast<long>(idb) + 4), octets("01 00 00 00"));
    EXPECT_EQ(file[idb + 8], 147);
    EXPECT_EQ(file.size() % 4, 0u);
}

TEST(Pcapng, RefusesAPacketOfAnUnknownInterface) {
    std::ostringstream out;
    PcapngWriter writer{out};
    EXPECT_FALSE(writer.write({0, {}, Direction::unknown, {}, 0}));
    EXPECT_EQ(writer.packets(), 0u);
}

TEST(Pcapng, SaysThatItsStreamFailed) {
    std::ostringstream out;
    PcapngWriter writer{out};
    const auto line = writer.add_interface(LinkType::profibus_dl, "x");
    out.setstate(std::ios::badbit);
    EXPECT_FALSE(writer.write({0, {}, Direction::unknown, {}, line}));
}

TEST(Pcapng, EveryCutFileGivesItsWholePacketsAndTheErrorTruncated) {
    const Octets file = recorded();
    std::size_t most = 0;
    for (std::size_t size = 4; size < file.size(); ++size) {
        const Octets cut{file.begin(), file.begin() + static_cast<long>(size)};
        const Capture capture = read_pcapng(cut);
        EXPECT_LE(capture.offset, size);
        EXPECT_TRUE(capture.error == PcapngError::truncated || (capture.error == PcapngError::none && capture.offset == size)) << size;
        EXPECT_GE(capture.packets.size(), most);
        most = capture.packets.size();
    }
    EXPECT_EQ(most, 1u);
}

struct Bad { const char* name; const char* hex; PcapngError error; };

class BadFileIsNamed : public testing::TestWithParam<Bad> {};

TEST_P(BadFileIsNamed, ByItsError) {
    const Octets file = octets(GetParam().hex);
    EXPECT_EQ(read_pcapng(file).error, GetParam().error) << name(read_pcapng(file).error);
}

#define SHB "0A0D0D0A 1C000000 4D3C2B1A 0100 0000 FFFFFFFFFFFFFFFF 1C000000 "
#define IDB "01000000 14000000 9300 0000 00000000 14000000 "
INSTANTIATE_TEST_SUITE_P(Each, BadFileIsNamed, testing::Values(
    Bad{"not_pcapng", "D4C3B2A1 00000000 00000000", PcapngError::not_pcapng},
    Bad{"empty", "", PcapngError::not_pcapng},
    Bad{"byte_order", "0A0D0D0A 1C000000 4D3C2B1B 0100 0000 FFFFFFFFFFFFFFFF 1C000000", PcapngError::byte_order},
    Bad{"version", "0A0D0D0A 1C000000 4D3C2B1A 0200 0000 FFFFFFFFFFFFFFFF 1C000000", PcapngError::version},
    Bad{"truncated", SHB "06000000", PcapngError::truncated},
    Bad{"length_small", SHB "06000000 08000000 08000000", PcapngError::block_length},
    Bad{"length_odd", SHB "06000000 0D000000 0D000000 00", PcapngError::block_length},
    Bad{"length_differs", SHB "0B000000 10000000 00000000 14000000", PcapngError::block_length},
    Bad{"section_short", "0A0D0D0A 10000000 4D3C2B1A 10000000", PcapngError::block_length},
    Bad{"interface_short", SHB "01000000 0C000000 0C000000", PcapngError::block_length},
    Bad{"packet_short", SHB IDB "06000000 10000000 00000000 10000000", PcapngError::block_length},
    Bad{"no_interface", SHB "06000000 20000000 00000000 00000000 00000000 00000000 00000000 20000000", PcapngError::no_interface},
    Bad{"simple_no_interface", SHB "03000000 10000000 00000000 10000000", PcapngError::no_interface},
    Bad{"packet_length", SHB IDB "06000000 20000000 00000000 00000000 00000000 01000000 01000000 20000000", PcapngError::packet_length},
    Bad{"simple_length", SHB IDB "03000000 10000000 05000000 10000000", PcapngError::packet_length}),
    [](const auto& row) { return row.param.name; });

TEST(Pcapng, ReadsBigEndianFilesSimplePacketsAndSkipsUnknownBlocks) {
    const Octets file = octets(
        "0A0D0D0A 0000001C 1A2B3C4D 0001 0000 FFFFFFFFFFFFFFFF 0000001C\n"
        "00000001 00000020 0101 0000 00000002 0009 0001 06000000 0000 0000 00000020\n"
        "0000000B 00000010 DEADBEEF 00000010\n"
        "00000003 00000014 00000004 E5160000 00000014\n"
        "00000006 00000024 00000000 00000000 0000000A 00000001 00000001 E5000000 00000024");
    const Capture capture = read_pcapng(file);
    EXPECT_EQ(capture.error, PcapngError::none) << name(capture.error) << capture.offset;
    EXPECT_EQ(capture.skipped_blocks, 1u);
    ASSERT_EQ(capture.packets.size(), 2u);
    EXPECT_FALSE(capture.packets[0].has_time);
    EXPECT_EQ(capture.packets[0].octets.size(), 2u) << "the snap length is 2";
    EXPECT_EQ(capture.packets[0].original_length, 4u);
    EXPECT_EQ(capture.packets[1].link_type, 257);
    EXPECT_EQ(capture.packets[1].time_ns, 10'000) << "microseconds";
}

TEST(Pcapng, TakesTimesInAnyResolutionWithoutOverflow) {
    struct Row { const char* resolution; const char* offset; std::int64_t ns; };
    for (const Row& row : {Row{"09", "0000000000000000", 4'294'967'298}, Row{"06", "0000000000000000", 4'294'967'298'000},
                           Row{"8A", "0000000000000000", 4'294'967'298'000'000'000 / 1024}, Row{"00", "0000000000000000", 4'294'967'298'000'000'000},
                           Row{"09", "0100000000000000", 5'294'967'298}, Row{"09", "FFFFFFFFFFFFFFFF", 3'294'967'298},
                           Row{"09", "FFFFFFFFFFFFFF7F", INT64_MAX}, Row{"7F", "0000000000000000", 0}, Row{"FF", "0000000000000000", 0}}) {
        const Octets file = octets(std::string{SHB "01000000 2C000000 9300 0000 00000000 0900 0100 "} + row.resolution + "000000 0E00 0800 " +
                                   row.offset + " 0000 0000 2C000000 "
                                   "06000000 20000000 00000000 01000000 02000000 00000000 00000000 20000000");
        const Capture capture = read_pcapng(file);
        ASSERT_EQ(capture.error, PcapngError::none) << name(capture.error);
        ASSERT_EQ(capture.packets.size(), 1u);
        EXPECT_EQ(capture.packets[0].time_ns, row.ns) << row.resolution << ' ' << row.offset;
    }
}

TEST(Pcapng, KeepsAPacketWhoseOptionsAreDamaged) {
    const Octets file = octets(SHB IDB "06000000 24000000 00000000 00000000 00000000 00000000 00000000 0100 FF00 24000000");
    const Capture capture = read_pcapng(file);
    EXPECT_EQ(capture.error, PcapngError::none);
    ASSERT_EQ(capture.packets.size(), 1u);
    EXPECT_EQ(capture.packets[0].comment, "");
}

}  // namespace
}  // namespace dpchip::trace
