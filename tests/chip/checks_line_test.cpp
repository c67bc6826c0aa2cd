// SPDX-License-Identifier: Apache-2.0
// Conformance checks of layers 1 and 2: C001 to C018 (reference 8.3).
#include "checks.hpp"

#include <vector>

namespace dpchip::checks {
namespace {

/// Reads the chip's pin edges out of its queue.
std::vector<chip::Edge> edges_of(Bench& bench, chip::Pin pin) {
    std::vector<chip::Edge> out;
    while (!bench.chip().edges().empty())
        if (const chip::Edge e = bench.chip().edges().pop(); e.pin == pin) out.push_back(e);
    return out;
}

void watch(Bench& bench, chip::Pin pin) {
    bench.chip().watch(static_cast<std::uint8_t>(1u << static_cast<unsigned>(pin)));
}

// proves: VPC3C 2.1-05, VPC3C 6.1-01, APC3 1-01, APC3 5.1-01
TEST_P(Checks, C001_a_status_request_is_answered_and_sets_no_interrupt) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("10 08 02 49 53 16"), "10 02 08 00 0A 16");
    EXPECT_EQ(b.irr(), 0);
}

// proves: VPC3C 1-02
TEST_P(Checks, C002_a_wrong_FCS_is_met_with_silence_and_the_next_good_telegram_is_answered) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("10 08 02 49 52 16"), kSilence);
    EXPECT_EQ(b.ask("10 08 02 49 53 16"), "10 02 08 00 0A 16");
}

// proves: VPC3C 1-02
TEST_P(Checks, C003_differing_lengths_are_met_with_silence) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("68 05 04 68 88 82 6D 3C 3E F1 16"), kSilence);
    EXPECT_EQ(b.ask(kFdlStatus), kFdlStatusOk);
}

// proves: VPC3C 1-02
TEST_P(Checks, C004_a_wrong_end_delimiter_is_met_with_silence) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("68 05 05 68 88 82 6D 3C 3E F1 17"), kSilence);
    EXPECT_EQ(b.ask(kFdlStatus), kFdlStatusOk);
}

// proves: VPC3C 1-02, VPC3C 2.1-02
TEST_P(Checks, C005_a_parity_error_is_met_with_silence) {
    Bench b{recipe(), Stage::p0};
    b.tell({hex("10 08 02 49 53 16"), {{3, fdl::fault_parity}}, {}});
    EXPECT_EQ(b.listen_text(), kSilence);
    EXPECT_EQ(b.ask(kFdlStatus), kFdlStatusOk);
}

// proves: VPC3C 5.1.1-17..18, VPC3C 8.3-04
TEST_P(Checks, C006_a_low_stop_bit_matters_unless_Dis_Stop_Control_is_set) {
    for (const bool disabled : {false, true}) {
        Recipe s = recipe();
        if (disabled) s.mode0 |= regmap::mode0::dis_stop_control;
        Bench b{s, Stage::p0};
        b.tell({hex("10 08 02 49 53 16"), {{2, fdl::fault_stop}}, {}});
        EXPECT_EQ(b.listen_text(), disabled ? kFdlStatusOk : kSilence);
        EXPECT_EQ(b.ask(kFdlStatus), kFdlStatusOk);
    }
}

// proves: VPC3C 5.1.1-20..21, VPC3C 8.3-04
TEST_P(Checks, C007_a_gap_of_three_bit_times_matters_unless_Dis_Start_Control_is_set) {
    for (const bool disabled : {false, true}) {
        Recipe s = recipe();
        if (disabled) s.mode0 |= regmap::mode0::dis_start_control;
        Bench b{s, Stage::p0};
        b.tell({hex("10 08 02 49 53 16"), {}, {{2, 3}}});
        EXPECT_EQ(b.listen_text(), disabled ? kFdlStatusOk : kSilence);
        EXPECT_EQ(b.ask(kFdlStatus), kFdlStatusOk);
    }
}

