// SPDX-License-Identifier: Apache-2.0
// What can go wrong with waveforms, in words.
#include <dpchip/cli/wave_file.hpp>

#include <dpchip/cli/failure.hpp>

namespace dpchip::cli {

WaveFile::WaveFile(const WaveOptions& options, segment::Segment& segment, const std::vector<std::string>& slaves)
    : path_{options.path}, waves_{file_, segment, slaves, options.drawn} {
    if (const std::string* const pattern = waves_.unmatched()) {
        std::string known;
        for (const std::string& name : waves_.signals()) known += "\n  " + name;
        throw Failure{ExitCode::usage, "--signals " + *pattern + ": no signal is called so. There are:" + known};
    }
    file_.open(path_, std::ios::binary | std::ios::trunc);
    if (!file_) throw Failure{ExitCode::failed, path_ + ": cannot be written"};
}

void WaveFile::settle() {
    waves_.settle();
    if (!waves_.good()) throw Failure{ExitCode::failed, path_ + ": cannot be written any more"};
}

}  // namespace dpchip::cli
