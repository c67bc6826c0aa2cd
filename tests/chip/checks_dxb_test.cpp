// SPDX-License-Identifier: Apache-2.0
// Data eXchange Broadcast: C123 to C127 (reference 8.11), figures 7-7 to 7-14 (7.3.1; reference 6.1).
#include "dpv2_bench.hpp"

#include <array>

namespace dpchip::checks {
namespace {

constexpr std::uint16_t kLinkCells = kLinkBuf << 3, kStatusCells = kStatusBuf << 3;
const std::vector<Link> kOneLink{{9, 4, 1, 2}};
constexpr std::string_view kMulticast = "68 05 05 68 08 02 77 12 34 C7 16";
constexpr std::string_view kPublished = "68 07 07 68 7F 09 08 11 22 33 44 3A 16";
constexpr std::string_view kTooShort = "68 06 06 68 7F 09 08 11 22 33 F6 16";

std::uint8_t link_status(const Bench& b, unsigned link = 0) {
    return b.peek(static_cast<std::uint16_t>(kStatusCells + 4 + 2 * link + 1));
}

/// What the user gets from 13H: "publisher length samples".
std::string take_sample(Bench& b) {
    const std::uint8_t command = b.read(control::next_dxbout_buffer_cmd);
    if ((command & 0x04) == 0) return "nothing new";
    constexpr std::array<std::uint8_t, 4> kBuffers{0, kDxbOut1, kDxbOut2, kDxbOut3};
    const auto at = static_cast<std::uint16_t>(kBuffers.at(command & 3u) << 3);
    return text(b.ram(at, 2u + b.peek(static_cast<std::uint16_t>(at + 1))));
}

/// Data_Exchange every 20 ms: keeps the watchdog of the master off for five of them, one monitoring time of the links.
void exchange(Bench& b, int times) {
    for (int i = 0; i < times; ++i) {
        EXPECT_EQ(b.ask(kDx1234), kInputs);
        b.run(20_ms);
    }
}

/// To the end of a monitoring time.
void run_to_monitoring(Bench& b) {
    const Ticks due = b.chip().state().timers[static_cast<std::size_t>(chip::Timer::dxb_monitor)];
    ASSERT_NE(due, core::kNever);
    while (due - b.now() > 30_ms) exchange(b, 1);
    b.run_to(due + 2_clk);
}

// proves: VPC3C 6.2.2-16, VPC3C 7.3.1-01, VPC3C 7.3.1-03, E077
TEST_P(ChecksStepBC, C123_a_publisher_answers_function_code_7_to_everybody) {
    Recipe r = recipe();
    Bench b{r, Stage::configured};
    start_to_p2(b, kPrmPublisher);
    EXPECT_EQ(b.ask(kMulticast), "68 05 05 68 7F 08 08 AB CD 07 16");
    EXPECT_EQ(b.irr(), irq::dx_out);
    EXPECT_EQ(text(b.take_outputs().octets), "12 34");
    EXPECT_EQ((b.last_answer().start - b.request_end()) / b.bit(), 39) << "minTSDR of the Set_Prm";
}

// proves: VPC3C 7.3.1-13
TEST_P(ChecksStepBC, C124_without_Publisher_Enable_function_code_7_is_not_even_answered) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask(kMulticast), kSilence);
    EXPECT_EQ(b.irr(), 0);
}

// proves: VPC3C 1-04, VPC3C 4.1-12, VPC3C 4.3-14..15, VPC3C 4.3-33..34, VPC3C 4.3-42..43, VPC3C 5.3.1-02,
//   VPC3C 7.3.1-01, VPC3C 7.3.1-08, VPC3C 7.3.1-12, VPC3C 7.3.1-33..37, VPC3C 7.3.1-43
TEST_P(ChecksStepBC, C125_a_subscriber_gets_the_samples_of_its_link) {
    Bench b = subscriber(recipe(), kOneLink);
    tell(b, kPublished);
    EXPECT_EQ(b.irr(), irq::dxb_out);
    EXPECT_EQ(take_sample(b), "09 02 22 33");
    EXPECT_EQ(link_status(b), 0x01);
}

