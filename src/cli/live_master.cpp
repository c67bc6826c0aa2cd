// SPDX-License-Identifier: Apache-2.0
// A master on a live line.
#include <algorithm>

#include <fmt/format.h>

#include <dpchip/cli/live_master.hpp>
#include <dpchip/cli/master_setup.hpp>

namespace dpchip::cli {
namespace {

/// A program is no hardware: also on serial lines it waits longer for an answer than the profile says, because the
/// adapter and the operating system hand octets over when they like.
constexpr Ticks kSerialPatience = core::milliseconds(50);
/// A master that only asks now and then does not fill a pty with tokens.
constexpr Ticks kIdleCycle = core::milliseconds(5);

/// Nothing on a live line is exact to a bit: no equidistant cycle, no clock that others could follow.
void refuse_exact_time(const LineConfig& config) {
    for (const MasterEntry& m : config.masters) {
        if (m.dpv2.isochron != Ticks{}) refuse(m.at, "isochron needs exact time, which only a simulated line has (dpchip sim)");
        if (m.dpv2.clock_sync != Ticks{}) refuse(m.at, "clock_sync needs exact time, which only a simulated line has (dpchip sim)");
    }
}

master::MasterConfig live_config(const LineConfig& config, const LiveMaster::Options& options) {
    refuse_exact_time(config);
    master::MasterConfig m = master_config(config, fdl::BaudCode::kbit_19_2);
    if (options.mode != master::Mode::operate) m.mode = options.mode;
    if (m.mode == master::Mode::stop) m.min_cycle = std::max(m.min_cycle, kIdleCycle);
    if (!config.slot_time && options.slot_time) m.slot_time = *options.slot_time;
    return m;
}

}  // namespace

LiveMaster::LiveMaster(const LineConfig& config, const Options& options) : config_{config} {
    if (!config_.line) throw Failure{ExitCode::usage, "which line? Give --line PATH, --line serial:DEVICE or --line tcp:HOST:PORT"};
    if (config_.baud_auto) throw Failure{ExitCode::usage, "--baud auto is for slaves: a master decides on the rate"};
    master::MasterConfig m = live_config(config_, options);
    check_addresses(config_, m.address);
    live::LineOptions line;
    line.baud = m.baud;
    const std::vector<master::SlaveConfig> slaves = slave_configs(config_, shelf_, options.watchdog_ms);
    for (std::size_t i = 0; i < slaves.size(); ++i) texts_.set(slaves[i].address, &gsd(i));
    open_ = std::make_unique<live::OpenLine>(*config_.line, live::Role::visit, line);
    if (m.slot_time == Ticks{})
        m.slot_time = std::max(open_->line().slot_time(), open_->port().medium() == live::Medium::serial ? kSerialPatience : Ticks{});
    master_ = std::make_unique<master::Master>(m);
    add_slaves(*master_, config_, slaves);
    const auto attached = open_->line().segment().attach(*master_, "master");
    if (!attached) throw Failure{ExitCode::failed, segment::name(attached.error())};
    index_ = *attached;
    if (config_.trace)
        trace_ = std::make_unique<TraceFile>(*config_.trace, open_->line().segment(), live::Recorder::Options{place(), config_.link_type,
                                                                                live::epoch_ns(open_->line().now()), open_->line().port_station()});
}

std::string trouble(const master::SlaveHandler& slave) {
    const auto& c = slave.counters();
    if (slave.state() == master::SlaveState::absent)
        return c.diagnoses == 0 ? "does not answer" : fmt::format("does not answer any more ({} times lost)", c.lost);
    std::string text = fmt::format("stays in state '{}'", master::name(slave.state()));
    if (slave.fault() != master::SlaveFault::none) text += fmt::format(": {}", master::name(slave.fault()));
    const auto diagnosis = dp::decode_diag_header(slave.diagnosis());
    if (!diagnosis) return text;
    if (slave.fault() == master::SlaveFault::wrong_ident) text += fmt::format(" (0x{:04X} instead of 0x{:04X})", diagnosis->ident, slave.config().ident);
    if (slave.fault() == master::SlaveFault::locked) text += fmt::format(" ({})", diagnosis->master_add);
    return text;
}

}  // namespace dpchip::cli