// proves: VPC3C 2.1-16, VPC3C 2.1-17, VPC3C 8.3-03
TEST_P(Checks, C008_answers_start_on_time_at_every_baud_rate_and_RTS_encloses_them) {
    for (const fdl::Baud& baud : fdl::kBaud) {
        SCOPED_TRACE(baud.name);
        Recipe s = recipe();
        s.baud = baud.code;
        Bench b{s, Stage::p0};
        EXPECT_EQ(b.peek(control::status_reg_high) & 0x0F, static_cast<int>(baud.code));
        watch(b, chip::Pin::rts);
        EXPECT_EQ(b.ask("10 08 02 49 53 16"), "10 02 08 00 0A 16");
        const std::int64_t delay = baud.code == BaudCode::mbit_12 ? 36 : baud.code == BaudCode::mbit_6 ? 18 : 11;
        EXPECT_EQ(b.last_answer().start - b.request_end(), b.bits(delay));
        const std::vector<chip::Edge> rts = edges_of(b, chip::Pin::rts);
        ASSERT_EQ(rts.size(), 2u);
        EXPECT_EQ(rts[0], (chip::Edge{b.last_answer().start - 4_clk, chip::Pin::rts, chip::Level::high}));
        EXPECT_EQ(rts[1], (chip::Edge{b.last_answer().end + 4_clk, chip::Pin::rts, chip::Level::low}));
    }
}

// proves: VPC3C 4.2-33, APC3 3.2-26
TEST_P(Checks, C009_register_0B_sets_the_delay_of_answers) {
    Recipe s = recipe();
    s.min_tsdr = 0x14;
    Bench b{s, Stage::p0};
    EXPECT_EQ(b.ask("10 08 02 49 53 16"), "10 02 08 00 0A 16");
    EXPECT_EQ(b.last_answer().start - b.request_end(), 640_clk);
}

TEST_P(Checks, C010_a_token_is_ignored) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("DC 05 02"), kSilence);
    EXPECT_EQ(b.ask("10 08 02 49 53 16"), "10 02 08 00 0A 16");
}

TEST_P(Checks, C011_an_ident_request_is_answered_RS) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("10 08 02 4E 58 16"), "10 02 08 03 0D 16");
}

TEST_P(Checks, C012_a_broadcast_that_wants_an_answer_gets_none) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("10 7F 02 49 CA 16"), kSilence);
    EXPECT_EQ(b.ask("68 05 05 68 FF 82 6D 3C 3E 68 16"), kSilence);
}

TEST_P(Checks, C013_SDA_to_SAP_61_is_answered_RS) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("68 0C 0C 68 88 82 55 3D 3E 80 01 01 0B 47 11 00 BF 16"), "10 02 08 03 0D 16");
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.dp_state(), kWaitPrm);
}

TEST_P(Checks, C014_SDN_to_SAP_61_changes_nothing) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("68 0C 0C 68 88 82 44 3D 3E 80 01 01 0B 47 11 00 AE 16"), kSilence);
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.diag(), kDiagWaitPrm);
}

TEST_P(Checks, C015_SAP_52_does_not_exist) {
    Bench b{recipe(), Stage::p0};
    EXPECT_EQ(b.ask("68 06 06 68 88 82 7D 34 3E 01 FA 16"), "10 02 08 03 0D 16");
}

TEST_P(Checks, C016_XCTS_holds_the_first_character_back_but_not_RTS) {
    Bench b{recipe(), Stage::p0};
    watch(b, chip::Pin::rts);
    b.chip().set_xcts(chip::Level::high);
    b.tell(kFdlStatus);
    b.run_to(b.request_end() + 100_us);
    const std::vector<chip::Edge> rts = edges_of(b, chip::Pin::rts);
    ASSERT_EQ(rts.size(), 1u);
    EXPECT_EQ(rts[0], (chip::Edge{b.request_end() + b.bits(11) - 4_clk, chip::Pin::rts, chip::Level::high}));
    const Ticks released = b.now();
    b.chip().set_xcts(chip::Level::low);
    EXPECT_EQ(b.listen_text(), "10 02 08 00 0A 16");
    EXPECT_GE(b.last_answer().start, released);
    EXPECT_LE(b.last_answer().start, released + b.bit());
}

