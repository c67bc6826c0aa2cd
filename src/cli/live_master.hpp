// SPDX-License-Identifier: Apache-2.0
// A master on a live line that somebody else serves: what `dpchip master`'s verbs and the demonstration have in common.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <dpchip/cli/line_config.hpp>
#include <dpchip/cli/stations.hpp>
#include <dpchip/cli/trace_file.hpp>
#include <dpchip/live/open_line.hpp>
#include <dpchip/master/master.hpp>
#include <dpchip/trace/gsd_texts.hpp>

namespace dpchip::cli {

class LiveMaster {
public:
    struct Options {
        std::uint32_t watchdog_ms = 5000;  ///< of slaves that say nothing; 0: off
        master::Mode mode = master::Mode::operate;
        std::optional<Ticks> slot_time{};  ///< when neither file nor command line says one
    };
    /// Opens config.line and puts a master with config's slaves on it. Throws Failure and LineError.
    LiveMaster(const LineConfig& config, const Options& options);
    LiveMaster(const LiveMaster&) = delete;
    LiveMaster& operator=(const LiveMaster&) = delete;

    live::LiveLine& line() { return open_->line(); }
    std::string place() { return open_->port().place(); }
    master::Master& master() { return *master_; }
    const LineConfig& config() const { return config_; }
    const trace::GsdTexts& texts() const { return texts_; }
    GsdShelf& shelf() { return shelf_; }
    const gsd::Gsd& gsd(std::size_t n) { return shelf_.get(config_.slaves[n].gsd); }
    /// Lives until `done` or the time is over; false when it was not done. Ends early when a signal stopped the line.
    template <class F>
    bool run_until(F&& done, Ticks limit) {
        line().run(limit, done);
        return done();
    }
    /// Tells the segment that the master has something new to do.
    void wake() { line().segment().touch(index_); }

private:
    LineConfig config_;
    GsdShelf shelf_;
    trace::GsdTexts texts_;
    std::unique_ptr<master::Master> master_;
    std::unique_ptr<live::OpenLine> open_;
    segment::StationIndex index_{};
    std::unique_ptr<TraceFile> trace_;
};

/// What keeps a slave from data exchange, in a sentence.
std::string trouble(const master::SlaveHandler& slave);

}  // namespace dpchip::cli
