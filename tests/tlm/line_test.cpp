// SPDX-License-Identifier: Apache-2.0
// What goes on behind the bus: X/INT and SYNC at their times, several chips and a master on one line, RESET, XCTS, and a
// processor that is ahead of the kernel.
#include <gtest/gtest.h>

#include <sstream>

#include "tlm/simulation.hpp"

namespace dpchip::tlm::test {

namespace {

const Octets kFdlStatus{0x10, 0x08, 0x02, 0x49, 0x53, 0x16}, kFdlAnswer{0x10, 0x02, 0x08, 0x00, 0x0A, 0x16};

ChipSettings quick(Synchronisation synchronisation = Synchronisation::exact) {
    ChipSettings s;
    s.access_time = sc_core::SC_ZERO_TIME;
    s.synchronisation = synchronisation;
    s.options = {{"baud_probe_ms", "1"}};
    return s;
}

/// Keeps the times at which a signal changed.
struct Probe : sc_core::sc_module {
    struct Change {
        sc_time at;
        bool level;
        friend bool operator==(const Change& a, const Change& b) { return a.at == b.at && a.level == b.level; }
        friend std::ostream& operator<<(std::ostream& out, const Change& c) { return out << c.at << (c.level ? " up" : " down"); }
    };
    Probe(const sc_core::sc_module_name& name, const sc_core::sc_signal<bool>& signal) : sc_core::sc_module{name}, signal_{&signal} {
        using SC_CURRENT_USER_MODULE = Probe;
        SC_METHOD(note);
        dont_initialize();
        sensitive << signal.value_changed_event();
    }
    void note() { changes.push_back({sc_core::sc_time_stamp(), signal_->read()}); }

