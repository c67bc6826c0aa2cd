// SPDX-License-Identifier: Apache-2.0
// The package as a SystemC module: its pins, bus cycles by strobes, the line bit by bit, and the start-up to data exchange
// through nothing but pins.
#include <gtest/gtest.h>

#include <algorithm>

#include "tlm/startup_station.hpp"

namespace dpchip::tlm::test {

namespace {

constexpr Ticks kBit = 40'000;  // 1.5 Mbit/s

TEST(TlmPackage, there_are_44_pins_with_the_names_of_the_drawing_and_none_has_to_be_bound) {
    simulate([] {
        Package package{"package"};
        std::vector<std::string> names;
        const std::function<void(const sc_core::sc_object&)> collect = [&](const sc_core::sc_object& o) {
            if (dynamic_cast<const sc_core::sc_port_base*>(&o) != nullptr) names.emplace_back(o.basename());
            for (const sc_core::sc_object* child : o.get_child_objects()) collect(*child);
        };
        collect(package);
        EXPECT_EQ(names.size(), 44u);
        for (const char* name : {"XCS_AB11", "XDATAEXCH_SYNC", "XREADY_XDTACK", "CLKOUT2_4", "XINT_MOT", "DB_7", "AB_10", "VDD_1", "TXD"})
            EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
        sc_core::sc_start(ms(1));
        EXPECT_EQ(package.violations(), 0);
    });
}

class TlmBusMode : public testing::TestWithParam<Bus> {};

TEST_P(TlmBusMode, a_bus_cycle_writes_and_reads_and_leaves_the_bus_alone) {
    simulate([] {
        PinBoard b{"board", {}, GetParam()};
        bool ended = false;
        b.program = [&] {
            b.power_up();
            b.write(0x100, 0x5A);
            b.write(0x101, 0xA5);
            EXPECT_EQ(b.package.peek(0x100), 0x5A);
            EXPECT_EQ(b.read(0x100), 0x5A);
            EXPECT_EQ(b.data(), "ZZZZZZZZ");
            EXPECT_EQ(b.read(0x101), 0xA5);
            const bool motorola = GetParam() != Bus::async_intel;
            EXPECT_EQ(b.read(motorola ? 0x04 : 0x05), 0xCF) << "Status Register: VPC3+C, no baud rate";
            ended = true;
        };
        Scope ready{"ready", b.xready};
        sc_core::sc_start(us(20));
        EXPECT_TRUE(ended);
        EXPECT_EQ(b.package.violations(), 0);
        const std::size_t edges = GetParam() == Bus::sync_motorola ? 1 : 11;
        EXPECT_EQ(ready.edges.size(), edges) << "high at first, then XREADY or XDTACK falls and rises in each of five cycles";
    });
}

INSTANTIATE_TEST_SUITE_P(Buses, TlmBusMode, testing::Values(Bus::async_intel, Bus::async_motorola, Bus::sync_motorola));

TEST(TlmPackage, data_are_valid_after_the_access_time_and_held_after_the_strobe) {
    simulate([] {
        PinBoard b{"board"};
        b.program = [&] {
            b.power_up();
            b.write(0x100, 0x5A);
            for (unsigned i = 0; i < 11; ++i) b.ab[i].write(i == 8 ? sc_dt::SC_LOGIC_1 : sc_dt::SC_LOGIC_0);
            b.xcs.write(sc_dt::SC_LOGIC_0);
            b.xrd.write(sc_dt::SC_LOGIC_0);
            sc_core::wait(ns(103));
            EXPECT_EQ(b.data(), "01011010") << "parameter 17";
            sc_core::wait(ns(20));
            b.xrd.write(sc_dt::SC_LOGIC_1);
            sc_core::wait(ns(3));
            EXPECT_EQ(b.data(), "01011010") << "parameter 24, minimum";
            sc_core::wait(ns(14));
            EXPECT_EQ(b.data(), "ZZZZZZZZ") << "parameter 24, maximum";
        };
        sc_core::sc_start(us(5));
    });
}

TEST(TlmPackage, a_strobe_that_is_too_short_is_a_finding_that_names_the_parameter) {
    simulate([] {
        const Reports findings{report::kFinding};
        PinBoard b{"board"};
        b.program = [&] {
            b.power_up();
            b.xcs.write(sc_dt::SC_LOGIC_0);
            b.xwr.write(sc_dt::SC_LOGIC_0);
            b.drive_data(sc_dt::SC_LOGIC_1, 1);
            sc_core::wait(ns(82));
            b.xwr.write(sc_dt::SC_LOGIC_1);
        };
        sc_core::sc_start(us(5));
        EXPECT_EQ(b.package.violations(29), 1);
        EXPECT_EQ(b.package.violations(), 1);
        EXPECT_NE(findings.text().find("29"), std::string::npos) << findings.text();
    });
}

TEST(TlmPackage, an_address_that_changes_together_with_E_CLOCK_has_no_set_up_time) {
    simulate([] {
        const Reports findings{report::kFinding};
        PinBoard b{"board", {}, Bus::sync_motorola};
        b.program = [&] {
            b.power_up();
            EXPECT_EQ(b.read(0x100), 0x00);
            b.ab[3].write(sc_dt::SC_LOGIC_1);
            b.xcs.write(sc_dt::SC_LOGIC_0);
            b.xwr.write(sc_dt::SC_LOGIC_1);
            sc_core::wait(ns(140));
            b.xwr.write(sc_dt::SC_LOGIC_0);
        };
        sc_core::sc_start(us(5));
        EXPECT_EQ(b.package.violations(33), 1) << findings.text();
        EXPECT_EQ(b.package.violations(), 1) << findings.text();
    });
}

TEST(TlmPackage, who_drives_the_bus_during_a_read_collides_with_the_part) {
    simulate([] {
        const Reports findings{report::kFinding};
        PinBoard b{"board"};
        b.program = [&] {
            b.power_up();
            b.write(0x00, 0x00);
            b.drive_data(sc_dt::SC_LOGIC_1, 0xFF);
            b.xcs.write(sc_dt::SC_LOGIC_0);
            b.xrd.write(sc_dt::SC_LOGIC_0);
            sc_core::wait(ns(110));
            EXPECT_NE(b.data().find('X'), std::string::npos) << b.data();
        };
        sc_core::sc_start(us(5));
        EXPECT_NE(findings.text().find("contention"), std::string::npos) << findings.text();
    });
}

TEST(TlmPackage, XTEST0_lets_go_of_every_output) {
    simulate([] {
        Package package{"package"};
        PinBoard::Wire xtest0{"xtest0", sc_dt::SC_LOGIC_1}, x_int{"x_int"}, rts{"rts"}, xready{"xready"};
        package.xtest0(xtest0);
        package.x_int(x_int);
        package.rts(rts);
        package.xready_xdtack(xready);
        sc_core::sc_start(us(1));
        EXPECT_EQ(x_int.read(), sc_dt::SC_LOGIC_1);
        EXPECT_EQ(rts.read(), sc_dt::SC_LOGIC_0);
        EXPECT_EQ(xready.read(), sc_dt::SC_LOGIC_1);
        xtest0.write(sc_dt::SC_LOGIC_0);
        sc_core::sc_start(us(1));
        for (const PinBoard::Wire* wire : {&x_int, &rts, &xready}) EXPECT_EQ(wire->read(), sc_dt::SC_LOGIC_Z) << wire->name();
    });
}

TEST(TlmPackage, CLKOUT_divides_the_clock_and_no_edge_drifts) {
    simulate([] {
        PackageSettings s;
        s.clock_phase = 7;
        Package package{"package", s};
        PinBoard::Wire clkout{"clkout"};
        package.clkout(clkout);
        Scope scope{"scope", clkout};
        sc_core::sc_start(us(100));
        ASSERT_GT(scope.edges.size(), 2000u);
        ASSERT_EQ((scope.edges[1].at - 7) % 1250, 0) << "at a rising edge of CLK";
        for (std::size_t i = 2; i < scope.edges.size(); ++i) ASSERT_EQ(scope.edges[i].at, scope.edges[i - 1].at + 2500) << "12 MHz: an edge every two CLK";
    });
}

TEST(TlmPackage, a_driven_clock_sets_the_phase) {
    simulate([] {
        Package package{"package"};
        PinBoard::Wire clk{"clk", sc_dt::SC_LOGIC_0}, clkout{"clkout"};
        package.clk(clk);
        package.clkout(clkout);
        Scope scope{"scope", clkout};
        Actor oscillator{"oscillator", [&] {
            for (Ticks t = 100'000 + 333;; t += 625) {
                until(to_sc_time(t));
                clk.write(clk.read() == sc_dt::SC_LOGIC_1 ? sc_dt::SC_LOGIC_0 : sc_dt::SC_LOGIC_1);
            }
        }};
        sc_core::sc_start(us(10));
        ASSERT_GT(scope.edges.size(), 100u);
        EXPECT_EQ((scope.edges.back().at - 333) % 1250, 0);
        EXPECT_EQ(package.violations(), 0) << "half a period high, half a period low";
    });
}

TEST(TlmPackage, a_supply_pin_at_the_wrong_level_is_reported) {
    simulate([] {
        const Reports reports{report::kPackage};
        Package package{"package"};
        PinBoard::Wire vdd{"vdd", sc_dt::SC_LOGIC_0};
        package.vdd[1](vdd);
        sc_core::sc_start(us(1));
        EXPECT_NE(reports.text().find("VDD_1"), std::string::npos) << reports.text();
    });
}

TEST(TlmPackage, parts_that_do_not_exist_are_errors_of_elaboration) {
    simulate([] {
        const auto refused = [](const PackageSettings& s) {
            try {
                const Package package{sc_core::sc_gen_unique_name("package"), s};
            } catch (const sc_core::sc_report& report) {
                return std::string{report.get_msg()};
            }
            return std::string{};
        };
        PackageSettings s;
        s.variant = "vpc4";
        EXPECT_NE(refused(s).find("vpc4"), std::string::npos);
        s.variant = "apc3";
        s.millivolts = 5000;
        EXPECT_NE(refused(s).find("5000"), std::string::npos);
        s.millivolts = 3300;
        s.options = {{"fatal", "perhaps"}};
        EXPECT_NE(refused(s).find("fatal"), std::string::npos);
        s.options.clear();
        s.clock_phase = 1250;
        EXPECT_NE(refused(s), "");
    });
}

TEST(TlmPackage, a_fatal_violation_stops_the_part_and_is_one_error) {
    simulate([] {
        sc_core::sc_report_handler::set_actions(report::kFinding, sc_core::SC_DO_NOTHING);
        const Reports reports{report::kPackage};
        PackageSettings s;
        s.options = {{"fatal", "true"}};
        PinBoard b{"board", s};
        b.program = [&] {
            b.power_up();
            b.xcs.write(sc_dt::SC_LOGIC_0);
            b.xrd.write(sc_dt::SC_LOGIC_0);
            sc_core::wait(ns(50));
            b.xrd.write(sc_dt::SC_LOGIC_1);
        };
        sc_core::sc_start(us(5));
        EXPECT_EQ(std::count(reports.text().begin(), reports.text().end(), '\n'), 1) << reports.text();
    });
}

/// The start-up scenario through strobes and bits.
struct PinPlatform : PinStation {
    PinPlatform() : PinStation{"board"} {}

