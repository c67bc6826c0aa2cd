// SPDX-License-Identifier: Apache-2.0
// Total state tables: every (state, event) pair stands exactly once, as a transition or as ignored with a reason.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace dpchip::chip {

inline constexpr int kIgnoredPair = -1;

/// Index into `rows` by (state, event), kIgnoredPair where `ignored` says why nothing happens.
/// A pair that is forgotten or answered twice does not compile.
template <std::size_t States, class Event, class Row, std::size_t Rows, class Ignored, std::size_t Ignores>
consteval auto total_table(const Row (&rows)[Rows], const Ignored (&ignored)[Ignores]) {
    constexpr auto kEvents = static_cast<std::size_t>(Event::count);
    std::array<std::array<std::int8_t, kEvents>, States> table{};
    std::array<std::array<int, kEvents>, States> answers{};
    const auto put = [&](auto state, Event event, std::int8_t index) {
        table[static_cast<std::size_t>(state)][static_cast<std::size_t>(event)] = index;
        ++answers[static_cast<std::size_t>(state)][static_cast<std::size_t>(event)];
    };
    for (std::size_t i = 0; i < Rows; ++i) put(rows[i].from, rows[i].on, static_cast<std::int8_t>(i));
    for (const Ignored& row : ignored) put(row.in, row.on, kIgnoredPair);
    for (const auto& state : answers)
        for (const int n : state)
            if (n != 1) throw "a (state, event) pair is answered not at all or twice";
    return table;
}

}  // namespace dpchip::chip