// proves: VPC3C 8.3-01
TEST_P(Checks, whoever_sends_the_bits_may_hold_a_later_character_and_says_when_sending_is_over) {
    Recipe s = recipe();
    s.path = Path::telegrams;
    Bench b{s, Stage::p0};
    bench::Bench::ChipUnderTest& chip = b.chip();
    b.tell(kFdlStatus);
    fdl::Transmission answer;
    while (!chip.take(answer)) chip.advance(chip.next());
    chip.advance(answer.start + b.bits(11));
    chip.hold();
    chip.advance(answer.end() + b.bits(100));
    EXPECT_EQ(chip.level(chip::Pin::rts), chip::Level::high) << "sending goes on";
    std::vector<std::uint8_t> snapshot(bench::Bench::ChipUnderTest::snapshot_size());
    ASSERT_TRUE(chip.save(snapshot));
    ASSERT_EQ(chip.load(snapshot), core::ArchiveError::none);
    const Ticks end = chip.now() + b.bits(55);
    chip.sent(end);
    chip.advance(end + 4_clk - Ticks{1});
    EXPECT_EQ(chip.level(chip::Pin::rts), chip::Level::high);
    chip.advance(end + 4_clk);
    EXPECT_EQ(chip.level(chip::Pin::rts), chip::Level::low) << "the trail counts from the end that was told";
    chip.hold();
    EXPECT_EQ(b.ask(kFdlStatus), kFdlStatusOk) << "outside an answer there is nothing to hold";
}

TEST_P(Checks, C017_a_retry_is_answered_again_and_indicated_once) {
    Bench b{recipe(), Stage::p2};
    const unsigned user_wd = b.chip().user_wd_timer();
    EXPECT_EQ(b.ask_verbatim("68 05 05 68 08 02 5D 12 34 AD 16"), "68 05 05 68 02 08 08 AB CD 8A 16");
    EXPECT_EQ(b.irr(), irq::dx_out);
    EXPECT_EQ(b.chip().user_wd_timer(), user_wd - 1);
    const std::uint8_t dout_sm = b.peek(control::dout_buffer_sm);
    b.acknowledge();
    EXPECT_EQ(b.ask_verbatim("68 05 05 68 08 02 5D 12 34 AD 16"), "68 05 05 68 02 08 08 AB CD 8A 16");
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.chip().user_wd_timer(), user_wd - 1);
    EXPECT_EQ(b.peek(control::dout_buffer_sm), dout_sm);
}

TEST_P(Checks, C018_a_request_of_another_master_in_between_makes_the_same_octets_a_new_request) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask_verbatim("68 05 05 68 08 02 5D 12 34 AD 16"), kInputs);
    EXPECT_EQ(b.irr(), irq::dx_out);
    b.acknowledge();
    EXPECT_EQ(b.ask_verbatim("68 05 05 68 88 83 6D 3C 3E F2 16"), "68 0B 0B 68 83 88 08 3E 3C 00 0C 00 02 47 11 F3 16");
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.ask_verbatim("68 05 05 68 08 02 5D 12 34 AD 16"), kInputs);
    EXPECT_EQ(b.irr(), irq::dx_out);
}

// ---- what the ids leave open: the frame count bit (reference 2.5)
// ------------------------------------------------------

/// Data_Exchange of the owner with the given function code octet, verbatim; true when the outputs were taken.
bool is_new(Bench& b, std::uint8_t fc) {
    b.acknowledge();
    EXPECT_EQ(b.ask_verbatim(text(b.request(2, fc, std::nullopt, {0x12, 0x34}))), kInputs);
    return b.irr() == irq::dx_out;
}

