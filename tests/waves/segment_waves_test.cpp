// SPDX-License-Identifier: Apache-2.0
// SegmentWaves by itself: names, whose pin moved, and what waits for what.
#include <gtest/gtest.h>

#include <array>
#include <sstream>
#include <string>

#include <dpchip/segment/port.hpp>
#include <dpchip/waves/segment_waves.hpp>

namespace dpchip::waves {
namespace {

using namespace core::literals;

constexpr std::array<std::uint8_t, 1> kShort{0xE5};

/// How often a signal changes in the dump.
std::size_t changes(const std::string& text, const std::string& scope, const std::string& name) {
    const std::size_t scoped = text.find("$scope module " + scope + " ");
    const std::size_t behind = text.find(' ' + name + " $end", scoped);
    EXPECT_NE(behind, std::string::npos) << scope << '.' << name;
    const std::size_t before = text.rfind(' ', behind - 1) + 1;
    const std::string id = text.substr(before, behind - before);
    std::istringstream in{text.substr(text.find("$end\n", text.find("$dumpvars")))};
    std::size_t n = 0;
    for (std::string line; std::getline(in, line);) n += line == "0" + id || line == "1" + id ? 1u : 0u;
    return n;
}

struct Drawn {
    segment::Segment line;
    segment::Port one{fdl::BaudCode::mbit_1_5}, two{fdl::BaudCode::mbit_1_5};
    std::ostringstream out;

    static Options options(std::vector<std::string> signals = {}) {
        Options o;
        o.signals = std::move(signals);
        return o;
    }
};

TEST(SegmentWaves, a_pattern_that_fits_nothing_is_named_and_nothing_is_written_yet) {
    Drawn d;
    SegmentWaves waves{d.out, d.line, {"Press", "Oven"}, Drawn::options({"*.TXD", "Presse.*", "x"})};
    ASSERT_NE(waves.unmatched(), nullptr);
    EXPECT_EQ(*waves.unmatched(), "Presse.*");
    EXPECT_EQ(waves.signals().size(), 2u + 2u * 30u);
    EXPECT_EQ(waves.signals().front(), "line.level");
    EXPECT_TRUE(d.out.str().empty());
}

TEST(SegmentWaves, a_station_that_is_unplugged_while_it_sends_keeps_its_pin_when_another_gets_its_number) {
    Drawn d;
    const auto index = d.line.attach(d.one, "one");
    ASSERT_TRUE(index);
    {
        SegmentWaves waves{d.out, d.line, {"one", "two"}, Drawn::options()};
        EXPECT_EQ(waves.unmatched(), nullptr);
        waves.look(0, nullptr, *index);
        ASSERT_TRUE(d.one.send_at(10_us, kShort));
        d.line.touch(*index);
        d.line.run(11_us);
        d.line.detach(*index);
        const auto again = d.line.attach(d.two, "two");
        ASSERT_TRUE(again);
        ASSERT_EQ(*again, *index);
        waves.look(0, nullptr, segment::kNobody);
        waves.look(1, nullptr, *again);
        waves.settle();
        d.line.run(1_ms);
        waves.settle();
        ASSERT_TRUE(d.two.send_at(2_ms, kShort));
        d.line.touch(*again);
        d.line.run(2_ms);
        waves.settle();
    }
    const std::string text = d.out.str();
    const std::size_t edges = changes(text, "one", "TXD");
    EXPECT_EQ(edges, 6u) << "E5: 0 1 0 1 00 111, parity 1, stop 1";
    EXPECT_EQ(changes(text, "two", "TXD"), edges);
    EXPECT_EQ(changes(text, "two", "RXD"), 2 * edges);
}

TEST(SegmentWaves, finishing_twice_is_finishing_once) {
    Drawn d;
    SegmentWaves waves{d.out, d.line, {}, Drawn::options()};
    d.line.run(1_us);
    waves.finish();
    const std::string text = d.out.str();
    EXPECT_TRUE(text.ends_with("#1000000\n")) << text;
    d.line.run(1_us);
    waves.finish();
    EXPECT_EQ(d.out.str(), text);
    EXPECT_TRUE(waves.good());
}

}  // namespace
}  // namespace dpchip::waves
