// SPDX-License-Identifier: Apache-2.0
// The live line with a fake port and a fake time: nothing here depends on how fast the machine is.
#include <gtest/gtest.h>

#include <sstream>

#include <dpchip/live/recorder.hpp>

#include "fakes.hpp"

namespace dpchip::live {
namespace {

constexpr Ticks kBit = fdl::baud(fdl::BaudCode::kbit_19_2).bit;

/// FDL_Status to station 8 from master 2.
const Octets kStatus8 = octets("10 08 02 49 53 16");
const Octets kStatus9 = octets("10 09 02 49 54 16");

struct Bench {
    explicit Bench(Medium medium = Medium::pty, const LineOptions& options = {}) : port{time, medium}, line{port, time, options} {
        static_cast<void>(line.segment().attach(slave, "slave"));
    }
    /// Line time at which something was written.
    Ticks written(std::size_t i) const { return port.sent.at(i).at - 1_s; }
    void arrive(Ticks line_time, Octets octets, Octets faults = {}) { port.arrive(1_s + line_time, std::move(octets), std::move(faults)); }

    FakeTime time;
    FakePort port;
    LiveLine line;
    Echoer slave;
};

TEST(LiveLine, AnswersElevenBitTimesAfterTheLastOctetWasRead) {
    Bench b;
    b.arrive(5_ms, kStatus8);
    EXPECT_EQ(b.line.run(20_ms), 20_ms);
    ASSERT_EQ(b.port.sent.size(), 1u);
    EXPECT_EQ(b.port.sent[0].octets, Octets{0xE5});
    EXPECT_EQ(b.written(0), 5_ms + 11 * kBit);
    EXPECT_EQ(b.slave.heard_at.at(0), 5_ms);
    EXPECT_EQ(b.line.counters().sent, 1u);
}

TEST(LiveLine, EndsATelegramWithItsLastOctet) {
    Bench b;
    b.arrive(5_ms, octets("10 08 02"));
    b.arrive(9_ms, octets("49 53 16"));
    b.line.run(20_ms);
    ASSERT_EQ(b.port.sent.size(), 1u);
    EXPECT_EQ(b.slave.heard_at.at(0), 9_ms);
    EXPECT_EQ(b.written(0), 9_ms + 11 * kBit);
}

TEST(LiveLine, NeverWritesBeforeTheTimeOfTheAnswerEvenIfItLooksEarly) {
    Bench b;
    b.arrive(5_ms, kStatus8);
    for (int i = 0; i < 2000; ++i) b.line.run(Ticks{(10_us).n + i});
    ASSERT_EQ(b.port.sent.size(), 1u);
    EXPECT_GE(b.written(0), 5_ms + 11 * kBit);
}

TEST(LiveLine, EndsTheSendingOnAPtyWithTheWrite) {
    Bench b;
    b.slave.answer = octets("10 02 08 00 0A 16");
    b.arrive(5_ms, kStatus8);
    b.port.on_send = [&] { b.port.arrive(b.time.now_ + 100_us, kStatus8); b.port.on_send = {}; };
    b.line.run(30_ms);
    ASSERT_EQ(b.port.sent.size(), 2u) << "the next request comes before the answer's bit times are over";
    EXPECT_EQ(b.slave.sent_at.at(0), b.written(0));
    EXPECT_EQ(b.written(1), b.written(0) + 100_us + 11 * kBit);
    EXPECT_EQ(b.line.segment().counters().collisions, 0u);
}

TEST(LiveLine, EndsTheSendingOnASerialLineWithTheLastStopBit) {
    Bench b{Medium::serial};
    b.slave.answer = octets("10 02 08 00 0A 16");
    b.arrive(5_ms, kStatus8);
    b.line.run(5_ms + 12 * kBit);
    ASSERT_EQ(b.port.sent.size(), 1u);
    EXPECT_TRUE(b.line.segment().busy());
    b.line.run(66 * kBit);
    EXPECT_FALSE(b.line.segment().busy());
    EXPECT_TRUE(b.slave.sent_at.empty());
}

TEST(LiveLine, PacesAPtyLikeAWireWhenAsked) {
    Bench b{Medium::pty, {.pace = Pace::wire}};
    b.slave.answer = octets("10 02 08 00 0A 16");
    b.arrive(5_ms, kStatus8);
    b.line.run(30_ms);
    ASSERT_EQ(b.port.sent.size(), 1u);
    EXPECT_EQ(b.written(0), 5_ms + 11 * kBit + 66 * kBit);
}

TEST(LiveLine, KeepsSilentWhenTheSlotTimeIsOver) {
    struct Row { Medium medium; std::optional<Ticks> slot; Ticks oversleep; bool sent; };
    for (const Row& row : {Row{Medium::pty, {}, 150_ms, true}, Row{Medium::pty, {}, 250_ms, false}, Row{Medium::tcp, {}, 250_ms, false},
                           Row{Medium::pty, 300_ms, 250_ms, true}, Row{Medium::serial, {}, 4_ms, true}, Row{Medium::serial, {}, 6_ms, false},
                           Row{Medium::serial, 1000 * kBit, 6_ms, true}}) {
        Bench b{row.medium, {.slot_time = row.slot}};
        b.arrive(1_ms, kStatus8);
        b.line.run(1_ms);  // the request is read in time,
        b.port.oversleep = row.oversleep;
        b.line.run(2_ms);  // but then the host has other things to do
        EXPECT_EQ(b.port.sent.size(), row.sent ? 1u : 0u) << name(row.medium) << ' ' << row.oversleep.n;
        EXPECT_EQ(b.line.counters().late, row.sent ? 0u : 1u);
        b.port.oversleep = {};
        const std::size_t before = b.port.sent.size();
        b.port.arrive(b.time.now_ + 10_ms, kStatus8);
        b.line.run(20_ms);
        EXPECT_EQ(b.port.sent.size(), before + 1) << "the next request is answered";
    }
}

TEST(LiveLine, TakesTheProfilesSlotTimeOnSerialLines) {
    FakeTime time;
    FakePort serial{time, Medium::serial};
    EXPECT_EQ((LiveLine{serial, time, {.baud = fdl::BaudCode::mbit_1_5}}.slot_time()), 300 * fdl::baud(fdl::BaudCode::mbit_1_5).bit);
    FakePort pty{time};
    EXPECT_EQ((LiveLine{pty, time, {.baud = fdl::BaudCode::mbit_1_5}}.slot_time()), 200_ms);
}

TEST(LiveLine, SplitsSeveralTelegramsOfOneReadAndShowsThemInOrder) {
    Bench b;
    Octets all = octets("DC 03 02 68 07 07 68 FF 82 46 3A 3E 02 00 41 16");
    all.insert(all.end(), kStatus8.begin(), kStatus8.end());
    b.arrive(5_ms, all);
    b.line.run(20_ms);
    ASSERT_EQ(b.slave.heard.size(), 3u);
    EXPECT_EQ(b.slave.heard[2], kStatus8);
    EXPECT_LT(b.slave.heard_at[0], b.slave.heard_at[1]);
    EXPECT_LT(b.slave.heard_at[1], b.slave.heard_at[2]);
    EXPECT_LE(b.slave.heard_at[2], 5_ms + 3 * kBit);
    EXPECT_EQ(b.port.sent.size(), 1u);
    EXPECT_EQ(b.port.relayed.size(), 3u);
}

TEST(LiveLine, GivesUpAnAnswerWhenAnotherTelegramComesFirst) {
    Bench b;
    b.arrive(5_ms, kStatus8);
    b.arrive(5_ms + 5 * kBit, kStatus9);
    b.line.run(20_ms);
    EXPECT_TRUE(b.port.sent.empty());
}

TEST(LiveLine, SendsDamageCharacterByCharacterAndAnswersTheNextGoodTelegram) {
    Bench b;
    b.arrive(505_ms, octets("10 08 02 49 54 16"));
    b.arrive(506_ms, octets("68 05 05"));
    b.arrive(509_ms, kStatus8);
    b.line.run(600_ms);
    EXPECT_GE(b.slave.faults.size(), 6u);
    EXPECT_EQ(b.line.counters().damaged_octets, 9u);
    ASSERT_EQ(b.port.sent.size(), 1u);
    EXPECT_LE(b.written(0), 709_ms);
}

TEST(LiveLine, HandsFaultsOfAUartToTheStations) {
    Bench b{Medium::serial};
    b.arrive(5_ms, kStatus8, {0, 0, fdl::fault_parity, 0, 0, 0});
    b.line.run(20_ms);
    EXPECT_EQ(b.slave.faults, (Octets{0, 0, fdl::fault_parity, 0, 0, 0}));
    EXPECT_TRUE(b.port.sent.empty());
}

TEST(LiveLine, CountsWhatThePortDoesNotTake) {
    Bench b;
    b.port.refuses = true;
    b.arrive(5_ms, kStatus8);
    b.line.run(20_ms);
    EXPECT_EQ(b.line.counters().unsent, 1u);
    EXPECT_EQ(b.slave.sent_at.size(), 1u) << "for the station its sending is over all the same";
}

TEST(LiveLine, ReturnsAtOnceWhenStoppedAndWakesThePort) {
    Bench b;
    b.line.stop();
    EXPECT_TRUE(b.port.woken);
    EXPECT_EQ(b.line.run(10_s), 0_s);
    EXPECT_EQ(b.line.run(10_s), 0_s) << "until resume()";
    b.line.resume();
    EXPECT_EQ(b.line.run(1_s), 1_s);
}

TEST(LiveLine, ReturnsEarlyWhenEnoughHasHappened) {
    Bench b;
    b.arrive(5_ms, kStatus8);
    EXPECT_EQ(b.line.run(10_s, [&] { return !b.slave.heard.empty(); }), 5_ms);
    EXPECT_EQ(b.line.run(10_s, [] { return true; }), 0_s);
}

TEST(LiveLine, WaitsInsteadOfSpinning) {
    Bench b;
    b.line.run(60_s);
    EXPECT_LE(b.port.waits, 61);
}

TEST(LiveLine, RunsAheadByProcessorAccessesButNeverWritesEarly) {
    Bench b;
    b.arrive(5_ms, kStatus8);
    b.line.run(5_ms);
    b.line.spend(2_ms);  // 11 bit times are 0.57 ms
    EXPECT_EQ(b.line.now(), 7_ms);
    EXPECT_TRUE(b.port.sent.empty()) << "the wall stands at 5 ms";
    b.line.run(10_ms);
    ASSERT_EQ(b.port.sent.size(), 1u);
    EXPECT_EQ(b.written(0), 5_ms + 11 * kBit);
}

TEST(LiveLine, LetsTheChipsSearchSetTheRateOfTheUart) {
    Bench b{Medium::serial};
    b.port.fastest = fdl::BaudCode::mbit_1_5;
    fdl::BaudCode wanted = fdl::BaudCode::mbit_12;
    b.line.follow_baud([&] { return wanted; });
    b.line.run(1_ms);
    b.arrive(2_ms, kStatus8);
    b.line.run(5_ms);
    EXPECT_TRUE(b.slave.heard.empty()) << "the UART does not do 12 Mbit/s: it hears nothing there";
    wanted = fdl::BaudCode::kbit_500;
    b.line.run(1_ms);
    b.arrive(8_ms, kStatus8);
    b.line.run(5_ms);
    EXPECT_EQ(b.port.rates, (std::vector{fdl::BaudCode::mbit_12, fdl::BaudCode::kbit_500}));
    EXPECT_EQ(b.line.baud(), fdl::BaudCode::kbit_500);
    EXPECT_EQ(b.slave.heard.size(), 1u);
}

TEST(LiveLine, CarriesAMasterOfItsOwnWithoutASlotTimeForRequests) {
    Bench b;
    Echoer& master = b.slave;
    master.ts = 2;
    master.answer = kStatus9;  // sends requests
    b.arrive(5_ms, octets("10 02 09 49 54 16"));
    b.line.run(5_ms);
    b.port.oversleep = 500_ms;
    b.line.run(1_ms);
    ASSERT_EQ(b.port.sent.size(), 1u) << "a request is never too late";
    EXPECT_EQ(b.port.sent[0].octets, kStatus9);
}

TEST(Recorder, WritesWhatWasOnTheLineWithDirectionTimeAndFaults) {
    Bench b;
    std::ostringstream out;
    trace::PcapngWriter writer{out};
    Recorder recorder{writer, {.name = "pty", .epoch_ns = 1'000'000, .port = b.line.port_station()}};
    b.line.segment().observe(recorder);
    b.arrive(5_ms, kStatus8);
    b.arrive(20_ms, octets("10 08 02 49 54 16"));
    b.line.run(100_ms);
    const std::string file = out.str();
    const trace::Capture capture = trace::read_pcapng({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()});
    EXPECT_EQ(capture.error, trace::PcapngError::none);
    ASSERT_EQ(capture.packets.size(), 3u);
    EXPECT_EQ(capture.packets[0].time_ns, 6'000'000);
    EXPECT_EQ(capture.packets[0].direction, trace::Direction::inbound);
    EXPECT_EQ(capture.packets[1].direction, trace::Direction::outbound);
    EXPECT_EQ(capture.packets[1].time_ns, 1'000'000 + core::to_ns(5_ms + 11 * kBit));
    EXPECT_EQ(capture.packets[2].comment, "wrong FCS");
    EXPECT_EQ(recorder.lost(), 0u);
}

// ---- with the chip -----------------------------------------------------------------------------------------------

struct ChipBench {
    explicit ChipBench(Medium medium = Medium::pty) : port{time, medium}, line{port, time} {
        start(chip, 8);
        index = *line.segment().attach(chip, "chip");
        chip.options().baud_probe_ms.fill(7);
        Ticks at = 1_s;
        for (int i = 0; i < 100; ++i) port.arrive(at += 11_ms, kStatus9);
        line.run(1200_ms);
    }
    /// Sends and runs for `wait`; the octets of the answers.
    std::vector<Octets> ask(const Octets& octets, Ticks wait = core::milliseconds(100)) {
        port.sent.clear();
        port.arrive(time.now_ + 100_us, octets);
        line.run(wait);
        std::vector<Octets> answers;
        for (const auto& s : port.sent) answers.push_back(s.octets);
        return answers;
    }
    FakeTime time;
    FakePort port;
    LiveLine line;
    chip::Chip<> chip;
    segment::StationIndex index{};
};

TEST(AChipOnALiveLine, FindsTheRateAndAnswers) {
    ChipBench b;
    ASSERT_EQ(b.chip.baud(), fdl::BaudCode::kbit_19_2);
    EXPECT_EQ(b.ask(kStatus8), std::vector<Octets>{octets("10 02 08 00 0A 16")});
    EXPECT_EQ(b.ask(octets("68 05 05 68 88 82 6D 3C 3E F1 16")),
              std::vector<Octets>{octets("68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 0C DA 78 16")});
}

TEST(AChipOnALiveLine, AnswersRequestsThatFollowFasterThanAWireWouldCarryThem) {
    ChipBench b;
    for (int i = 0; i < 50; ++i) EXPECT_EQ(b.ask(kStatus8, 1_ms).size(), 1u) << i;
}

class ChipAfterNoise : public testing::TestWithParam<const char*> {};

TEST_P(ChipAfterNoise, StillAnswersTheNextGoodTelegram) {
    for (const Medium medium : {Medium::pty, Medium::tcp}) {
        ChipBench b{medium};
        ASSERT_EQ(b.ask(kStatus8, 2_ms).size(), 1u);
        Octets noisy = octets(GetParam());
        noisy.insert(noisy.end(), kStatus8.begin(), kStatus8.end());
        EXPECT_EQ(b.ask(noisy).size(), 1u) << "in one write, right behind an answer";
        EXPECT_TRUE(b.ask(octets(GetParam()), 3_ms).empty());
        EXPECT_EQ(b.ask(kStatus8).size(), 1u) << "in the next write";
        EXPECT_TRUE(b.ask(octets(GetParam()), 300_ms).empty());
        EXPECT_EQ(b.ask(kStatus8, 2_ms).size(), 1u) << "much later, and at once";
    }
}

INSTANTIATE_TEST_SUITE_P(OfAnyKind, ChipAfterNoise, testing::Values("00", "FF FF FF FF", "10 08 02", "68 F9 F9 68", "68 05 05 68 88 82 6D 3C",
    "10 08 02 49 54 16", "10 08 02 49 53 17", "68 05 06 68", "01 E5 DC 10 68"));

TEST(AChipOnALiveLine, HearsParityErrorsOnASerialLineAndRecovers) {
    ChipBench b{Medium::serial};
    ASSERT_EQ(b.chip.baud(), fdl::BaudCode::kbit_19_2);
    b.port.sent.clear();
    b.port.arrive(b.time.now_ + 1_ms, kStatus8, {0, 0, fdl::fault_parity, 0, 0, 0});
    b.line.run(30_ms);
    EXPECT_TRUE(b.port.sent.empty());
    EXPECT_EQ(b.ask(kStatus8).size(), 1u);
}

}  // namespace
}  // namespace dpchip::live