// proves: VPC3C 7.3.1-30, VPC3C 7.3.1-43..44
TEST_P(ChecksStepBC, C126_data_of_another_length_are_a_link_error) {
    Bench b = subscriber(recipe(), kOneLink);
    tell(b, kTooShort);
    EXPECT_EQ(link_status(b), 0x40);
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(take_sample(b), "nothing new");
}

// proves: VPC3C 5.3.1-04, VPC3C 7.3.1-29, VPC3C 7.3.1-45..46, VPC3C 7.3.1-48
TEST_P(ChecksStepBC, C127_the_links_are_monitored_with_the_watchdog_time) {
    Bench b = subscriber(recipe(), kOneLink);
    tell(b, kPublished);
    run_to_monitoring(b);
    EXPECT_EQ(link_status(b), 0x80);
    EXPECT_EQ(b.irr() & irq::dxb_link_error, 0);
    run_to_monitoring(b);
    EXPECT_EQ(link_status(b), 0x00);
    EXPECT_EQ(b.irr() & irq::dxb_link_error, irq::dxb_link_error);
    b.acknowledge();
    run_to_monitoring(b);
    EXPECT_EQ(b.irr() & irq::dxb_link_error, 0) << "a broken link is told once";
    EXPECT_EQ(b.dp_state(), kDataExch);
}

// ---- figure 7-14, from every status octet there is ------------------------------------------------------------------

enum class LinkEvent : std::uint8_t { valid, faulty, elapsed };
struct Figure7_14 {
    std::uint8_t before;
    LinkEvent on;
    std::uint8_t after;
    std::uint16_t interrupt;
};

// clang-format off
constexpr Figure7_14 kFigure7_14[]{
    {0x00, LinkEvent::valid,   0x01, irq::dxb_out}, {0x01, LinkEvent::valid,   0x01, irq::dxb_out},
    {0x40, LinkEvent::valid,   0x01, irq::dxb_out}, {0x80, LinkEvent::valid,   0x81, irq::dxb_out},
    {0x81, LinkEvent::valid,   0x81, irq::dxb_out}, {0x00, LinkEvent::faulty,  0x40, 0},
    {0x01, LinkEvent::faulty,  0x40, 0},            {0x40, LinkEvent::faulty,  0x40, 0},
    {0x80, LinkEvent::faulty,  0x40, 0},            {0x81, LinkEvent::faulty,  0x40, 0},
    {0x01, LinkEvent::elapsed, 0x80, 0},            {0x81, LinkEvent::elapsed, 0x80, 0},
    {0x40, LinkEvent::elapsed, 0x00, irq::dxb_link_error},
    {0x80, LinkEvent::elapsed, 0x00, irq::dxb_link_error},
    {0x00, LinkEvent::elapsed, 0x00, 0},
};
// clang-format on

// proves: VPC3C 7.3.1-11, VPC3C 7.3.1-43..44, VPC3C 7.3.1-46..47
TEST_P(ChecksStepBC, every_row_of_figure_7_14_from_every_link_status) {
    Bench b = subscriber(recipe(), kOneLink);
    for (const Figure7_14& row : kFigure7_14) {
        exchange(b, 1);
        b.acknowledge();
        b.write(kStatusCells + 5, row.before);
        switch (row.on) {
        case LinkEvent::valid: tell(b, kPublished); break;
        case LinkEvent::faulty: tell(b, kTooShort); break;
        case LinkEvent::elapsed: run_to_monitoring(b); break;
        }
        const testing::Message where = testing::Message() << "from " << unsigned{row.before} << " event " << static_cast<int>(row.on);
        EXPECT_EQ(link_status(b), row.after) << where;
        EXPECT_EQ(b.irr() & (irq::dxb_out | irq::dxb_link_error), row.interrupt) << where;
    }
}

// ---- layouts --------------------------------------------------------------------------------------------------------