TEST_P(Checks, the_frame_count_bit_tells_retries_from_new_requests) {
    Bench b{recipe(), Stage::p2};  // the last request was 7D
    EXPECT_TRUE(is_new(b, 0x5D));
    EXPECT_FALSE(is_new(b, 0x5D));
    EXPECT_FALSE(is_new(b, 0x5C)) << "the priority does not matter";
    EXPECT_TRUE(is_new(b, 0x7D));
    EXPECT_TRUE(is_new(b, 0x6D)) << "FCV = 0 is always new";
    EXPECT_TRUE(is_new(b, 0x6D));
    EXPECT_FALSE(is_new(b, 0x7D)) << "FCV = 0, FCB = 1 counts as FCB 1";
    EXPECT_TRUE(is_new(b, 0x5D));
    EXPECT_TRUE(is_new(b, 0x4D)) << "FCV = 0, FCB = 0 forgets";
    EXPECT_TRUE(is_new(b, 0x5D));
    EXPECT_TRUE(is_new(b, 0x4D));
    EXPECT_TRUE(is_new(b, 0x7D));
}

TEST_P(Checks, telegrams_without_frame_count_leave_it_alone) {
    Bench b{recipe(), Stage::p2};
    EXPECT_TRUE(is_new(b, 0x5D));
    EXPECT_EQ(b.ask_verbatim(kFdlStatus), kFdlStatusOk);
    EXPECT_FALSE(is_new(b, 0x5D));
    EXPECT_EQ(b.ask_verbatim("68 07 07 68 FF 82 46 3A 3E 00 00 3F 16"), kSilence);
    EXPECT_FALSE(is_new(b, 0x5D));
    EXPECT_EQ(b.ask_verbatim("10 08 02 49 52 16"), kSilence);
    EXPECT_FALSE(is_new(b, 0x5D));
    EXPECT_EQ(b.ask_verbatim("68 05 05 68 07 02 7D 12 34 CC 16"), kSilence) << "for station 7";
    EXPECT_FALSE(is_new(b, 0x5D));
}

TEST_P(Checks, a_repetition_of_a_refused_request_is_processed_anew) {
    Bench b{recipe(), Stage::p1};
    EXPECT_EQ(b.ask_verbatim("68 07 07 68 88 82 7D 3A 3E 02 00 01 16"), kRs);
    EXPECT_EQ(b.ask_verbatim("68 07 07 68 88 82 7D 3E 3E 11 21 35 16"), kSc)
        << "not a retry: the last answer was negative";
    EXPECT_EQ(b.irr(), irq::new_cfg_data);
}

TEST_P(Checks, a_status_request_in_between_does_not_turn_a_refused_request_into_a_retry) {
    Bench b{recipe(), Stage::p1};
    EXPECT_EQ(b.ask_verbatim("68 07 07 68 88 82 7D 3A 3E 02 00 01 16"), kRs);
    EXPECT_EQ(b.ask_verbatim(kFdlStatus), kFdlStatusOk);
    EXPECT_EQ(b.ask_verbatim("68 07 07 68 88 82 7D 3E 3E 11 21 35 16"), kSc);
    EXPECT_EQ(b.irr(), irq::new_cfg_data);
}

TEST_P(Checks, a_retry_repeats_the_inputs_and_another_master_with_the_same_frame_count_bit_gets_new_ones) {
    constexpr std::string_view kOld = "68 07 07 68 82 88 08 3E 38 AB CD 00 16";
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask_verbatim("68 05 05 68 88 82 5D 38 3E DD 16"), kOld);
    b.give_inputs("EF 01");
    EXPECT_EQ(b.ask_verbatim("68 05 05 68 88 82 5D 38 3E DD 16"), kOld);
    EXPECT_EQ(b.ask_verbatim("68 05 05 68 88 83 5D 38 3E DE 16"), "68 07 07 68 83 88 08 3E 38 EF 01 79 16");
}

}  // namespace
}  // namespace dpchip::checks
