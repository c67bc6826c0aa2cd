// SPDX-License-Identifier: Apache-2.0
// The 44 pins as data: name, direction, input type, output cell and what each does in the four processor modes
// (VPC3+C manual 3.1, figures 3-1, 3-2, 8-2; APC3 manual 2.1; hardware reference 1).
//
// Not modelled: the supply pins have no behaviour, and levels are low, high and Z, not volts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <dpchip/core/bits.hpp>
#include <dpchip/core/ticks.hpp>
#include <dpchip/regmap/processor_mode.hpp>

namespace dpchip::pins {

using core::Ticks;
using regmap::ProcessorMode;
using regmap::Supply;

/// A pin; the value is its number on the package. The numbering of VPC3+C and APC3 is the same.
enum class PinId : std::uint8_t {
    xcs_ab11 = 1, xwr_e_clock_ab11, divider, xrd_r_w, clk, vss_6, clkout, xint_mot, x_int, ab10, db0,
    db1 = 12, xdataexch_sync, xready_xdtack, db2, db3, vss_17, vdd_18, db4, db5, db6, db7,
    mode = 23, ale_as_ab11, ab9, txd, rts, vss_28, ab8, rxd, ab7, ab6, xcts,
    xtest0 = 34, xtest1, reset, ab4, vss_38, vdd_39, ab3, ab2, ab5, ab1, ab0,
};
inline constexpr std::size_t kPins = 44;

/// An input reads Z as its last level was, unless it has a pull-down.
enum class PinLevel : std::uint8_t { low, high, z };

/// A pin takes a level.
struct PinEdge {
    Ticks at{};
    PinId pin{};
    PinLevel level{};
    bool operator==(const PinEdge&) const = default;
};

enum class PinDirection : std::uint8_t { supply, input, output, bidirectional };
/// As the manual abbreviates them: I(C), I(CS), I(CPD), I(TS).
enum class InputType : std::uint8_t { none, cmos, cmos_schmitt, cmos_pulldown, ttl_schmitt };
enum class OutputStage : std::uint8_t { none, push_pull, tristate };

struct PinInfo {
    PinId id{};
    std::string_view name;          ///< as the VPC3+C manual prints it
    std::string_view apc3_name;     ///< without the functions that APC3 lacks
    PinDirection direction{};
    InputType input{};
    OutputStage output{};
    std::uint8_t drive_ma{};        ///< output cell; 0: no output
    std::uint8_t load_pf{};         ///< largest capacitive load at which the timing holds; 0: no output
    std::string_view function;
    constexpr unsigned number() const { return static_cast<unsigned>(id); }
};

// clang-format off
namespace detail {
consteval PinInfo in(PinId id, std::string_view name, std::string_view apc3, InputType type, std::string_view function) {
    return {id, name, apc3, PinDirection::input, type, OutputStage::none, 0, 0, function};
}
consteval PinInfo in(PinId id, std::string_view name, InputType type, std::string_view function) { return in(id, name, name, type, function); }
consteval PinInfo out(PinId id, std::string_view name, std::string_view apc3, OutputStage stage, std::uint8_t ma, std::uint8_t pf, std::string_view function) {
    return {id, name, apc3, PinDirection::output, InputType::none, stage, ma, pf, function};
}
consteval PinInfo db(PinId id, std::string_view name) {
    return {id, name, name, PinDirection::bidirectional, InputType::cmos, OutputStage::tristate, 8, 100, "data bus; with ALE also address bus"};
}
consteval PinInfo power(PinId id, std::string_view name, std::string_view function) {
    return {id, name, name, PinDirection::supply, InputType::none, OutputStage::none, 0, 0, function};
}
}  // namespace detail

/// Index: pin number - 1. AB9 and MODE are printed as plain "I" and taken as CMOS.
inline constexpr std::array<PinInfo, kPins> kPinTable{{
    detail::in (PinId::xcs_ab11, "XCS/AB11", "XCS", InputType::cmos, "chip select, or address line 11"),
    detail::in (PinId::xwr_e_clock_ab11, "XWR/E_CLOCK/AB11", "XWR/E_CLOCK", InputType::cmos, "write strobe, E clock, or address line 11"),
    detail::in (PinId::divider, "DIVIDER", InputType::cmos, "0: CLKOUT2/4 is CLK / 4, 1: CLK / 2"),
    detail::in (PinId::xrd_r_w, "XRD/R_W", InputType::cmos, "read strobe, or read (1) and write (0)"),
    detail::in (PinId::clk, "CLK", InputType::ttl_schmitt, "48 MHz system clock"),
    detail::power(PinId::vss_6, "VSS", "0 V"),
    detail::out(PinId::clkout, "CLKOUT2/4", "CLKOUT2/4", OutputStage::push_pull, 8, 100, "CLK divided by 2 or 4, for the processor"),
    detail::in (PinId::xint_mot, "XINT/MOT", InputType::cmos, "0: Intel, 1: Motorola"),
    detail::out(PinId::x_int, "X/INT", "X/INT", OutputStage::push_pull, 4, 50, "interrupt; polarity as INT_Pol says, low-active after RESET"),
    detail::in (PinId::ab10, "AB10", InputType::cmos_pulldown, "address line 10; sync. Intel: decoder input"),
    detail::db (PinId::db0, "DB0"),
    detail::db (PinId::db1, "DB1"),
    detail::out(PinId::xdataexch_sync, "XDATAEXCH/SYNC", "XDATAEXCH", OutputStage::push_pull, 8, 50, "0 in DATA-EXCH, for an LED; or SYNC"),
    detail::out(PinId::xready_xdtack, "XREADY/XDTACK", "XREADY/XDTACK", OutputStage::push_pull, 4, 50, "ready for the processor, low-active, never high-resistance"),
    detail::db (PinId::db2, "DB2"),
    detail::db (PinId::db3, "DB3"),
    detail::power(PinId::vss_17, "VSS", "0 V"),
    detail::power(PinId::vdd_18, "VDD", "3.3 V or 5 V (APC3: 3.3 V)"),
    detail::db (PinId::db4, "DB4"),
    detail::db (PinId::db5, "DB5"),
    detail::db (PinId::db6, "DB6"),
    detail::db (PinId::db7, "DB7"),
    detail::in (PinId::mode, "MODE", InputType::cmos, "0: asynchronous, 1: synchronous interface"),
    detail::in (PinId::ale_as_ab11, "ALE/AS/AB11", "ALE/AS", InputType::cmos, "address latch enable, address strobe, or address line 11"),
    detail::in (PinId::ab9, "AB9", InputType::cmos, "address line 9; sync. Intel: decoder input"),
    detail::out(PinId::txd, "TXD", "TXD", OutputStage::tristate, 8, 50, "serial output; needs an external pull-up"),
    detail::out(PinId::rts, "RTS", "RTS", OutputStage::push_pull, 8, 50, "request to send, high-active"),
    detail::power(PinId::vss_28, "VSS", "0 V"),
    detail::in (PinId::ab8, "AB8", InputType::cmos, "address line 8; sync. Intel: decoder input"),
    detail::in (PinId::rxd, "RXD", InputType::cmos, "serial input"),
    detail::in (PinId::ab7, "AB7", InputType::cmos, "address line 7; sync. Intel: decoder input"),
    detail::in (PinId::ab6, "AB6", InputType::cmos, "address line 6; sync. Intel: decoder input"),
    detail::in (PinId::xcts, "XCTS", InputType::cmos, "clear to send: 0 enables sending"),
    detail::in (PinId::xtest0, "XTEST0", InputType::cmos, "0: all outputs high-resistance; belongs on VDD"),
    detail::in (PinId::xtest1, "XTEST1", InputType::cmos, "0: test modes; belongs on VDD"),
    detail::in (PinId::reset, "RESET", InputType::cmos_schmitt, "hardware reset, high-active"),
    detail::in (PinId::ab4, "AB4", InputType::cmos, "address line 4; sync. Intel: decoder input"),
    detail::power(PinId::vss_38, "VSS", "0 V"),
    detail::power(PinId::vdd_39, "VDD", "3.3 V or 5 V (APC3: 3.3 V)"),
    detail::in (PinId::ab3, "AB3", InputType::cmos, "address line 3; sync. Intel: decoder input"),
    detail::in (PinId::ab2, "AB2", InputType::cmos, "address line 2; sync. Intel: address line 10"),
    detail::in (PinId::ab5, "AB5", InputType::cmos, "address line 5; sync. Intel: decoder input"),
    detail::in (PinId::ab1, "AB1", InputType::cmos, "address line 1; sync. Intel: address line 9"),
    detail::in (PinId::ab0, "AB0", InputType::cmos, "address line 0; sync. Intel: address line 8"),
}};

/// What the shared bus pins are in each mode, with 2 KB and with 4 KB (figures 3-2, 8-2). Index: ProcessorMode.
struct BusPinFunctions {
    PinId pin{};
    std::array<std::string_view, regmap::kProcessorModes> with_2k{}, with_4k{};
};
inline constexpr std::array<BusPinFunctions, 4> kBusPinFunctions{{
    //                          async. Intel       sync. Intel        async. Motorola    sync. Motorola
    {PinId::xcs_ab11,         {"XCS",             "unused, on VDD",  "XCS",             "XCS"},
                              {"XCS",             "AB11",            "XCS",             "XCS"}},
    {PinId::xwr_e_clock_ab11, {"XWR",             "XWR",             "unused, on VSS",  "E_CLOCK"},
                              {"XWR",             "XWR",             "AB11",            "E_CLOCK"}},
    {PinId::xrd_r_w,          {"XRD",             "XRD",             "R_W",             "R_W"},
                              {"XRD",             "XRD",             "R_W",             "R_W"}},
    {PinId::ale_as_ab11,      {"unused, on VSS",  "ALE",             "AS",              "unused, on VSS"},
                              {"AB11",            "ALE",             "AS",              "AB11"}},
}};
// clang-format on

constexpr const PinInfo& info(PinId pin) { return kPinTable[static_cast<std::size_t>(pin) - 1]; }
constexpr bool is_pin(unsigned number) { return number >= 1 && number <= kPins; }
/// The chip reads the pin.
constexpr bool is_input(PinId pin) {
    return info(pin).direction == PinDirection::input || info(pin).direction == PinDirection::bidirectional;
}
/// The chip drives the pin, at least at times.
constexpr bool is_output(PinId pin) {
    return info(pin).direction == PinDirection::output || info(pin).direction == PinDirection::bidirectional;
}

/// DB0..DB7 and AB0..AB10 by number; they do not lie in order on the package.
inline constexpr std::array<PinId, 8> kDataBus{PinId::db0, PinId::db1, PinId::db2, PinId::db3,
                                               PinId::db4, PinId::db5, PinId::db6, PinId::db7};
inline constexpr std::array<PinId, 11> kAddressBus{PinId::ab0, PinId::ab1, PinId::ab2, PinId::ab3, PinId::ab4, PinId::ab5,
                                                   PinId::ab6, PinId::ab7, PinId::ab8, PinId::ab9, PinId::ab10};

/// The pin that carries AB11 with 4 KB (figure 3-2).
constexpr PinId ab11_pin(ProcessorMode mode) {
    switch (mode) {
    case ProcessorMode::sync_intel: return PinId::xcs_ab11;
    case ProcessorMode::async_motorola: return PinId::xwr_e_clock_ab11;
    case ProcessorMode::async_intel:
    case ProcessorMode::sync_motorola: return PinId::ale_as_ab11;
    }
    return PinId::ale_as_ab11;
}

/// The pin of that name in the manual, where the name is not a supply's.
constexpr std::optional<PinId> pin_from_name(std::string_view name) {
    for (const PinInfo& p : kPinTable)
        if (p.direction != PinDirection::supply && p.name == name) return p.id;
    return std::nullopt;
}

constexpr PinLevel to_level(bool high) { return high ? PinLevel::high : PinLevel::low; }
constexpr char letter(PinLevel level) { return level == PinLevel::low ? '0' : level == PinLevel::high ? '1' : 'Z'; }

static_assert([] {
    for (std::size_t i = 0; i < kPins; ++i)
        if (kPinTable[i].number() != i + 1) return false;
    return true;
}());

}  // namespace dpchip::pins