// proves: VPC3C 4.3-35..36, VPC3C 7.3.1-06, VPC3C 7.3.1-17, VPC3C 7.3.1-23..24, VPC3C 7.3.1-26..32
TEST_P(ChecksStepBC, figure_7_10_a_pair_of_octets_per_link_behind_the_header) {
    Bench b = subscriber(recipe(), {{9, 4, 1, 2}, {10, 1, 0, 1}, {11, 2, 0, 2}});
    EXPECT_EQ(text(b.ram(kStatusCells, 10)), "0A 83 00 00 09 00 0A 00 0B 00");
    publish(b, 11, hex("55 66"));
    publish(b, 10, hex("55 66"));
    EXPECT_EQ(text(b.ram(kStatusCells, 10)), "0A 83 00 00 09 00 0A 40 0B 01");
    EXPECT_EQ(text(b.ram(kLinkCells, 12)), "09 04 01 02 0A 01 00 01 0B 02 00 02") << "the chip only reads the links";
}

// proves: VPC3C 7.3.1-08, VPC3C 7.3.1-37..38, E020
TEST_P(ChecksStepBC, figure_7_11_a_sample_may_fill_244_octets_behind_publisher_and_length) {
    Bench b = subscriber(recipe(), {{9, 244, 0, 244}});
    Octets data(244);
    for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<std::uint8_t>(i);
    publish(b, 9, data);
    Octets expected{0x09, 244};
    expected.insert(expected.end(), data.begin(), data.end());
    EXPECT_EQ(take_sample(b), text(expected));
}

// proves: VPC3C 4.2-22, VPC3C 7.3.1-09..10, VPC3C 7.3.1-34, VPC3C 7.3.1-36, VPC3C 7.3.1-39..42, E021
TEST_P(ChecksStepBC, figures_7_12_and_7_13_the_machine_moves_like_that_of_the_outputs) {
    Bench b = subscriber(recipe(), kOneLink);
    EXPECT_EQ(b.peek(control::dxbout_buffer_sm), 0xE1) << "F 3, U 2, N nil, D 1";
    EXPECT_EQ(b.read(control::next_dxbout_buffer_cmd), 0x02) << "no new U buffer";
    tell(b, kPublished);
    EXPECT_EQ(b.peek(control::dxbout_buffer_sm), 0x27) << "F nil, U 2, N 1, D 3";
    EXPECT_EQ(b.read(control::next_dxbout_buffer_cmd), 0x05) << "new, in DXBout_Buf 1";
    EXPECT_EQ(b.peek(control::dxbout_buffer_sm), 0x93) << "F 2, U 1, N nil, D 3";
    EXPECT_EQ(b.read(control::next_dxbout_buffer_cmd), 0x01);
    tell(b, kPublished);
    tell(b, kPublished);
    EXPECT_EQ(b.read(control::next_dxbout_buffer_cmd) & 0x04, 0x04);
    EXPECT_EQ(b.read(control::next_dxbout_buffer_cmd) & 0x04, 0x00) << "two samples unread: the older one is lost";
}

// proves: VPC3C 7.3.1-07
TEST_P(ChecksStepBC, LEAVE_MASTER_clears_Dout_and_leaves_DXBout_alone) {
    Bench b = subscriber(recipe(), kOneLink);
    tell(b, kPublished);
    const std::uint8_t before = b.peek(control::dxbout_buffer_sm);
    b.write(control::mode_reg1_s, regmap::mode1::user_leave_master);
    b.run(2_clk);
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.peek(control::dxbout_buffer_sm), before);
    EXPECT_EQ(take_sample(b), "09 02 22 33");
}

// ---- links ----------------------------------------------------------------------------------------------------------

// proves: VPC3C 7.3.1-02
TEST_P(ChecksStepBC, twenty_nine_links_are_served_and_a_thirtieth_is_not) {
    std::vector<Link> links;
    for (std::uint8_t i = 0; i < 30; ++i) links.push_back({static_cast<std::uint8_t>(20 + i), 3, 1, 1});
    Bench b = subscriber(recipe(), links);
    for (std::uint8_t i = 0; i < 29; ++i) {
        publish(b, links[i].publisher, {0xEE, i, 0xEE});
        EXPECT_EQ(take_sample(b), text(Octets{links[i].publisher, 1, i}));
        EXPECT_EQ(link_status(b, i), 0x01);
    }
    publish(b, links[29].publisher, {0xEE, 29, 0xEE});
    EXPECT_EQ(take_sample(b), "nothing new");
    EXPECT_EQ(link_status(b, 29), 0x00);
}

