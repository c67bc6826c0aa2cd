// SPDX-License-Identifier: Apache-2.0
// The UART and its chip: TXD, RTS, XCTS, what noise and others on the line do to an answer (8.3; reference 1.5, 9.1).
#include <chip/bench.hpp>

#include <gtest/gtest.h>

namespace dpchip::pins {
namespace {

using namespace bench;
using namespace core::literals;

Recipe at(fdl::BaudCode baud) {
    Recipe r;
    r.path = Path::bits;
    r.baud = baud;
    return r;
}

/// What happens at TXD and RTS from a request's end on.
struct Sending {
    std::vector<PinEdge> txd;
    std::vector<chip::Edge> rts;
    Ticks answer_end{};  ///< when the chip says that sending is over; 0: never
};

/// XCTS takes a level at a moment.
struct Xcts {
    Ticks at{};
    PinLevel level{};
};

Sending watch(Bench& b, Ticks until, const std::vector<Xcts>& script = {}) {
    Sending out;
    std::vector<core::TraceRecord> ring(4096);
    b.chip().trace().attach(ring);
    b.chip().watch(1u << static_cast<unsigned>(chip::Pin::rts));
    while (!b.chip().edges().empty()) static_cast<void>(b.chip().edges().pop());
    const auto collect = [&] {
        while (!b.uart().edges().empty()) out.txd.push_back(b.uart().edges().pop());
        while (!b.chip().edges().empty()) out.rts.push_back(b.chip().edges().pop());
    };
    const auto go = [&](Ticks to) {
        while (b.uart().next(b.chip()) <= to) {
            b.uart().advance(b.chip(), b.uart().next(b.chip()));
            collect();
        }
        b.uart().advance(b.chip(), to);
        collect();
    };
    for (const Xcts& x : script) {
        go(x.at - Ticks{1});
        b.uart().set_xcts(b.chip(), x.at, x.level);
        collect();
    }
    go(until);
    for (std::uint64_t i = 0; i < b.chip().trace().count; ++i)
        if (ring[i].what == static_cast<std::uint16_t>(regmap::Fact::answer_end)) out.answer_end = ring[i].at;
    b.chip().trace().attach({});
    return out;
}

/// The edges of characters at given moments, from the first start bit to the last rise.
std::vector<PinEdge> edges_of(const Octets& octets, const std::vector<Ticks>& starts, Ticks bit) {
    std::vector<PinEdge> out;
    PinLevel level = PinLevel::high;
    for (std::size_t i = 0; i < octets.size(); ++i)
        for (unsigned n = 0; n < 11; ++n) {
            const unsigned ones = static_cast<unsigned>(__builtin_popcount(octets[i]));
            const bool one = n == 0 ? false : n == 9 ? ones % 2 == 1 : n == 10 || ((octets[i] >> (n - 1)) & 1) != 0;
            if (to_level(one) == level) continue;
            level = to_level(one);
            out.push_back({starts[i] + bit * n, PinId::txd, level});
        }
    return out;
}

std::vector<Ticks> back_to_back(Ticks start, std::size_t count, Ticks bit) {
    std::vector<Ticks> out;
    for (std::size_t i = 0; i < count; ++i) out.push_back(start + bit * (11 * static_cast<std::int64_t>(i)));
    return out;
}

const Octets kOk = hex(kFdlStatusOk);

// proves: VPC3C 8.3-01, VPC3C 8.3-03, VPC3C 8.3-10, VPC3C 3.1-06, VPC3C 9.1-01, VPC3C 9.1-04..05
TEST(UartTransmitter, an_answer_is_on_TXD_edge_by_edge_at_every_rate_and_RTS_encloses_it) {
    for (const fdl::Baud& baud : fdl::kBaud) {
        SCOPED_TRACE(baud.name);
        Bench b{at(baud.code), Stage::p0};
        EXPECT_EQ(b.uart().txd(), PinLevel::z) << "nothing is sent: the pull-up holds the line";
        b.tell(kFdlStatus);
        b.run(1_clk);
        const Ticks first = b.chip().state().answer_at, last = first + b.bits(66);
        const Sending s = watch(b, last + b.bits(4) + 8_clk);
        ASSERT_EQ(s.rts.size(), 2u);
        EXPECT_EQ(s.rts[0].at, first - 4_clk);
        EXPECT_EQ(s.rts[1].at, last + 4_clk);
        EXPECT_EQ(s.answer_end, last);
        std::vector<PinEdge> expected{{first - 4_clk, PinId::txd, PinLevel::high}};
        for (const PinEdge& e : edges_of(kOk, back_to_back(first, kOk.size(), b.bit()), b.bit())) expected.push_back(e);
        expected.push_back({last + 4_clk, PinId::txd, PinLevel::z});
        EXPECT_EQ(s.txd, expected);
    }
}

// proves: VPC3C 8.3-01, VPC3C 3.1-07, VPC3C 8.3-09
TEST(UartTransmitter, XCTS_is_looked_at_after_each_character_and_holds_the_next_one) {
    for (const fdl::BaudCode code : {fdl::BaudCode::mbit_12, fdl::BaudCode::mbit_1_5, fdl::BaudCode::kbit_9_6}) {
        for (std::int64_t held = 1; held < 6; ++held) {
            Bench b{at(code), Stage::p0};
            SCOPED_TRACE(std::string{fdl::baud(code).name} + ", character held: " + std::to_string(held));
            b.tell(kFdlStatus);
            b.run(1_clk);
            const Ticks first = b.chip().state().answer_at, boundary = first + b.bits(11 * held);
            const Ticks free = boundary + b.bits(5) + Ticks{77};
            const Sending s = watch(b, free + b.bits(80), {{boundary - b.bits(3), PinLevel::high}, {free, PinLevel::low}});
            const Ticks again = b.uart().next_sample_from(free);
            std::vector<Ticks> starts = back_to_back(first, kOk.size(), b.bit());
            for (std::size_t i = static_cast<std::size_t>(held); i < starts.size(); ++i) starts[i] += again - boundary;
            const std::vector<PinEdge> expected = edges_of(kOk, starts, b.bit());
            ASSERT_EQ(s.txd.size(), expected.size() + 2);
            EXPECT_TRUE(std::equal(expected.begin(), expected.end(), s.txd.begin() + 1));
            EXPECT_GE(again, free);
            EXPECT_LT(again - free, b.uart().quarter());
            EXPECT_EQ(s.answer_end, starts.back() + b.bits(11)) << "sending ends when the last bit has left";
            ASSERT_EQ(s.rts.size(), 2u);
            EXPECT_EQ(s.rts[1].at, s.answer_end + 4_clk) << "RTS stays while a character is held";
            EXPECT_EQ(b.ask(kFdlStatus), kFdlStatusOk);
        }
    }
}

TEST(UartTransmitter, XCTS_in_the_middle_of_a_character_changes_nothing_when_it_is_low_again_at_its_end) {
    Bench b{at(fdl::BaudCode::mbit_3), Stage::p0};
    b.tell(kFdlStatus);
    b.run(1_clk);
    const Ticks first = b.chip().state().answer_at;
    const Sending s = watch(b, first + b.bits(80), {{first + b.bits(12), PinLevel::high}, {first + b.bits(21), PinLevel::low}});
    EXPECT_EQ(s.answer_end, first + b.bits(66));
}

TEST(UartTransmitter, the_last_character_is_followed_by_none_and_XCTS_holds_nothing) {
    Bench b{at(fdl::BaudCode::mbit_3), Stage::p0};
    b.tell(kFdlStatus);
    b.run(1_clk);
    const Ticks first = b.chip().state().answer_at;
    const Sending s = watch(b, first + b.bits(80), {{first + b.bits(60), PinLevel::high}});
    EXPECT_EQ(s.answer_end, first + b.bits(66));
    EXPECT_EQ(b.uart().txd(), PinLevel::z);
}

TEST(UartTransmitter, XCTS_high_from_the_start_holds_the_first_character_while_RTS_is_high) {
    Bench b{at(fdl::BaudCode::kbit_500), Stage::p0};
    b.uart().set_xcts(b.chip(), b.now(), PinLevel::high);
    b.tell(kFdlStatus);
    b.run(1_clk);
    const Ticks planned = b.chip().state().answer_at, free = planned + b.bits(100) + Ticks{5};
    const Sending s = watch(b, free + b.bits(80), {{free, PinLevel::low}});
    ASSERT_GE(s.txd.size(), 2u);
    EXPECT_EQ(s.txd[0], (PinEdge{planned - 4_clk, PinId::txd, PinLevel::high}));
    EXPECT_EQ(s.txd[1].at, b.uart().next_sample_from(free));
    EXPECT_EQ(s.answer_end, s.txd[1].at + b.bits(66)) << "TXD begins on the grid, and sending ends when its last bit has left";
}

/// Diag_Flag falls at the end of the answer that fetched the diagnosis: with held characters, later.
TEST(UartTransmitter, what_the_chip_does_at_the_end_of_an_answer_waits_for_held_characters) {
    Bench b{at(fdl::BaudCode::mbit_1_5), Stage::p2};
    b.give_diag(1, "02 07");
    ASSERT_TRUE(b.diag_flag());
    b.tell("68 05 05 68 88 82 5D 3C 3E E1 16");
    b.run(1_clk);
    const Ticks first = b.chip().state().answer_at, end = first + b.bits(11 * 17);
    const Sending s = watch(b, end + b.bits(40), {{first + b.bits(5), PinLevel::high}});
    EXPECT_EQ(s.answer_end, Ticks{}) << "held";
    EXPECT_TRUE(b.diag_flag());
    const Sending rest = watch(b, b.now() + b.bits(400), {{b.now() + b.bits(7), PinLevel::low}});
    EXPECT_NE(rest.answer_end, Ticks{});
    EXPECT_FALSE(b.diag_flag());
}

TEST(UartTransmitter, a_RESET_in_the_middle_of_a_character_lets_go_of_TXD) {
    Bench b{at(fdl::BaudCode::mbit_1_5), Stage::p0};
    b.tell(kFdlStatus);
    b.run(1_clk);
    const Ticks first = b.chip().state().answer_at;
    static_cast<void>(watch(b, first + b.bits(14)));
    EXPECT_NE(b.uart().txd(), PinLevel::z);
    b.chip().reset();
    b.uart().reset(b.chip());
    EXPECT_EQ(b.uart().txd(), PinLevel::z);
    const Sending after = watch(b, first + b.bits(100));
    EXPECT_TRUE(after.txd.size() <= 1);
}

// proves: VPC3C 8.3-05
TEST(UartNoise, a_spike_between_request_and_answer_is_noise_and_a_start_bit_is_somebody_else) {
    struct Row { std::int64_t quarters; bool answered; };
    for (const Row& row : {Row{1, true}, Row{2, true}, Row{3, false}, Row{8, false}}) {
        SCOPED_TRACE(row.quarters);
        Bench b{at(fdl::BaudCode::mbit_1_5), Stage::p0};
        b.tell(kFdlStatus);
        const Ticks spike = b.uart().next_sample_from(b.now() + b.bits(4));
        b.uart().set_rxd(b.chip(), spike, PinLevel::low);
        b.uart().set_rxd(b.chip(), spike + b.uart().quarter() * row.quarters, PinLevel::high);
        EXPECT_EQ(b.listen_text(), row.answered ? kFdlStatusOk : kSilence);
        b.run(b.bits(60));
        EXPECT_EQ(b.ask(kFdlStatus), kFdlStatusOk);
    }
}

TEST(UartNoise, noise_that_was_seen_delays_TSYN_after_a_damaged_telegram) {
    for (const bool noise : {false, true}) {
        Bench b{at(fdl::BaudCode::kbit_500), Stage::p0};
        b.tell({hex(kFdlStatus), {{2, fdl::fault_parity}}, {}});
        const Ticks end = b.now();
        if (noise) {
            b.uart().set_rxd(b.chip(), b.uart().next_sample_from(end + b.bits(20)), PinLevel::low);
            b.uart().set_rxd(b.chip(), b.uart().next_sample_from(end + b.bits(20) + Ticks{1}), PinLevel::high);
        }
        b.tell(kFdlStatus);  // 37 bit times after the damaged one
        EXPECT_EQ(b.listen_text(), noise ? kSilence : kFdlStatusOk);
        EXPECT_EQ(b.ask(kFdlStatus), kFdlStatusOk);
    }
}

/// One telegram whose third character is shifted by quarters of a bit, its stop bit longer or shorter.
std::string shifted(Bench& b, std::int64_t quarters) {
    const Octets octets = hex(kFdlStatus);
    b.run(b.bits(60));
    Ticks start = b.uart().next_sample_from(b.now());
    for (std::size_t i = 0; i < octets.size(); ++i) {
        if (i == 3) start += b.uart().quarter() * quarters;
        for (unsigned n = 0; n < 11; ++n) {
            const unsigned ones = static_cast<unsigned>(__builtin_popcount(octets[i]));
            const bool one = n == 0 ? false : n == 9 ? ones % 2 == 1 : n == 10 || ((octets[i] >> (n - 1)) & 1) != 0;
            b.uart().set_rxd(b.chip(), start + b.bits(n), to_level(one));
        }
        start += b.bits(11);
    }
    b.run_to(start);
    Octets answer;
    const Sending s = watch(b, start + b.bits(320));
    return s.answer_end != Ticks{} ? "answered" : "silent";
}

// proves: VPC3C 8.3-04, VPC3C 8.3-07, VPC3C 8.3-08, VPC3C 5.1.1-20..21
TEST(UartWindow, a_stop_bit_may_be_a_quarter_shorter_or_longer_and_much_more_under_Dis_Start_Control) {
    for (const fdl::Baud& baud : fdl::kBaud) {
        for (const bool dis_start : {false, true}) {
            for (const std::int64_t quarters : {-2, -1, 0, 1, 2, 3, 8, 100}) {
                SCOPED_TRACE(std::string{baud.name} + (dis_start ? ", no start control" : "") + ", so many quarters late: " + std::to_string(quarters));
                Recipe r = at(baud.code);
                if (dis_start) r.mode0 |= regmap::mode0::dis_start_control;
                Bench b{r, Stage::p0};
                const bool expected = quarters >= -1 && (quarters <= 1 || dis_start);
                EXPECT_EQ(shifted(b, quarters), expected ? "answered" : "silent");
            }
        }
    }
}

// proves: VPC3C 8.3-12
TEST(UartWindow, half_a_stop_bit_is_enough_when_neither_start_nor_stop_is_controlled) {
    Recipe r = at(fdl::BaudCode::mbit_1_5);
    r.mode0 |= regmap::mode0::dis_start_control | regmap::mode0::dis_stop_control;
    Bench b{r, Stage::p0};
    EXPECT_EQ(shifted(b, -2), "answered");
}

TEST(UartSearch, the_rate_is_found_bit_by_bit_lost_and_found_again) {
    Recipe r = at(fdl::BaudCode::kbit_187_5);
    r.baud_control = 1;
    Bench b{r, Stage::p0};
    EXPECT_EQ(b.wd_state(), kBaudControl);
    b.run(30_ms);
    EXPECT_EQ(b.wd_state(), kBaudSearch) << "10 ms times 1 without a telegram";
    b.find_baud();
    EXPECT_EQ(b.peek(control::status_reg_high) & 0x0F, static_cast<int>(fdl::BaudCode::kbit_187_5));
    EXPECT_EQ(b.ask(kFdlStatus), kFdlStatusOk);
}

TEST(UartSearch, bits_of_any_other_rate_prove_nothing) {
    for (const fdl::Baud& line : fdl::kBaud)
        for (const fdl::Baud& probe : fdl::kBaud) {
            if (line.code == probe.code) continue;
            Recipe r = at(line.code);
            r.options.baud_probe_ms.fill(1000);
            Bench b{r, Stage::searching};
            b.run_to(core::seconds(static_cast<std::int64_t>(probe.code)) + 10_ms);
            ASSERT_EQ(b.chip().state().probe, probe.code);
            b.tell(kFdlStatus);
            EXPECT_EQ(b.wd_state(), kBaudSearch) << line.name << " heard at " << probe.name;
        }
}

/// TXD wired back to RXD, as a transceiver does whose receiver is always on.
TEST(UartEcho, the_chip_does_not_hear_itself) {
    Bench b{at(fdl::BaudCode::mbit_12), Stage::p0};
    b.tell(kFdlStatus);
    std::vector<core::TraceRecord> ring(256);
    b.chip().trace().attach(ring);
    const Ticks until = b.now() + b.bits(200);
    while (b.uart().next(b.chip()) <= until) {
        b.uart().run(b.chip(), b.uart().next(b.chip()));
        b.uart().set_rxd(b.chip(), b.now(), b.uart().txd());
        b.uart().sample(b.chip());
    }
    for (std::uint64_t i = 0; i < b.chip().trace().count; ++i) {
        EXPECT_NE(ring[i].what, static_cast<std::uint16_t>(regmap::Fact::rejected));
        EXPECT_NE(ring[i].what, static_cast<std::uint16_t>(regmap::Fact::heard));
    }
    EXPECT_EQ(b.chip().state().rx_state, chip::RxState::hunt);
    while (!b.uart().edges().empty()) static_cast<void>(b.uart().edges().pop());
}

TEST(UartSnapshot, chip_and_UART_copied_at_every_event_of_a_message_cycle_go_on_the_same_way) {
    Bench b{at(fdl::BaudCode::mbit_1_5), Stage::p2};
    b.tell(kDx5678);
    const Ticks until = b.now() + b.bits(200);
    const auto rest = [&](chip::Chip<> chip, Uart<core::RingTrace> uart) {
        std::vector<PinEdge> edges;
        while (!uart.edges().empty()) static_cast<void>(uart.edges().pop());
        while (uart.next(chip) <= until) {
            uart.advance(chip, uart.next(chip));
            while (!uart.edges().empty()) edges.push_back(uart.edges().pop());
        }
        return edges;
    };
    std::size_t cuts = 0;
    std::vector<PinEdge> all = rest(b.chip(), b.uart());
    ASSERT_GT(all.size(), 20u);
    while (b.uart().next(b.chip()) <= until) {
        b.uart().advance(b.chip(), b.uart().next(b.chip()));
        ++cuts;
        std::vector<std::uint8_t> snapshot(chip::Chip<>::snapshot_size());
        ASSERT_TRUE(b.chip().save(snapshot));
        chip::Chip<> chip{b.recipe().variant, b.recipe().options};
        ASSERT_EQ(chip.load(snapshot), core::ArchiveError::none);
        Uart<core::RingTrace> uart;
        uart.restore(b.uart().state());
        ASSERT_TRUE(plausible(b.uart().state()));
        const std::vector<PinEdge> a = rest(chip, uart), c = rest(b.chip(), b.uart());
        ASSERT_EQ(a, c);
        ASSERT_LE(a.size(), all.size());
        ASSERT_TRUE(std::equal(a.rbegin(), a.rend(), all.rbegin()));
    }
    EXPECT_GT(cuts, 40u);
    while (!b.uart().edges().empty()) static_cast<void>(b.uart().edges().pop());
}

}  // namespace
}  // namespace dpchip::pins
