// SPDX-License-Identifier: Apache-2.0
// What the receiver bears: how many telegrams get through when the sender's bits are too fast or too slow and the line
// makes low levels longer or shorter (8.3). Everything is counted, nothing is timed: the same figures on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace dpchip::bench {

/// A map of accepted telegrams over the sender's error and the distortion.
struct ToleranceMap {
    bool start_controlled = true;               ///< Dis_Start_Control = 0
    std::vector<std::int32_t> error_ppm;        ///< columns: how much too fast the sender's bits are
    std::vector<std::int32_t> distortion;       ///< rows: percent of a bit by which low levels are longer
    std::vector<std::vector<unsigned>> accepted;///< [row][column]: of `phases`
    unsigned phases = 0;                        ///< tries in each place: edges at as many phases against the sampling grid

    /// The errors between which every phase is accepted without distortion; {0, 0}: none.
    std::int32_t lowest_ppm() const, highest_ppm() const;
    /// The distortions between which every phase is accepted without error of the rate.
    std::int32_t lowest_distortion() const, highest_distortion() const;
};

/// Measures a map with a chip behind its UART. `phases`: 1 to 1000.
ToleranceMap measure_tolerance(bool start_controlled, unsigned phases = 16);

/// As characters: # all phases, + some, . none.
std::string tolerance_text(const ToleranceMap& map);
/// Both maps as one drawing.
std::string tolerance_svg(const ToleranceMap& controlled, const ToleranceMap& uncontrolled);

}  // namespace dpchip::bench
