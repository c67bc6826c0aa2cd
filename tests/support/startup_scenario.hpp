// SPDX-License-Identifier: Apache-2.0
// The start-up to data exchange that every way into the chip has to end alike: telegrams, bits, pins, TLM. Data only, and
// C++17, so that SystemC programs can read it.
//
// The master's telegrams begin at fixed ticks. The firmware (startup_firmware.hpp) does its work at tick 0, then whenever
// X/INT goes active or, polling, every kPollPeriod; its accesses take no time where that can be had.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iomanip>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

namespace dpchip::test::startup {

using Octets = std::vector<std::uint8_t>;
using Ticks = std::int64_t;  ///< of 1/60 ns

inline constexpr Ticks kMicrosecond = 60'000, kMillisecond = 60'000'000;
inline constexpr std::uint32_t kBaud = 1'500'000;
inline constexpr std::uint8_t kStation = 8, kMaster = 2;
inline constexpr std::uint16_t kIdent = 0x4711;
inline constexpr std::array<std::uint8_t, 2> kCfg{0x11, 0x21};  ///< 2 octets of inputs, 2 of outputs
inline constexpr const char* kVariant = "vpc3+c";
inline constexpr std::size_t kMemory = 2048;
/// Options of the chip: the baud rate search tries each rate for 10 ms instead of seconds.
inline constexpr std::array<std::array<const char*, 2>, 1> kOptions{{{"baud_probe_ms", "10"}}};
inline constexpr Ticks kPollPeriod = 10 * kMicrosecond;
inline constexpr Ticks kEnd = 48 * kMillisecond;

/// What the firmware acts on.
enum class Service { interrupt, polling };

struct Request {
    Ticks at;       ///< falling edge of the first start bit
    Octets octets;
};

/// SD2 from the master to the station, FCS and ED included.
inline Octets sd2(std::uint8_t fc, const Octets& unit, bool saps) {
    Octets body{static_cast<std::uint8_t>(kStation | (saps ? 0x80 : 0)), static_cast<std::uint8_t>(kMaster | (saps ? 0x80 : 0)), fc};
    body.insert(body.end(), unit.begin(), unit.end());
    const auto le = static_cast<std::uint8_t>(body.size());
    Octets telegram{0x68, le, le, 0x68};
    std::uint8_t fcs = 0;
    for (const std::uint8_t octet : body) fcs = static_cast<std::uint8_t>(fcs + octet);
    telegram.insert(telegram.end(), body.begin(), body.end());
    telegram.push_back(fcs);
    telegram.push_back(0x16);
    return telegram;
}

/// What the master says. The first telegram proves the baud rate, which the search reaches 30 ms after the start of the chip,
/// and gets no answer.
inline std::vector<Request> requests() {
    constexpr std::uint8_t hi = kIdent >> 8, lo = kIdent & 0xFF;
    const Octets fdl_status{0x10, kStation, kMaster, 0x49, static_cast<std::uint8_t>(kStation + kMaster + 0x49), 0x16};
    constexpr Ticks ms = kMillisecond;
    return {
        {35 * ms + ms / 2, fdl_status},
        {36 * ms, fdl_status},
        {37 * ms + 1, sd2(0x6D, {60, 62}, true)},                                     // Slave_Diag
        {38 * ms + 2, sd2(0x5D, {61, 62, 0x88, 2, 5, 11, hi, lo, 0}, true)},          // Set_Prm, watchdog 100 ms
        {39 * ms + 3, sd2(0x7D, {62, 62, kCfg[0], kCfg[1]}, true)},                   // Chk_Cfg
        {40 * ms + 4, sd2(0x5D, {60, 62}, true)},                                     // Slave_Diag
        {41 * ms + 5, sd2(0x7D, {0x12, 0x34}, false)},                                // Data_Exchange
        {42 * ms + 6, sd2(0x5D, {0x56, 0x78}, false)},
        {42 * ms + 300 * kMicrosecond, sd2(0x5D, {0x56, 0x78}, false)},              // the same again: a lost answer
        {43 * ms, sd2(0x7D, {59, 62}, true)},                                        // Get_Cfg
        {44 * ms, sd2(0x5D, {56, 62}, true)},                                        // RD_Input
        {45 * ms + 7, sd2(0x7D, {0x9A, 0xBC}, false)},
        {46 * ms + 8, sd2(0x5D, {0xDE, 0xF0}, false)},
    };
}
/// How many of them are answered: all but the first.
inline std::size_t answers() { return requests().size() - 1; }

/// A telegram as it was on the line.
struct Seen {
    Ticks start = 0;
    bool own = false;  ///< the master's
    Octets octets;
    friend bool operator==(const Seen& a, const Seen& b) { return a.start == b.start && a.own == b.own && a.octets == b.octets; }
};

/// What a run ends with.
struct Result {
    std::vector<Seen> telegrams;
    std::array<std::uint8_t, kMemory> memory{};  ///< every address, by peek
    friend bool operator==(const Result& a, const Result& b) { return a.telegrams == b.telegrams && a.memory == b.memory; }

    /// The same with every telegram at tick 0, for ways in whose accesses take time.
    Result without_times() const {
        Result r = *this;
        for (Seen& seen : r.telegrams) seen.start = 0;
        return r;
    }
};

inline std::ostream& operator<<(std::ostream& out, const Seen& seen) {
    out << std::dec << seen.start << (seen.own ? " > " : " < ") << std::hex << std::uppercase << std::setfill('0');
    for (const std::uint8_t octet : seen.octets) out << std::setw(2) << int{octet} << ' ';
    return out << std::dec << '\n';
}

/// Where two runs differ, a line each; empty when they are the same.
inline std::string difference(const Result& is, const Result& should_be) {
    std::ostringstream out;
    const std::size_t n = std::max(is.telegrams.size(), should_be.telegrams.size());
    for (std::size_t i = 0; i < n; ++i) {
        const Seen a = i < is.telegrams.size() ? is.telegrams[i] : Seen{}, b = i < should_be.telegrams.size() ? should_be.telegrams[i] : Seen{};
        if (!(a == b)) out << "telegram " << i << ":\n  is        " << a << "  should be " << b;
    }
    out << std::hex << std::uppercase << std::setfill('0');
    for (std::size_t i = 0; i < kMemory; ++i)
        if (is.memory[i] != should_be.memory[i])
            out << "address " << std::setw(3) << i << ": is " << std::setw(2) << int{is.memory[i]} << ", should be " << std::setw(2) << int{should_be.memory[i]} << '\n';
    return out.str();
}

}  // namespace dpchip::test::startup