    std::vector<Change> changes;

private:
    const sc_core::sc_signal<bool>* signal_;
};

/// The X/INT of the user's millisecond clock, acknowledged at 2.5 ms, with EOI 1 us later again because the event stays.
std::vector<Probe::Change> user_clock() { return {{ms(1), false}, {us(2500), true}, {us(2501), false}}; }

class TlmDecoupled : public testing::TestWithParam<Synchronisation> {};

TEST_P(TlmDecoupled, X_INT_is_shown_at_its_own_time_however_far_ahead_the_processor_is) {
    simulate([] {
        Board b{"board", quick(GetParam())};
        Probe x_int{"probe", b.x_int};
        b.program = [&] {
            b.set_up(0xEF);  // User_Timer_Clock alone
            b.delay += us(2500);
            b.write(0x08, 0x02);  // EOI
            EXPECT_EQ(sc_core::sc_time_stamp() + b.delay, us(2500));
            EXPECT_EQ(sc_core::sc_time_stamp(), GetParam() == Synchronisation::exact ? us(2500) : sc_core::SC_ZERO_TIME);
            b.delay += us(500);
            EXPECT_EQ(b.read(0x02), 0x10) << "and the processor sees it at its local time";
        };
        sc_core::sc_start(ms(4));
        EXPECT_EQ(x_int.changes, user_clock());
    });
}

INSTANTIATE_TEST_SUITE_P(Both, TlmDecoupled, testing::Values(Synchronisation::exact, Synchronisation::run_ahead));

TEST(TlmLine, after_two_hundred_days_an_edge_is_still_exact_to_the_picosecond) {
    simulate([] {
        const sc_time start = ms(200ull * 24 * 3600 * 1000);
        Line line{"line"};
        Board b{"board", quick(), &line};
        Probe x_int{"probe", b.x_int};
        b.program = [&] {
            until(start + sc_time::from_value(1));  // between two ticks: it counts as the earlier one
            b.set_up(0xEF);
        };
        sc_core::sc_start(start + us(2500));
        EXPECT_EQ(x_int.changes, (std::vector<Probe::Change>{{start + ms(1), false}}));
    });
}

TEST(TlmLine, a_coarser_resolution_is_warned_of_and_shows_edges_late_by_less_than_its_unit) {
    simulate([] {
        sc_core::sc_set_time_resolution(1, sc_core::SC_US);
        const Reports reports{report::kLine};
        Line line{"line"};
        Board b{"board", quick(), &line};
        Probe x_int{"probe", b.x_int};
        b.program = [&] {
            sc_core::wait(1, sc_core::SC_MS);
            b.set_up(0xEF);
            b.write(0x08, 0x02);
            sc_core::wait(1500, sc_core::SC_US);
            b.write(0x08, 0x02);  // X/INT is inactive for 1 us
        };
        sc_core::sc_start(3, sc_core::SC_MS);
        EXPECT_NE(reports.text().find("resolution"), std::string::npos);
        EXPECT_EQ(x_int.changes, (std::vector<Probe::Change>{{{2, sc_core::SC_MS}, false}, {{2500, sc_core::SC_US}, true}, {{2501, sc_core::SC_US}, false}}));
    });
}

TEST(TlmLine, X_INT_of_a_telegram_comes_one_CLK_after_its_last_stop_bit) {
    simulate([] {
        Line line{"line"};
        Board b{"board", quick(), &line};
        Probe x_int{"probe", b.x_int};
        b.program = [&] { b.set_up(0xFF, 0xF7); };  // New_Prm_Data
        Actor master{"master", [&] {
            Telegram answer;
            until(us(3500));
            EXPECT_FALSE(line.exchange(kFdlStatus, answer, us(200))) << "the telegram that proves the rate";
            until(ms(5));
            EXPECT_TRUE(line.send_now({0x68, 0x0D, 0x0D, 0x68, 0x88, 0x82, 0x6D, 0x3D, 0x3E, 0x80, 0x01, 0x01, 0x0B, 0x47, 0x11, 0x00, 0x00, 0xD7, 0x16}));
        }};
        sc_core::sc_start(ms(6));
        // 19 characters of 11 bits after 5 ms, and the CLK that the chip takes: 5139354166.67 ps.
        EXPECT_EQ(x_int.changes, (std::vector<Probe::Change>{{to_sc_time(5 * 60'000'000 + 19 * 11 * 40'000 + 1250), false}}));
        EXPECT_EQ(x_int.changes.at(0).at, sc_time::from_value(5'139'354'167));
    });
}

TEST(TlmLine, XDATAEXCH_falls_when_data_exchange_begins_and_rises_at_RESET) {
    simulate([] {
        Line line{"line"};
        Board b{"board", quick(), &line};
        Probe x{"probe", b.xdataexch};
        b.program = [&] {
            b.set_up();
            until(us(7500));
            EXPECT_EQ(b.read(0x10), 0x00) << "the configuration is accepted";
        };
        Actor master{"master", [&] {
            Telegram answer;
            const Octets set_prm{0x68, 0x0C, 0x0C, 0x68, 0x88, 0x82, 0x6D, 0x3D, 0x3E, 0x80, 0x01, 0x01, 0x0B, 0x47, 0x11, 0x00, 0xD7, 0x16};
            const Octets chk_cfg{0x68, 0x07, 0x07, 0x68, 0x88, 0x82, 0x5D, 0x3E, 0x3E, 0x11, 0x21, 0x15, 0x16};
            until(us(3500));
            EXPECT_FALSE(line.exchange(kFdlStatus, answer, us(200)));
            until(ms(5));
            EXPECT_TRUE(line.exchange(set_prm, answer, us(200)));
            EXPECT_EQ(answer.octets, Octets{0xE5});
            until(ms(6));
            EXPECT_TRUE(line.exchange(chk_cfg, answer, us(200)));
            EXPECT_EQ(answer.octets, Octets{0xE5});
            until(ms(9));
            b.reset.write(true);
            sc_core::wait(us(1));
            b.reset.write(false);
            EXPECT_FALSE(line.exchange(kFdlStatus, answer, us(200))) << "a chip after RESET is Offline";
        }};
        sc_core::sc_start(ms(10));
        ASSERT_EQ(x.changes.size(), 2u);
        EXPECT_FALSE(x.changes[0].level);
        EXPECT_GE(x.changes[0].at, us(7500));
        EXPECT_EQ(x.changes[1], (Probe::Change{ms(9), true}));
        EXPECT_EQ(b.chip.info().online, 0);
    });
}

TEST(TlmLine, while_RESET_is_high_nobody_drives_the_bus) {
    simulate([] {
        Board b{"board", quick()};
        Actor reset{"reset", [&] {
            b.reset.write(true);
            sc_core::wait(us(10));
            b.reset.write(false);
        }};
        b.program = [&] {
            sc_core::wait(us(1));
            b.write(0x100, 0x5A);
            EXPECT_EQ(b.read(0x100), 0xFF);
            sc_core::wait(us(10));
            EXPECT_EQ(b.read(0x100), 0x00);
            b.write(0x100, 0x5A);
            EXPECT_EQ(b.read(0x100), 0x5A);
        };
        sc_core::sc_start(us(20));
    });
}

TEST(TlmLine, XCTS_holds_the_answer_back) {
    simulate([] {
        Line line{"line"};
        Board b{"board", quick(), &line};
        b.program = [&] { b.set_up(); };
        Actor master{"master", [&] {
            Telegram answer;
            until(us(3500));
            EXPECT_FALSE(line.exchange(kFdlStatus, answer, us(200)));
            b.xcts.write(true);
            sc_core::wait(us(10));
            EXPECT_FALSE(line.exchange(kFdlStatus, answer, us(200)));
            b.xcts.write(false);
            sc_core::wait(line.received_event());
            EXPECT_TRUE(line.receive(answer));
            EXPECT_EQ(answer.octets, kFdlAnswer);
        }};
        sc_core::sc_start(ms(5));
    });
}

TEST(TlmLine, two_chips_and_a_master_share_a_line) {
    simulate([] {
        Line line{"line"};
        Monitor monitor{"monitor", line};
        ChipSettings apc3 = quick();
        apc3.variant = "apc3";
        Board b8{"b8", quick(), &line}, b9{"b9", apc3, &line};
        b8.program = [&] { b8.set_up(); };
        b9.program = [&] { b9.set_up(0xFF, 0xFF, 9); };
        const Octets to_9{0x10, 0x09, 0x02, 0x49, 0x54, 0x16}, from_9{0x10, 0x02, 0x09, 0x00, 0x0B, 0x16};
        Actor master{"master", [&] {
            Telegram answer;
            until(us(3500));
            EXPECT_FALSE(line.exchange(kFdlStatus, answer, us(200))) << "proves the rate to both";
            EXPECT_TRUE(line.exchange(to_9, answer, us(200)));
            EXPECT_EQ(answer.octets, from_9);
            EXPECT_TRUE(line.exchange(kFdlStatus, answer, us(200)));
            EXPECT_EQ(answer.octets, kFdlAnswer);
        }};
        sc_core::sc_start(ms(6));
        ASSERT_EQ(monitor.seen.size(), 5u);
        std::ostringstream text;
        text << monitor.seen[4];
        EXPECT_EQ(text.str(), "10 02 08 00 0A 16");
        for (const Telegram& t : monitor.seen) EXPECT_FALSE(t.damaged);
        const Telegram& request = monitor.seen[1];
        const Telegram& answer = monitor.seen[2];
        EXPECT_TRUE(request.own);
        EXPECT_FALSE(answer.own);
        EXPECT_EQ(to_ticks(request.end) - to_ticks(request.start), 66 * 40'000);
        EXPECT_GE(to_ticks(answer.start) - to_ticks(request.end), 11 * 40'000) << "minTSDR";
    });
}

TEST(TlmLine, a_master_that_speaks_into_an_answer_collides) {
    simulate([] {
        Line line{"line"};
        Monitor monitor{"monitor", line};
        Board b{"board", quick(), &line};
        b.program = [&] { b.set_up(); };
        Actor master{"master", [&] {
            Telegram answer;
            until(us(3500));
            EXPECT_FALSE(line.exchange(kFdlStatus, answer, us(200)));
            until(ms(5));
            EXPECT_TRUE(line.send_now(kFdlStatus));
            until(us(5060));  // the answer has begun
            EXPECT_TRUE(line.send_now(kFdlStatus));
        }};
        sc_core::sc_start(ms(6));
        ASSERT_EQ(monitor.seen.size(), 4u);
        EXPECT_FALSE(monitor.seen[1].damaged);
        EXPECT_TRUE(monitor.seen[2].damaged);
        EXPECT_TRUE(monitor.seen[3].damaged);
    });
}

/// Two stations whose processors poll on a line of their own, each ahead of the kernel by up to its quantum.
struct Pair {
    struct Sample {
        sc_time at;
        std::uint8_t status, requests;
        friend bool operator==(const Sample& a, const Sample& b) { return a.at == b.at && a.status == b.status && a.requests == b.requests; }
    };
    Pair(const std::string& name, const sc_time& quantum_8, const sc_time& quantum_9)
        : line{(name + "_line").c_str()}, b8{(name + "_8").c_str(), quick(), &line}, b9{(name + "_9").c_str(), quick(), &line},
          master{(name + "_master").c_str(), [this] { speak(); }} {
        b8.program = [this, quantum_8] { poll(b8, 8, us(7), quantum_8, seen_8); };
        b9.program = [this, quantum_9] { poll(b9, 9, us(11), quantum_9, seen_9); };
    }
    static void poll(Board& b, std::uint8_t station, const sc_time& period, const sc_time& quantum, std::vector<Sample>& seen) {
        b.set_up(0xFF, 0xFF, station);
        for (;;) {
            b.delay += period;
            if (b.delay >= quantum) {
                sc_core::wait(b.delay);
                b.delay = sc_core::SC_ZERO_TIME;
            }
            const sc_time at = sc_core::sc_time_stamp() + b.delay;
            const std::uint8_t status = b.read(0x04), requests = b.read(0x01);
            seen.push_back({at, status, requests});
        }
    }
    void speak() {
        const Octets set_prm{0x68, 0x0D, 0x0D, 0x68, 0x88, 0x82, 0x6D, 0x3D, 0x3E, 0x80, 0x01, 0x01, 0x0B, 0x47, 0x11, 0x00, 0x00, 0xD7, 0x16};
        Octets to_9 = set_prm;
        to_9[4] = 0x89;
        to_9[17] = 0xD8;
        Telegram answer;
        until(us(3500));
        EXPECT_FALSE(line.exchange(kFdlStatus, answer, us(200)));
        for (const Octets& request : {set_prm, to_9, set_prm}) {
            EXPECT_TRUE(line.exchange(request, answer, us(200)));
            sc_core::wait(us(33));
        }
    }

    Line line;
    Board b8, b9;
    Actor master;
    std::vector<Sample> seen_8, seen_9;
};

TEST(TlmLine, processors_that_are_ahead_by_different_quanta_see_their_chips_as_if_they_were_not) {
    simulate([] {
        Pair plain{"plain", sc_core::SC_ZERO_TIME, sc_core::SC_ZERO_TIME}, decoupled{"decoupled", ms(1), us(123)};
        sc_core::sc_start(us(5500));
        ASSERT_GT(plain.seen_8.size(), 700u);
        const auto prefix = [](const std::vector<Pair::Sample>& a, const std::vector<Pair::Sample>& b) {
            return std::equal(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(std::min(a.size(), b.size())), b.begin());
        };
        EXPECT_TRUE(prefix(plain.seen_8, decoupled.seen_8));
        EXPECT_TRUE(prefix(plain.seen_9, decoupled.seen_9));
        EXPECT_EQ(plain.b8.memory(), decoupled.b8.memory());
        EXPECT_EQ(plain.b9.memory(), decoupled.b9.memory());
        EXPECT_NE(plain.seen_9.front().requests, plain.seen_9.back().requests) << "something has happened meanwhile";
    });
}

TEST(TlmLine, a_snapshot_brings_registers_and_outputs_back) {
    simulate([] {
        Board b{"board", quick()};
        Probe x_int{"probe", b.x_int};
        b.program = [&] {
            Octets snapshot(dpchip_chip_snapshot_size(b.chip.handle()));
            b.set_up(0xEF);
            until(us(1200));
            const auto before = b.memory();
            EXPECT_GT(dpchip_chip_save(b.chip.handle(), snapshot.data(), snapshot.size()), 0);
            EXPECT_EQ(dpchip_chip_reset(b.chip.handle()), DPCHIP_OK);
            b.chip.changed();
            until(us(1500));
            EXPECT_EQ(dpchip_chip_load(b.chip.handle(), snapshot.data(), snapshot.size()), DPCHIP_OK) << dpchip_last_error();
            b.chip.changed();
            EXPECT_EQ(b.memory(), before);
        };
        sc_core::sc_start(us(1900));
        EXPECT_EQ(x_int.changes, (std::vector<Probe::Change>{{ms(1), false}, {us(1200), true}, {us(1500), false}}));
    });
}

TEST(TlmLine, what_cannot_be_sent_and_rates_that_do_not_exist_are_errors) {
    simulate([] {
        const auto error_of = [](const std::function<void()>& mistake) {
            try {
                mistake();
            } catch (const sc_core::sc_report& report) {
                return std::string{report.get_msg()};
            }
            return std::string{};
        };
        EXPECT_NE(error_of([] { const Line wrong{"wrong", 1234}; }).find("1234"), std::string::npos);
        Line line{"line"};
        Actor master{"master", [&] {
            EXPECT_NE(error_of([&] { static_cast<void>(line.send({})); }), "");
            EXPECT_NE(error_of([&] { static_cast<void>(line.send_now(Octets(256, 0))); }), "");
            EXPECT_TRUE(line.send(kFdlStatus)) << "waits until the line has been idle for TID1";
            Telegram answer;
            EXPECT_NE(error_of([&] { static_cast<void>(line.exchange(kFdlStatus, answer, us(1))); }), "");
        }};
        sc_core::sc_start(us(10));
    });
}

TEST(TlmLine, one_telegram_waits_for_the_bus_rules_at_a_time) {
    simulate([] {
        Line line{"line"};
        Monitor monitor{"monitor", line};
        Actor master{"master", [&] {
            until(ms(1));
            EXPECT_TRUE(line.send(kFdlStatus)) << "begins at once";
            EXPECT_TRUE(line.send(kFdlStatus)) << "waits for the slot time of the first";
            EXPECT_FALSE(line.send(kFdlStatus));
        }};
        sc_core::sc_start(ms(3));
        ASSERT_EQ(monitor.seen.size(), 2u);
        EXPECT_EQ(monitor.seen[0].start, ms(1));
        EXPECT_GT(to_ticks(monitor.seen[1].start) - to_ticks(monitor.seen[0].end), 100 * 40'000);
    });
}

TEST(TlmLine, unread_answers_push_the_oldest_out) {
    simulate([] {
        Line line{"line"};
        Board b{"board", quick(), &line};
        b.program = [&] { b.set_up(); };
        Actor master{"master", [&] {
            Telegram answer;
            until(us(3500));
            EXPECT_FALSE(line.exchange(kFdlStatus, answer, us(200)));
            for (int i = 0; i < 70; ++i) {
                EXPECT_TRUE(line.send(kFdlStatus));
                sc_core::wait(line.received_event());
            }
            int kept = 0;
            while (line.receive(answer)) ++kept;
            EXPECT_EQ(kept, 64);
        }};
        sc_core::sc_start(ms(20));
    });
}

TEST(TlmLine, an_approximately_timed_initiator_is_served_through_the_socket_too) {
    struct AtInitiator : sc_core::sc_module {
        explicit AtInitiator(const sc_core::sc_module_name& name) : sc_core::sc_module{name} { socket.register_nb_transport_bw(this, &AtInitiator::answered); }
        ::tlm::tlm_sync_enum answered(::tlm::tlm_generic_payload&, ::tlm::tlm_phase& phase, sc_time&) {
            if (phase == ::tlm::BEGIN_RESP) done.notify(sc_core::SC_ZERO_TIME);
            phase = ::tlm::END_RESP;
            return ::tlm::TLM_COMPLETED;
        }
        tlm_utils::simple_initiator_socket<AtInitiator> socket{"socket"};
        sc_core::sc_event done;
    };
    simulate([] {
        AtInitiator at{"at"};
        Chip chip{"chip"};
        sc_core::sc_signal<bool> x_int{"x_int"}, xdataexch{"xdataexch"};
        at.socket.bind(chip.bus);
        chip.x_int(x_int);
        chip.xdataexch_sync(xdataexch);
        bool ended = false;
        Actor run{"run", [&] {
            std::uint8_t value = 0x5A;
            ::tlm::tlm_generic_payload p;
            p.set_command(::tlm::TLM_WRITE_COMMAND);
            p.set_address(0x100);
            p.set_data_ptr(&value);
            p.set_data_length(1);
            p.set_streaming_width(1);
            ::tlm::tlm_phase phase = ::tlm::BEGIN_REQ;
            sc_time delay;
            at.socket->nb_transport_fw(p, phase, delay);
            sc_core::wait(at.done);
            EXPECT_EQ(p.get_response_status(), ::tlm::TLM_OK_RESPONSE);
            EXPECT_EQ(sc_core::sc_time_stamp(), ns(125)) << "the cycle's time has passed";
            EXPECT_EQ(chip.peek(0x100), 0x5A);
            ended = true;
        }};
        sc_core::sc_start(us(1));
        EXPECT_TRUE(ended);
    });
}

}  // namespace

}  // namespace dpchip::tlm::test