// proves: E080
TEST_P(ChecksStepBC, several_links_to_one_publisher_leave_only_the_last_sample_in_N) {
    Bench b = subscriber(recipe(), {{9, 4, 0, 1}, {9, 4, 1, 1}, {9, 4, 2, 2}});
    tell(b, kPublished);
    EXPECT_EQ(b.irr(), irq::dxb_out) << "one interrupt for three samples";
    EXPECT_EQ(take_sample(b), "09 02 33 44");
    EXPECT_EQ(take_sample(b), "nothing new");
    for (unsigned link = 0; link < 3; ++link) EXPECT_EQ(link_status(b, link), 0x01);
}

TEST_P(ChecksStepBC, of_several_links_to_one_publisher_only_those_of_the_wrong_length_fail) {
    Bench b = subscriber(recipe(), {{9, 4, 0, 1}, {9, 3, 0, 1}});
    tell(b, kPublished);
    EXPECT_EQ(link_status(b, 0), 0x01);
    EXPECT_EQ(link_status(b, 1), 0x40);
    EXPECT_EQ(take_sample(b), "09 01 11");
}

TEST_P(ChecksStepBC, a_publisher_that_changes_its_length_breaks_the_link_and_mends_it_with_the_old_one) {
    Bench b = subscriber(recipe(), kOneLink);
    tell(b, kPublished);
    EXPECT_EQ(take_sample(b), "09 02 22 33");
    publish(b, 9, hex("11 22 33 44 55"));
    EXPECT_EQ(link_status(b), 0x40);
    EXPECT_EQ(take_sample(b), "nothing new");
    run_to_monitoring(b);
    EXPECT_EQ(link_status(b), 0x00);
    EXPECT_EQ(b.irr() & irq::dxb_link_error, irq::dxb_link_error);
    tell(b, kPublished);
    EXPECT_EQ(link_status(b), 0x01);
    EXPECT_EQ(take_sample(b), "09 02 22 33");
    run_to_monitoring(b);
    EXPECT_EQ(link_status(b), 0x80);
}

TEST_P(ChecksStepBC, a_link_that_fits_neither_the_data_nor_the_buffer_is_treated_as_a_wrong_length) {
    for (const Link& link : {Link{9, 4, 3, 2}, Link{9, 4, 4, 1}, Link{9, 4, 0, 255}}) {
        Bench b = subscriber(recipe(), {link});
        tell(b, kPublished);
        EXPECT_EQ(link_status(b), 0x40) << unsigned{link.offset};
        EXPECT_EQ(take_sample(b), "nothing new");
    }
    Bench b{recipe(), Stage::configured};
    write_dxb_cells(b);
    b.write(org::r_len_dxbout_buf, 3);
    write_links(b, kOneLink);
    start_to_p2(b);
    tell(b, kPublished);
    EXPECT_EQ(link_status(b), 0x40) << "two octets and their header need a buffer of four";
}

TEST_P(ChecksStepBC, a_damaged_broadcast_changes_nothing) {
    Bench b = subscriber(recipe(), kOneLink);
    b.tell(Stimulus{hex(kPublished), {{8, fdl::fault_parity}}, {}});
    b.run(b.bits(100));
    b.tell("68 07 07 68 7F 09 08 11 22 33 44 3B 16");
    b.run(b.bits(100));
    EXPECT_EQ(link_status(b), 0x00);
    EXPECT_EQ(b.irr(), 0);
    tell(b, kPublished);
    EXPECT_EQ(link_status(b), 0x01);
}

