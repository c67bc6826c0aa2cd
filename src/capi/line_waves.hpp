// SPDX-License-Identifier: Apache-2.0
// Waveforms of a sim: line in a file: waves::SegmentWaves of the chips that were on the line when drawing began.
#pragma once

#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include <dpchip/dpchip.h>
#include <dpchip/waves/segment_waves.hpp>

namespace dpchip::capi {

class LineWaves {
public:
    LineWaves(segment::Segment& segment, std::span<dpchip_chip* const> chips, segment::StationIndex master, const waves::Options& options);

    /// Nothing when every pattern fits, else what is wrong in words.
    std::string misfit() const;
    /// False when the file cannot be written. Once, before look().
    bool open(const std::string& path);
    const std::string& path() const { return path_; }
    /// After anything that may have changed something. `on_line`: the chips that are there now.
    void look(std::span<dpchip_chip* const> on_line, core::Ticks hold);
    /// False when not everything could be written.
    bool finish();

private:
    std::string path_;
    std::ofstream file_;
    waves::SegmentWaves waves_;
    std::vector<std::uint64_t> serials_;  ///< of the chips that are drawn
};

}  // namespace dpchip::capi
