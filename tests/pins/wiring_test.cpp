// SPDX-License-Identifier: Apache-2.0
// Wiring: a good board has no fault, and each fault is found and named with its pin.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <vector>

#include <dpchip/pins/wiring.hpp>

namespace dpchip::pins {
namespace {

/// Asynchronous Intel with 2 KB, everything right.
Wiring good() {
    static constexpr std::array<std::string_view, 8> kD{"D0", "D1", "D2", "D3", "D4", "D5", "D6", "D7"};
    static constexpr std::array<std::string_view, 11> kA{"A0", "A1", "A2", "A3", "A4", "A5", "A6", "A7", "A8", "A9", "A10"};
    Wiring w;
    for (std::size_t i = 0; i < kD.size(); ++i) w.add(both_ways(kD[i], kDataBus[i]));
    for (std::size_t i = 0; i < kA.size(); ++i) w.add(from(kA[i], kAddressBus[i]));
    for (const PinId pin : {PinId::vss_6, PinId::vss_17, PinId::vss_28, PinId::vss_38}) w.add(on_gnd(pin));
    for (const PinId pin : {PinId::vdd_18, PinId::vdd_39, PinId::xtest0, PinId::xtest1}) w.add(on_vdd(pin));
    return w.add(from("XCS", PinId::xcs_ab11)).add(from("XRD", PinId::xrd_r_w)).add(from("XWR", PinId::xwr_e_clock_ab11)).add(pull_down("1 kOhm", PinId::ale_as_ab11))
        .add(on_gnd(PinId::mode)).add(on_gnd(PinId::xint_mot)).add(on_gnd(PinId::divider)).add(from("48 MHz", PinId::clk)).add(from("RESET", PinId::reset))
        .add(pull_down("1 kOhm", PinId::xcts)).add(from("RxD", PinId::rxd)).add(to("TxD", PinId::txd)).add(pull_up("3.3 kOhm", PinId::txd)).add(to("RTS", PinId::rts))
        .add(to("INT", PinId::x_int)).add(to("READY", PinId::xready_xdtack));
}

struct Mistake {
    std::string what;
    std::function<void(Wiring&)> make;
    std::vector<std::string> words;
};

std::vector<Mistake> mistakes() {
    return {
        {"XTEST0 open", [](Wiring& w) { w.cut(PinId::xtest0); }, {"pin 34 (XTEST0): an input that nothing drives (3.1)"}},
        {"XTEST1 pulled down", [](Wiring& w) { w.cut(PinId::xtest1).add(pull_down("1 kOhm", PinId::xtest1)); }, {"pin 35 (XTEST1): a test pin belongs on VDD (8.4)"}},
        {"XCTS open", [](Wiring& w) { w.cut(PinId::xcts); }, {"pin 33 (XCTS): an input that nothing drives (3.1)"}},
        {"no clock", [](Wiring& w) { w.cut(PinId::clk); }, {"pin 5 (CLK): an input that nothing drives (3.1)"}},
        {"TXD without pull-up", [](Wiring& w) { w.cut(PinId::txd).add(to("TxD", PinId::txd)); },
         {"pin 26 (TXD): without its pull-up the line driver sees no level between transmissions (3.1)"}},
        {"AB7 on two lines", [](Wiring& w) { w.add(from("A15", PinId::ab7)); }, {"pin 31 (AB7), line A7 and A15: driven from two sides"}},
        {"XCS on a line and on GND", [](Wiring& w) { w.add(on_gnd(PinId::xcs_ab11)); }, {"pin 1 (XCS/AB11), line XCS and GND: driven from two sides"}},
        {"X/INT on VDD", [](Wiring& w) { w.add(on_vdd(PinId::x_int)); }, {"pin 9 (X/INT), line VDD: an output, and the board drives it too (3.1)"}},
        {"X/INT and XREADY on one line", [](Wiring& w) { w.cut(PinId::xready_xdtack).add(to("INT", PinId::xready_xdtack)); },
         {"pin 9 (X/INT), line INT, together with pin 14 (XREADY/XDTACK): tied to another output; it is never high-resistance (8.1.2)"}},
        {"D3 missing", [](Wiring& w) { w.cut(PinId::db3); }, {"pin 16 (DB3): the data bus goes both ways (8.1.2)"}},
        {"D3 only listened to", [](Wiring& w) { w.cut(PinId::db3).add(to("D3", PinId::db3)); }, {"pin 16 (DB3): the data bus goes both ways (8.1.2)"}},
        {"VDD forgotten", [](Wiring& w) { w.cut(PinId::vdd_39); }, {"pin 39 (VDD): a supply pin that is not on its rail (3.1)"}},
        {"VSS on VDD as well", [](Wiring& w) { w.add(on_vdd(PinId::vss_6)); }, {"pin 6 (VSS): a supply pin that is not on its rail (3.1)"}},
        {"MODE on a port", [](Wiring& w) { w.cut(PinId::mode).add(from("P1.0", PinId::mode)); }, {"pin 23 (MODE), line P1.0: a strap is static, this one hangs on a line (8.1.2)"}},
        {"ALE on VDD", [](Wiring& w) { w.cut(PinId::ale_as_ab11).add(pull_up("1 kOhm", PinId::ale_as_ab11)); },
         {"pin 24 (ALE/AS/AB11): unused in this mode, and on the wrong rail (8.1.2)"}},
        {"two mistakes", [](Wiring& w) { w.cut(PinId::reset).cut(PinId::rxd); },
         {"pin 30 (RXD): an input that nothing drives (3.1)", "pin 36 (RESET): an input that nothing drives (3.1)"}},
    };
}

std::vector<std::string> words(const Wiring& wiring, bool with_4k = false) {
    std::vector<std::string> all;
    for (const WiringFault& f : wiring.check(with_4k)) all.emplace_back(std::string_view{text(f)});
    return all;
}

TEST(WiringCheck, A_board_that_is_wired_right_has_no_fault) { EXPECT_EQ(words(good()), std::vector<std::string>{}); }

TEST(WiringCheck, Each_mistake_is_found_and_named_with_its_pin) {
    for (const Mistake& m : mistakes()) {
        Wiring w = good();
        m.make(w);
        EXPECT_EQ(words(w), m.words) << m.what;
    }
}

TEST(WiringCheck, An_open_AB10_has_its_pull_down_and_open_outputs_do_no_harm) {
    Wiring w = good();
    w.cut(PinId::ab10).cut(PinId::x_int).cut(PinId::xready_xdtack).cut(PinId::clkout);
    EXPECT_EQ(words(w), std::vector<std::string>{});
    EXPECT_EQ(w.tied(PinId::ab10), PinLevel::low);
}

TEST(WiringCheck, A_resistor_gives_way_to_a_line) {
    Wiring w = good();
    w.add(pull_up("10 kOhm", PinId::xcs_ab11));
    EXPECT_EQ(words(w), std::vector<std::string>{});
    EXPECT_EQ(w.tied(PinId::xcs_ab11), std::nullopt);
    EXPECT_EQ(w.cut(PinId::xcs_ab11).add(pull_up("10 kOhm", PinId::xcs_ab11)).tied(PinId::xcs_ab11), PinLevel::high);
}

// proves: VPC3C 8.1.2-24, E037
TEST(WiringCheck, What_is_unused_depends_on_the_mode_and_on_AB11) {
    struct Case {
        PinLevel xint_mot, mode;
        bool with_4k;
        PinId pin;
        PinLevel wrong;
        bool is_fault;
    };
    constexpr auto L = PinLevel::low, H = PinLevel::high;
    for (const Case& c : {Case{L, H, false, PinId::xcs_ab11, L, true}, Case{L, H, true, PinId::xcs_ab11, L, false}, Case{L, L, false, PinId::ale_as_ab11, H, true},
                          Case{L, L, true, PinId::ale_as_ab11, H, false}, Case{H, L, false, PinId::xwr_e_clock_ab11, H, true}, Case{H, L, true, PinId::xwr_e_clock_ab11, H, false},
                          Case{H, H, false, PinId::ale_as_ab11, H, true}, Case{H, H, true, PinId::ale_as_ab11, H, false}}) {
        const auto tie = [](PinLevel level, PinId pin) { return level == H ? on_vdd(pin) : on_gnd(pin); };
        Wiring w = good();
        w.cut(PinId::xint_mot).cut(PinId::mode).cut(PinId::ale_as_ab11).cut(c.pin);
        if (c.pin != PinId::ale_as_ab11) w.add(from("ALE", PinId::ale_as_ab11));
        w.add(tie(c.xint_mot, PinId::xint_mot)).add(tie(c.mode, PinId::mode)).add(tie(c.wrong, c.pin));
        EXPECT_EQ(w.mode(), regmap::processor_mode(c.xint_mot == H, c.mode == H));
        EXPECT_EQ(words(w, c.with_4k).size(), c.is_fault ? 1u : 0u) << info(c.pin).name << (c.with_4k ? ", 4 KB" : ", 2 KB");
    }
}

TEST(WiringUse, A_line_reaches_its_pins_through_its_inverters_and_nothing_else) {
    Package<> package;
    Wiring w = good();
    w.cut(PinId::ab7).add(from_inverted("A6", PinId::ab7)).add(to_inverted("INTR", PinId::x_int));
    w.tie(package);
    const WiredLine a6 = w.line("A6");
    EXPECT_EQ(a6.pins(), 2u);
    for (const PinLevel level : {PinLevel::high, PinLevel::low}) {
        a6.drive(package, level);
        EXPECT_EQ(package.pin(PinId::ab6), level);
        EXPECT_NE(package.pin(PinId::ab7), level);
        EXPECT_EQ(a6.level(package), level);
    }
    EXPECT_EQ(w.line("INT").level(package), PinLevel::high);
    EXPECT_EQ(w.line("INTR").level(package), PinLevel::low);
    EXPECT_FALSE(w.line("A20").connected());
    EXPECT_EQ(w.line("A20").level(package), PinLevel::z);
    EXPECT_FALSE(w.line("1 kOhm").connected()) << "a resistor is no line";
    w.line("A20").drive(package, PinLevel::high);
}

TEST(WiringUse, Straps_take_their_levels_and_open_inputs_float) {
    Package<> package;
    Wiring w = good();
    w.cut(PinId::mode).add(pull_up("3.3 kOhm", PinId::mode)).cut(PinId::xcts).cut(PinId::txd);
    w.tie(package);
    EXPECT_EQ(package.mode(), ProcessorMode::sync_intel);
    EXPECT_EQ(package.pin(PinId::xcts), PinLevel::z);
    EXPECT_EQ(package.pin(PinId::txd), PinLevel::z) << "no pull-up";
    ASSERT_EQ(package.findings().size(), 1u);
    const core::Finding f = package.findings().pop();
    EXPECT_EQ(f.rule, core::to_underlying(regmap::PinRule::floating_input));
    EXPECT_EQ(f.detail, core::to_underlying(PinId::xcts));
}

TEST(WiringText, APC3_has_its_own_names) {
    Wiring w = good();
    w.cut(PinId::xcs_ab11);
    EXPECT_EQ(std::string_view{text(*w.check().begin(), Variant::apc3)}, "pin 1 (XCS): an input that nothing drives (3.1)");
}

}  // namespace
}  // namespace dpchip::pins
