// SPDX-License-Identifier: Apache-2.0
// A master on a live line.
#include <algorithm>

#include <fmt/format.h>

#include <dpchip/cli/live_master.hpp>

namespace dpchip::cli {
namespace {

/// A program is no hardware: also on serial lines it waits longer for an answer than the profile says, because the
/// adapter and the operating system hand octets over when they like.
constexpr Ticks kSerialPatience = core::milliseconds(50);
/// A master that only asks now and then does not fill a pty with tokens.
constexpr Ticks kIdleCycle = core::milliseconds(5);

master::MasterConfig master_config_of(const LineConfig& config, const LiveMaster::Options& options) {
    if (config.masters.size() > 1) refuse(config.masters[1].at, "this program is one master; one [[master]] is possible");
    MasterEntry entry;
    if (!config.masters.empty()) entry = config.masters[0];
    master::MasterConfig m;
    m.address = entry.address;
    m.baud = config.baud.value_or(fdl::BaudCode::kbit_19_2);
    m.max_retry = entry.max_retry;
    m.gap_factor = entry.gap_factor;
    m.min_cycle = entry.min_cycle;
    m.mode = options.mode == master::Mode::operate ? entry.mode : options.mode;
    if (m.mode == master::Mode::stop) m.min_cycle = std::max(m.min_cycle, kIdleCycle);
    if (config.slot_time) m.slot_time = config.slot_time->at(m.baud);
    else if (options.slot_time) m.slot_time = *options.slot_time;
    return m;
}

}  // namespace

LiveMaster::LiveMaster(const LineConfig& config, const Options& options) : config_{config} {
    if (!config_.line) throw Failure{ExitCode::usage, "which line? Give --line PATH, --line serial:DEVICE or --line tcp:HOST:PORT"};
    if (config_.baud_auto) throw Failure{ExitCode::usage, "--baud auto is for slaves: a master decides on the rate"};
    master::MasterConfig m = master_config_of(config_, options);
    check_addresses(config_, m.address);
    live::LineOptions line;
    line.baud = m.baud;
    std::vector<master::SlaveConfig> slaves;
    for (const SlaveEntry& entry : config_.slaves) {
        if (entry.address == 126) refuse(entry.at, "a slave with address 126 has to get another one first");
        const gsd::Gsd& gsd = shelf_.get(entry.gsd, entry.at);
        slaves.push_back(cli::master_config(gsd, entry, options.watchdog_ms));
        texts_.set(slaves.back().address, &gsd);
    }
    open_ = std::make_unique<live::OpenLine>(*config_.line, live::Role::visit, line);
    if (m.slot_time == Ticks{})
        m.slot_time = std::max(open_->line().slot_time(), open_->port().medium() == live::Medium::serial ? kSerialPatience : Ticks{});
    master_ = std::make_unique<master::Master>(m);
    for (std::size_t i = 0; i < slaves.size(); ++i)
        if (const auto added = master_->add(slaves[i]); !added) refuse(config_.slaves[i].at, title(config_.slaves[i]) + ": " + master::name(added.error()));
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
