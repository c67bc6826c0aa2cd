// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <set>

#include <dpchip/chip/chip.hpp>
#include <dpchip/regmap/address.hpp>
#include <dpchip/regmap/pin_rules.hpp>
#include <dpchip/trace/fact_text.hpp>

namespace dpchip::trace {
namespace {

using namespace core::literals;
using regmap::Fact;
using regmap::Variant;

core::TraceRecord fact(Fact what, std::uint16_t a, std::uint32_t b, core::Ticks at = {}) {
    return {at, static_cast<std::uint16_t>(what), a, b};
}

struct Row { Fact what; std::uint16_t a; std::uint32_t b; const char* words; };

class FactReads : public testing::TestWithParam<Row> {};

TEST_P(FactReads, InTheManualsWords) {
    const Row& r = GetParam();
    EXPECT_EQ(fact_words(fact(r.what, r.a, r.b), Variant::vpc3c), r.words);
}

INSTANTIATE_TEST_SUITE_P(Each, FactReads, testing::Values(
    Row{Fact::reset, 0, 0, "reset"},
    Row{Fact::cpu_read, 0x0B, 0x07, "cpu_read 00BH Next_Dout_Buffer_Cmd = 07H"},
    Row{Fact::cpu_write, 0x04, 0xFF, "cpu_write 004H IntMask-Reg 7..0 = FFH"},
    Row{Fact::cpu_write, 0x123, 0x01, "cpu_write 123H RAM = 01H"},
    Row{Fact::irr, 0x0000, 0x2008, "irr 0000H -> 2008H +WD_DP_CONTROL_Timeout +DX_Out"},
    Row{Fact::irr, 0x2000, 0x0000, "irr 2000H -> 0000H -DX_Out"},
    Row{Fact::x_int, 0, 0, "x_int low"}, Row{Fact::rts, 0, 1, "rts high"}, Row{Fact::passive_idle, 0, 1, "passive_idle Passive_Idle"},
    Row{Fact::dp_state, 0, 1, "dp_state WAIT-PRM -> WAIT-CFG"}, Row{Fact::wd_state, 0, 2, "wd_state BAUD_SEARCH -> DP_CONTROL"},
    Row{Fact::baud, 0, 8, "baud 19.2 kbit/s"}, Row{Fact::baud, 0, 15, "baud searching"},
    Row{Fact::heard, 0x8882, 0x6D3C3E00, "heard 2->8 FC 6DH SRD high DSAP 60 Slave_Diag SSAP 62, 0 octets"},
    Row{Fact::heard, 0x0802, 0x7DFFFF02, "heard 2->8 FC 7DH SRD high, 2 octets"},
    Row{Fact::rejected, 5, 9, "rejected wrong FCS after 9 octets"},
    Row{Fact::answer, 0xE500, 1, "answer SC"}, Row{Fact::answer, 0x0882, 17, "answer DL to 2, 17 octets"},
    Row{Fact::dout_buffer_sm, 0xE1, 0x2D, "Dout_Buffer_SM E1H -> 2DH (F=0 U=2 N=3 D=1)"},
    Row{Fact::exchange, 61, 0x1517, "exchange Set_Prm: aux now 15H, target 17H"},
    Row{Fact::leave_master, 5, 0, "leave_master watchdog"}, Row{Fact::diag_flag, 0, 1, "diag_flag 1"},
    Row{Fact::finding, 4, 0x0C40, "finding iar_protected 0C40H: IAR does not clear New_Prm_Data, New_Ext_Prm_Data and New_Cfg_Data (5.3.2)"},
    Row{Fact::finding, 999, 0, "finding rule 999"}, Row{Fact::leave_master, 99, 0, "leave_master ?"}, Row{Fact::rejected, 99, 0, "rejected ? after 0 octets"},
    Row{Fact::count, 0, 0, "fact 35"},
    Row{Fact::pin_finding, 0, regmap::pack({16, regmap::Supply::v5, core::Ticks{-1}}),
        "pin_finding timing 16, address set-up before XRD or XWR: -0.016 ns, at least 0 ns (5 V, figure 10-14)"},
    Row{Fact::pin_finding, 4, 30, "pin_finding floating_input at pin 30: an input without pull-down is not driven: its last level is kept (3.1)"}, Row{Fact::ram_wait, 0, 7, "ram_wait 7 CLK in all"}));

TEST(FactText, HasADifferentNameForEveryFact) {
    std::set<std::string> names;
    for (unsigned i = 0; i < static_cast<unsigned>(Fact::count); ++i) {
        const std::string words = fact_words(fact(static_cast<Fact>(i), 0, 0), Variant::apc3);
        names.insert(words.substr(0, words.find(' ')));
    }
    EXPECT_EQ(names.size(), static_cast<std::size_t>(Fact::count));
}

TEST(FactText, NamesInterruptBit0ByWhatModeRegister0Says) {
    FactText text{Variant::vpc3c};
    EXPECT_NE(text.line(fact(Fact::irr, 0, 1)).find("+MAC_Reset"), std::string::npos);
    text.line(fact(Fact::cpu_write, regmap::control::mode_reg0_low, regmap::mode0::cs_supported));
    EXPECT_NE(text.line(fact(Fact::irr, 0, 1)).find("+Clock_Sync"), std::string::npos);
    text.line(fact(Fact::reset, 0, 0));
    EXPECT_NE(text.line(fact(Fact::irr, 0, 1)).find("+MAC_Reset"), std::string::npos);
    EXPECT_EQ(fact_words(fact(Fact::heard, 0x7F02, 0xC0FFFF12), Variant::vpc3c), "heard 2->127 FC C0H Clock_Value, 18 octets");
}

TEST(FactText, TellsAnyTwoTicksApart) {
    std::set<std::string> seen;
    for (std::int64_t n = -120; n < 120; ++n) seen.insert(time_text({n}));
    EXPECT_EQ(seen.size(), 240u);
    EXPECT_EQ(time_text(core::kClk), "20.833 ns");
    EXPECT_EQ(time_text(5_ms), "5000000.000 ns");
}

TEST(FactText, CountsBitTimesFromTheEndOfTheTelegramHeard) {
    FactText text{Variant::vpc3c};
    const core::Ticks bit = fdl::baud(fdl::BaudCode::mbit_1_5).bit;
    EXPECT_EQ(text.line(fact(Fact::passive_idle, 0, 1, 1_us)), "         1000.000 ns            - tBit  passive_idle Passive_Idle");
    text.line(fact(Fact::baud, 0, 3, 2_us));
    EXPECT_EQ(text.line(fact(Fact::heard, 0x0802, 0x49FFFF00, 3_us)), "         3000.000 ns        +0.00 tBit  heard 2->8 FC 49H FDL_Status, 0 octets");
    EXPECT_EQ(text.line(fact(Fact::answer, 0x0002, 6, 3_us + 11 * bit)), "        10333.333 ns       +11.00 tBit  answer OK to 2, 6 octets");
    EXPECT_EQ(text.line(fact(Fact::rts, 0, 0, 3_us + 11 * bit + core::kClk)), "        10354.166 ns       +11.03 tBit  rts low");
}

TEST(FactText, RendersWhatAChipReallyTraces) {
    chip::Chip<> chip;
    std::array<core::TraceRecord, 4096> ring{};
    chip.trace().attach(ring);
    for (std::uint16_t a = 0x16; a < 0x40; ++a) chip.write(a, static_cast<std::uint8_t>(a));
    chip.write(regmap::control::mode_reg1_s, regmap::mode1::start_vpc3);
    chip.advance(1_s);
    FactText text{Variant::vpc3c};
    const auto count = std::min<std::uint64_t>(chip.trace().count, ring.size());
    ASSERT_GT(count, 40u);
    bool idle = false, probe = false;
    for (std::size_t i = 0; i < count; ++i) {
        const std::string line = text.line(ring[i]);
        EXPECT_EQ(line.find('?'), std::string::npos) << line;
        idle = idle || line.find("passive_idle Passive_Idle") != std::string::npos;
        probe = probe || line.find("baud_probe 6 Mbit/s") != std::string::npos;
    }
    EXPECT_TRUE(idle);
    EXPECT_TRUE(probe);
}

}  // namespace
}  // namespace dpchip::trace
