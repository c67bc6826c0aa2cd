// SPDX-License-Identifier: Apache-2.0
// Packages on a telegram-level line: what the transceiver makes of bits and of telegrams, held against a UART of the tests'
// own, and a line that a package, a chip and a master share.
#include <gtest/gtest.h>

#include <algorithm>

#include <dpchip/tlm/transceiver.hpp>

#include "tlm/startup_station.hpp"

namespace dpchip::tlm::test {

namespace {

constexpr Ticks kBit = 40'000;  // 1.5 Mbit/s
const Octets kFdlStatus{0x10, 0x08, 0x02, 0x49, 0x53, 0x16}, kFdlAnswer{0x10, 0x02, 0x08, 0x00, 0x0A, 0x16};

/// A transceiver whose package the test plays.
struct Wires {
    Wires(const std::string& name, Line& line, std::uint32_t baud)
        : txd{(name + "_txd").c_str(), sc_dt::SC_LOGIC_1}, rts{(name + "_rts").c_str(), sc_dt::SC_LOGIC_0}, rxd{(name + "_rxd").c_str(), sc_dt::SC_LOGIC_1},
          transceiver{name.c_str(), baud}, scope{(name + "_scope").c_str(), rxd} {
        transceiver.txd(txd);
        transceiver.rts(rts);
        transceiver.rxd(rxd);
        transceiver.line(line);
    }
    /// RTS is high a bit before and after; for an SC_THREAD.
    void send(Ticks at, Ticks bit, const Octets& octets) {
        until(to_sc_time(at - bit));
        rts.write(sc_dt::SC_LOGIC_1);
        send_bits(txd, at, bit, octets);
        sc_core::wait(to_sc_time(bit));
        rts.write(sc_dt::SC_LOGIC_0);
    }

