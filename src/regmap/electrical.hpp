// SPDX-License-Identifier: Apache-2.0
// Ratings, levels and dimensions as data (VPC3+C manual 10.1 to 10.6 and 10.8; APC3 manual 1 and 7, dimensions from its Chinese
// edition; hardware reference 10). Output cells and loads stand in the table of pins, bus timing in bus_timing.hpp.
//
// The model has no volts: nothing here changes what it does. Figures are printed, by `dpchip regs --electrical`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <dpchip/regmap/processor_mode.hpp>
#include <dpchip/regmap/variant.hpp>

namespace dpchip::regmap {

/// A figure in thousandths of its unit, alone or in relation to the supply.
struct Figure {
    enum class Kind : std::uint8_t { none, absolute, plus_minus, times_supply, supply_plus };
    Kind kind{};
    std::int32_t milli{};
    bool operator==(const Figure&) const = default;
};

/// One line of a table of figures.
struct ElectricalRow {
    std::string_view symbol, parameter;
    Figure min{}, typ{}, max{};
    std::string_view unit;
};

/// Dimensions in micrometres, the angle in thousandths of a degree.
struct Dimension {
    std::string_view symbol, meaning;
    Figure vpc3c_min{}, vpc3c_nom{}, vpc3c_max{};
    Figure apc3_min{}, apc3_nom{}, apc3_max{};
};

namespace detail {
consteval Figure abs(std::int32_t milli) { return {Figure::Kind::absolute, milli}; }
consteval Figure pm(std::int32_t milli) { return {Figure::Kind::plus_minus, milli}; }
consteval Figure times(std::int32_t milli) { return {Figure::Kind::times_supply, milli}; }
consteval Figure plus(std::int32_t milli) { return {Figure::Kind::supply_plus, milli}; }
inline constexpr Figure no{};
}  // namespace detail

// clang-format off
/// Figure 10-1.
inline constexpr std::array<ElectricalRow, 4> kMaximumRatings = [] {
    using namespace detail;
    return std::array<ElectricalRow, 4>{{
    {"VDD",    "DC supply voltage",   abs(-300),    no, abs(6'000),   "V"},
    {"VI",     "Input voltage",       abs(-300),    no, plus(300),    "V"},
    {"VO",     "Output voltage",      abs(-300),    no, plus(300),    "V"},
    {"Tstore", "Storage temperature", abs(-40'000), no, abs(125'000), "C"},
    }};
}();

/// Figure 10-2. The static current counts with the clock stopped and inputs at the rails.
inline constexpr std::array<ElectricalRow, 8> kOperatingConditions = [] {
    using namespace detail;
    return std::array<ElectricalRow, 8>{{
    {"VDD", "DC supply voltage",          abs(3'000),   no, abs(5'500),  "V"},
    {"IDD", "Static supply current",      no,           no, abs(100'000),"uA"},
    {"VSS", "Circuit ground",             abs(0),       no, abs(0),      "V"},
    {"VI",  "Input voltage",              abs(0),       no, plus(0),     "V"},
    {"VIH", "Input voltage (HIGH level)", times(700),   no, plus(0),     "V"},
    {"VIL", "Input voltage (LOW level)",  abs(0),       no, times(300),  "V"},
    {"VO",  "Output voltage",             abs(0),       no, plus(0),     "V"},
    {"TA",  "Ambient temperature",        abs(-40'000), no, abs(85'000), "C"},
    }};
}();

/// Figure 10-3.
inline constexpr std::array<ElectricalRow, 9> kGeneralDc = [] {
    using namespace detail;
    return std::array<ElectricalRow, 9>{{
    {"IIL",  "Input LOW current",                abs(-1'000),  no,          abs(1'000),  "uA"},
    {"IIH",  "Input HIGH current",               abs(-1'000),  no,          abs(1'000),  "uA"},
    {"IOZ",  "Tristate leakage current",         abs(-10'000), no,          abs(10'000), "uA"},
    {"IA",   "Current consumption at 3.3 V",     no,           abs(36'000), no,          "mA"},
    {"IA",   "Current consumption at 5 V",       no,           abs(72'000), no,          "mA"},
    {"CIN",  "Input capacitance",                no,           abs(5'000),  no,          "pF"},
    {"COUT", "Output capacitance",               no,           abs(5'000),  no,          "pF"},
    {"CBID", "Bidirectional buffer capacitance", no,           abs(5'000),  no,          "pF"},
    {"RthJA","Thermal resistance",               no,           abs(52'600), no,          "K/W"},
    }};
}();

inline constexpr std::size_t kDcRows = 16;

/// Figure 10-5.
inline constexpr std::array<ElectricalRow, kDcRows> kDc5V = [] {
    using namespace detail;
    return std::array<ElectricalRow, kDcRows>{{
    {"VCC",  "DC supply voltage",                              abs(4'500),   abs(5'000), abs(5'500),  "V"},
    {"VILC", "CMOS input voltage LOW level",                   abs(0),       no,         times(300),  "V"},
    {"VIHC", "CMOS input voltage HIGH level",                  times(700),   no,         plus(0),     "V"},
    {"VOL",  "Output voltage LOW level",                       no,           no,         abs(400),    "V"},
    {"VOH",  "Output voltage HIGH level",                      abs(3'500),   no,         no,          "V"},
    {"VT-",  "CMOS Schmitt trigger, negative going threshold", abs(1'500),   abs(1'800), no,          "V"},
    {"VT+",  "CMOS Schmitt trigger, positive going threshold", no,           abs(3'200), abs(3'500),  "V"},
    {"VT-",  "TTL Schmitt trigger, negative going threshold",  abs(900),     abs(1'100), no,          "V"},
    {"VT+",  "TTL Schmitt trigger, positive going threshold",  no,           abs(1'900), abs(2'100),  "V"},
    {"IIL",  "Input LOW current",                              abs(-1'000),  no,         abs(1'000),  "uA"},
    {"IIH",  "Input HIGH current",                             abs(-1'000),  no,         abs(1'000),  "uA"},
    {"IOZ",  "Tristate leakage current",                       abs(-10'000), pm(1'000),  abs(10'000), "uA"},
    {"IOL",  "Output current LOW level, 4 mA cell",            abs(4'000),   no,         no,          "mA"},
    {"IOH",  "Output current HIGH level, 4 mA cell",           abs(-4'000),  no,         no,          "mA"},
    {"IOL",  "Output current LOW level, 8 mA cell",            abs(8'000),   no,         no,          "mA"},
    {"IOH",  "Output current HIGH level, 8 mA cell",           abs(-8'000),  no,         no,          "mA"},
    }};
}();

/// Figure 10-6: output currents are 70 % of those at 5 V.
inline constexpr std::array<ElectricalRow, kDcRows> kDc3V3 = [] {
    using namespace detail;
    return std::array<ElectricalRow, kDcRows>{{
    {"VCC",  "DC supply voltage",                              abs(3'000),   abs(3'300), abs(3'600),  "V"},
    {"VILC", "CMOS input voltage LOW level",                   abs(0),       no,         times(300),  "V"},
    {"VIHC", "CMOS input voltage HIGH level",                  times(700),   no,         plus(0),     "V"},
    {"VOL",  "Output voltage LOW level",                       no,           no,         abs(400),    "V"},
    {"VOH",  "Output voltage HIGH level",                      abs(2'400),   no,         no,          "V"},
    {"VT-",  "CMOS Schmitt trigger, negative going threshold", abs(800),     no,         no,          "V"},
    {"VT+",  "CMOS Schmitt trigger, positive going threshold", no,           no,         abs(2'700),  "V"},
    {"VT-",  "TTL Schmitt trigger, negative going threshold",  abs(600),     no,         no,          "V"},
    {"VT+",  "TTL Schmitt trigger, positive going threshold",  no,           no,         abs(1'700),  "V"},
    {"IIL",  "Input LOW current",                              abs(-1'000),  no,         abs(1'000),  "uA"},
    {"IIH",  "Input HIGH current",                             abs(-1'000),  no,         abs(1'000),  "uA"},
    {"IOZ",  "Tristate leakage current",                       abs(-10'000), pm(1'000),  abs(10'000), "uA"},
    {"IOL",  "Output current LOW level, 4 mA cell",            abs(2'800),   no,         no,          "mA"},
    {"IOH",  "Output current HIGH level, 4 mA cell",           abs(-2'800),  no,         no,          "mA"},
    {"IOL",  "Output current LOW level, 8 mA cell",            abs(5'600),   no,         no,          "mA"},
    {"IOH",  "Output current HIGH level, 8 mA cell",           abs(-5'600),  no,         no,          "mA"},
    }};
}();

/// All that the APC3 manual says.
inline constexpr std::array<ElectricalRow, 4> kApc3Ratings = [] {
    using namespace detail;
    return std::array<ElectricalRow, 4>{{
    {"VDD",    "Supply voltage",       no,           abs(3'300), no,           "V"},
    {"Tstore", "Storage temperature",  abs(-65'000), no,         abs(150'000), "C"},
    {"TA",     "Ambient temperature",  abs(-40'000), no,         abs(85'000),  "C"},
    {"TJ",     "Junction temperature", abs(-40'000), no,         abs(85'000),  "C"},
    }};
}();

/// 44-pin PQFP: figure 10-22, and table 7.1 of the APC3 manual's Chinese edition. Millimetres; the angle in degrees.
inline constexpr std::array<Dimension, 15> kPackageDimensions = [] {
    using namespace detail;
    return std::array<Dimension, 15>{{
    {"A",     "total height",      no,          no,          abs(2'700),  no,          no,          abs(2'350)},
    {"A1",    "stand-off",         abs(250),    no,          abs(350),    abs(50),     no,          abs(150)},
    {"A2",    "body height",       abs(1'800),  abs(2'000),  abs(2'200),  abs(2'050),  abs(2'100),  abs(2'150)},
    {"A3",    "",                  no,          no,          no,          abs(950),    abs(1'000),  abs(1'050)},
    {"b",     "lead width",        abs(220),    abs(300),    abs(380),    abs(280),    no,          abs(360)},
    {"b1",    "base metal width",  no,          no,          no,          abs(270),    abs(300),    abs(330)},
    {"c",     "lead thickness",    abs(100),    abs(150),    abs(200),    abs(150),    no,          abs(190)},
    {"c1",    "",                  no,          no,          no,          abs(140),    abs(150),    abs(160)},
    {"e",     "pitch",             no,          abs(800),    no,          no,          abs(800),    no},
    {"D, E",  "over leads",        abs(13'700), abs(13'900), abs(14'100), abs(13'000), abs(13'200), abs(13'400)},
    {"D1, E1","body",              abs(9'900),  abs(10'000), abs(10'100), abs(9'900),  abs(10'000), abs(10'100)},
    {"eB",    "",                  no,          no,          no,          abs(11'590), no,          abs(11'890)},
    {"L",     "foot length",       abs(730),    abs(880),    abs(930),    abs(780),    no,          abs(980)},
    {"L1",    "lead length",       no,          abs(1'950),  no,          no,          abs(1'600),  no},
    {"angle", "of the foot",       abs(0),      no,          abs(7'000),  abs(0),      no,          abs(7'000)},
    }};
}();
// clang-format on

}  // namespace dpchip::regmap
