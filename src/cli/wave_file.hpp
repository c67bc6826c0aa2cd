// SPDX-License-Identifier: Apache-2.0
// Waveforms of a simulation in a file: waves::SegmentWaves of virtual slaves, with the program's errors.
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include <dpchip/segment/segment.hpp>
#include <dpchip/slave/virtual_slave.hpp>
#include <dpchip/waves/segment_waves.hpp>

namespace dpchip::cli {

struct WaveOptions {
    std::string path;  ///< empty: no waveforms
    waves::Options drawn;
};

class WaveFile {
public:
    /// Records `segment` from now on. Throws Failure when the file cannot be written or a pattern fits no signal.
    WaveFile(const WaveOptions& options, segment::Segment& segment, const std::vector<std::string>& slaves);

    /// To be called after everything that may have changed something, for each slave; null: it has no power.
    void look(std::size_t n, const slave::VirtualSlave* slave, segment::StationIndex index) {
        waves_.look(n, slave == nullptr ? nullptr : &slave->chip().state(), index);
    }
    /// After all slaves: writes what is settled. Throws Failure when the disk is full.
    void settle();
    void set_master(segment::StationIndex index) { waves_.set_master(index); }
    const std::string& path() const { return path_; }

private:
    std::string path_;
    std::ofstream file_;
    waves::SegmentWaves waves_;
};

}  // namespace dpchip::cli
