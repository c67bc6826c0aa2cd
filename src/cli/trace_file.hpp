// SPDX-License-Identifier: Apache-2.0
// A segment recorded into a pcapng file for as long as this object lives.
#pragma once

#include <fstream>
#include <memory>
#include <string>

#include <dpchip/live/recorder.hpp>
#include <dpchip/segment/segment.hpp>
#include <dpchip/trace/pcapng.hpp>

namespace dpchip::cli {

class TraceFile {
public:
    /// Records `segment` from now on. Throws Failure when the file cannot be written.
    TraceFile(const std::string& path, segment::Segment& segment, const live::Recorder::Options& options);
    ~TraceFile();
    TraceFile(const TraceFile&) = delete;
    TraceFile& operator=(const TraceFile&) = delete;

    std::uint64_t packets() const { return writer_.packets(); }
    std::uint64_t lost() const { return recorder_.lost(); }
    const std::string& path() const { return path_; }

private:
    std::string path_;
    std::ofstream file_;
    trace::PcapngWriter writer_;
    live::Recorder recorder_;
    segment::Segment& segment_;
};

}  // namespace dpchip::cli
