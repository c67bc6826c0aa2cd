// SPDX-License-Identifier: Apache-2.0
// The receiver's half of the UART, sample by sample (8.3; reference 1.3).
#include "rx_probe.hpp"

namespace dpchip::pins {
namespace {

constexpr Ticks kBegin = 1_ms;

Ticks on_grid(const Rig& rig, Ticks at) { return rig.uart.next_sample_from(at); }

// proves: VPC3C 8.3-02, VPC3C 8.3-11, VPC3C 9.1-06
TEST(UartReceiver, every_octet_at_every_rate_comes_out_at_its_very_time_when_its_edges_lie_on_the_grid) {
    for (const fdl::Baud& baud : fdl::kBaud) {
        Rig rig{baud.code};
        Ticks start = on_grid(rig, kBegin);
        for (unsigned octet = 0; octet < 256; ++octet) {
            SCOPED_TRACE(std::string{baud.name} + ", octet " + std::to_string(octet));
            rig.character(start, static_cast<std::uint8_t>(octet));
            rig.finish(start + rig.bit * 11);
            ASSERT_EQ(rig.host.characters.size(), octet + 1u);
            const fdl::Character& c = rig.host.characters.back();
            EXPECT_EQ(c.octet, octet);
            EXPECT_EQ(c.faults, fdl::fault_none);
            EXPECT_EQ(c.start, start);
            EXPECT_EQ(c.bit, rig.bit);
            EXPECT_EQ(rig.host.handed_over.back(), c.end());
            start += rig.bit * 11;
        }
        EXPECT_EQ(rig.host.carriers, (std::vector<Ticks>{on_grid(rig, kBegin) + rig.quarter() * 2})) << "one transmission, told of in the middle of its start bit";
    }
}

TEST(UartReceiver, every_phase_of_an_edge_against_CLK_at_12_Mbit_s_costs_less_than_a_quarter_of_a_bit) {
    for (std::int64_t phase = 0; phase < core::kClk.n; ++phase) {
        Rig rig{fdl::BaudCode::mbit_12};
        const Ticks start = on_grid(rig, kBegin) + Ticks{phase};
        for (unsigned n = 0; n < 8; ++n) rig.character(start + rig.bit * (11 * n), static_cast<std::uint8_t>(0x1Du << n | n));
        rig.finish(start + rig.bit * 100);
        ASSERT_EQ(rig.host.characters.size(), 8u) << phase;
        for (unsigned n = 0; n < 8; ++n) {
            const fdl::Character& c = rig.host.characters[n];
            ASSERT_EQ(c.octet, static_cast<std::uint8_t>(0x1Du << n | n)) << phase;
            ASSERT_EQ(c.faults, 0) << phase;
            ASSERT_EQ(c.start - (start + rig.bit * (11 * n)), phase == 0 ? Ticks{} : core::kClk - Ticks{phase});
        }
    }
}

TEST(UartReceiver, every_phase_in_CLK_at_every_other_rate_costs_less_than_a_quarter_of_a_bit) {
    for (const fdl::Baud& baud : fdl::kBaud) {
        const std::int64_t clks = baud.bit.n / 4 / core::kClk.n, step = std::max<std::int64_t>(clks / 64, 1);
        for (std::int64_t phase = 0; phase < clks; phase += step) {
            Rig rig{baud.code};
            const Ticks start = on_grid(rig, kBegin) + core::kClk * phase;
            rig.character(start, 0xA7);
            rig.finish(start + rig.bit * 12);
            ASSERT_EQ(rig.host.characters.size(), 1u) << baud.name << ' ' << phase;
            EXPECT_EQ(rig.host.characters[0].octet, 0xA7);
            const Ticks late = rig.host.characters[0].start - start;
            EXPECT_GE(late, Ticks{});
            EXPECT_LT(late, rig.quarter());
        }
    }
}

TEST(UartReceiver, the_grid_lies_on_the_edges_of_CLK_and_begins_again_with_the_rate) {
    const Ticks phase{417};
    Rig rig{fdl::BaudCode::mbit_12, phase};
    EXPECT_EQ(rig.uart.next_sample_from(1_us), phase + 48_clk - (phase.n > 0 ? Ticks{} : 1_clk));
    rig.finish(1_us + Ticks{3});
    rig.host.s.probe = fdl::BaudCode::kbit_500;
    rig.finish(1_us + Ticks{4});
    const Ticks origin = rig.uart.state().grid_origin;
    EXPECT_EQ(origin, phase + 48_clk);
    EXPECT_EQ(rig.uart.quarter(), 24_clk);
    EXPECT_EQ(rig.uart.next_sample_from(origin + Ticks{1}), origin + 24_clk);
}

TEST(UartReceiver, a_rate_that_changes_in_the_middle_of_a_character_loses_it) {
    Rig rig{fdl::BaudCode::mbit_3};
    const Ticks start = on_grid(rig, kBegin);
    rig.level(start, false);
    rig.finish(start + rig.bit * 5);
    rig.host.s.probe = fdl::BaudCode::mbit_1_5;
    rig.finish(start + rig.bit * 60);
    EXPECT_TRUE(rig.host.characters.empty());
    rig.level(start + rig.bit * 61, true);
    rig.finish(start + rig.bit * 200);
    EXPECT_TRUE(rig.host.characters.empty()) << "a line that is low when the rate changes shows no start edge";
}

// proves: VPC3C 8.3-05
TEST(UartReceiver, a_start_bit_is_looked_at_again_in_its_middle) {
    struct Row { std::int64_t quarters; std::size_t characters; };
    for (const fdl::Baud& baud : fdl::kBaud) {
        for (const Row& row : {Row{1, 0}, Row{2, 0}, Row{3, 1}, Row{4, 1}}) {
            SCOPED_TRACE(std::string{baud.name} + ", low for so many quarters: " + std::to_string(row.quarters));
            Rig rig{baud.code};
            const Ticks start = on_grid(rig, kBegin);
            rig.level(start, false);
            rig.level(start + rig.quarter() * row.quarters, true);
            rig.finish(start + rig.bit * 12);
            EXPECT_EQ(rig.host.characters.size(), row.characters);
            EXPECT_EQ(rig.host.carriers.size(), row.characters) << "noise is nobody's transmission";
            if (row.characters == 1) {
                EXPECT_EQ(rig.host.characters[0].octet, 0xFF);
                EXPECT_EQ(rig.host.characters[0].faults, fdl::fault_parity);
            }
        }
    }
}

TEST(UartReceiver, noise_shorter_than_a_sample_is_not_seen_and_noise_that_is_seen_ends_the_silence) {
    Rig rig{fdl::BaudCode::kbit_187_5};
    const Ticks grid = on_grid(rig, kBegin);
    rig.level(grid + Ticks{1}, false);
    rig.level(grid + rig.quarter() - Ticks{1}, true);  // between two samples
    const Ticks noise = grid + rig.quarter() * 10;
    rig.level(noise, false);
    rig.level(noise + Ticks{1}, true);
    const Ticks start = grid + rig.quarter() * 20;
    rig.character(start, 0x00);
    rig.finish(start + rig.bit * 12);
    ASSERT_EQ(rig.host.characters.size(), 1u);
    ASSERT_EQ(rig.host.lows.size(), 1u);
    EXPECT_EQ(rig.host.lows[0], noise + rig.quarter()) << "the idle line counts from the first sample that is high again";
}

// proves: VPC3C 8.3-06
TEST(UartReceiver, one_sample_decides_each_bit_the_other_three_mean_nothing) {
    for (const std::uint8_t octet : std::array<std::uint8_t, 4>{0x00, 0xFF, 0x5A, 0xC3}) {
        for (unsigned slot = 1; slot < 11; ++slot) {
            for (int quarter = 0; quarter < 4; ++quarter) {
                SCOPED_TRACE("octet " + std::to_string(octet) + ", bit " + std::to_string(slot) + ", quarter " + std::to_string(quarter));
                Rig rig{fdl::BaudCode::mbit_1_5};
                const Ticks start = on_grid(rig, kBegin);
                const unsigned frame = transmitter::frame(octet);
                for (int q = 0; q < 44; ++q) {
                    const bool bit = transmitter::bit_of(frame, static_cast<unsigned>(q) / 4);
                    rig.level(start + rig.quarter() * q, bit != (q == static_cast<int>(slot) * 4 + quarter));
                }
                rig.level(start + rig.bit * 11, true);
                rig.finish(start + rig.bit * 24);
                ASSERT_FALSE(rig.host.characters.empty());
                const fdl::Character& c = rig.host.characters[0];
                const unsigned turned = quarter == 2 && slot <= 8 ? 1u << (slot - 1) : 0u;
                EXPECT_EQ(c.octet, octet ^ turned);
                EXPECT_EQ((c.faults & fdl::fault_parity) != 0, quarter == 2 && slot <= 9);
                EXPECT_EQ((c.faults & fdl::fault_stop) != 0, quarter == 2 && slot == 10);
            }
        }
    }
}

TEST(UartReceiver, parity_is_checked_for_every_octet) {
    Rig rig{fdl::BaudCode::mbit_6};
    Ticks start = on_grid(rig, kBegin);
    for (unsigned octet = 0; octet < 256; ++octet, start += rig.bit * 11) {
        rig.frame(start, transmitter::frame(static_cast<std::uint8_t>(octet)) ^ 1u << 9, rig.bit);
        rig.finish(start + rig.bit * 11);
        ASSERT_EQ(rig.host.characters.size(), octet + 1u);
        EXPECT_EQ(rig.host.characters.back().octet, octet);
        EXPECT_EQ(rig.host.characters.back().faults, fdl::fault_parity);
    }
}

TEST(UartReceiver, a_break_is_one_character_without_stop_bit_until_the_line_rises_and_falls_again) {
    Rig rig{fdl::BaudCode::kbit_93_75};
    const Ticks start = on_grid(rig, kBegin), rise = start + rig.bit * 100;
    rig.level(start, false);
    rig.level(rise, true);
    rig.character(rise + rig.bit * 3, 0x42);
    rig.finish(rise + rig.bit * 20);
    ASSERT_EQ(rig.host.characters.size(), 2u);
    EXPECT_EQ(rig.host.characters[0].octet, 0x00);
    EXPECT_EQ(rig.host.characters[0].faults, fdl::fault_stop);
    EXPECT_EQ(rig.host.characters[1].octet, 0x42);
    ASSERT_EQ(rig.host.lows.size(), 2u);
    EXPECT_EQ(rig.host.lows[1], rise);
}

// proves: VPC3C 8.3-08
TEST(UartReceiver, hunting_begins_one_sample_behind_the_stop_bit_and_at_it_under_Dis_Start_Control) {
    struct Row { bool dis_start; std::int64_t quarters; bool heard; };
    for (const Row& row : {Row{false, 42, false}, Row{false, 43, true}, Row{false, 44, true}, Row{false, 45, true}, Row{false, 60, true}, Row{true, 42, true},
                           Row{true, 43, true}, Row{true, 60, true}}) {
        SCOPED_TRACE(std::to_string(row.quarters) + (row.dis_start ? " without start control" : ""));
        Rig rig{fdl::BaudCode::mbit_3};
        if (row.dis_start) rig.host.s.mode0 = regmap::mode0::dis_start_control;
        const Ticks start = on_grid(rig, kBegin), second = start + rig.quarter() * row.quarters;
        for (unsigned n = 0; n < 11 && start + rig.bit * n < second; ++n) rig.level(start + rig.bit * n, transmitter::bit_of(transmitter::frame(0x31), n));
        rig.character(second, 0xFF);
        rig.finish(second + rig.bit * 12);
        ASSERT_EQ(rig.host.characters.size(), row.heard ? 2u : 1u);
        EXPECT_EQ(rig.host.characters[0].octet, 0x31);
        EXPECT_EQ(rig.host.characters[0].faults, row.quarters == 42 ? fdl::fault_stop : fdl::fault_none);
        if (row.heard) {
            EXPECT_EQ(rig.host.characters[1].start, second);
            EXPECT_EQ(rig.host.characters[1].octet, 0xFF);
        }
    }
}

TEST(UartReceiver, characters_that_follow_without_a_gap_are_one_transmission) {
    Rig rig{fdl::BaudCode::mbit_3};
    Ticks start = on_grid(rig, kBegin);
    for (const std::int64_t quarters : {44, 45, 43, 44, 46, 44}) {
        rig.character(start, 0x55);
        start += rig.quarter() * quarters;
    }
    rig.finish(start + rig.bit * 12);
    EXPECT_EQ(rig.host.characters.size(), 6u);
    EXPECT_EQ(rig.host.carriers.size(), 2u);
}

TEST(UartReceiver, its_own_voice_is_not_heard) {
    Rig rig{fdl::BaudCode::mbit_1_5};
    rig.host.s.rts = 1;
    const Ticks start = on_grid(rig, kBegin);
    rig.character(start, 0x3C);
    rig.finish(start + rig.bit * 20);
    EXPECT_TRUE(rig.host.characters.empty());
    rig.host.s.rts = 0;
    rig.character(start + rig.bit * 21, 0x3C);
    rig.finish(start + rig.bit * 40);
    EXPECT_EQ(rig.host.characters.size(), 1u);
}

TEST(UartReceiver, it_makes_no_difference_in_how_many_steps_time_goes_by) {
    for (const std::int64_t step : {1, 7, 625, 1250, 9999, 1'000'000}) {
        Rig one{fdl::BaudCode::mbit_6}, other{fdl::BaudCode::mbit_6};
        const Ticks start = on_grid(one, kBegin) + Ticks{333};
        const auto walk = [&](Ticks to) {
            if (to - other.host.now() > Ticks{200'000}) other.finish(to - Ticks{200'000});
            while (other.host.now() + Ticks{step} < to) other.finish(other.host.now() + Ticks{step});
        };
        for (unsigned n = 0; n < 11; ++n) {
            const Ticks at = start + one.bit * n;
            const bool high = transmitter::bit_of(transmitter::frame(0x96), n);
            one.level(at, high);
            walk(at);
            other.level(at, high);
        }
        one.finish(start + one.bit * 12);
        walk(start + one.bit * 12);
        other.finish(start + one.bit * 12);
        ASSERT_EQ(one.host.characters.size(), 1u);
        ASSERT_EQ(other.host.characters.size(), 1u) << step;
        EXPECT_EQ(one.host.characters[0].start, other.host.characters[0].start);
        EXPECT_EQ(one.host.characters[0].octet, other.host.characters[0].octet);
        EXPECT_EQ(one.host.handed_over, other.host.handed_over);
    }
}

TEST(UartReceiver, a_snapshot_at_any_moment_of_a_character_goes_on_the_same_way) {
    for (std::int64_t cut = 0; cut < 46; ++cut) {
        Rig rig{fdl::BaudCode::mbit_3};
        const Ticks start = on_grid(rig, kBegin);
        Rig copy = rig;
        for (std::int64_t q = 0; q < 48; ++q) {
            const bool high = q >= 44 || transmitter::bit_of(transmitter::frame(0xB2), static_cast<unsigned>(q) / 4);
            Rig& r = q < cut ? rig : copy;
            if (q == cut) {
                copy.host = rig.host;
                copy.uart.restore(rig.uart.state());
            }
            r.level(start + r.quarter() * q, high);
            r.uart.sample(r.host);
        }
        copy.finish(start + rig.bit * 13);
        ASSERT_EQ(copy.host.characters.size(), 1u) << cut;
        EXPECT_EQ(copy.host.characters[0].octet, 0xB2);
        EXPECT_EQ(copy.host.handed_over[0], start + rig.bit * 11);
        EXPECT_TRUE(plausible(copy.uart.state()));
    }
}

}  // namespace
}  // namespace dpchip::pins
