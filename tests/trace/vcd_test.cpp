// SPDX-License-Identifier: Apache-2.0
// Waveforms: what stands in the file, octet by octet where that is the point, and when.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include <dpchip/fdl/baud.hpp>
#include <dpchip/trace/vcd_order.hpp>
#include <dpchip/trace/vcd_writer.hpp>

namespace dpchip::trace {
namespace {

using namespace core::literals;

TEST(VcdTimescale, is_a_power_of_ten_and_a_unit) {
    EXPECT_EQ(parse_timescale("1ps")->femtoseconds, 1'000);
    EXPECT_EQ(parse_timescale("10 ns")->femtoseconds, 10'000'000);
    EXPECT_EQ(parse_timescale("100us")->femtoseconds, 100'000'000'000);
    EXPECT_EQ(parse_timescale("1s")->femtoseconds, 1'000'000'000'000'000);
    EXPECT_EQ(parse_timescale("1fs")->text(), "1 fs");
    EXPECT_EQ(parse_timescale("100ns")->text(), "100 ns");
    EXPECT_EQ(parse_timescale("100s")->text(), "100 s");
    for (const char* text : {"", "ps", "2ns", "1", "1000ps", "1 m", "-1ns", "1nsx", "01.ns", "ns1"}) EXPECT_FALSE(parse_timescale(text)) << text;
}

TEST(VcdTimescale, rounds_every_absolute_time_to_the_nearest_unit_and_never_drifts) {
    const VcdTimescale ps{1'000}, ns{1'000'000}, fs{1};
    EXPECT_EQ(ps.units(1_clk), 20'833);   // 20833.33
    EXPECT_EQ(ps.units(2_clk), 41'667);   // 41666.67
    EXPECT_EQ(ps.units(3_clk), 62'500);
    EXPECT_EQ(ps.units(48'000'000_clk), 1'000'000'000'000) << "a second of CLK is a second";
    EXPECT_EQ(ns.units(Ticks{29}), 0);
    EXPECT_EQ(ns.units(Ticks{30}), 1) << "half a unit rounds up";
    EXPECT_EQ(fs.units(Ticks{3}), 50'000);
    EXPECT_EQ(ps.units(core::seconds(9'000'000)), 9'000'000LL * 1'000'000'000'000) << "three months in ps";
}

TEST(VcdWriter, writes_scopes_first_values_and_changes) {
    std::ostringstream out;
    {
        VcdWriter vcd{out, {.timescale = {1'000'000}, .comment = "a test"}};
        const auto a = vcd.bit("chip.pins", "X/INT", '1');
        const auto b = vcd.vector("chip.pins", "sm", 4);
        const auto c = vcd.text("chip", "DP State");
        const auto d = vcd.bit("", "top");
        vcd.set(0_ns, a, '1');
        vcd.set(5_ns, a, '0');
        vcd.set_value(5_ns, b, 10);
        vcd.set_text(7_ns, c, "WAIT PRM");
        vcd.set(7_ns, d, 'z');
        vcd.set_text(8_ns, c, "WAIT PRM");
        vcd.unknown(9_ns, b);
        vcd.finish(12_ns);
        EXPECT_EQ(vcd.late(), 0u);
    }
    const std::string text = out.str();
    EXPECT_EQ(text.substr(text.find("$comment")), "$comment a test $end\n$timescale 1 ns $end\n"
                                                  "$scope module chip $end\n$scope module pins $end\n$var wire 1 ! X_INT $end\n$var reg 4 \" sm $end\n$upscope $end\n"
                                                  "$var string 1 # DP_State $end\n$upscope $end\n$var wire 1 $ top $end\n$enddefinitions $end\n"
                                                  "#0\n$dumpvars\n1!\nbx \"\ns? #\nx$\n$end\n#5\n0!\nb1010 \"\n#7\nsWAIT_PRM #\nz$\n#9\nbx \"\n#12\n");
}

TEST(VcdWriter, a_window_begins_with_the_values_of_its_first_moment_and_ends_in_time) {
    std::ostringstream out;
    VcdWriter vcd{out, {.timescale = {1'000'000}, .from = 100_ns, .to = 200_ns}};
    const auto a = vcd.bit("", "a", '0');
    const auto b = vcd.vector("", "b", 8);
    vcd.set(10_ns, a, '1');
    vcd.set_value(100_ns, b, 3);
    vcd.set(150_ns, a, '0');
    vcd.set(200_ns, a, '1');
    vcd.set(201_ns, a, '0');
    vcd.finish(300_ns);
    const std::string text = out.str();
    EXPECT_EQ(text.substr(text.find("#100")), "#100\n$dumpvars\n1!\nb00000011 \"\n$end\n#150\n0!\n#200\n1!\n");
    EXPECT_EQ(vcd.changes(), 2u);
}

TEST(VcdWriter, a_window_that_nothing_happens_in_is_a_valid_file) {
    std::ostringstream out;
    VcdWriter vcd{out, {.timescale = {1'000'000}, .from = 10_ns, .to = 20_ns}};
    vcd.bit("", "a", '0');
    vcd.finish(1_ms);
    EXPECT_NE(out.str().find("#10\n$dumpvars\n0!\n$end\n#20\n"), std::string::npos);
}

TEST(VcdWriter, what_comes_late_is_written_at_the_last_time_and_counted) {
    std::ostringstream out;
    VcdWriter vcd{out, {.timescale = {1'000'000}}};
    const auto a = vcd.bit("", "a", '0');
    vcd.set(50_ns, a, '1');
    vcd.set(40_ns, a, '0');
    vcd.finish(50_ns);
    EXPECT_EQ(vcd.late(), 1u);
    EXPECT_NE(out.str().find("#50\n1!\n0!\n"), std::string::npos);
}

TEST(VcdWriter, a_signal_that_nobody_wants_costs_nothing) {
    std::ostringstream out;
    VcdWriter vcd{out};
    vcd.set(1_ns, VcdWriter::kOff, '1');
    vcd.set_value(1_ns, VcdWriter::kOff, 1);
    vcd.set_text(1_ns, VcdWriter::kOff, "a");
    vcd.unknown(1_ns, VcdWriter::kOff);
    EXPECT_EQ(vcd.changes(), 0u);
}

TEST(VcdWriter, thousands_of_signals_have_names_of_their_own) {
    std::ostringstream out;
    VcdWriter vcd{out};
    for (int i = 0; i < 10'000; ++i) vcd.bit("many", "s" + std::to_string(i));
    vcd.finish(1_ns);
    std::map<std::string, int> ids;
    std::istringstream in{out.str()};
    for (std::string word; in >> word;)
        if (word == "wire") {
            std::string width, id;
            in >> width >> id;
            EXPECT_EQ(++ids[id], 1);
        }
    EXPECT_EQ(ids.size(), 10'000u);
}

TEST(VcdOrder, brings_changes_into_the_order_of_time_and_keeps_the_order_of_one_moment) {
    std::ostringstream out;
    VcdWriter vcd{out, {.timescale = {1'000'000}}};
    const auto a = vcd.bit("", "a", '0');
    const auto b = vcd.bit("", "b", '0');
    VcdOrder order{vcd};
    order.set(30_ns, a, '1');
    order.set(10_ns, b, '1');
    order.set(10_ns, b, '0');
    order.set(20_ns, b, '1');
    order.release(20_ns);
    EXPECT_EQ(order.waiting(), 2u);
    order.set(20_ns, a, 'x');
    order.release(core::kNever);
    vcd.finish(30_ns);
    EXPECT_EQ(vcd.late(), 0u);
    const std::string text = out.str();
    EXPECT_EQ(text.substr(text.find("$end\n#10")), "$end\n#10\n1\"\n0\"\n#20\n1\"\nx!\n#30\n1!\n");
}

TEST(VcdRender, shows_every_bit_of_every_octet_at_every_rate_and_its_faults) {
    for (const fdl::Baud& baud : fdl::kBaud)
        for (unsigned octet = 0; octet < 256; ++octet)
            for (const unsigned faults : {0u, unsigned{fdl::fault_parity}, unsigned{fdl::fault_stop}}) {
                fdl::Transmission t;
                const std::array<std::uint8_t, 2> octets{static_cast<std::uint8_t>(octet), 0x55};
                t.assign(1_us, baud.bit, octets);
                t.damaged = true;
                t.faults.fill(0);
                t.faults[0] = static_cast<std::uint8_t>(faults);
                std::vector<std::pair<Ticks, bool>> edges;
                render(t, [&](Ticks at, bool high) { edges.emplace_back(at, high); });
                const auto level = [&](Ticks at) {
                    bool high = true;
                    for (const auto& [when, to] : edges)
                        if (when <= at) high = to;
                    return high;
                };
                unsigned bits = 0;
                for (unsigned n = 0; n < 11; ++n) bits |= level(1_us + baud.bit * n + Ticks{baud.bit.n / 2}) ? 1u << n : 0u;
                const unsigned ones = static_cast<unsigned>(__builtin_popcount(octet));
                const bool parity = (ones % 2 == 1) != (faults == fdl::fault_parity);
                ASSERT_EQ(bits, octet << 1 | (parity ? 1u << 9 : 0u) | (faults == fdl::fault_stop ? 0u : 1u << 10));
                ASSERT_TRUE(level(t.end()));
                for (std::size_t i = 1; i < edges.size(); ++i) ASSERT_TRUE(edges[i - 1].first < edges[i].first && edges[i - 1].second != edges[i].second);
            }
}

/// Not a check of time: it prints how much faster the writer is than the stream's own formatting.
TEST(VcdWriter, throughput_against_an_ostream_is_printed) {
    const auto seconds = [](auto&& work) {
        const auto begin = std::chrono::steady_clock::now();
        work();
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    constexpr int kChanges = 300'000;
    std::ofstream mine{"/dev/null"}, plain{"/dev/null"};
    const double writer = seconds([&] {
        VcdWriter vcd{mine, {.timescale = {1'000}}};
        const auto a = vcd.bit("", "a", '0');
        for (int i = 1; i <= kChanges; ++i) vcd.set(1_clk * i, a, i % 2 == 0 ? '0' : '1');
    });
    const double stream = seconds([&] {
        for (int i = 1; i <= kChanges; ++i) plain << '#' << i * 20833LL << '\n' << (i % 2) << '!' << '\n';
    });
    std::printf("VCD: %d changes, %.2f times the speed of operator<<, %.1f million changes a second\n", kChanges, stream / writer, kChanges / writer / 1e6);
    EXPECT_TRUE(mine.good() && plain.good());
}

}  // namespace
}  // namespace dpchip::trace
