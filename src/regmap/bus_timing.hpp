// SPDX-License-Identifier: Apache-2.0
// Bus timing as data: the 59 numbered parameters and the unnumbered ones (VPC3+C manual 10.7; hardware reference 4 to 6).
//
// Checks are what the processor owes the chip, promises what the chip owes the processor. The manual prints only some of
// the edges between which a time counts; the others follow from the parameter's name and from the sums of reference 4.5.
// No APC3 manual has figures: it works at 3.3 V and takes that column.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string_view>

#include <dpchip/core/ticks.hpp>
#include <dpchip/regmap/processor_mode.hpp>

namespace dpchip::regmap {

using core::Ticks;

/// What happens at the bus pins, seen from the processor interface.
enum class BusEvent : std::uint8_t {
    ale_rises, ale_falls,
    xrd_falls, xrd_rises,
    xwr_falls, xwr_rises,
    as_falls, as_rises,
    e_falls, e_rises,
    xcs_falls, xcs_rises,
    r_w_changes,
    address_changes,  ///< an AB pin, or the pin of AB11 with 4 KB
    data_changes,     ///< a DB pin, moved by the processor
    data_valid, data_z,         ///< the chip drives DB, or lets it go
    ready_falls, ready_rises,   ///< XREADY/XDTACK
    count
};
inline constexpr std::size_t kBusEvents = static_cast<std::size_t>(BusEvent::count);

/// A set of events: a parameter may count from or to any of several.
struct BusEvents {
    std::uint32_t bits{};
    constexpr BusEvents() = default;
    constexpr BusEvents(BusEvent e) : bits{1u << static_cast<unsigned>(e)} {}
    constexpr bool has(BusEvent e) const { return ((bits >> static_cast<unsigned>(e)) & 1u) != 0; }
    friend constexpr BusEvents operator|(BusEvents a, BusEvents b) {
        BusEvents both;
        both.bits = a.bits | b.bits;
        return both;
    }
    bool operator==(const BusEvents&) const = default;
};
constexpr BusEvents operator|(BusEvent a, BusEvent b) { return BusEvents{a} | BusEvents{b}; }

constexpr std::string_view name(BusEvent e) {
    constexpr std::array<std::string_view, kBusEvents> kNames{
        "ALE rises", "ALE falls", "XRD falls", "XRD rises", "XWR falls", "XWR rises", "AS falls", "AS rises",
        "E_CLOCK falls", "E_CLOCK rises", "XCS falls", "XCS rises", "R_W changes", "AB changes", "DB changes",
        "DB valid", "DB high-resistance", "ready falls", "ready rises"};
    return kNames[static_cast<std::size_t>(e)];
}

enum class Cycle : std::uint8_t { read = 1, write = 2, both = 3 };
constexpr bool covers(Cycle parameter, Cycle cycle) {
    return (static_cast<unsigned>(parameter) & static_cast<unsigned>(cycle)) != 0;
}

enum class TimingKind : std::uint8_t { check, promise };

/// No limit on that side.
inline constexpr Ticks kNoMin{core::kNever.n * -1}, kNoMax = core::kNever;

struct TimingLimits {
    Ticks min = kNoMin, max = kNoMax;
    constexpr bool meets(Ticks t) const { return t >= min && t <= max; }
    bool operator==(const TimingLimits&) const = default;
};

struct TimingParameter {
    std::uint8_t number{};
    ProcessorMode mode{};
    Cycle cycle{};
    TimingKind kind{};
    BusEvents from{}, to{};
    std::array<TimingLimits, kSupplies> limits{};  ///< index: Supply
    std::string_view name;
    std::string_view figure;                       ///< of the VPC3+C manual