// proves: VPC3C 7.3.1-12
TEST_P(ChecksStepBC, only_answers_with_data_to_127_from_a_publisher_of_the_table_are_samples) {
    Bench b = subscriber(recipe(), kOneLink);
    const Octets data = hex("11 22 33 44");
    publish(b, 10, data);                                             // not in the table
    for (const std::uint8_t fc : hex("00 02 03 0C 0D 48 88")) publish(b, 9, data, fc);  // neither DL nor DH
    b.tell(Stimulus{telegram(0x02, 9, 0x08, data), {}, {}});          // to the master
    b.run(2_clk);
    b.tell(Stimulus{telegram(0xFF, 9, 0x08, hex("3E 11 22 33 44")), {}, {}});  // to a SAP of everybody
    b.run(b.bits(100));
    EXPECT_EQ(link_status(b), 0x00);
    EXPECT_EQ(b.irr(), 0);
    publish(b, 9, data, 0x0A);
    EXPECT_EQ(link_status(b), 0x01);
    EXPECT_EQ(take_sample(b), "09 02 22 33");
}

// proves: VPC3C 7.3.1-45
TEST_P(ChecksStepBC, samples_come_in_DATA_EXCH_only) {
    Bench b{recipe(), Stage::configured};
    write_dxb_cells(b);
    write_links(b, kOneLink);
    b.start();
    b.find_baud();
    b.ask(kPrm);
    b.acknowledge();
    tell(b, kPublished);
    EXPECT_EQ(b.dp_state(), kWaitCfg);
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(link_status(b), 0x00);
}

// proves: VPC3C 7.3.1-49
TEST_P(ChecksStepBC, without_a_watchdog_the_links_are_not_monitored) {
    Bench b = subscriber(recipe(), kOneLink, "68 0C 0C 68 88 82 5D 3D 3E 80 02 05 0B 47 11 00 CC 16");
    tell(b, kPublished);
    b.run(10_s);
    EXPECT_EQ(b.dp_state(), kDataExch);
    EXPECT_EQ(link_status(b), 0x01);
    EXPECT_EQ(b.irr() & irq::dxb_link_error, 0);
}

// ---- the publisher --------------------------------------------------------------------------------------------------

TEST_P(ChecksStepBC, a_publisher_with_diagnosis_broadcasts_with_high_priority) {
    Bench b{recipe(), Stage::configured};
    start_to_p2(b, kPrmPublisher);
    b.give_diag(0x00);
    EXPECT_EQ(b.ask(kMulticast), "68 05 05 68 7F 08 0A AB CD 09 16");
}

TEST_P(ChecksStepBC, a_repetition_of_the_poll_is_broadcast_again) {
    Bench b{recipe(), Stage::configured};
    start_to_p2(b, kPrmPublisher);
    const std::string first = b.ask(kMulticast);
    b.acknowledge();
    EXPECT_EQ(b.ask_again(), first);
    EXPECT_EQ(b.irr(), 0) << "a repetition is not executed";
}

TEST_P(ChecksStepBC, a_publisher_without_inputs_answers_its_master_only) {
    Recipe r = recipe();
    r.din = 0;
    Bench b{r, Stage::configured};
    start_to_p2(b, kPrmPublisher);
    EXPECT_EQ(b.ask(kMulticast), kSc);
}

TEST_P(ChecksStepBC, a_publisher_refuses_masters_that_do_not_own_it) {
    Bench b{recipe(), Stage::configured};
    start_to_p2(b, kPrmPublisher);
    EXPECT_EQ(b.ask(b.request(3, 0x77, std::nullopt, hex("12 34"))), "10 03 08 03 0E 16");
    EXPECT_EQ(b.irr(), 0);
}

TEST_P(ChecksStepBC, a_publisher_still_answers_ordinary_Data_Exchange_to_its_master) {
    Bench b{recipe(), Stage::configured};
    start_to_p2(b, kPrmPublisher);
    EXPECT_EQ(b.ask(kDx1234), kInputs);
}

TEST_P(ChecksStepBC, monitoring_ends_when_a_Set_Prm_in_DATA_EXCH_switches_WD_On_off) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask("68 0C 0C 68 88 82 5D 3D 3E 80 01 01 0B 47 11 00 C7 16"), kSc);
    b.run(1_s);
    EXPECT_EQ(b.dp_state(), kDataExch);
    EXPECT_EQ(b.irr() & irq::dxb_link_error, 0);
}

}  // namespace
}  // namespace dpchip::checks