    startup::Result run() {
        sc_core::sc_start(to_sc_time(startup::kEnd) + sc_time::from_value(1));
        startup::Result result;
        for (const Burst& b : bursts(rxd, kBit)) result.telegrams.push_back({b.start, true, b.octets});
        for (const Burst& b : bursts(txd, kBit)) result.telegrams.push_back({b.start, false, b.octets});
        std::sort(result.telegrams.begin(), result.telegrams.end(), [](const auto& a, const auto& b) { return a.start < b.start; });
        for (std::size_t i = 0; i < startup::kMemory; ++i) result.memory[i] = board.package.peek(static_cast<std::uint16_t>(i));
        return result;
    }

    Actor master{"master", [this] {
        for (const startup::Request& r : startup::requests()) send_bits(board.rxd, r.at, kBit, r.octets);
    }};
    Scope rxd{"rxd_scope", board.rxd}, txd{"txd_scope", board.txd};
};

TEST(TlmPackage, the_start_up_through_nothing_but_pins_ends_as_at_telegram_level) {
    simulate([] {
        PinPlatform p;
        const startup::Result is = p.run(), should_be = startup::telegram_level(startup::Service::interrupt);
        ASSERT_EQ(difference(is.without_times(), should_be.without_times()), "");
        for (std::size_t i = 0; i < is.telegrams.size(); ++i) {
            const Ticks late = is.telegrams[i].start - should_be.telegrams[i].start;
            EXPECT_GE(late, 0) << "telegram " << i;
            EXPECT_LE(late, is.telegrams[i].own ? 0 : kBit / 4) << "telegram " << i << ": the receiver samples four times a bit";
        }
        EXPECT_EQ(p.board.package.violations(), 0);
        EXPECT_TRUE(p.firmware.exchanging());
        EXPECT_EQ(p.board.xdataexch.read(), sc_dt::SC_LOGIC_0);
    });
}

}  // namespace

}  // namespace dpchip::tlm::test
