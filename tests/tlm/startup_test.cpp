// SPDX-License-Identifier: Apache-2.0
// The start-up to data exchange through the TLM socket, held against the same at telegram level in C++; with and without
// temporal decoupling.
#include <gtest/gtest.h>

#include "tlm/startup_station.hpp"

namespace dpchip::tlm::test {

namespace {

ChipSettings settings(const sc_time& access_time) {
    auto s = startup_settings<ChipSettings>();
    s.access_time = access_time;
    return s;
}

/// The scenario on a platform: processor, chip, line, master.
struct Platform {
    Platform(startup::Service service, const sc_time& access_time) : station{"board", settings(access_time), line, service} {}

    void speak() {
        for (const startup::Request& request : startup::requests()) {
            until(to_sc_time(request.at));
            EXPECT_TRUE(line.send_now(request.octets));
        }
    }
    /// The processor that computes ahead of the kernel, by up to `quantum`, and polls every kPollPeriod of its own time.
    void poll(const sc_time& quantum) {
        EXPECT_TRUE(firmware.begin());
        for (startup::Ticks at = startup::kPollPeriod;; at += startup::kPollPeriod) {
            const sc_time local = sc_core::sc_time_stamp() + board.delay, next = to_sc_time(at);
            if (next > local) board.delay += next - local;
            if (board.delay >= quantum) {
                sc_core::wait(board.delay);
                board.delay = sc_core::SC_ZERO_TIME;
            }
            firmware.poll();
        }
    }
    startup::Result run() {
        // One unit more: what is due at the end itself has happened.
        sc_core::sc_start(to_sc_time(startup::kEnd) + sc_time::from_value(1));
        startup::Result result;
        for (const Telegram& t : monitor.seen) result.telegrams.push_back({to_ticks(t.start), t.own, t.octets});
        const auto memory = board.memory();
        std::copy(memory.begin(), memory.end(), result.memory.begin());
        return result;
    }

    Line line{"line", startup::kBaud};
    Monitor monitor{"monitor", line};
    SocketStation station;
    Board& board = station.board;
    startup::Firmware& firmware = station.firmware;
    Actor master{"master", [this] { speak(); }};
};

TEST(TlmStartup, the_reference_reaches_data_exchange_and_answers_everything_but_the_first_telegram) {
    for (const startup::Service service : {startup::Service::interrupt, startup::Service::polling}) {
        const startup::Result result = startup::telegram_level(service);
        EXPECT_EQ(result.telegrams.size(), startup::requests().size() + startup::answers());
        EXPECT_EQ(result.memory[0x04] & 0x30, 0x20) << "DATA-EXCH in the Status Register";
        // The interrupt routine inverts the outputs before the answer is due; who polls gives those of the telegram before.
        const startup::Octets inputs = service == startup::Service::interrupt ? startup::Octets{0x21, 0x0F} : startup::Octets{0x65, 0x43};
        const startup::Octets& answer = result.telegrams.back().octets;
        EXPECT_EQ(startup::Octets(answer.begin() + 7, answer.begin() + 9), inputs);
    }
}

TEST(TlmStartup, registers_RAM_telegrams_and_their_ticks_are_those_of_telegram_level) {
    simulate([] {
        Platform p{startup::Service::interrupt, sc_core::SC_ZERO_TIME};
        EXPECT_EQ(difference(p.run(), startup::telegram_level(startup::Service::interrupt)), "");
        EXPECT_TRUE(p.firmware.exchanging());
    });
}

TEST(TlmStartup, accesses_that_take_time_change_no_register_and_no_telegram) {
    simulate([] {
        Platform p{startup::Service::interrupt, ns(125)};
        EXPECT_EQ(difference(p.run().without_times(), startup::telegram_level(startup::Service::interrupt).without_times()), "");
    });
}

class TlmQuantum : public testing::TestWithParam<std::uint64_t> {};

TEST_P(TlmQuantum, a_processor_that_computes_ahead_sees_what_it_would_see_without) {
    simulate([] {
        Platform p{startup::Service::polling, sc_core::SC_ZERO_TIME};
        p.board.program = [&] { p.poll(us(GetParam())); };
        EXPECT_EQ(difference(p.run(), startup::telegram_level(startup::Service::polling)), "");
        EXPECT_TRUE(p.firmware.exchanging());
    });
}

INSTANTIATE_TEST_SUITE_P(Microseconds, TlmQuantum, testing::Values(0, 1, 15, 100, 1000, 50000));

}  // namespace

}  // namespace dpchip::tlm::test
