// SPDX-License-Identifier: Apache-2.0
// Bus times of the default profile in bit times (reference 1.6), and what follows from them.
#pragma once

#include <algorithm>
#include <cstdint>

#include <dpchip/fdl/baud.hpp>
#include <dpchip/fdl/character.hpp>

namespace dpchip::fdl {

/// All in bit times.
struct BusTimes {
    std::int64_t tqui{};      ///< quiet time of the transmitter
    std::int64_t tset{};      ///< setup time
    std::int64_t min_tsdr{};  ///< earliest answer
    std::int64_t max_tsdr{};  ///< latest answer the profile allows
    std::int64_t tsl{};       ///< slot time: how long a master waits for the first character

    /// Idle time of a requester after an answer: max(TSYN + TSM, min TSDR), TSM = 2 + 2 TSET + TQUI.
    constexpr std::int64_t tid1() const { return std::max<std::int64_t>(kTsynBits + 2 + 2 * tset + tqui, min_tsdr); }
    /// Idle time of a requester after a telegram that has no answer.
    constexpr std::int64_t tid2() const { return std::max<std::int64_t>(kTsynBits + 2 + 2 * tset + tqui, max_tsdr); }
    /// What a master writes into a publisher's minTSDR (VPC3+C 7.3.1): two bit times more than tid1().
    constexpr std::int64_t publisher_min_tsdr() const { return 37 + 2 * tset + tqui; }
};

/// The default profile of a rate; 45.45 kbit/s belongs to the lowest class.
constexpr BusTimes bus_times(BaudCode code) {
    switch (code) {
    case BaudCode::mbit_12: return {9, 16, 11, 800, 1000};
    case BaudCode::mbit_6: return {6, 8, 11, 450, 600};
    case BaudCode::mbit_3: return {3, 4, 11, 250, 400};
    case BaudCode::mbit_1_5: return {0, 1, 11, 150, 300};
    case BaudCode::kbit_500: return {0, 1, 11, 100, 200};
    case BaudCode::kbit_187_5:
    case BaudCode::kbit_93_75:
    case BaudCode::kbit_45_45:
    case BaudCode::kbit_19_2:
    case BaudCode::kbit_9_6:
    case BaudCode::not_found: break;
    }
    return {0, 1, 11, 60, 100};
}
static_assert(bus_times(BaudCode::mbit_12).tid1() == 76 && bus_times(BaudCode::mbit_6).tid1() == 57);
static_assert(bus_times(BaudCode::mbit_3).tid1() == 46 && bus_times(BaudCode::kbit_9_6).tid1() == 37);

}  // namespace dpchip::fdl