    PinBoard::Wire txd, rts, rxd;
    Transceiver transceiver;
    Scope scope;
};

struct Rate {
    std::uint32_t baud;
    Ticks bit;
};
class TlmTransceiverRate : public testing::TestWithParam<Rate> {};

TEST_P(TlmTransceiverRate, telegrams_become_bits_and_bits_telegrams_without_losing_a_tick) {
    simulate([] {
        const std::uint32_t baud = GetParam().baud;
        const Ticks bit = GetParam().bit;
        const Octets long_one = startup::sd2(0x7D, Octets(246, 0xA5), false);
        const Ticks from_master = 7 + 1'000 * bit, from_wire = from_master + 4'000 * bit;
        Line line{"line", baud};
        Monitor monitor{"monitor", line};
        Wires a{"a", line, baud}, b{"b", line, baud};
        Actor master{"master", [&] {
            until(to_sc_time(from_master));
            EXPECT_TRUE(line.send_now(long_one));
        }};
        Actor part{"part", [&] { a.send(from_wire, bit, kFdlAnswer); }};
        sc_core::sc_start(to_sc_time(from_wire + 100 * bit));

        ASSERT_EQ(monitor.seen.size(), 2u);
        const Telegram& t = monitor.seen[1];
        EXPECT_EQ(t.octets, kFdlAnswer);
        EXPECT_FALSE(t.own);
        EXPECT_FALSE(t.damaged);
        EXPECT_EQ(to_ticks(t.start), from_wire);
        EXPECT_EQ(to_ticks(t.end), from_wire + 66 * bit);
        const auto at_a = bursts(a.scope, bit), at_b = bursts(b.scope, bit);
        ASSERT_EQ(at_a.size(), 1u) << "nobody hears itself";
        ASSERT_EQ(at_b.size(), 2u) << "the other transceiver";
        for (const Burst& burst : {at_a[0], at_b[0]}) {
            EXPECT_EQ(burst.start, from_master);
            EXPECT_EQ(burst.octets, long_one);
        }
        EXPECT_EQ(at_b[1].start, from_wire);
        EXPECT_EQ(at_b[1].octets, kFdlAnswer);
        for (const Scope::Edge& e : b.scope.edges) EXPECT_EQ((e.at - from_master) % bit, 0) << "edges are at bit boundaries";
    });
}

INSTANTIATE_TEST_SUITE_P(Rates, TlmTransceiverRate,
                         testing::Values(Rate{9'600, 6'250'000}, Rate{19'200, 3'125'000}, Rate{45'450, 1'320'000},
                                         Rate{93'750, 640'000}, Rate{187'500, 320'000}, Rate{500'000, 120'000}, Rate{1'500'000, 40'000},
                                         Rate{3'000'000, 20'000}, Rate{6'000'000, 10'000}, Rate{12'000'000, 5'000}),
                         [](const auto& rate) { return "at_" + std::to_string(rate.param.baud); });

TEST(TlmTransceiver, wrong_parity_damages_the_telegram_and_is_a_warning) {
    simulate([] {
        const Reports warnings{report::kTransceiver};
        Line line{"line"};
        Monitor monitor{"monitor", line};
        Wires a{"a", line, 1'500'000};
        Actor part{"part", [&] {
            until(to_sc_time(100 * kBit));
            a.rts.write(sc_dt::SC_LOGIC_1);
            for (const unsigned frame : {0x5CAu, 0x7CAu}) {  // E5: five ones, parity 1
                const Ticks at = frame == 0x7CAu ? 120 * kBit : 100 * kBit;
                for (Ticks i = 0; i < 11; ++i) {
                    until(to_sc_time(at + i * kBit));
                    a.txd.write((frame >> i & 1) != 0 ? sc_dt::SC_LOGIC_1 : sc_dt::SC_LOGIC_0);
                }
            }
        }};
        sc_core::sc_start(us(200));
        ASSERT_EQ(monitor.seen.size(), 2u);
        EXPECT_TRUE(monitor.seen[0].damaged);
        EXPECT_FALSE(monitor.seen[1].damaged);
        EXPECT_EQ(monitor.seen[1].octets, Octets{0xE5});
        EXPECT_EQ(std::count(warnings.text().begin(), warnings.text().end(), '\n'), 1) << warnings.text();
        EXPECT_NE(warnings.text().find("parity"), std::string::npos) << warnings.text();
    });
}

TEST(TlmTransceiver, octets_that_are_no_telegram_end_half_a_bit_after_the_last_one) {
    simulate([] {
        Line line{"line"};
        Monitor monitor{"monitor", line};
        Wires a{"a", line, 1'500'000};
        sc_time heard;
        Actor part{"part", [&] { a.send(100 * kBit, kBit, {0x10, 0x08}); }};
        Actor master{"master", [&] {
            sc_core::wait(line.received_event());
            heard = sc_core::sc_time_stamp();
        }};
        sc_core::sc_start(us(200));
        ASSERT_EQ(monitor.seen.size(), 1u);
        EXPECT_TRUE(monitor.seen[0].damaged);
        EXPECT_EQ(monitor.seen[0].octets, (Octets{0x10, 0x08}));
        EXPECT_EQ(to_ticks(monitor.seen[0].end), 122 * kBit);
        EXPECT_EQ(to_ticks(heard), 122 * kBit + kBit / 2);
    });
}

TEST(TlmTransceiver, a_master_that_obeys_the_rules_waits_until_the_package_has_sent) {
    simulate([] {
        Line line{"line"};
        Monitor monitor{"monitor", line};
        Wires a{"a", line, 1'500'000};
        Actor part{"part", [&] { a.send(100 * kBit, kBit, kFdlAnswer); }};
        Actor master{"master", [&] {
            until(to_sc_time(110 * kBit));
            EXPECT_TRUE(line.send(kFdlStatus));
        }};
        sc_core::sc_start(us(300));
        ASSERT_EQ(monitor.seen.size(), 2u);
        EXPECT_FALSE(monitor.seen[0].damaged);
        EXPECT_FALSE(monitor.seen[1].damaged);
        EXPECT_GT(monitor.seen[1].start, monitor.seen[0].end);
    });
}

TEST(TlmTransceiver, who_speaks_into_it_collides_whoever_begins) {
    simulate([] {
        Line line{"line"};
        Monitor monitor{"monitor", line};
        Wires a{"a", line, 1'500'000};
        Actor part{"part", [&] {
            a.send(1'000 * kBit, kBit, kFdlAnswer);
            a.send(2'000 * kBit, kBit, kFdlAnswer);
            a.send(3'000 * kBit, kBit, kFdlAnswer);
        }};
        Actor master{"master", [&] {
            until(to_sc_time(1'030 * kBit));
            EXPECT_TRUE(line.send_now(kFdlStatus));
            until(to_sc_time(1'980 * kBit));
            EXPECT_TRUE(line.send_now(kFdlStatus));
        }};
        sc_core::sc_start(us(2100));
        ASSERT_EQ(monitor.seen.size(), 5u);
        for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(monitor.seen[i].damaged) << i;
        EXPECT_FALSE(monitor.seen[4].damaged);
        EXPECT_EQ(monitor.seen[4].octets, kFdlAnswer);
    });
}

TEST(TlmTransceiver, a_planned_answer_of_a_chip_is_given_up_when_the_package_begins) {
    simulate([] {
        Line line{"line"};
        Monitor monitor{"monitor", line};
        ChipSettings s;
        s.access_time = sc_core::SC_ZERO_TIME;
        s.options = {{"baud_probe_ms", "1"}};
        Board b{"board", s, &line};
        b.program = [&] { b.set_up(); };
        Wires a{"a", line, 1'500'000};
        constexpr Ticks kStart = 5 * 60'000'000;
        Actor master{"master", [&] {
            Telegram answer;
            until(us(3500));
            EXPECT_FALSE(line.exchange(kFdlStatus, answer, us(200)));
            until(to_sc_time(kStart));
            EXPECT_TRUE(line.send_now(kFdlStatus));
        }};
        Actor part{"part", [&] { a.send(kStart + 72 * kBit, kBit, {0xE5}); }};  // before minTSDR is over
        sc_core::sc_start(ms(6));
        ASSERT_EQ(monitor.seen.size(), 3u);
        EXPECT_EQ(monitor.seen[2].octets, Octets{0xE5});
        EXPECT_FALSE(monitor.seen[2].damaged);
    });
}

TEST(TlmTransceiver, a_rate_that_does_not_exist_is_an_error_of_elaboration) {
    simulate([] {
        Line line{"line"};
        Wires a{"a", line, 1234};
        std::string error;
        try {
            sc_core::sc_start(us(1));
        } catch (const sc_core::sc_report& report) {
            error = report.get_msg();
        }
        EXPECT_NE(error.find("1234"), std::string::npos) << error;
    });
}

// ---- the package on a line ---------------------------------------------------------------------------------------

/// The station of the start-up scenario as a package behind a transceiver.
struct PackageOnLine : PinStation {
    PackageOnLine(Line& line, std::uint32_t baud) : PinStation{"package_board"}, transceiver{"transceiver", baud} {
        transceiver.txd(board.txd);
        transceiver.rts(board.rts);
        transceiver.rxd(board.rxd);
        transceiver.line(line);
    }
    Transceiver transceiver;
};

/// The same as a chip behind a socket.
struct ChipOnLine : SocketStation {
    explicit ChipOnLine(Line& line) : SocketStation{"chip_board", startup_settings<ChipSettings>(), line, startup::Service::interrupt} {}
};

/// For station 9 what the master says to station 8, FCS corrected.
Octets to_9(Octets telegram) {
    const std::size_t da = telegram[0] == 0x68 ? 4 : 1;
    ++telegram[da];
    ++telegram[telegram.size() - 2];
    return telegram;
}

/// A line with station 8, one way or the other, station 9, which is a chip, and a master that takes both to data exchange.
template <class Station8>
struct Plant {
    template <class... More>
    explicit Plant(const std::string& name, const More&... more)
        : line{(name + "_line").c_str(), startup::kBaud}, monitor{(name + "_monitor").c_str(), line}, station_8{line, more...},
          board_9{(name + "_9").c_str(), startup_settings<ChipSettings>(), &line}, master{(name + "_master").c_str(), [this] { speak(); }} {
        board_9.program = [this] {
            board_9.set_up(0xFF, 0xFF, 9);
            until(us(38'900));
            board_9.delay = sc_core::SC_ZERO_TIME;
            EXPECT_EQ(board_9.read(0x10), 0x00) << "the configuration is accepted";
        };
    }
    static std::vector<startup::Request> requests() {
        auto all = startup::requests();
        const Ticks ms = startup::kMillisecond;
        const std::pair<Ticks, std::size_t> more[] = {{36 * ms, 1}, {37 * ms, 3}, {38 * ms, 4}, {40 * ms, 5}, {41 * ms, 6}, {43 * ms, 7}};
        for (const auto& [at, like] : more) all.push_back({at + ms / 2, to_9(all[like].octets)});
        std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
        return all;
    }
    void speak() {
        for (const startup::Request& r : requests()) {
            until(to_sc_time(r.at));
            EXPECT_TRUE(line.send_now(r.octets));
        }
    }

    Line line;
    Monitor monitor;
    Station8 station_8;
    Board board_9;
    Actor master;
};

TEST(TlmTransceiver, package_chip_and_master_on_one_line_exchange_what_two_chips_and_a_master_do) {
    simulate([] {
        Plant<ChipOnLine> chips{"chips"};
        Plant<PackageOnLine> mixed{"mixed", startup::kBaud};
        sc_core::sc_start(to_sc_time(startup::kEnd));
        const auto &is = mixed.monitor.seen, &should_be = chips.monitor.seen;
        ASSERT_EQ(should_be.size(), 2 * Plant<ChipOnLine>::requests().size() - 1) << "all but the first are answered";
        ASSERT_EQ(is.size(), should_be.size());
        for (std::size_t i = 0; i < is.size(); ++i) {
            EXPECT_EQ(is[i].octets, should_be[i].octets) << "telegram " << i;
            EXPECT_EQ(is[i].own, should_be[i].own) << "telegram " << i;
            EXPECT_FALSE(is[i].damaged) << "telegram " << i;
            const Ticks late = to_ticks(is[i].start) - to_ticks(should_be[i].start);
            const bool of_package = !is[i].own && (is[i - 1].octets[is[i - 1].octets[0] == 0x68 ? 4 : 1] & 0x7F) == startup::kStation;
            EXPECT_GE(late, 0) << "telegram " << i;
            EXPECT_LE(late, of_package ? kBit / 4 : 0) << "telegram " << i << ": the package samples four times a bit";
        }
        EXPECT_TRUE(mixed.station_8.firmware.exchanging());
        EXPECT_TRUE(chips.station_8.firmware.exchanging());
        EXPECT_FALSE(mixed.board_9.xdataexch.read());
        EXPECT_EQ(mixed.station_8.board.xdataexch.read(), sc_dt::SC_LOGIC_0);
        EXPECT_EQ(mixed.station_8.board.package.violations(), 0);
        EXPECT_EQ(mixed.board_9.memory(), chips.board_9.memory());
        for (std::size_t i = 0; i < startup::kMemory; ++i) {
            const auto address = static_cast<std::uint16_t>(i);
            EXPECT_EQ(mixed.station_8.board.package.peek(address), chips.station_8.board.chip.peek(address)) << "address " << i;
        }
    });
}

TEST(TlmTransceiver, XCTS_holds_the_package_back_and_between_characters_tears_its_answer) {
    simulate([] {
        Line line{"line", startup::kBaud};
        Monitor monitor{"monitor", line};
        PackageOnLine station{line, startup::kBaud};
        Actor master{"master", [&] {
            Telegram answer;
            until(us(35'500));
            EXPECT_FALSE(line.exchange(kFdlStatus, answer, us(200))) << "proves the rate";
            station.board.xcts.write(sc_dt::SC_LOGIC_1);
            EXPECT_FALSE(line.exchange(kFdlStatus, answer, us(200)));
            station.board.xcts.write(sc_dt::SC_LOGIC_0);
            sc_core::wait(us(200));
            EXPECT_TRUE(line.receive(answer));
            EXPECT_EQ(answer.octets, kFdlAnswer);
            EXPECT_TRUE(line.send(kFdlStatus));
            sc_core::wait(station.board.rts.posedge_event());
            station.board.xcts.write(sc_dt::SC_LOGIC_1);
            sc_core::wait(us(20));
            station.board.xcts.write(sc_dt::SC_LOGIC_0);
        }};
        sc_core::sc_start(ms(38));
        ASSERT_GE(monitor.seen.size(), 6u);
        Octets torn;
        for (std::size_t i = monitor.seen.size() - 2; i < monitor.seen.size(); ++i) {
            EXPECT_TRUE(monitor.seen[i].damaged) << i;
            EXPECT_FALSE(monitor.seen[i].own) << i;
            torn.insert(torn.end(), monitor.seen[i].octets.begin(), monitor.seen[i].octets.end());
        }
        EXPECT_EQ(torn, kFdlAnswer);
    });
}

TEST(TlmTransceiver, a_package_answers_only_at_the_rate_that_it_has_found) {
    simulate([] {
        Line line{"line", 500'000};
        Monitor monitor{"monitor", line};
        PackageOnLine station{line, 500'000};
        Actor master{"master", [&] {
            Telegram answer;
            until(us(35'500));  // it listens at 1.5 Mbit/s
            for (int i = 0; i < 3; ++i) EXPECT_FALSE(line.exchange(kFdlStatus, answer, us(600)));
            until(us(45'500));  // at 500 kbit/s
            EXPECT_FALSE(line.exchange(kFdlStatus, answer, us(600))) << "proves the rate";
            EXPECT_TRUE(line.exchange(kFdlStatus, answer, us(600)));
            EXPECT_EQ(answer.octets, kFdlAnswer);
            EXPECT_FALSE(answer.damaged);
        }};
        sc_core::sc_start(ms(50));
        EXPECT_EQ(monitor.seen.size(), 6u);
    });
}

TEST(TlmTransceiver, a_transceiver_at_another_rate_makes_no_telegram_of_the_answer) {
    simulate([] {
        const Reports warnings{report::kTransceiver};
        Line line{"line", startup::kBaud};
        Monitor monitor{"monitor", line};
        PackageOnLine station{line, 500'000};
        Actor master{"master", [&] {
            Telegram answer;
            until(us(35'500));
            EXPECT_FALSE(line.exchange(kFdlStatus, answer, us(200)));
            until(us(36'500));
            EXPECT_TRUE(line.exchange(kFdlStatus, answer, us(200)));
            EXPECT_TRUE(answer.damaged);
            EXPECT_NE(answer.octets, kFdlAnswer);
        }};
        sc_core::sc_start(ms(38));
        EXPECT_NE(warnings.text().find("500000"), std::string::npos) << warnings.text();
    });
}

}  // namespace

}  // namespace dpchip::tlm::test
