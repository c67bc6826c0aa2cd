// SPDX-License-Identifier: Apache-2.0
// Pins that are not the bus: RESET, straps, clocks, test pins, X/INT, pin 13, the serial side (3.1, 8.1.1, 8.4, 10.7.1).
#include <gtest/gtest.h>

#include "pins/part.hpp"

namespace {

using namespace dpchip;
using namespace dpchip::core::literals;
using test::Part;
using core::Ticks;
using test::PinId;
using test::PinLevel;
using test::ProcessorMode;
using test::Supply;

constexpr std::array<PinId, 7> kSingleOutputs{PinId::clkout, PinId::x_int, PinId::xdataexch_sync, PinId::xready_xdtack, PinId::txd, PinId::rts, PinId::db3};

// ---- RESET ------------------------------------------------------------------------------------------------------

// proves: VPC3C 8.1.2-07
TEST(Reset, Leaves_the_outputs_at_their_inactive_levels_and_DB_and_TXD_high_resistance) {
    Part part{ProcessorMode::async_intel, false, Supply::v5, regmap::Variant::vpc3c, {.txd_pull_up = false}};
    part.bus.write(0x06, 0x10);  // INT_Pol: X/INT idles at 0
    part.bus.settle();
    EXPECT_EQ(part.pin(PinId::x_int), PinLevel::low);
    part.set(PinId::xcs_ab11, 0);
    part.set(PinId::xrd_r_w, 0);
    part.wait(150_ns);
    EXPECT_NE(part.pin(PinId::db0), PinLevel::z);
    EXPECT_EQ(part.pin(PinId::xready_xdtack), PinLevel::low);
    part.set(PinId::reset, 1);
    for (const PinId db : pins::kDataBus) EXPECT_EQ(part.pin(db), PinLevel::z);
    EXPECT_EQ(part.pin(PinId::x_int), PinLevel::high);
    EXPECT_EQ(part.pin(PinId::xdataexch_sync), PinLevel::high);
    EXPECT_EQ(part.pin(PinId::xready_xdtack), PinLevel::high);
    EXPECT_EQ(part.pin(PinId::rts), PinLevel::low);
    EXPECT_EQ(part.pin(PinId::txd), PinLevel::z);
}

// proves: VPC3C 10.7.1-03, VPC3C 8.1.2-20, E039
TEST(Reset, Of_100_ns_is_long_enough_and_a_tick_less_is_reported_and_resets_all_the_same) {
    Part part{ProcessorMode::async_intel};
    part.bus.write(0x06, 0x10);
    part.bus.settle();
    part.set(PinId::reset, 1);
    part.wait(100_ns);
    part.set(PinId::reset, 0);
    EXPECT_EQ(part.findings(), "");
    part.bus.write(0x06, 0x10);
    part.bus.settle();
    part.set(PinId::reset, 1);
    part.wait(100_ns - Ticks{1});
    part.set(PinId::reset, 0);
    const core::Finding f = part.package.findings().pop();
    EXPECT_EQ(trace::pin_finding_text(f.rule, f.detail), "RESET: 99.983 ns, at least 100 ns (section 10.7.1)");
    EXPECT_EQ(part.package.chip().state().mode0, 0u);
}

TEST(Reset, Ignores_accesses_and_a_strobe_that_outlasts_it) {
    Part part{ProcessorMode::async_intel};
    part.accesses();
    part.set(PinId::reset, 1);
    part.set(PinId::xcs_ab11, 0);
    part.set(PinId::xrd_r_w, 0);
    part.wait(300_ns);
    EXPECT_EQ(part.pin(PinId::db0), PinLevel::z);
    part.set(PinId::reset, 0);
    part.wait(300_ns);
    EXPECT_EQ(part.pin(PinId::db0), PinLevel::z);
    part.set(PinId::xrd_r_w, 1);
    part.wait(100_ns);
    EXPECT_TRUE(part.accesses().empty());
    EXPECT_EQ(part.findings(), "access_in_reset");
    part.bus.write(0x100, 0x42);
    EXPECT_EQ(part.bus.read(0x100), 0x42) << "the next access is one";
}

TEST(Reset, Forgets_a_write_that_has_not_reached_the_chip) {
    Part part{ProcessorMode::async_intel};
    part.bus.write(0x100, 0x11);
    part.bus.settle();
    part.bus.write(0x100, 0x22);
    part.set(PinId::reset, 1);
    part.wait(300_ns);
    part.set(PinId::reset, 0);
    EXPECT_EQ(part.package.chip().peek(0x100), 0x11);
}

TEST(Reset, Is_missed_when_it_never_came) {
    pins::Package<> package;
    pins::BusCycles<> bus{package, ProcessorMode::async_intel};
    bus.write(0x100, 1);
    bus.write(0x101, 1);
    EXPECT_EQ(test::findings(package), "no_reset");
}

// ---- straps -----------------------------------------------------------------------------------------------------

// proves: VPC3C 3.1-05
TEST(Straps, May_change_in_RESET_and_are_misuse_outside) {
    Part part{ProcessorMode::async_intel};
    EXPECT_EQ(part.package.mode(), ProcessorMode::async_intel);
    part.set(PinId::mode, 1);
    EXPECT_EQ(part.package.mode(), ProcessorMode::sync_intel);
    EXPECT_EQ(part.findings(), "strap_changed 23");
    part.set(PinId::reset, 1);
    part.set(PinId::xint_mot, 1);
    part.wait(300_ns);
    part.set(PinId::reset, 0);
    EXPECT_EQ(part.package.mode(), ProcessorMode::sync_motorola);
    EXPECT_EQ(part.package.chip().bus_mode(), chip::BusMode::motorola);
    EXPECT_EQ(part.findings(), "");
}

// ---- clocks -----------------------------------------------------------------------------------------------------

int edges_in(Part& part, Ticks time) {
    int edges = 0;
    const Ticks end = part.package.now() + time;
    while (part.package.now() < end) {
        part.package.advance(std::min(end, part.package.next()));
        edges += static_cast<int>(part.edges(PinId::clkout).size());
    }
    return edges;
}

// proves: VPC3C 3.1-04, VPC3C 8.1.1-02, APC3 1-05
TEST(ClockOut, Is_24_MHz_with_DIVIDER_1_and_12_MHz_with_0_and_symmetric) {
    Part part{ProcessorMode::async_intel};
    part.package.watch(PinId::clkout, true);
    EXPECT_EQ(edges_in(part, 1_ms), 2 * 12'000);
    part.set(PinId::divider, 1);
    EXPECT_EQ(edges_in(part, 1_ms), 2 * 24'000);
    part.set(PinId::divider, 0);
    part.package.advance(part.package.now() + 1_us);
    part.edges(PinId::clkout);
    std::vector<pins::PinEdge> edges;
    while (edges.size() < 5) {
        part.package.advance(part.package.next());
        for (const pins::PinEdge& e : part.edges(PinId::clkout)) edges.push_back(e);
    }
    for (std::size_t i = 1; i < edges.size(); ++i) {
        EXPECT_EQ(edges[i].at - edges[i - 1].at, 2_clk);
        EXPECT_NE(edges[i].level, edges[i - 1].level);
    }
}

TEST(ClockOut, Starts_low_toggles_with_rising_CLK_and_runs_during_RESET) {
    pins::Package<> package;
    package.set_clock_phase(Ticks{200});
    package.watch(PinId::clkout, true);
    package.set_pin(PinId::divider, PinLevel::high);
    package.set_pin(PinId::reset, PinLevel::high);
    EXPECT_EQ(package.pin(PinId::clkout), PinLevel::low);
    EXPECT_EQ(package.next(), Ticks{200});
    package.advance(10_clk);
    std::vector<Ticks> at;
    while (!package.edges().empty())
        if (const pins::PinEdge e = package.edges().pop(); e.pin == PinId::clkout) at.push_back(e.at);
    ASSERT_EQ(at.size(), 10u);
    for (const Ticks t : at) EXPECT_EQ(t % core::kClk, Ticks{200});
}

TEST(ClockOut, Costs_nothing_while_nobody_watches) {
    pins::Package<> package;
    EXPECT_EQ(package.next(), core::kNever);
    package.advance(3600_s);
    EXPECT_TRUE(package.edges().empty());
    EXPECT_NE(package.pin(PinId::clkout), PinLevel::z);
}

struct ClkCase {
    const char* what;
    Ticks high, low, slope;
    std::string expected;
};

// proves: VPC3C 10.7.1-01, VPC3C 10.7.1-04..08
TEST(Clk, Edges_that_are_driven_keep_every_limit_to_the_tick) {
    const std::string period = "system_timing 0", high = "system_timing 1", low = "system_timing 2", rise = "system_timing 3", fall = "system_timing 4";
    const std::array<ClkCase, 9> cases{{
        {"30:70", 6.25_ns, core::kClk - 6.25_ns, 4_ns, ""},
        {"70:30", core::kClk - 6.25_ns, 6.25_ns, 4_ns, ""},
        {"short high", 6.25_ns - Ticks{1}, core::kClk - 6.25_ns + Ticks{1}, 4_ns, high},
        {"short low", core::kClk - 6.25_ns + Ticks{1}, 6.25_ns - Ticks{1}, 4_ns, low},
        {"long high", 14.6_ns + Ticks{1}, core::kClk - 14.6_ns - Ticks{1}, 4_ns, high + ", " + low},
        {"slow edges", Ticks{625}, Ticks{625}, 4_ns + Ticks{1}, rise + ", " + fall},
        {"fast crystal", Ticks{623}, Ticks{623}, Ticks{}, period},
        {"slow crystal", Ticks{627}, Ticks{627}, Ticks{}, period},
        {"crystal within 0.3 %", Ticks{624}, Ticks{623}, Ticks{}, ""},
    }};
    for (const ClkCase& c : cases) {
        pins::Package<> package;
        for (int i = 0; i < 4; ++i) {
            package.clock_edge(PinLevel::high, c.slope);
            package.advance(package.now() + c.high);
            package.clock_edge(PinLevel::low, c.slope);
            package.advance(package.now() + c.low);
        }
        const std::string found = test::findings(package);
        EXPECT_EQ(found.substr(0, c.expected.size()), c.expected) << c.what;
        EXPECT_EQ(found.empty(), c.expected.empty()) << c.what << ": " << found;
    }
}

TEST(Clk, A_rising_edge_sets_the_phase_and_accesses_follow_it) {
    Part part{ProcessorMode::async_intel};
    part.wait(Ticks{333});
    const Ticks edge = part.package.now();
    part.package.clock_edge(PinLevel::high);
    EXPECT_EQ(part.package.clk().phase(), edge % core::kClk);
    part.accesses();
    part.bus.read(0x40);
    EXPECT_EQ((part.accesses().at(0).at - edge) % core::kClk, Ticks{});
}

// ---- test pins --------------------------------------------------------------------------------------------------

// proves: VPC3C 8.4-01, VPC3C 8.4-02, VPC3C 3.1-08
TEST(TestPins, XTEST0_takes_every_output_from_the_board_and_the_chip_runs_on) {
    Part part{ProcessorMode::async_intel, false, Supply::v5, regmap::Variant::vpc3c, {.txd_pull_up = false}};
    part.package.watch(PinId::clkout, true);
    part.set(PinId::xtest0, 0);
    for (const PinId pin : kSingleOutputs) EXPECT_EQ(part.pin(pin), PinLevel::z) << pins::info(pin).name;
    part.bus.times().wait_for_ready = false;
    part.bus.write(0x100, 0x5A);
    EXPECT_EQ(part.bus.read(0x100), 0xFF) << "nobody drives DB";
    part.set(PinId::xtest0, 1);
    EXPECT_EQ(part.bus.read(0x100), 0x5A);
    for (const PinId pin : {PinId::x_int, PinId::rts, PinId::clkout, PinId::xready_xdtack, PinId::xdataexch_sync}) EXPECT_NE(part.pin(pin), PinLevel::z);
    EXPECT_EQ(part.findings(), "");
}

// proves: VPC3C 8.4-03
TEST(TestPins, XTEST1_at_0_and_open_test_pins_are_misuse) {
    Part part{ProcessorMode::async_intel};
    part.set(PinId::xtest1, 0);
    EXPECT_EQ(part.findings(), "test_mode 35");
    part.set(PinId::xtest1, 1);
    part.package.set_pin(PinId::xtest1, PinLevel::z);
    part.package.set_pin(PinId::xtest0, PinLevel::z);
    EXPECT_EQ(part.findings(), "floating_input 35, floating_input 34");
    EXPECT_EQ(part.pin(PinId::xtest0), PinLevel::z);
    EXPECT_EQ(part.pin(PinId::rts), PinLevel::low) << "behaviour is otherwise normal";
}

// ---- interrupt and pin 13 ---------------------------------------------------------------------------------------

// proves: VPC3C 10.7.1-02
TEST(Interrupt, Pin_falls_with_an_event_and_stays_away_for_1_us_or_1_ms_after_EOI) {
    for (const bool ms : {false, true}) {
        Part part{ProcessorMode::async_intel};
        part.bus.write(0x07, ms ? 0x02 : 0x00);  // EOI_Time_Base
        part.bus.write(0x04, 0xEF);              // IMR: bit 4 enabled
        part.bus.settle();
        EXPECT_EQ(part.pin(PinId::x_int), PinLevel::high);
        part.edges(PinId::x_int);
        part.bus.write(0x00, 0x10);              // IRR: bit 4 set
        part.bus.settle();
        ASSERT_EQ(part.edges(PinId::x_int).size(), 1u);
        EXPECT_EQ(part.pin(PinId::x_int), PinLevel::low);
        part.bus.write(0x08, 0x02);              // EOI
        part.wait(2_ms);
        const auto edges = part.edges(PinId::x_int);
        ASSERT_EQ(edges.size(), 2u) << "the event still waits";
        EXPECT_EQ(edges[0].level, PinLevel::high);
        EXPECT_EQ(edges[1].at - edges[0].at, ms ? 1_ms : 1_us);
    }
}

// proves: VPC3C 3.1-03
TEST(Pin13, Idles_as_the_role_that_Mode_Register_2_gives_it) {
    Part part{ProcessorMode::async_intel};
    EXPECT_EQ(part.pin(PinId::xdataexch_sync), PinLevel::high) << "XDATAEXCH outside DATA-EXCH";
    part.bus.write(0x0C, 0x31);  // SYNC_Ena, SYNC_Pol = 1
    part.bus.settle();
    EXPECT_EQ(part.pin(PinId::xdataexch_sync), PinLevel::low) << "SYNC, positive";
    part.bus.write(0x0C, 0x11);
    part.bus.settle();
    EXPECT_EQ(part.pin(PinId::xdataexch_sync), PinLevel::high) << "SYNC, negative";
}

// ---- inputs -----------------------------------------------------------------------------------------------------

TEST(Inputs, Only_AB10_has_a_pull_down_and_the_others_keep_their_level_and_are_reported) {
    Part part{ProcessorMode::async_intel};
    part.set(PinId::ab10, 1);
    part.package.set_pin(PinId::ab10, PinLevel::z);
    EXPECT_EQ(part.pin(PinId::ab10), PinLevel::low);
    EXPECT_EQ(part.findings(), "");
    part.package.set_pin(PinId::rxd, PinLevel::z);
    EXPECT_EQ(part.findings(), "floating_input 30");
    part.package.set_pin(PinId::rxd, PinLevel::z);
    EXPECT_EQ(part.findings(), "") << "once";
}

TEST(Inputs, An_output_cannot_be_driven_and_a_supply_pin_is_no_input) {
    Part part{ProcessorMode::async_intel};
    part.set(PinId::rts, 1);
    EXPECT_EQ(part.findings(), "output_driven 27");
    EXPECT_EQ(part.pin(PinId::rts), PinLevel::low);
    part.set(PinId::vdd_18, 0);
    EXPECT_EQ(part.pin(PinId::vdd_18), PinLevel::high);
    EXPECT_EQ(part.pin(PinId::vss_6), PinLevel::low);
    EXPECT_EQ(part.findings(), "");
}

// proves: VPC3C 3.1-07
TEST(Inputs, XCTS_reaches_the_transmitter) {
    Part part{ProcessorMode::async_intel};
    EXPECT_EQ(part.package.chip().state().xcts_high, 0u) << "low enables sending";
    part.set(PinId::xcts, 1);
    EXPECT_EQ(part.package.chip().state().xcts_high, 1u);
}

// proves: VPC3C 3.1-06, VPC3C 9.1-03, VPC3C 10.4-01
TEST(Txd, Is_high_resistance_while_nothing_is_sent_and_the_pull_up_makes_it_1) {
    Part with{ProcessorMode::async_intel};
    EXPECT_EQ(with.pin(PinId::txd), PinLevel::high);
    Part without{ProcessorMode::async_intel, false, Supply::v5, regmap::Variant::vpc3c, {.txd_pull_up = false}};
    EXPECT_EQ(without.pin(PinId::txd), PinLevel::z);
    without.package.set_options({});
    EXPECT_EQ(without.edges(PinId::txd).back().level, PinLevel::high) << "the pull-up is fitted";
}

// ---- the part ---------------------------------------------------------------------------------------------------

// proves: E036, APC3 2.1-02
TEST(Supply, APC3_works_at_3_3_V_and_VPC3_C_at_both) {
    using regmap::Variant;
    EXPECT_TRUE(pins::works_at(Variant::vpc3c, Supply::v3_3) && pins::works_at(Variant::vpc3c, Supply::v5));
    EXPECT_TRUE(pins::works_at(Variant::apc3, Supply::v3_3));
    EXPECT_FALSE(pins::works_at(Variant::apc3, Supply::v5));
    EXPECT_FALSE(pins::works_at(Variant::vpc3a, Supply::v3_3));
}

TEST(Violations, Are_counted_by_number_and_traced) {
    Part part{ProcessorMode::async_intel};
    part.bus.times() = pins::BusTimes::at_limits(ProcessorMode::async_intel, Supply::v5);
    part.bus.times().of[29] -= Ticks{1};
    for (int i = 0; i < 3; ++i) part.bus.write(0x100, 0);
    part.bus.settle();
    EXPECT_EQ(part.package.violations(29), 3u);
    EXPECT_EQ(part.package.violations(0), 3u);
    EXPECT_EQ(part.package.violations(28), 0u);
    EXPECT_EQ(part.package.violations(1000), 0u);
    EXPECT_FALSE(part.package.failed());
    std::size_t traced = 0;
    for (const core::TraceRecord& r : part.ring) traced += r.what == static_cast<std::uint16_t>(regmap::Fact::pin_finding) ? 1u : 0u;
    EXPECT_EQ(traced, 3u);
}

TEST(Violations, Are_fatal_by_option_and_silent_when_timing_is_not_checked) {
    for (const bool check : {true, false}) {
        Part part{ProcessorMode::async_intel, false, Supply::v5, regmap::Variant::vpc3c, {.check_timing = check, .fatal = true}};
        part.bus.times() = pins::BusTimes::at_limits(ProcessorMode::async_intel, Supply::v5);
        part.bus.times().of[29] -= Ticks{1};
        part.bus.write(0x100, 0);
        part.bus.settle();
        EXPECT_EQ(part.package.failed(), check);
        EXPECT_EQ(part.package.violations(0), check ? 1u : 0u);
    }
}

TEST(Copy, A_copy_of_a_package_is_a_snapshot_in_the_middle_of_a_cycle) {
    Part part{ProcessorMode::async_intel};
    part.bus.write(0x100, 0x77);
    part.bus.settle();
    part.set(PinId::ab8, 1);
    part.set(PinId::xcs_ab11, 0);
    part.set(PinId::xrd_r_w, 0);
    part.package.advance(part.package.now() + 50_ns);
    pins::Package<> copy = part.package;
    copy.chip().trace().attach({});
    copy.advance(copy.now() + 200_ns);
    part.package.advance(part.package.now() + 200_ns);
    for (unsigned n = 1; n <= pins::kPins; ++n) EXPECT_EQ(copy.pin(static_cast<PinId>(n)), part.pin(static_cast<PinId>(n))) << n;
    EXPECT_EQ(copy.pin(PinId::db0), PinLevel::high);
}

}  // namespace
