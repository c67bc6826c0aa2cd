// SPDX-License-Identifier: Apache-2.0
// What the UART remembers: trivially copyable, no padding, no pointers, like chip::State. A copy is a snapshot.
//
// Times are ticks of the chip. Samples are counted from grid_origin, one every quarter of a bit; the octets being sent
// are not here but in chip::State::tx.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include <dpchip/core/ticks.hpp>
#include <dpchip/fdl/baud.hpp>
#include <dpchip/pins/pin.hpp>

namespace dpchip::pins {

/// What the receiver looks for next.
enum class RxPhase : std::uint8_t {
    hunt,   ///< a falling edge
    check,  ///< the middle of the start bit: noise, or a character
    bits,   ///< data, parity and stop bit
};

/// What the transmitter is about.
enum class TxPhase : std::uint8_t {
    off,   ///< RTS is low, TXD is high-resistance
    lead,  ///< RTS is high, the first character has not begun
    bits,  ///< a character is on the line
    held,  ///< XCTS holds the next character back
    trail, ///< the last stop bit is over, RTS still high
};

struct UartState {
    // ---- sampling grid (reference 1.3)
    Ticks grid_origin{};       ///< sample 0: the CLK edge at or after the moment the rate was chosen
    Ticks rxd_since{};         ///< last edge on RXD
    std::int64_t sampled = 0;  ///< samples taken: number of the next one
    std::int64_t changed = -1; ///< sample that first saw the present level; -1: before the grid began
    Ticks idle_since{};        ///< the sample that last saw RXD rise
    // ---- character being received
    std::int64_t s0 = 0;       ///< sample that saw its start edge
    std::int64_t before = -1;  ///< s0 of the character before; -1: none
    // ---- character that is complete and is handed over at its end
    std::int64_t done_s0 = 0;
    // ---- transmitter
    Ticks tx_start{};          ///< start bit of the present character
    Ticks tx_bit{};            ///< bit time of the answer

    std::uint16_t tx_index = 0;  ///< present character
    std::uint16_t tx_count = 0;  ///< characters of the answer
    fdl::BaudCode rate{};        ///< the grid's
    PinLevel rxd = PinLevel::high;
    PinLevel level = PinLevel::high;  ///< RXD as last sampled
    RxPhase rx = RxPhase::hunt;
    std::uint8_t bit = 0;        ///< data 0..7, parity 8, stop 9: which is looked at next
    std::uint8_t octet = 0, faults = 0;
    std::uint8_t done = 0;       ///< a complete character waits for its end
    std::uint8_t done_octet = 0, done_faults = 0;
    TxPhase tx = TxPhase::off;
    std::uint8_t tx_slot = 0;    ///< bit boundary of the present character that comes next, 0..11
    PinLevel txd = PinLevel::z;
    std::array<std::uint8_t, 7> spare{};  ///< fills the last eight octets
};
static_assert(std::is_trivially_copyable_v<UartState>);
static_assert(std::has_unique_object_representations_v<UartState>, "no padding: snapshots compare with memcmp");

/// Calls `visit(name, member)` for every member, in the order of declaration.
template <class S, class Visitor>
    requires std::is_same_v<std::remove_const_t<S>, UartState>
constexpr void describe(S& s, Visitor&& visit) {
#define DPCHIP_FIELD(member) visit(std::string_view{#member}, s.member)
    DPCHIP_FIELD(grid_origin); DPCHIP_FIELD(rxd_since); DPCHIP_FIELD(sampled); DPCHIP_FIELD(changed);
    DPCHIP_FIELD(idle_since); DPCHIP_FIELD(s0); DPCHIP_FIELD(before); DPCHIP_FIELD(done_s0);
    DPCHIP_FIELD(tx_start); DPCHIP_FIELD(tx_bit); DPCHIP_FIELD(tx_index); DPCHIP_FIELD(tx_count); DPCHIP_FIELD(rate);
    DPCHIP_FIELD(rxd); DPCHIP_FIELD(level); DPCHIP_FIELD(rx); DPCHIP_FIELD(bit); DPCHIP_FIELD(octet);
    DPCHIP_FIELD(faults); DPCHIP_FIELD(done); DPCHIP_FIELD(done_octet); DPCHIP_FIELD(done_faults);
    DPCHIP_FIELD(tx); DPCHIP_FIELD(tx_slot); DPCHIP_FIELD(txd); DPCHIP_FIELD(spare);
#undef DPCHIP_FIELD
}

namespace detail {
/// Octets that describe() covers; a name that comes twice stops the compiler.
consteval std::size_t described_uart_octets() {
    UartState s{};
    std::size_t octets = 0, count = 0;
    std::array<std::string_view, 32> names{};
    describe(s, [&](std::string_view name, auto& member) {
        for (std::size_t i = 0; i < count; ++i)
            if (names[i] == name) throw "a member is described twice";
        names[count++] = name;
        octets += sizeof member;
    });
    return octets;
}
}  // namespace detail
static_assert(detail::described_uart_octets() == sizeof(UartState), "a UartState member is missing from describe()");

/// A state that a running UART could be in: for whoever loads one.
constexpr bool plausible(const UartState& s) {
    const bool enums = s.rx <= RxPhase::bits && s.tx <= TxPhase::trail && s.rxd <= PinLevel::high && s.level <= PinLevel::high &&
                       s.txd <= PinLevel::z && static_cast<std::size_t>(s.rate) < fdl::kBaudRates;
    const bool counts = s.bit <= 9 && s.tx_slot <= 11 && s.tx_count <= 255 &&
                        s.tx_index <= s.tx_count && s.done <= 1;
    const bool samples = s.sampled >= 0 && s.changed < s.sampled && s.s0 < s.sampled + 1 && s.before <= s.s0 && s.done_s0 <= s.sampled;
    const bool times = s.grid_origin >= Ticks{} && s.rxd_since >= Ticks{} && s.idle_since >= Ticks{} && s.tx_start >= Ticks{} && s.tx_bit >= Ticks{};
    return enums && counts && samples && times;
}

}  // namespace dpchip::pins
