// SPDX-License-Identifier: Apache-2.0
// Clock synchronisation: C130 to C132 (reference 8.11), figures 7-20 to 7-24 (7.3.3; reference 6.3).
#include <support/golden.hpp>

#include <dpchip/chip/clock_sync.hpp>

#include "dpv2_bench.hpp"

namespace dpchip::checks {
namespace {

namespace cs = chip::clock_sync;

constexpr std::string_view kTimeEvent = "10 7F 02 40 C1 16";
constexpr std::string_view kClockValue =
    "68 15 15 68 7F 02 C0 C3 12 34 56 80 00 00 00 C3 12 34 4C 80 00 00 00 00 01 F6 16";
constexpr std::string_view kShortValue = "68 0B 0B 68 7F 02 C0 C3 12 34 56 80 00 00 00 20 16";
constexpr std::string_view kTime1 = "C3 12 34 56 80 00 00 00", kTime0 = "C3 12 34 4C 80 00 00 00";
constexpr std::uint16_t kBase2k = 0x7E0, kBase4k = 0xFE0;

/// A time receiver that runs: CS_Supported, interval 10 s. `base` says which memory mode.
struct Receiver {
    Bench b;
    std::uint16_t base;

    explicit Receiver(Recipe r, std::uint16_t memory = kBase2k) : b{prepared(r, memory), Stage::p2}, base{memory} {
        b.write_word(control::int_mask_reg_low, 0x0000);
        set_interval(0x03E8);
    }
    static Recipe prepared(Recipe r, std::uint16_t memory) {
        r.mode0 |= regmap::mode0::cs_supported;
        if (memory == kBase4k) r.mode2 = regmap::mode2::mode_4kb | regmap::mode2::gc_int_mode;
        return r;
    }
    std::uint16_t at(unsigned offset) const { return static_cast<std::uint16_t>(base + offset); }
    void set_interval(std::uint16_t tens_of_ms) {
        b.write(at(cs::interval_high), core::high(tens_of_ms));
        b.write(at(cs::interval_low), core::low(tens_of_ms));
    }
    std::uint8_t status() const { return b.peek(at(cs::status)); }
    std::string time() const { return text(b.ram(at(cs::time_event), 8)); }
    std::string previous() const { return text(b.ram(at(cs::previous_te), 8)); }
    std::uint32_t peek_delay() const { return word(b.ram(at(cs::receive_delay_time), 4)); }
    std::uint32_t read_delay() {
        Octets o;
        for (unsigned i = 0; i < 4; ++i) o.push_back(b.read(at(cs::receive_delay_time + i)));
        return word(o);
    }
    static std::uint32_t word(const Octets& o) {
        return static_cast<std::uint32_t>(o[0]) << 24 | static_cast<std::uint32_t>(o[1]) << 16 | static_cast<std::uint32_t>(o[2]) << 8 | o[3];
    }
    void value(std::string_view now, std::string_view before) {
        Octets unit = hex(now);
        for (const std::uint8_t octet : hex(before)) unit.push_back(octet);
        unit.push_back(0x00);
        unit.push_back(0x01);
        b.tell(Stimulus{telegram(0x7F, 2, 0xC0, unit), {}, {}});
        b.run(2_clk);
    }
    /// DATA-EXCH goes on while time passes.
    void exchange_for(Ticks duration) {
        for (const Ticks end = b.now() + duration; b.now() < end;) {
            EXPECT_EQ(b.ask(kDx1234), kInputs);
            b.run(std::min(50_ms, std::max(Ticks{}, end - b.now())));
        }
        b.acknowledge(irq::dx_out);
    }
    chip::CsState state() const { return b.chip().state().cs_state; }
};

// proves: VPC3C 5.1.1-14, VPC3C 5.3.1-11, VPC3C 7.3.3-01, VPC3C 7.3.3-03, VPC3C 7.3.3-08..09, VPC3C 7.3.3-11..12,
//   VPC3C 7.3.3-19..21, VPC3C 7.3.3-25, VPC3C 7.3.3-29, VPC3C 7.3.3-32, E004
TEST_P(ChecksClockSync, C130_Time_Event_and_Clock_Value_set_the_time) {
    Receiver r{recipe()};
    tell(r.b, kTimeEvent);
    const Ticks event = r.b.request_end();
    tell(r.b, kClockValue);
    EXPECT_EQ(r.b.irr(), irq::clock_sync);
    EXPECT_EQ(r.status(), cs::kSetTime);
    EXPECT_EQ(r.time(), kTime1);
    EXPECT_EQ(r.previous(), kTime0);
    EXPECT_EQ(text(r.b.ram(r.at(cs::cv_status1), 2)), "00 01");
    r.b.run(3_ms);
    const auto elapsed = static_cast<std::uint32_t>((r.b.now() - event) / 1_us);
    EXPECT_EQ(r.peek_delay(), elapsed) << "the counter runs";
    EXPECT_EQ(r.read_delay(), elapsed);
    r.b.run(3_ms);
    EXPECT_EQ(r.read_delay(), elapsed) << "until its first octet was read";
}

// proves: VPC3C 7.3.3-29..30
TEST_P(ChecksClockSync, C131_a_Clock_Value_of_the_wrong_length_is_a_violation) {
    Receiver r{recipe()};
    tell(r.b, kTimeEvent);
    tell(r.b, kShortValue);
    EXPECT_EQ(r.b.irr(), irq::clock_sync);
    EXPECT_EQ(r.status(), cs::kViolation);
}

// proves: VPC3C 7.3.3-22, VPC3C 7.3.3-31
TEST_P(ChecksClockSync, C132_two_intervals_of_silence_are_a_violation) {
    Receiver r{recipe()};
    tell(r.b, kTimeEvent);
    const Ticks due = r.b.request_end() + 20_s;
    r.exchange_for(due - r.b.now() - 1_ms);
    EXPECT_EQ(r.b.irr(), 0);
    r.b.run_to(due);
    EXPECT_EQ(r.b.irr() & irq::clock_sync, irq::clock_sync);
    EXPECT_EQ(r.status(), cs::kViolation);
    EXPECT_EQ(r.state(), chip::CsState::wait_te);
}

// ---- figure 7-20 and 7-24: a whole sequence as golden traces ----------------------------------------------------------

// proves: VPC3C 7.3.3-01
TEST_P(ChecksClockSync, figure_7_20_marks_1_to_4) {
    Receiver r{recipe()};
    Recording recording{r.b};
    recording.heading("1: Time_Event");
    tell(r.b, kTimeEvent);
    r.b.run(100_us);
    recording.heading("2: Clock_Value, Clock_Sync interrupt");
    tell(r.b, kClockValue);
    r.b.run(50_us);
    recording.heading("3: read access Receive_Delay_Time");
    static_cast<void>(r.read_delay());
    recording.heading("4: update system timer");
    r.b.run(20_us);
    r.b.acknowledge(irq::clock_sync);
    EXPECT_TRUE(matches_golden(GetParam().path, "chip/figure_7_20.trace", recording.text()));
}

/// The user's part of figure 7-24: Status, the buffer if the time is good, acknowledgement last. Returns the delay.
std::uint32_t handle_interrupt(Receiver& r) {
    std::uint32_t delay = 0;
    if ((r.b.read(r.at(cs::status)) & cs::kSetTime) != 0) {
        delay = r.read_delay();
        for (unsigned i = 0; i < 8; ++i) static_cast<void>(r.b.read(r.at(cs::time_event + i)));
    }
    r.b.acknowledge(irq::clock_sync);
    r.b.write(control::mode_reg1_s, regmap::mode1::eoi);
    return delay;
}

// proves: VPC3C 7.3.3-06, VPC3C 7.3.3-28
TEST_P(ChecksClockSync, figure_7_24_user_and_chip) {
    Receiver r{recipe()};
    Recording recording{r.b};
    recording.heading("a good sequence");
    tell(r.b, kTimeEvent);
    tell(r.b, kClockValue);
    r.b.run(10_us);
    static_cast<void>(handle_interrupt(r));
    recording.heading("a violation: Clock_Value without Time_Event");
    tell(r.b, kClockValue);
    r.b.run(10_us);
    static_cast<void>(handle_interrupt(r));
    recording.heading("Stop_Clock_Sync");
    r.b.write(r.at(cs::command), cs::kStop);
    tell(r.b, kTimeEvent);
    recording.heading("a new interval starts the time receiver again");
    r.set_interval(0x0064);
    tell(r.b, kTimeEvent);
    tell(r.b, kClockValue);
    r.b.run(10_us);
    static_cast<void>(handle_interrupt(r));
    EXPECT_TRUE(matches_golden(GetParam().path, "chip/figure_7_24.trace", recording.text()));
}

// ---- figure 7-23: the buffer ------------------------------------------------------------------------------------------

// proves: VPC3C 7.3.3-05, VPC3C 7.3.3-45..48
TEST_P(ChecksClockSync, figure_7_23_the_buffer_lies_at_7E0H_or_FE0H_in_its_own_order) {
    for (const std::uint16_t base : {kBase2k, kBase4k})
        for (const chip::BusMode mode : {chip::BusMode::intel, chip::BusMode::motorola}) {
            Recipe recipe_ = recipe();
            recipe_.bus_mode = mode;
            Receiver r{recipe_, base};
            r.b.write(r.at(cs::command), cs::kCheckEna | cs::kIgnoreCyclic);
            tell(r.b, kTimeEvent);
            r.value("01 02 03 04 05 06 07 08", "00 00 00 00 00 00 00 00");
            static_cast<void>(r.read_delay());
            r.b.acknowledge();
            tell(r.b, kTimeEvent);
            r.value("11 12 13 14 15 16 17 18", "01 02 03 04 05 06 07 08");
            const Ticks event = r.b.request_end();
            EXPECT_GT(event, Ticks{});
            const std::uint32_t delay = r.read_delay();
            Octets expected = hex("01 06 00 01 11 12 13 14 15 16 17 18");
            for (const unsigned shift : {24u, 16u, 8u, 0u}) expected.push_back(static_cast<std::uint8_t>(delay >> shift));
            for (const std::uint8_t octet : hex("01 02 03 04 05 06 07 08 03 E8")) expected.push_back(octet);
            EXPECT_EQ(text(r.b.ram(base, cs::buffer_octets)), text(expected)) << base;
        }
}

// proves: VPC3C 7.3.3-09, VPC3C 7.3.3-46
TEST_P(ChecksClockSync, the_delay_counts_from_the_end_of_the_Time_Event) {
    Receiver r{recipe()};
    tell(r.b, kTimeEvent);
    const Ticks event = r.b.request_end();
    tell(r.b, kClockValue);
    for (const auto& [us, ns] : {std::pair{999, 999}, std::pair{1000, 0}, std::pair{1000, 21}}) {
        r.b.run_to(event + core::microseconds(us) + core::nanoseconds(ns));
        EXPECT_EQ(r.peek_delay(), static_cast<std::uint32_t>(us));
    }
}

// proves: VPC3C 7.3.3-12
TEST_P(ChecksClockSync, reading_any_other_octet_does_not_stop_the_delay) {
    Receiver r{recipe()};
    tell(r.b, kTimeEvent);
    tell(r.b, kClockValue);
    for (unsigned i = 0; i < cs::buffer_octets; ++i)
        if (i != cs::receive_delay_time) static_cast<void>(r.b.read(r.at(i)));
    const std::uint32_t before = r.peek_delay();
    r.b.run(10_us);
    EXPECT_EQ(r.peek_delay(), before + 10);
}

// ---- what goes wrong --------------------------------------------------------------------------------------------------

// proves: VPC3C 7.3.3-30
TEST_P(ChecksClockSync, a_Clock_Value_without_Time_Event_is_a_violation) {
    Receiver r{recipe()};
    tell(r.b, kClockValue);
    EXPECT_EQ(r.b.irr(), irq::clock_sync);
    EXPECT_EQ(r.status(), cs::kViolation);
    EXPECT_EQ(r.time(), "00 00 00 00 00 00 00 00");
}

TEST_P(ChecksClockSync, a_second_Time_Event_starts_the_delay_and_the_supervision_anew) {
    Receiver r{recipe()};
    tell(r.b, kTimeEvent);
    r.exchange_for(15_s);
    tell(r.b, kTimeEvent);
    const Ticks second = r.b.request_end();
    r.exchange_for(15_s);
    EXPECT_EQ(r.b.irr() & irq::clock_sync, 0) << "the supervision of the first one is over";
    tell(r.b, kClockValue);
    EXPECT_EQ(r.status(), cs::kSetTime);
    EXPECT_EQ(r.read_delay(), static_cast<std::uint32_t>((r.b.now() - second) / 1_us));
}

// proves: VPC3C 7.3.3-34
TEST_P(ChecksClockSync, Clock_Value_Check_Ena_compares_the_previous_time) {
    Receiver r{recipe()};
    r.b.write(r.at(cs::command), cs::kCheckEna);
    tell(r.b, kTimeEvent);
    r.value(kTime1, kTime0);
    EXPECT_EQ(r.status(), cs::kViolation) << "nothing was received before";
    r.b.acknowledge();
    r.b.write(r.at(cs::command), 0);
    tell(r.b, kTimeEvent);
    r.value(kTime0, "00 00 00 00 00 00 00 00");
    r.b.acknowledge();
    r.b.write(r.at(cs::command), cs::kCheckEna);
    tell(r.b, kTimeEvent);
    r.value(kTime1, kTime0);
    EXPECT_EQ(r.status(), cs::kSetTime);
    r.b.acknowledge();
    tell(r.b, kTimeEvent);
    r.value("C3 12 34 60 80 00 00 00", kTime0);
    EXPECT_EQ(r.status(), cs::kViolation) << "a sequence was missed";
}

// proves: E081
TEST_P(ChecksClockSync, the_check_passes_again_one_sequence_after_the_one_that_failed) {
    Receiver r{recipe()};
    r.b.write(r.at(cs::command), cs::kCheckEna);
    tell(r.b, kTimeEvent);
    r.value(kTime0, "C3 12 34 42 80 00 00 00");
    EXPECT_EQ(r.status(), cs::kViolation) << "the first one cannot be known";
    EXPECT_EQ(r.time(), "00 00 00 00 00 00 00 00");
    r.b.acknowledge();
    tell(r.b, kTimeEvent);
    r.value(kTime1, kTime0);
    EXPECT_EQ(r.status(), cs::kSetTime);
    EXPECT_EQ(r.time(), kTime1);
}

// proves: VPC3C 7.3.3-33
TEST_P(ChecksClockSync, the_reserved_bits_of_Command_mean_nothing) {
    Receiver r{recipe()};
    r.b.write(r.at(cs::command), 0xF8);
    EXPECT_EQ(r.state(), chip::CsState::wait_te) << "it runs on";
    tell(r.b, kTimeEvent);
    r.value(kTime1, "00 00 00 00 00 00 00 00");
    EXPECT_EQ(r.status(), cs::kSetTime) << "and checks nothing";
    EXPECT_EQ(r.b.ask(kPrm), kSc);
    EXPECT_EQ(r.state(), chip::CsState::stopped) << "and stops with new parameters";
}

// proves: VPC3C 7.3.3-27
TEST_P(ChecksClockSync, an_unacknowledged_interrupt_keeps_the_buffer) {
    Receiver r{recipe()};
    tell(r.b, kTimeEvent);
    const Ticks first = r.b.request_end();
    tell(r.b, kClockValue);
    const Octets before = r.b.ram(r.at(0), 12);
    tell(r.b, kTimeEvent);
    r.value("C3 12 34 60 80 00 00 00", kTime1);
    tell(r.b, kTimeEvent);
    tell(r.b, kShortValue);
    EXPECT_EQ(r.b.ram(r.at(0), 12), before);
    EXPECT_EQ(r.previous(), kTime0);
    EXPECT_EQ(r.read_delay(), static_cast<std::uint32_t>((r.b.now() - first) / 1_us));
    r.b.acknowledge();
    tell(r.b, kTimeEvent);
    r.value("C3 12 34 6A 80 00 00 00", kTime1);
    EXPECT_EQ(r.time(), "C3 12 34 6A 80 00 00 00");
}

// proves: VPC3C 7.3.3-26
TEST_P(ChecksClockSync, an_overflow_of_the_delay_clears_Status) {
    Receiver r{recipe()};
    tell(r.b, kTimeEvent);
    const Ticks event = r.b.request_end();
    tell(r.b, kClockValue);
    r.b.write(r.at(cs::command), cs::kIgnoreCyclic);
    const Ticks overflow = event + core::microseconds(std::int64_t{1} << 32);
    r.b.run_to(overflow - 1_us);
    EXPECT_EQ(r.peek_delay(), 0xFFFFFFFFu);
    EXPECT_EQ(r.status(), cs::kSetTime);
    r.b.run_to(overflow);
    EXPECT_EQ(r.status(), 0x00);
    r.b.run(1_s);
    EXPECT_EQ(r.status(), 0x00);
}

TEST_P(ChecksClockSync, a_delay_that_was_read_does_not_overflow) {
    Receiver r{recipe()};
    tell(r.b, kTimeEvent);
    tell(r.b, kClockValue);
    r.b.write(r.at(cs::command), cs::kIgnoreCyclic);
    const std::uint32_t delay = r.read_delay();
    r.b.run(core::microseconds(std::int64_t{1} << 32) + 1_s);
    EXPECT_EQ(r.status(), cs::kSetTime);
    EXPECT_EQ(r.peek_delay(), delay);
}

// proves: VPC3C 7.3.3-18
TEST_P(ChecksClockSync, the_time_goes_on_into_the_era_that_begins_in_2036) {
    Receiver r{recipe()};
    r.b.write(r.at(cs::command), cs::kCheckEna);
    r.value("FF FF FF FF 80 00 00 00", "FF FF FF FE 80 00 00 00");  // without Time_Event: a violation, not stored
    r.b.acknowledge();
    r.b.write(r.at(cs::command), 0);
    tell(r.b, kTimeEvent);
    r.value("FF FF FF FF 80 00 00 00", "FF FF FF FE 80 00 00 00");
    EXPECT_EQ(r.status(), cs::kSetTime);
    r.b.acknowledge();
    r.b.write(r.at(cs::command), cs::kCheckEna);
    tell(r.b, kTimeEvent);
    r.value("00 00 00 00 80 00 00 00", "FF FF FF FF 80 00 00 00");
    EXPECT_EQ(r.status(), cs::kSetTime) << "the chip compares octets, not times";
    EXPECT_EQ(r.time(), "00 00 00 00 80 00 00 00");
}

// ---- start and stop ---------------------------------------------------------------------------------------------------

// proves: VPC3C 7.3.3-04, VPC3C 7.3.3-23..24, VPC3C 7.3.3-36
TEST_P(ChecksClockSync, the_interval_is_locked_while_the_time_receiver_runs) {
    Receiver r{recipe()};
    r.set_interval(0x0102);
    EXPECT_EQ(text(r.b.ram(r.at(cs::interval_high), 2)), "03 E8");
    r.b.write(r.at(cs::command), cs::kStop | cs::kCheckEna);
    EXPECT_EQ(r.b.peek(r.at(cs::command)), cs::kCheckEna) << "the chip takes Stop_Clock_Sync away";
    EXPECT_EQ(r.state(), chip::CsState::stopped);
    r.set_interval(0x0102);
    EXPECT_EQ(text(r.b.ram(r.at(cs::interval_high), 2)), "01 02");
    EXPECT_EQ(r.state(), chip::CsState::wait_te);
}

// proves: VPC3C 7.3.3-04
TEST_P(ChecksClockSync, the_low_octet_of_an_interval_other_than_0_starts_the_time_receiver) {
    Receiver r{recipe()};
    r.b.write(r.at(cs::command), cs::kStop);
    r.b.write(r.at(cs::interval_high), 0x00);
    EXPECT_EQ(r.state(), chip::CsState::stopped);
    r.b.write(r.at(cs::interval_low), 0x00);
    EXPECT_EQ(r.state(), chip::CsState::stopped);
    r.b.write(r.at(cs::interval_low), 0x01);
    EXPECT_EQ(r.state(), chip::CsState::wait_te);
}

TEST_P(ChecksClockSync, a_stopped_time_receiver_hears_nothing) {
    Receiver r{recipe()};
    tell(r.b, kTimeEvent);
    r.b.write(r.at(cs::command), cs::kStop);
    tell(r.b, kTimeEvent);
    tell(r.b, kClockValue);
    r.exchange_for(25_s);
    EXPECT_EQ(r.b.irr(), 0);
    EXPECT_EQ(r.status(), 0x00);
}

// proves: VPC3C 7.3.3-23, VPC3C 7.3.3-35
TEST_P(ChecksClockSync, Set_Prm_and_LEAVE_MASTER_stop_it_unless_they_are_ignored) {
    for (const bool ignored : {false, true})
        for (const bool set_prm : {false, true}) {
            Receiver r{recipe()};
            if (ignored) r.b.write(r.at(cs::command), cs::kIgnoreCyclic);
            if (set_prm) EXPECT_EQ(r.b.ask(kPrm), kSc);
            else r.b.write(control::mode_reg1_s, regmap::mode1::user_leave_master);
            r.b.run(2_clk);
            EXPECT_EQ(r.state(), ignored ? chip::CsState::wait_te : chip::CsState::stopped);
            r.b.acknowledge();
            tell(r.b, kTimeEvent);
            tell(r.b, kClockValue);
            EXPECT_EQ(r.b.irr() & irq::clock_sync, ignored ? irq::clock_sync : 0);
        }
}

TEST_P(ChecksClockSync, Go_Offline_stops_it_and_raises_no_MAC_Reset) {
    Receiver r{recipe()};
    r.b.write(r.at(cs::command), cs::kIgnoreCyclic);
    r.b.go_offline();
    EXPECT_EQ(r.state(), chip::CsState::stopped);
    EXPECT_EQ(r.b.irr() & irq::clock_sync, 0) << "bit 0 is Clock_Sync now";
    r.set_interval(0x0102);
    EXPECT_EQ(r.state(), chip::CsState::stopped) << "Offline the buffer is plain RAM";
}

TEST_P(ChecksClockSync, without_CS_Supported_the_telegrams_and_the_buffer_mean_nothing) {
    Bench b{recipe(), Stage::p2};
    b.write(kBase2k + cs::interval_high, 0x03);
    b.write(kBase2k + cs::interval_low, 0xE8);
    b.write(kBase2k + cs::command, 0xFF);
    EXPECT_EQ(b.peek(kBase2k + cs::command), 0xFF);
    tell(b, kTimeEvent);
    tell(b, kClockValue);
    EXPECT_EQ(b.irr(), 0);
}

TEST_P(ChecksClockSync, the_telegrams_may_carry_SAP_octets_or_come_as_SD2) {
    Receiver r{recipe()};
    r.b.tell(Stimulus{telegram(0x7F, 2, 0x40, hex("00")), {}, {}});
    r.b.run(2_clk);
    r.b.tell(Stimulus{telegram(0xFF, 0x82, 0xC0, hex("3B 3E C3 12 34 56 80 00 00 00 C3 12 34 4C 80 00 00 00 00 01")), {}, {}});
    r.b.run(2_clk);
    EXPECT_EQ(r.status(), cs::kSetTime);
    EXPECT_EQ(r.time(), kTime1);
}

}  // namespace
}  // namespace dpchip::checks
