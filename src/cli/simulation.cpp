// SPDX-License-Identifier: Apache-2.0
// The course of a scenario.
#include <algorithm>

#include <fmt/format.h>

#include <dpchip/cli/log.hpp>
#include <dpchip/cli/master_setup.hpp>
#include <dpchip/cli/simulation.hpp>
#include <dpchip/cli/stop_signal.hpp>
#include <dpchip/cli/slave_events.hpp>

namespace dpchip::cli {
namespace {

constexpr std::uint32_t kWatchdogMs = 100;
constexpr Ticks kLongest = core::seconds(3600);

std::vector<Application::Wish> wishes(const LineConfig& config) {
    std::vector<Application::Wish> all;
    for (const SlaveEntry& s : config.slaves) {
        Application::Wish w;
        w.io = slave::IoBehaviour{s.io.value_or("echo")};
        all.push_back(std::move(w));
    }
    return all;
}

}  // namespace

segment::Fault Simulation::Faults::operator()(const fdl::Transmission&, segment::StationIndex sender, std::uint64_t) {
    for (Armed& a : armed) {
        if (a.left == 0 || (a.sender != segment::kNobody && a.sender != sender)) continue;
        --a.left;
        ++*count;
        return a.fault;
    }
    return {};
}

Simulation::Simulation(const LineConfig& config) : config_{config} {
    if (config_.slaves.empty()) refuse({config_.file, 0, 0}, "a scenario needs at least one [[slave]]");
    if (config_.baud_auto) refuse({config_.file, 0, 0}, "baud = \"auto\" is for live lines");
    const master::MasterConfig m = master_config(config_, fdl::BaudCode::mbit_12);
    check_addresses(config_, m.address);
    master_ = std::make_unique<master::Master>(m);
    application_ = std::make_unique<Application>(wishes(config_));
    master_index_ = *segment_.attach(*master_, "master");
    add_slaves(*master_, config_, slave_configs(config_, shelf_, kWatchdogMs));
    for (const SlaveEntry& entry : config_.slaves) {
        const gsd::Gsd& gsd = shelf_.get(entry.gsd, entry.at);
        Member member{entry, make_slave(gsd, entry), {}, true, false, 0};
        members_.push_back(std::move(member));
        attach(members_.back());
    }
    alarm_desk_ = std::make_unique<AlarmDesk>(*master_, config_.slaves, shelf_);
    hook_ = {application_.get(), alarm_desk_.get()};
    master_->on_cycle(hook_);
    segment_.observe(judge_);
    segment_.set_faults(segment::FaultRef{fault_source_});
    if (config_.trace) trace_ = std::make_unique<TraceFile>(*config_.trace, segment_, live::Recorder::Options{"simulated line", config_.link_type, 0, master_index_});
}

/// What the slave with this address publishes.
/// The master dies at this very moment. A backup with its address and its state hears silence and goes on.
void Simulation::switch_over() {
    const master::Mode mode = master_->mode();
    segment_.detach(master_index_);
    master_->set_mode(master::Mode::offline);
    master_index_ = *segment_.attach(*master_, "backup master");
    segment_.settle();
    master_->set_mode(mode);
    segment_.touch(master_index_);
}

void Simulation::attach(Member& m) {
    const auto attached = segment_.attach(*m.slave, m.slave->name());
    if (!attached) refuse(m.entry.at, title(m.entry) + ": " + segment::name(attached.error()));
    m.index = *attached;
    m.plugged = true;
}

void Simulation::detach(Member& m) {
    if (m.plugged) segment_.detach(m.index);
    m.plugged = false;
}

void Simulation::power_on(Member& m, const EventEntry& event) {
    if (m.on) refuse(event.at, title(m.entry) + " has power already");
    m.slave = make_slave(shelf_.get(m.entry.gsd, m.entry.at), m.entry, segment_.now());
    m.on = true;
    attach(m);
}

void Simulation::arm(const EventEntry& e) {
    segment::StationIndex sender = segment::kNobody;
    if (e.sender == kMasterSends) sender = master_index_;
    else if (e.sender) {
        if (!members_[*e.sender].plugged) refuse(e.at, title(members_[*e.sender].entry) + " is not on the line");
        sender = members_[*e.sender].index;
    }
    fault_source_.armed.push_back({e.fault, e.count, sender});
}

void Simulation::happen_to(Member& m, const EventEntry& e) {
    if (!m.on) refuse(e.at, title(m.entry) + " has no power");
    const Deed deed = do_to(*m.slave, e);
    if (deed.good) spdlog::info("{}: {}: {}", time_text(e.when), title(m.entry), deed.words);
    else spdlog::warn("{}: {}: {}", time_text(e.when), title(m.entry), deed.words);
    if (!deed.good) ++unheard_;
    if (m.plugged) segment_.touch(m.index);
    if (e.kind != EventKind::io) return;
    application_->expect(e.slave, m.slave->io());
    m.entry.io = e.io;
}

/// What slaves and master have to say, as it happens.
void Simulation::tell() {
    for (AlarmDesk::Line& line : alarm_desk_->take(segment_.now())) {
        spdlog::info("{}: master: {}: {}", time_text(line.at), title(members_[line.slave].entry), line.text);
        for (const std::string& detail : line.details) spdlog::info("  {}", detail);
        alarms_.push_back(std::move(line));
    }
    for (Member& m : members_)
        while (const auto event = m.on ? m.slave->take_event() : std::nullopt)
            spdlog::info("{}: {}: {}", time_text(segment_.now()), title(m.entry), slave::text(*event));
}

/// Global_Control, and what it does to the check of values.
void Simulation::control(const EventEntry& e) {
    if (!master_->global_control({e.command, e.groups})) refuse(e.at, "too many Global_Control at one time");
    modes_ |= e.command & (dp::kGcSync | dp::kGcFreeze | dp::kGcClearData);
    if (e.command == 0) modes_ &= static_cast<std::uint8_t>(~dp::kGcClearData);
    if ((e.command & dp::kGcUnsync) != 0) modes_ &= static_cast<std::uint8_t>(~dp::kGcSync);
    if ((e.command & dp::kGcUnfreeze) != 0) modes_ &= static_cast<std::uint8_t>(~dp::kGcFreeze);
    application_->disturb(modes_ != 0);
}

void Simulation::happen(const EventEntry& e) {
    spdlog::info("{}: {}", time_text(e.when), name(e.kind));
    segment_.settle();
    Member& m = members_[e.slave];
    switch (e.kind) {
    case EventKind::power_off:
        if (!m.on) refuse(e.at, title(m.entry) + " has no power already");
        m.exchanges += m.slave->counters().exchanges;
        detach(m);
        m.slave.reset();
        m.on = false;
        return;
    case EventKind::power_on: return power_on(m, e);
    case EventKind::unplug:
        if (!m.plugged) refuse(e.at, title(m.entry) + " is not on the line");
        return detach(m);
    case EventKind::plug:
        if (!m.on || m.plugged) refuse(e.at, title(m.entry) + (m.on ? " is on the line already" : " has no power"));
        return attach(m);
    case EventKind::diagnosis:
    case EventKind::alarm:
    case EventKind::status:
    case EventKind::io: return happen_to(m, e);
    case EventKind::global_control: return control(e);
    case EventKind::fault: return arm(e);
    case EventKind::switch_over: return switch_over();
    case EventKind::mode:
        master_->set_mode(e.mode);
        segment_.touch(master_index_);
        return;
    }
}

void Simulation::advance_to(Ticks end, std::optional<std::uint64_t> cycles) {
    const auto look = [&] {
        if (waves_) look_at_waves();
        if (!reached_ && master_->all_exchanging()) {
            reached_ = segment_.now();
            master_->clear_statistics();  // the summary is about data exchange, not about the way to it
        }
        tell();
        return StopSignal::stopped() || (cycles && reached_ && master_->cycle().cycles >= *cycles);
    };
    segment_.run_until(look, end - segment_.now());
}

void Simulation::run(std::optional<Ticks> duration, std::optional<std::uint64_t> cycles) {
    if (!duration && !cycles) cycles = 100;
    const Ticks end = duration.value_or(kLongest);
    for (const EventEntry& event : config_.events) {
        if (event.when > end) refuse(event.at, "this event is later than the end of the scenario");
        advance_to(event.when, {});
        if (StopSignal::stopped()) return;
        happen(event);
    }
    advance_to(end, duration ? std::optional<std::uint64_t>{} : cycles);
    segment_.settle();
}

void Simulation::show_waves(const WaveOptions& options) {
    std::vector<std::string> names;
    for (const Member& m : members_) {
        std::string scope = m.slave ? m.slave->name() : title(m.entry);
        std::replace(scope.begin(), scope.end(), '.', '_');
        if (std::find(names.begin(), names.end(), scope) != names.end()) scope += ' ' + std::to_string(m.entry.address.value_or(126));
        names.push_back(scope);
    }
    waves_ = std::make_unique<WaveFile>(options, segment_, names);
    look_at_waves();
}

void Simulation::look_at_waves() {
    waves_->set_master(master_index_);
    for (std::size_t n = 0; n < members_.size(); ++n)
        waves_->look(n, members_[n].slave.get(), members_[n].plugged ? members_[n].index : segment::kNobody);
    waves_->settle();
}

bool Simulation::good() const {
    for (std::size_t i = 0; i < members_.size(); ++i)
        if (members_[i].plugged && !master_->slave(i).exchanging()) return false;
    return reached_ && application_->wrong() == 0 && (judge_.clean() || faults_ != 0);
}

}  // namespace dpchip::cli
