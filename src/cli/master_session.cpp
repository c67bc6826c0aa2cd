// SPDX-License-Identifier: Apache-2.0
// The course of `master run`.
#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <dpchip/cli/interrupt.hpp>
#include <dpchip/cli/log.hpp>
#include <dpchip/cli/master_session.hpp>
#include <dpchip/trace/service_text.hpp>

namespace dpchip::cli {
namespace {

constexpr Ticks kSlice = core::milliseconds(100);

std::vector<Application::Wish> wishes(const LineConfig& config, const SessionOptions& options) {
    std::vector<Application::Wish> all;
    for (const SlaveEntry& s : config.slaves) {
        Application::Wish w;
        if (s.io) w.io = slave::IoBehaviour{*s.io};
        w.outputs = options.outputs;
        all.push_back(std::move(w));
    }
    return all;
}

}  // namespace

MasterSession::MasterSession(const LineConfig& config, const SessionOptions& options)
    : options_{options}, live_{std::make_unique<LiveMaster>(config, LiveMaster::Options{})}, application_{wishes(config, options)},
      alarm_desk_{live_->master(), live_->config().slaves, live_->shelf()},
      said_(config.slaves.size()), lost_before_(config.slaves.size()) {
    if (config.slaves.empty()) throw Failure{ExitCode::usage, "no slave to drive: give --gsd FILE --address N, or a LINE.toml with [[slave]]"};
    live_->master().on_cycle(hook_);
}

ExitCode MasterSession::run() {
    const Interrupt interrupt{live_->line()};
    reached_ = reach();
    if (reached_) exchange();
    leave();
    view_.clear();
    return report();
}

bool MasterSession::reach() {
    const Ticks begin = live_->line().now();
    for (;;) {
        const Ticks spent = live_->line().now() - begin;
        const bool all = live_->run_until([this] { return live_->master().all_exchanging(); }, std::min(kSlice, options_.patience - spent));
        reached_after_ = live_->line().now() - begin;
        if (view_.active() && !options_.json) view_.draw(rows());
        else tell_changes();
        if (all) return true;
        stopped_ = live_->line().stopped();
        if (stopped_ || reached_after_ >= options_.patience) return false;
    }
}

void MasterSession::exchange() {
    master::Master& m = live_->master();
    for (std::size_t n = 0; n < m.size(); ++n) lost_before_[n] = m.slave(n).counters().lost;
    m.clear_statistics();
    const Ticks begin = live_->line().now();
    const auto enough = [&] { return options_.cycles && m.cycle().cycles >= *options_.cycles; };
    for (;;) {
        const Ticks spent = live_->line().now() - begin;
        const Ticks left = options_.duration ? *options_.duration - spent : core::kNever;
        if (enough() || left <= Ticks{} || live_->line().stopped()) break;
        live_->line().run(std::min(kSlice, left), enough);
        if (view_.active() && !options_.json) view_.draw(rows());
        else tell_changes();
    }
    stopped_ = live_->line().stopped();
}

/// The slaves are left with outputs of zero; who has a watchdog then waits for its next master.
void MasterSession::leave() {
    master::Master& m = live_->master();
    counters_ = m.counters();
    cycle_ = m.cycle();
    rows_at_the_end_ = rows();
    for (std::size_t n = 0; n < m.size(); ++n) {
        const master::SlaveHandler& s = m.slave(n);
        at_the_end_.push_back({s.exchanging(), hex_text(s.outputs(), 244), hex_text(s.inputs(), 244)});
    }
    live_->line().resume();
    m.set_mode(master::Mode::clear);
    const std::uint64_t until = m.cycle().cycles + 3;
    live_->run_until([&] { return m.cycle().cycles >= until; }, core::seconds(1));
}

void MasterSession::tell_changes() {
    const master::Master& m = live_->master();
    for (const AlarmDesk::Line& line : alarm_desk_.take(live_->line().now())) {
        spdlog::info("master: slave {} {}: {}", m.slave(line.slave).config().address, m.slave(line.slave).config().name, line.text);
        for (const std::string& detail : line.details) spdlog::info("  {}", detail);
    }
    for (std::size_t n = 0; n < m.size(); ++n) {
        std::string now = master::name(m.slave(n).state());
        if (m.slave(n).fault() != master::SlaveFault::none) now += fmt::format(" ({})", master::name(m.slave(n).fault()));
        if (now == said_[n]) continue;
        spdlog::info("master: slave {} {}: {}", m.slave(n).config().address, m.slave(n).config().name, now);
        said_[n] = std::move(now);
    }
}

Rows MasterSession::rows() const {
    Rows rows{{"ADDR", "NAME", "STATE", "EXCHANGES", "CHECKED", "WRONG", "RETRIES", "LOST", "OUTPUTS", "INPUTS"}};
    const master::Master& m = live_->master();
    for (std::size_t n = 0; n < m.size(); ++n) {
        const master::SlaveHandler& s = m.slave(n);
        const Application::Checked& c = application_.checked(n);
        rows.push_back({std::to_string(s.config().address), s.config().name, master::name(s.state()), std::to_string(s.counters().exchanges),
                        std::to_string(c.compared), std::to_string(c.wrong), std::to_string(s.counters().retries), std::to_string(lost(n)),
                        hex_text(s.outputs(), 8), hex_text(s.inputs(), 8)});
    }
    return rows;
}

bool MasterSession::good() const {
    if (!reached_ || application_.wrong() != 0) return false;
    for (std::size_t n = 0; n < at_the_end_.size(); ++n)
        if (!at_the_end_[n].exchanging || lost(n) != 0) return false;
    return !options_.cycles || stopped_ || cycle_.cycles >= *options_.cycles;
}

ExitCode MasterSession::report() const {
    const bool ok = good();
    if (options_.json) report_json(ok);
    else report_text(ok);
    return ok ? ExitCode::ok : ExitCode::failed;
}

void MasterSession::report_text(bool ok) const {
    const master::Master& m = live_->master();
    print(rows_at_the_end_);
    if (reached_) {
        std::printf("all %zu slave%s in data exchange after %s\n", m.size(), m.size() == 1 ? "" : "s", time_text(reached_after_).c_str());
        if (cycle_.cycles != 0)
            std::printf("%llu cycles, %s to %s each; %llu requests, %llu repeated; %llu inputs compared, %llu wrong\n",
                        static_cast<unsigned long long>(cycle_.cycles), time_text(cycle_.min).c_str(), time_text(cycle_.max).c_str(),
                        static_cast<unsigned long long>(counters_.requests), static_cast<unsigned long long>(counters_.retries),
                        static_cast<unsigned long long>(application_.compared()), static_cast<unsigned long long>(application_.wrong()));
    }
    for (std::size_t n = 0; n < m.size(); ++n) {
        const master::SlaveHandler& s = m.slave(n);
        if (!at_the_end_[n].exchanging) spdlog::error("slave {} {}: {}", s.config().address, s.config().name, trouble(s));
        else if (lost(n) != 0) spdlog::error("slave {} {}: lost {} times", s.config().address, s.config().name, lost(n));
        if (application_.checked(n).wrong != 0)
            spdlog::error("slave {} {}: {}", s.config().address, s.config().name, application_.checked(n).first_wrong);
        if (s.diagnosis().size() <= dp::kDiagHeader && at_the_end_[n].exchanging) continue;
        if (!s.diagnosis().empty()) std::printf("slave %d diagnosis: %s\n", s.config().address, trace::diag_text(s.diagnosis(), s.config().address, &live_->texts()).words.c_str());
    }
    if (ok) return;
    if (stopped_ && !reached_) spdlog::error("stopped before all slaves were in data exchange");
}

void MasterSession::report_json(bool ok) const {
    const master::Master& m = live_->master();
    nlohmann::ordered_json j;
    j["ok"] = ok;
    j["line"] = live_->place();
    j["reached_ms"] = reached_ ? nlohmann::ordered_json(core::to_ns(reached_after_) / 1'000'000) : nlohmann::ordered_json(nullptr);
    j["cycles"] = cycle_.cycles;
    if (cycle_.cycles != 0) j["cycle_us"] = {{"min", core::to_ns(cycle_.min) / 1000}, {"max", core::to_ns(cycle_.max) / 1000}};
    j["requests"] = counters_.requests;
    j["retries"] = counters_.retries;
    for (std::size_t n = 0; n < m.size(); ++n) {
        const master::SlaveHandler& s = m.slave(n);
        const Application::Checked& c = application_.checked(n);
        nlohmann::ordered_json e;
        e["address"] = s.config().address;
        e["name"] = s.config().name;
        e["data_exchange"] = at_the_end_[n].exchanging;
        e["fault"] = master::name(s.fault());
        e["exchanges"] = s.counters().exchanges;
        e["compared"] = c.compared;
        e["wrong"] = c.wrong;
        e["retries"] = s.counters().retries;
        e["lost"] = lost(n);
        e["outputs"] = at_the_end_[n].outputs;
        e["inputs"] = at_the_end_[n].inputs;
        e["diagnosis"] = hex_text(s.diagnosis(), 244);
        j["slaves"].push_back(std::move(e));
    }
    std::printf("%s\n", j.dump(2).c_str());
}

}  // namespace dpchip::cli
