// SPDX-License-Identifier: Apache-2.0
// The TLM target socket: what the standard demands of a target, one 8-bit cycle for each enabled byte, debug by peek; and
// the conversion of time.
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "tlm/simulation.hpp"

namespace dpchip::tlm::test {

namespace {

constexpr auto kOk = ::tlm::TLM_OK_RESPONSE;
constexpr auto kRead = ::tlm::TLM_READ_COMMAND;
constexpr auto kWrite = ::tlm::TLM_WRITE_COMMAND;

/// Runs `program` as the processor of a single chip at this place.
void with_chip(const BusWindow& window, const std::function<void(Board&)>& program, DataFormat format = DataFormat::intel) {
    simulate([&] {
        ChipSettings settings;
        settings.window = window;
        settings.format = format;
        Board board{"board", settings};
        bool ended = false;
        board.program = [&] {
            program(board);
            ended = true;
        };
        sc_core::sc_start(ms(20));
        EXPECT_TRUE(ended) << "the program came to its end";
    });
}

// ---- time --------------------------------------------------------------------------------------------------------

constexpr std::uint64_t kPs = 1'000'000'000'000;

TEST(TlmTime, a_tick_is_converted_with_an_error_under_one_picosecond_after_any_time) {
    constexpr Ticks day = 24ll * 3600 * 60'000'000'000;
    for (const Ticks from : {Ticks{0}, day, 100 * day, 213 * day})
        for (Ticks t = from; t < from + 3000; ++t) {
            const std::uint64_t units = detail::units_from_ticks(t, kPs);
            // units is the least with units * 60 >= ticks * 1000: less than one unit late, never early.
            ASSERT_GE(static_cast<detail::Wide>(units) * 60, static_cast<detail::Wide>(t) * 1000);
            ASSERT_LT(static_cast<detail::Wide>(units) * 60, static_cast<detail::Wide>(t) * 1000 + 60);
            ASSERT_EQ(detail::ticks_from_units(units, kPs), t) << "and back";
        }
}

TEST(TlmTime, what_has_happened_by_a_tick_has_happened_by_its_time_in_every_resolution) {
    for (const std::uint64_t units_per_s : {std::uint64_t{1}, std::uint64_t{1'000}, std::uint64_t{1'000'000'000}, kPs, 1000 * kPs})
        for (Ticks t = 1; t < 1'000'000'000'000; t = 3 * t + 1)
            ASSERT_GE(detail::ticks_from_units(detail::units_from_ticks(t, units_per_s), units_per_s), t);
}

TEST(TlmTime, the_ends_of_time_are_kept) {
    EXPECT_EQ(detail::units_from_ticks(0, kPs), 0u);
    EXPECT_EQ(detail::units_from_ticks(kNever - 1, 1000 * kPs), std::numeric_limits<std::uint64_t>::max());
    EXPECT_EQ(detail::ticks_from_units(std::numeric_limits<std::uint64_t>::max(), 1'000), kNever - 1);
    simulate([] {
        EXPECT_EQ(to_sc_time(kNever), sc_core::sc_max_time());
        EXPECT_EQ(to_sc_time(60), ns(1));
        EXPECT_EQ(to_sc_time(1250), sc_time::from_value(20'834)) << "one CLK, 20833.33 ps";
        EXPECT_EQ(to_ticks(sc_time::from_value(20'834)), 1250);
        EXPECT_EQ(to_ticks(sc_time::from_value(20'833)), 1249);
    });
}

// ---- where the chip lies -----------------------------------------------------------------------------------------

TEST(TlmBusWindow, mirrors_and_strides_follow_the_wiring) {
    constexpr BusWindow plain{0x8000, 0x1000, 0xFFF, 1}, mirrored{0, 0x10000, 0x7FF, 1}, words{0x400, 0x2000, 0x1FFF, 2};
    EXPECT_EQ(plain.chip_address(0x8016), 0x16);
    EXPECT_TRUE(plain.holds(0x8FFF, 1));
    EXPECT_FALSE(plain.holds(0x8FFF, 2));
    EXPECT_FALSE(plain.holds(0x7FFF, 1));
    EXPECT_FALSE(plain.holds(0x8000, std::numeric_limits<std::uint64_t>::max()));
    EXPECT_EQ(mirrored.chip_address(0x1816), 0x16);
    EXPECT_EQ(words.chip_address(0x42C), 0x16);
    EXPECT_TRUE(words.selects(0x42C));
    EXPECT_FALSE(words.selects(0x42D));
}

TEST(TlmBus, a_chip_sits_at_its_base_address) {
    with_chip({0x40000000, 0x1000, 0xFFF, 1}, [](Board& b) {
        b.write(0x40000100, 0x5A);
        EXPECT_EQ(b.chip.peek(0x100), 0x5A);
        std::uint8_t value = 0;
        EXPECT_EQ(b.transport(kRead, 0x100, &value, 1), ::tlm::TLM_ADDRESS_ERROR_RESPONSE);
        EXPECT_EQ(b.transport(kRead, 0x40001000, &value, 1), ::tlm::TLM_ADDRESS_ERROR_RESPONSE);
    });
}

TEST(TlmBus, with_a_word_stride_every_second_octet_is_the_chip) {
    with_chip({0, 0x2000, 0x1FFF, 2}, [](Board& b) {
        std::array<std::uint8_t, 4> words{0x11, 0xAA, 0x22, 0xBB};
        EXPECT_EQ(b.transport(kWrite, 0x200, words.data(), 4), kOk);
        EXPECT_EQ(sc_core::sc_time_stamp() + b.delay, ns(250)) << "two cycles of the chip";
        EXPECT_EQ(b.chip.peek(0x100), 0x11);
        EXPECT_EQ(b.chip.peek(0x101), 0x22);
        EXPECT_EQ(b.transport(kRead, 0x200, words.data(), 4), kOk);
        EXPECT_EQ(words, (std::array<std::uint8_t, 4>{0x11, 0xFF, 0x22, 0xFF})) << "nobody drives the upper half";
    });
}

TEST(TlmBus, the_Motorola_format_swaps_the_octets_of_the_word_registers) {
    with_chip({}, [](Board& b) {
        b.write(0x05, 0x0F);  // IntMask-Reg low octet
        EXPECT_EQ(dpchip_chip_set_bus_mode(b.chip.handle(), DPCHIP_INTEL), DPCHIP_OK);
        b.chip.changed();
        b.write(0x00, 0xF0);
        EXPECT_EQ(b.read(0x02), 0xF0) << "the requests 10H..80H pass the mask";
    }, DataFormat::motorola);
}

// ---- the generic payload -----------------------------------------------------------------------------------------

TEST(TlmBus, every_byte_is_one_cycle_and_the_time_is_annotated_not_waited) {
    with_chip({}, [](Board& b) {
        std::array<std::uint8_t, 8> data{1, 2, 3, 4, 5, 6, 7, 8};
        b.write(0x100, 0);
        EXPECT_EQ(b.delay, ns(125));
        EXPECT_EQ(sc_core::sc_time_stamp(), sc_core::SC_ZERO_TIME);
        EXPECT_EQ(b.transport(kWrite, 0x100, data.data(), 8), kOk);
        EXPECT_EQ(sc_core::sc_time_stamp() + b.delay, ns(9 * 125));
        data.fill(0);
        EXPECT_EQ(b.transport(kRead, 0x100, data.data(), 8), kOk);
        EXPECT_EQ(sc_core::sc_time_stamp() + b.delay, ns(17 * 125));
        EXPECT_EQ(data, (std::array<std::uint8_t, 8>{1, 2, 3, 4, 5, 6, 7, 8}));
    });
}

TEST(TlmBus, a_read_command_acts_once_for_each_read) {
    with_chip({}, [](Board& b) {
        b.set_up();
        EXPECT_EQ(b.read(0x0B) & 4, 4) << "the cleared outputs of Start";
        EXPECT_EQ(b.read(0x0B) & 4, 0) << "are fetched once";
    });
}

struct BadPayload {
    const char* what;
    std::function<void(::tlm::tlm_generic_payload&)> spoil;
    ::tlm::tlm_response_status answer;
};

TEST(TlmBus, what_the_standard_forbids_is_refused_with_its_own_status_and_without_any_effect) {
    static unsigned char strange[] = {0xFF, 0x01};
    const BadPayload bad[] = {
        {"no length", [](auto& p) { p.set_data_length(0); }, ::tlm::TLM_BURST_ERROR_RESPONSE},
        {"no streaming width", [](auto& p) { p.set_streaming_width(0); }, ::tlm::TLM_BURST_ERROR_RESPONSE},
        {"no data", [](auto& p) { p.set_data_ptr(nullptr); }, ::tlm::TLM_GENERIC_ERROR_RESPONSE},
        {"byte enables without a length", [](auto& p) { p.set_byte_enable_ptr(strange); }, ::tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE},
        {"a byte enable that is neither", [](auto& p) { p.set_byte_enable_ptr(strange); p.set_byte_enable_length(2); }, ::tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE},
        {"an address outside", [](auto& p) { p.set_address(0x1000); }, ::tlm::TLM_ADDRESS_ERROR_RESPONSE},
        {"an end outside", [](auto& p) { p.set_address(0xFFD); }, ::tlm::TLM_ADDRESS_ERROR_RESPONSE},
    };
    with_chip({}, [&](Board& b) {
        b.set_up();
        const auto before = b.memory();
        for (const BadPayload& wrong : bad)
            for (const auto command : {kRead, kWrite}) {
                std::array<std::uint8_t, 4> data{0xC5, 0xC5, 0xC5, 0xC5};
                ::tlm::tlm_generic_payload p;
                p.set_command(command);
                p.set_address(0x0B);
                p.set_data_ptr(data.data());
                p.set_data_length(4);
                p.set_streaming_width(4);
                wrong.spoil(p);
                const sc_time delay = b.delay;
                b.cpu->b_transport(p, b.delay);
                EXPECT_EQ(p.get_response_status(), wrong.answer) << wrong.what;
                EXPECT_EQ(b.delay, delay) << wrong.what;
                EXPECT_EQ(data, (std::array<std::uint8_t, 4>{0xC5, 0xC5, 0xC5, 0xC5})) << wrong.what;
            }
        EXPECT_EQ(b.memory(), before);
    });
}

TEST(TlmBus, an_ignored_command_does_nothing_and_is_all_right) {
    with_chip({}, [](Board& b) {
        std::uint8_t value = 7;
        EXPECT_EQ(b.transport(::tlm::TLM_IGNORE_COMMAND, 0x0B, &value, 1), kOk);
        EXPECT_EQ(value, 7);
        EXPECT_EQ(b.delay, sc_core::SC_ZERO_TIME);
    });
}

TEST(TlmBus, disabled_bytes_are_no_cycles_and_enables_repeat) {
    with_chip({}, [](Board& b) {
        std::array<std::uint8_t, 6> data{1, 2, 3, 4, 5, 6};
        std::array<unsigned char, 4> enables{TLM_BYTE_ENABLED, TLM_BYTE_DISABLED, TLM_BYTE_DISABLED, TLM_BYTE_ENABLED};
        ::tlm::tlm_generic_payload p;
        p.set_command(kWrite);
        p.set_address(0x100);
        p.set_data_ptr(data.data());
        p.set_data_length(6);
        p.set_streaming_width(6);
        p.set_byte_enable_ptr(enables.data());
        p.set_byte_enable_length(4);
        for (std::uint64_t i = 0; i < 6; ++i) b.write(0x100 + i, 0xEE);
        const sc_time before = sc_core::sc_time_stamp() + b.delay;
        b.cpu->b_transport(p, b.delay);
        EXPECT_EQ(p.get_response_status(), kOk);
        EXPECT_EQ(sc_core::sc_time_stamp() + b.delay - before, ns(3 * 125));
        const std::array<std::uint8_t, 6> expected{1, 0xEE, 0xEE, 4, 5, 0xEE};
        for (std::uint16_t i = 0; i < 6; ++i) EXPECT_EQ(b.chip.peek(static_cast<std::uint16_t>(0x100 + i)), expected[i]) << i;
        p.set_read();
        data.fill(0x77);
        b.cpu->b_transport(p, b.delay);
        EXPECT_EQ(data, (std::array<std::uint8_t, 6>{1, 0x77, 0x77, 4, 5, 0x77})) << "disabled bytes of a read are left alone";
    });
}

TEST(TlmBus, a_streaming_transaction_comes_back_to_its_address) {
    with_chip({}, [](Board& b) {
        std::array<std::uint8_t, 5> data{1, 2, 3, 4, 5};
        ::tlm::tlm_generic_payload p;
        p.set_command(kWrite);
        p.set_address(0xFFE);
        p.set_data_ptr(data.data());
        p.set_data_length(5);
        p.set_streaming_width(2);
        b.cpu->b_transport(p, b.delay);
        EXPECT_EQ(p.get_response_status(), kOk) << "two octets fit before the end of the window";
        p.set_address(0x100);
        b.cpu->b_transport(p, b.delay);
        EXPECT_EQ(b.chip.peek(0x100), 5);
        EXPECT_EQ(b.chip.peek(0x101), 4);
        EXPECT_EQ(b.chip.peek(0x102), 0);
    });
}

TEST(TlmBus, there_is_no_direct_memory) {
    with_chip({}, [](Board& b) {
        std::uint8_t value = 0;
        ::tlm::tlm_generic_payload p;
        p.set_command(kRead);
        p.set_address(0x100);
        p.set_data_ptr(&value);
        p.set_data_length(1);
        p.set_streaming_width(1);
        p.set_dmi_allowed(true);
        b.cpu->b_transport(p, b.delay);
        EXPECT_FALSE(p.is_dmi_allowed());
        ::tlm::tlm_dmi dmi;
        EXPECT_FALSE(b.cpu->get_direct_mem_ptr(p, dmi));
        EXPECT_EQ(dmi.get_start_address(), 0u);
        EXPECT_EQ(dmi.get_end_address(), std::numeric_limits<sc_dt::uint64>::max()) << "refused everywhere, so nobody asks again";
    });
}

TEST(TlmBus, a_debugger_reads_everything_and_changes_nothing) {
    with_chip({}, [](Board& b) {
        b.set_up();
        const auto before = b.memory();
        const auto time = sc_core::sc_time_stamp().value();
        std::vector<std::uint8_t> view(0x1000, 0);
        ::tlm::tlm_generic_payload p;
        p.set_command(kRead);
        p.set_address(0);
        p.set_data_ptr(view.data());
        p.set_data_length(0x1000);
        EXPECT_EQ(b.cpu->transport_dbg(p), 0x1000u);
        EXPECT_EQ(std::vector<std::uint8_t>(view.begin(), view.begin() + 2048), before);
        EXPECT_EQ(b.memory(), before) << "Next_Dout_Buffer_Cmd at 0BH has not acted";
        EXPECT_EQ(sc_core::sc_time_stamp().value(), time);
        p.set_address(0xFFE);
        EXPECT_EQ(b.cpu->transport_dbg(p), 2u) << "up to the end of the window";
        p.set_address(0x2000);
        EXPECT_EQ(b.cpu->transport_dbg(p), 0u);
        p.set_address(0x100);
        p.set_write();
        EXPECT_EQ(b.cpu->transport_dbg(p), 0u) << "debug writes are refused";
        EXPECT_EQ(b.memory(), before);
        EXPECT_EQ(b.read(0x0B) & 4, 4) << "the command still finds what Start put there";
    });
}

TEST(TlmBus, findings_are_warnings_of_their_own_type) {
    with_chip({}, [](Board& b) {
        const Reports findings{report::kFinding};
        b.set_up();
        b.write(0x06, 0x00);  // Mode Register 0 while online
        EXPECT_NE(findings.text().find("mode_reg_online"), std::string::npos) << findings.text();
        EXPECT_EQ(findings.text().find("board.chip: "), 0u) << findings.text();
    });
}

TEST(TlmBus, a_chip_that_does_not_exist_is_an_error_of_elaboration) {
    simulate([] {
        const auto refused = [](const ChipSettings& s) {
            try {
                const Board board{sc_core::sc_gen_unique_name("board"), s};
            } catch (const sc_core::sc_report& report) {
                return std::string{report.get_msg()};
            }
            return std::string{};
        };
        ChipSettings s;
        s.variant = "vpc4";
        EXPECT_NE(refused(s).find("vpc4"), std::string::npos);
        s.variant = "apc3";
        s.options = {{"no_such_option", "1"}};
        EXPECT_NE(refused(s).find("no_such_option"), std::string::npos);
        s.options.clear();
        s.window.stride = 0;
        EXPECT_NE(refused(s).find("stride"), std::string::npos);
    });
}

}  // namespace

}  // namespace dpchip::tlm::test
