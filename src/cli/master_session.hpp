// SPDX-License-Identifier: Apache-2.0
// `master run` as an object: reach the slaves, exchange data, leave them, say how it was. The demonstration uses it too.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <dpchip/cli/alarm_desk.hpp>
#include <dpchip/cli/application.hpp>
#include <dpchip/cli/failure.hpp>
#include <dpchip/cli/live_master.hpp>
#include <dpchip/cli/live_view.hpp>

namespace dpchip::cli {

struct SessionOptions {
    std::optional<std::uint64_t> cycles{};             ///< with all slaves in data exchange
    std::optional<Ticks> duration{};                   ///< of data exchange
    Ticks patience = core::seconds(10);                ///< until all slaves are in data exchange
    std::optional<std::vector<std::uint8_t>> outputs{};
    bool json = false;
};

class MasterSession {
public:
    MasterSession(const LineConfig& config, const SessionOptions& options);
    ExitCode run();

private:
    bool reach();
    void exchange();
    void leave();
    void tell_changes();
    Rows rows() const;
    ExitCode report() const;
    void report_json(bool good) const;
    void report_text(bool good) const;
    bool good() const;
    std::uint64_t lost(std::size_t n) const { return live_->master().slave(n).counters().lost - lost_before_[n]; }

    SessionOptions options_;
    std::unique_ptr<LiveMaster> live_;
    Application application_;
    AlarmDesk alarm_desk_;
    CycleHook hook_{&application_, &alarm_desk_};
    LiveView view_;
    std::vector<std::string> said_;
    std::vector<std::uint64_t> lost_before_;
    Ticks reached_after_{};
    bool reached_ = false, stopped_ = false;
    struct End {
        bool exchanging;
        std::string outputs, inputs;
    };
    std::vector<End> at_the_end_;         ///< when leaving began
    Rows rows_at_the_end_;
    master::MasterCounters counters_{};   ///< of the exchange
    master::CycleStatistics cycle_{};
};

}  // namespace dpchip::cli