    constexpr const TimingLimits& at(Supply s) const { return limits[static_cast<std::size_t>(s)]; }
};

namespace detail {
using namespace core::literals;

struct Mode {
    ProcessorMode mode;
    std::string_view figure;
    /// A requirement with a minimum, the same at both supplies.
    consteval TimingParameter check(std::uint8_t n, Cycle c, BusEvents from, BusEvents to, Ticks min, std::string_view what) const {
        const TimingLimits limits{min, kNoMax};
        return {n, mode, c, TimingKind::check, from, to, {limits, limits}, what, figure};
    }
    consteval TimingParameter promise(std::uint8_t n, Cycle c, BusEvents from, BusEvents to, TimingLimits at_3_3, TimingLimits at_5,
                                      std::string_view what) const {
        return {n, mode, c, TimingKind::promise, from, to, {at_3_3, at_5}, what, figure};
    }
};

inline constexpr Mode kSyncIntel{ProcessorMode::sync_intel, "10-11"}, kAsyncIntel{ProcessorMode::async_intel, "10-14"};
inline constexpr Mode kSyncMotorola{ProcessorMode::sync_motorola, "10-17"}, kAsyncMotorola{ProcessorMode::async_motorola, "10-20"};

inline constexpr Cycle kR = Cycle::read, kW = Cycle::write, kRw = Cycle::both;
using enum BusEvent;
inline constexpr BusEvents kFalls = xrd_falls | xwr_falls, kRises = xrd_rises | xwr_rises;
inline constexpr BusEvents kAddressOrData = address_changes | data_changes;
}  // namespace detail

inline constexpr std::size_t kTimingParameters = 59;

// clang-format off
/// In the order of their numbers; 34 does not exist.
inline constexpr std::array<TimingParameter, kTimingParameters> kBusTiming = [] {
    using namespace detail;
    constexpr auto& s = kSyncIntel; constexpr auto& a = kAsyncIntel; constexpr auto& e = kSyncMotorola; constexpr auto& m = kAsyncMotorola;
    return std::array<TimingParameter, kTimingParameters>{{
    s.check  ( 1, kRw, ale_rises,       ale_falls,        10_ns,                                  "ALE pulse width"),
    s.check  ( 2, kR,  ale_falls,       xrd_falls,        20_ns,                                  "ALE to XRD"),
    s.check  ( 3, kRw, kAddressOrData,  ale_falls,        10_ns,                                  "address set-up before ALE"),
    s.check  ( 4, kRw, ale_falls,       data_changes,     10_ns,                                  "address hold after ALE"),
    s.promise( 5, kR,  xrd_falls,       data_valid,       {kNoMin, 103_ns}, {kNoMin, 97_ns},      "XRD to data valid"),
    s.check  ( 6, kR,  xrd_falls,       xrd_rises,        115_ns,                                 "XRD pulse width"),
    s.check  ( 7, kR,  xrd_rises,       ale_rises,        10_ns,                                  "XRD to ALE"),
    s.check  ( 8, kRw, kRises,          address_changes,  5_ns,                                   "address hold after XRD or XWR"),
    s.promise( 9, kR,  xrd_rises,       data_z,           {4_ns, 16_ns}, {4_ns, 13_ns},           "data hold after XRD"),
    s.check  (10, kRw, kFalls,          kFalls,           155_ns,                                 "XRD or XWR cycle time"),
    s.check  (11, kW,  ale_falls,       xwr_falls,        20_ns,                                  "ALE to XWR"),
    s.check  (12, kW,  xwr_falls,       xwr_rises,        83_ns,                                  "XWR pulse width"),
    s.check  (13, kW,  data_changes,    xwr_rises,        10_ns,                                  "data set-up before XWR"),
    s.check  (14, kW,  xwr_rises,       ale_rises,        10_ns,                                  "XWR to ALE"),
    s.check  (15, kW,  xwr_rises,       data_changes,     10_ns,                                  "data hold after XWR"),

    a.check  (16, kRw, address_changes, kFalls,           0_ns,                                   "address set-up before XRD or XWR"),
    a.promise(17, kR,  xrd_falls,       data_valid,       {kNoMin, 103_ns}, {kNoMin, 97_ns},      "XRD to data valid"),
    a.check  (18, kR,  xrd_falls,       xrd_rises,        115_ns,                                 "XRD pulse width"),
    a.check  (19, kRw, xcs_falls,       kFalls,           0_ns,                                   "XCS set-up before XRD or XWR"),
    a.promise(20, kRw, kFalls,          ready_falls,      {kNoMin, 132_ns}, {kNoMin, 126_ns},     "XRD or XWR to XREADY, normal ready"),
    a.promise(21, kRw, kFalls,          ready_falls,      {kNoMin, 111_ns}, {kNoMin, 105_ns},     "XRD or XWR to XREADY, early ready"),
    a.check  (22, kRw, kFalls,          kFalls,           125_ns,                                 "XRD or XWR cycle time"),
    a.check  (23, kRw, kRises,          address_changes,  0_ns,                                   "address hold after XRD or XWR"),
    a.promise(24, kR,  xrd_rises,       data_z,           {4_ns, 16_ns}, {4_ns, 13_ns},           "data hold after XRD"),
    a.check  (25, kRw, kRises,          kFalls,           10_ns,                                  "read or write inactive time"),
    a.check  (26, kRw, kRises,          xcs_rises,        0_ns,                                   "XCS hold after XRD or XWR"),
    a.promise(27, kRw, kRises,          ready_rises,      {6_ns, 21_ns}, {5_ns, 16_ns},           "XREADY hold after XRD or XWR"),
    a.check  (28, kW,  data_changes,    xwr_rises,        10_ns,                                  "data set-up before XWR"),
    a.check  (29, kW,  xwr_falls,       xwr_rises,        83_ns,                                  "XWR pulse width"),
    a.check  (30, kW,  xwr_rises,       data_changes,     10_ns,                                  "data hold after XWR"),

    e.check  (31, kRw, e_rises,         e_falls,          136.7_ns,                               "E_CLOCK pulse width"),
    e.promise(32, kR,  e_rises,         data_valid,       {kNoMin, 103_ns}, {kNoMin, 97_ns},      "E_CLOCK to data valid"),
    e.check  (33, kRw, address_changes, e_rises,          10_ns,                                  "address set-up before E_CLOCK"),
    e.check  (35, kRw, r_w_changes,     e_rises,          10_ns,                                  "R_W set-up before E_CLOCK"),
    e.check  (36, kRw, xcs_falls,       e_rises,          0_ns,                                   "XCS set-up before E_CLOCK"),
    e.check  (37, kRw, e_falls,         address_changes,  5_ns,                                   "address hold after E_CLOCK"),
    e.promise(38, kR,  e_falls,         data_z,           {4_ns, 16_ns}, {4_ns, 12_ns},           "data hold after E_CLOCK"),
    e.check  (39, kRw, e_falls,         r_w_changes,      5_ns,                                   "R_W hold after E_CLOCK"),
    e.check  (40, kRw, e_falls,         xcs_rises,        0_ns,                                   "XCS hold after E_CLOCK"),
    e.check  (41, kW,  data_changes,    e_falls,          10_ns,                                  "data set-up before E_CLOCK"),
    e.check  (42, kW,  e_falls,         data_changes,     10_ns,                                  "data hold after E_CLOCK"),

    m.check  (43, kRw, address_changes, as_falls,         0_ns,                                   "address set-up before AS"),
    m.promise(44, kR,  as_falls,        data_valid,       {kNoMin, 103_ns}, {kNoMin, 97_ns},      "AS to data valid"),
    m.check  (45, kR,  as_falls,        as_rises,         115_ns,                                 "AS pulse width, read"),
    m.check  (46, kRw, r_w_changes,     as_falls,         10_ns,                                  "R_W set-up before AS"),
    m.check  (47, kRw, xcs_falls,       as_falls,         5_ns,                                   "XCS set-up before AS"),
    m.promise(48, kRw, as_falls,        ready_falls,      {kNoMin, 132_ns}, {kNoMin, 126_ns},     "AS to XDTACK, normal ready"),
    m.promise(49, kRw, as_falls,        ready_falls,      {kNoMin, 111_ns}, {kNoMin, 105_ns},     "AS to XDTACK, early ready"),
    m.check  (50, kRw, as_falls,        xcs_falls,        93_ns,                                  "last AS to XCS"),
    m.check  (51, kRw, as_falls,        as_falls,         125_ns,                                 "AS cycle time"),
    m.check  (52, kRw, as_rises,        address_changes,  10_ns,                                  "address hold after AS"),
    m.promise(53, kR,  as_rises,        data_z,           {4_ns, 16_ns}, {4_ns, 13_ns},           "data hold after AS"),
    m.check  (54, kRw, as_rises,        as_falls,         10_ns,                                  "AS inactive time"),
    m.check  (55, kRw, as_rises,        r_w_changes,      10_ns,                                  "R_W hold after AS"),
    m.check  (56, kRw, as_rises,        xcs_rises,        0_ns,                                   "XCS hold after AS"),
    m.promise(57, kRw, as_rises,        ready_rises,      {6_ns, 21_ns}, {5_ns, 16_ns},           "XDTACK hold after AS"),
    m.check  (58, kW,  data_changes,    as_rises,         10_ns,                                  "data set-up before AS"),
    m.check  (59, kW,  as_falls,        as_rises,         83_ns,                                  "AS pulse width, write"),
    m.check  (60, kW,  as_rises,        data_changes,     10_ns,                                  "data hold after AS"),
    }};
}();
// clang-format on

/// Where the parameter of that number stands in kBusTiming; 1..60 without 34.
constexpr bool is_timing_number(unsigned number) { return number >= 1 && number <= 60 && number != 34; }
constexpr std::size_t timing_index(unsigned number) { return number < 34 ? number - 1 : number - 2; }
constexpr const TimingParameter& timing(unsigned number) { return kBusTiming[timing_index(number)]; }

static_assert([] {
    std::size_t checks = 0;
    for (std::size_t i = 0; i < kBusTiming.size(); ++i) {
        if (timing_index(kBusTiming[i].number) != i) return false;
        if (kBusTiming[i].kind == TimingKind::check) ++checks;
    }
    return checks == 45;
}());

/// The times of 10.7.1 that have no number.
enum class SystemTiming : std::uint8_t {
    clk_period, clk_high, clk_low, clk_rise, clk_fall, eoi_inactive_us, eoi_inactive_ms, reset_width, count
};

struct SystemTimingParameter {
    SystemTiming id{};
    TimingKind kind{};
    TimingLimits limits{};
    std::string_view symbol, name, figure;
};

// clang-format off
/// The period is printed with two digits, 20.83 ns: one CLK. Nothing is said of the crystal's tolerance; what the line
/// allows, 0.3 %, bounds it here.
inline constexpr std::array<SystemTimingParameter, static_cast<std::size_t>(SystemTiming::count)> kSystemTiming = [] {
    using namespace core::literals;
    using enum SystemTiming;
    constexpr auto check = TimingKind::check, promise = TimingKind::promise;
    return std::array<SystemTimingParameter, static_cast<std::size_t>(SystemTiming::count)>{{
    {clk_period,      check,   {Ticks{1247}, Ticks{1253}}, "T",    "clock period, 20.83 ns within the 0.3 % of the line", "10-7"},
    {clk_high,        check,   {6.25_ns, 14.6_ns},         "TCH",  "clock high time",                        "10-7"},
    {clk_low,         check,   {6.25_ns, 14.6_ns},         "TCL",  "clock low time",                         "10-7"},
    {clk_rise,        check,   {kNoMin, 4_ns},             "TCR",  "clock rise time",                        "10-7"},
    {clk_fall,        check,   {kNoMin, 4_ns},             "TCF",  "clock fall time",                        "10-7"},
    {eoi_inactive_us, promise, {1_us, 1_us},               "",     "interrupt inactive time, EOI_Time_Base = 0", "10-8"},
    {eoi_inactive_ms, promise, {1000_us, 1000_us},         "",     "interrupt inactive time, EOI_Time_Base = 1", "10-8"},
    {reset_width,     check,   {100_ns, kNoMax},           "",     "RESET",                                  "10.7.1"},
    }};
}();
// clang-format on
constexpr const SystemTimingParameter& timing(SystemTiming t) { return kSystemTiming[static_cast<std::size_t>(t)]; }

/// When the chip does what, counted from k, the first rising edge of CLK at or after the one that opens the strobe
/// (hardware reference 5). Nothing of this is published; every printed maximum is met at every phase of CLK.
struct InternalTiming {
    Ticks data_valid, early_ready, normal_ready;  ///< from k
};
namespace detail {
consteval InternalTiming internal(Ticks data, Ticks ready) { return {3_clk + data, 3_clk + ready, 4_clk + ready}; }
}  // namespace detail
inline constexpr Ticks kReadAccess = core::kClk * 2;   ///< from k: the value is taken, a command acts
inline constexpr Ticks kWriteAccess = core::kClk;      ///< from the first rising edge of CLK at or after the capturing edge
inline constexpr std::array<InternalTiming, kSupplies> kInternalTiming = [] {
    using namespace core::literals;
    return std::array<InternalTiming, kSupplies>{{detail::internal(19_ns, 27_ns), detail::internal(13_ns, 21_ns)}};
}();
constexpr const InternalTiming& internal_timing(Supply s) { return kInternalTiming[static_cast<std::size_t>(s)]; }

/// The promises about the end of a strobe in a mode: DB goes high-resistance, ready rises.
constexpr unsigned data_hold_number(ProcessorMode m) {
    switch (m) {
    case ProcessorMode::sync_intel: return 9;
    case ProcessorMode::async_intel: return 24;
    case ProcessorMode::sync_motorola: return 38;
    case ProcessorMode::async_motorola: return 53;
    }
    return 9;
}
/// 0: the mode has no ready.
constexpr unsigned ready_hold_number(ProcessorMode m) {
    return m == ProcessorMode::async_intel ? 27u : m == ProcessorMode::async_motorola ? 57u : 0u;
}

}  // namespace dpchip::regmap
