// SPDX-License-Identifier: Apache-2.0
// A tap on a segment, live or virtual: everything that was on the line goes into a pcapng file.
#pragma once

#include <cstdint>
#include <string>

#include <dpchip/segment/observer.hpp>
#include <dpchip/trace/pcapng.hpp>

namespace dpchip::live {

/// A segment::Observer. Packets bear the time of the end of their last stop bit, so that times never run backwards.
class Recorder {
public:
    struct Options {
        std::string name = "line";                          ///< of the interface
        trace::LinkType link_type = trace::LinkType::user0;
        std::int64_t epoch_ns = 0;                          ///< of line time 0
        segment::StationIndex port = segment::kNobody;      ///< what this station sends is inbound, all else outbound
    };

    /// `writer` must outlive the recorder.
    Recorder(trace::PcapngWriter& writer, const Options& options);

    void see(const segment::Sighting& sighting);
    /// Packets that could not be written.
    [[nodiscard]] std::uint64_t lost() const { return lost_; }

private:
    trace::Direction direction(segment::StationIndex sender) const;

    trace::PcapngWriter& writer_;
    Options options_;
    std::uint32_t interface_;
    std::uint64_t lost_{};
};

}  // namespace dpchip::live
