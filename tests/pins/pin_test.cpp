// SPDX-License-Identifier: Apache-2.0
// The table of pins against the manuals' figures.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include <dpchip/pins/pin.hpp>

namespace {

using namespace dpchip;
using pins::InputType;
using pins::OutputStage;
using pins::PinDirection;
using pins::PinId;
using pins::PinInfo;
using regmap::ProcessorMode;

std::string printed_direction(const PinInfo& p) {
    if (p.direction == PinDirection::supply) return "-";
    if (p.direction == PinDirection::output) return "O";
    if (p.direction == PinDirection::bidirectional) return "I(C)/O";
    if (p.id == PinId::ab9 || p.id == PinId::mode) return "I";  // the figure leaves the type open; the model takes CMOS
    switch (p.input) {
    case InputType::cmos: return "I(C)";
    case InputType::cmos_schmitt: return "I(CS)";
    case InputType::cmos_pulldown: return "I(CPD)";
    case InputType::ttl_schmitt: return "I(TS)";
    case InputType::none: break;
    }
    return "?";
}

std::string printed_stage(OutputStage stage) {
    return stage == OutputStage::none ? "-" : stage == OutputStage::tristate ? "tristate" : "push/pull";
}

std::string number_or_dash(unsigned n) { return n == 0 ? "-" : std::to_string(n); }

// proves: VPC3C 3.1-01, VPC3C 3.1-12..50, VPC3C 8.1.2-02, VPC3C 8.1.2-07..19, VPC3C 10.4-02..08, APC3 1-04, APC3 2.1-01, APC3 2.1-04..42, E076
TEST(PinTable, Is_the_one_that_the_manuals_print) {
    std::ifstream file{DPCHIP_SOURCE_DIR "/tests/pins/pins.txt"};
    unsigned rows = 0;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::istringstream words{line};
        unsigned number{};
        char bar{};
        std::string name, apc3, direction, stage, drive, load;
        words >> number >> bar >> name >> bar >> apc3 >> bar >> direction >> bar >> stage >> bar >> drive >> bar >> load;
        ASSERT_TRUE(words && pins::is_pin(number)) << line;
        const PinInfo& p = pins::info(static_cast<PinId>(number));
        EXPECT_EQ(p.number(), number);
        EXPECT_EQ(p.name, name);
        EXPECT_EQ(p.apc3_name, apc3);
        EXPECT_EQ(printed_direction(p), direction) << line;
        EXPECT_EQ(printed_stage(p.output), stage) << line;
        EXPECT_EQ(number_or_dash(p.drive_ma), drive) << line;
        EXPECT_EQ(number_or_dash(p.load_pf), load) << line;
        ++rows;
    }
    EXPECT_EQ(rows, 44u);
}

// proves: VPC3C 3.2-01, APC3 2.2-01
TEST(PinTable, Counts_44_pins_with_every_signal_once) {
    std::set<std::string_view> names;
    int supplies = 0;
    for (const PinInfo& p : pins::kPinTable) {
        if (p.direction == PinDirection::supply) {
            ++supplies;
            continue;
        }
        EXPECT_TRUE(names.insert(p.name).second) << p.name;
        EXPECT_EQ(pins::pin_from_name(p.name), p.id);
    }
    EXPECT_EQ(supplies, 6) << "four VSS, two VDD";
    EXPECT_EQ(names.size(), 38u);
    EXPECT_FALSE(pins::pin_from_name("AB12"));
    EXPECT_FALSE(pins::pin_from_name("VSS")) << "there are several";
}

// proves: VPC3C 3.1-10
TEST(PinTable, AB11_is_on_the_pin_that_the_mode_leaves_free) {
    EXPECT_EQ(pins::ab11_pin(ProcessorMode::sync_intel), PinId{1});
    EXPECT_EQ(pins::ab11_pin(ProcessorMode::async_intel), PinId{24});
    EXPECT_EQ(pins::ab11_pin(ProcessorMode::async_motorola), PinId{2});
    EXPECT_EQ(pins::ab11_pin(ProcessorMode::sync_motorola), PinId{24});
    for (const pins::BusPinFunctions& f : pins::kBusPinFunctions)
        for (std::size_t mode = 0; mode < regmap::kProcessorModes; ++mode) {
            const bool free = f.with_2k[mode].starts_with("unused");
            EXPECT_EQ(free, pins::ab11_pin(static_cast<ProcessorMode>(mode)) == f.pin);
            EXPECT_EQ(f.with_4k[mode], free ? "AB11" : f.with_2k[mode]);
        }
}

TEST(PinTable, The_straps_select_the_modes_of_figure_8_1) {
    EXPECT_EQ(regmap::processor_mode(false, true), ProcessorMode::sync_intel);
    EXPECT_EQ(regmap::processor_mode(false, false), ProcessorMode::async_intel);
    EXPECT_EQ(regmap::processor_mode(true, false), ProcessorMode::async_motorola);
    EXPECT_EQ(regmap::processor_mode(true, true), ProcessorMode::sync_motorola);
}

}  // namespace
