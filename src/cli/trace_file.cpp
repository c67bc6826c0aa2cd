// SPDX-License-Identifier: Apache-2.0
// Opening a capture and hanging it on a segment.
#include <dpchip/cli/failure.hpp>
#include <dpchip/cli/log.hpp>
#include <dpchip/cli/trace_file.hpp>
#include <dpchip/version.h>

namespace dpchip::cli {
namespace {

std::ofstream open(const std::string& path) {
    std::ofstream file{path, std::ios::binary | std::ios::trunc};
    if (!file) throw Failure{ExitCode::failed, path + ": cannot be written"};
    return file;
}

}  // namespace

TraceFile::TraceFile(const std::string& path, segment::Segment& segment, const live::Recorder::Options& options)
    : path_{path}, file_{open(path)}, writer_{file_, "dpchip " DPCHIP_VERSION}, recorder_{writer_, options}, segment_{segment} {
    segment_.observe(recorder_);
}

TraceFile::~TraceFile() {
    segment_.unobserve(&recorder_);
    if (recorder_.lost() != 0) spdlog::warn("{}: {} telegrams could not be written", path_, recorder_.lost());
}

}  // namespace dpchip::cli
