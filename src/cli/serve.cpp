// SPDX-License-Identifier: Apache-2.0
// `dpchip serve`: virtual slaves on a live line, for as long as nobody says stop.
#include <algorithm>
#include <cstdio>
#include <set>

#include <fmt/format.h>

#include <dpchip/cli/command_input.hpp>
#include <dpchip/cli/commands.hpp>
#include <dpchip/cli/dpv2_report.hpp>
#include <dpchip/cli/event_config.hpp>
#include <dpchip/cli/interrupt.hpp>
#include <dpchip/cli/live_view.hpp>
#include <dpchip/cli/log.hpp>
#include <dpchip/cli/settings.hpp>
#include <dpchip/cli/slave_arguments.hpp>
#include <dpchip/cli/slave_events.hpp>
#include <dpchip/cli/state_store.hpp>
#include <dpchip/cli/stations.hpp>
#include <dpchip/cli/trace_file.hpp>
#include <dpchip/live/open_line.hpp>

namespace dpchip::cli {
namespace {

struct Arguments {
    LineArguments line;
    LineConfig slaves;
    std::string state_dir;
    std::string commands;
    bool show_options = false;
};

class Server {
public:
    /// `commands`: where commands come from; empty: nowhere.
    Server(const LineConfig& config, const std::string& commands);
    ExitCode run();

private:
    struct Served {
        SlaveEntry entry;
        std::unique_ptr<slave::VirtualSlave> slave;
        slave::StoredAddress stored{};
        std::string said;  ///< its state as told last
        segment::StationIndex index{};
    };

    void build();
    live::LineOptions line_options() const;
    void keep_addresses();
    void tell_changes();
    Rows rows() const;
    void summary(const live::LiveLine& line) const;
    bool changed() const;
    Ticks until_event(Ticks now, Ticks longest) const;
    void happen(live::LiveLine& line);
    void happen(live::LiveLine& line, const EventEntry& event);

    LineConfig config_;
    GsdShelf shelf_;
    std::optional<StateStore> store_;
    std::vector<Served> served_;
    std::size_t next_event_ = 0;
    std::optional<CommandInput> commands_;
};

std::string state_text(const slave::VirtualSlave& s) {
    if (s.wd_state() == chip::WdState::baud_search) return "searching the baud rate";
    std::string text = fmt::format("{}, {}, {}", name(s.dp_state()), name(s.wd_state()), rate_text(s));
    if (s.owner() != dp::kNoMaster) text += fmt::format(", master {}", s.owner());
    return text;
}

Server::Server(const LineConfig& config, const std::string& commands) : config_{config} {
    if (config_.slaves.empty()) throw Failure{ExitCode::usage, "no slave to serve: give --gsd FILE --address N, or a LINE.toml with [[slave]]"};
    for (const EventEntry& e : config_.events)
        if (!is_of_the_slave(e.kind)) spdlog::warn("{}: note: {} is for `dpchip sim`; serve leaves it out", to_string(e.at), name(e.kind));
    std::erase_if(config_.events, [](const EventEntry& e) { return !is_of_the_slave(e.kind); });
    if (config_.state_dir) store_.emplace(*config_.state_dir);
    build();
    if (!commands.empty()) commands_.emplace(commands);
}

/// Everything that can be wrong with files and modules is found before the line is opened.
void Server::build() {
    check_addresses(config_);
    LineConfig present = config_;  // addresses as earlier runs left them
    std::set<std::string> files;
    for (std::size_t i = 0; i < config_.slaves.size(); ++i) {
        const SlaveEntry& entry = config_.slaves[i];
        const gsd::Gsd& gsd = shelf_.get(entry.gsd, entry.at);
        if (store_ && !files.insert(store_->path(entry)).second)
            refuse(entry.at, store_->path(entry) + " would be kept for two slaves; give them names of their own");
        const auto kept = store_ ? store_->load(entry, gsd.ident_number) : std::nullopt;
        Served s{entry, make_slave(gsd, entry, {}, kept ? &*kept : nullptr), {}, {}};
        s.stored = s.slave->stored_address();
        if (kept && kept->address != entry.address) spdlog::info("{}: address {} of an earlier Set_Slave_Add", title(entry), kept->address);
        present.slaves[i].address = s.stored.address;
        served_.push_back(std::move(s));
    }
    check_addresses(present);
}

live::LineOptions Server::line_options() const {
    live::LineOptions o;
    o.baud = config_.baud_auto ? fdl::BaudCode::mbit_12 : config_.baud.value_or(fdl::BaudCode::kbit_19_2);
    if (config_.slot_time) o.slot_time = config_.slot_time->at(o.baud);
    o.pace = config_.pace;
    return o;
}

bool Server::changed() const {
    return std::any_of(served_.begin(), served_.end(), [](const Served& s) {
        const slave::StoredAddress now = s.slave->stored_address();
        return now.address != s.stored.address || now.no_add_change != s.stored.no_add_change;
    });
}

void Server::keep_addresses() {
    for (Served& s : served_) {
        const slave::StoredAddress now = s.slave->stored_address();
        if (now.address == s.stored.address && now.no_add_change == s.stored.no_add_change) continue;
        spdlog::info("{}: Set_Slave_Add: address {}{}", title(s.entry), now.address, now.no_add_change ? ", locked" : "");
        s.stored = now;
        if (store_) store_->save(s.entry, s.slave->ident(), now);
    }
}

void Server::tell_changes() {
    for (Served& s : served_) {
        while (const auto event = s.slave->take_event())
            spdlog::info("slave {} {}: {}", s.slave->stored_address().address, s.slave->name(), slave::text(*event));
        std::string now = state_text(*s.slave);
        if (now == s.said) continue;
        if (!s.said.empty()) spdlog::info("slave {} {}: {}", s.slave->stored_address().address, s.slave->name(), now);
        s.said = std::move(now);
    }
}

/// How long the line may run until something is to happen.
Ticks Server::until_event(Ticks now, Ticks longest) const {
    if (next_event_ == config_.events.size()) return longest;
    return std::clamp(config_.events[next_event_].when - now, Ticks{}, longest);
}

/// Events that are due, and commands that have come.
void Server::happen(live::LiveLine& line) {
    for (; next_event_ < config_.events.size() && config_.events[next_event_].when <= line.now(); ++next_event_) happen(line, config_.events[next_event_]);
    while (const auto command = commands_ ? commands_->line() : std::nullopt) try {
            happen(line, read_command(*command, commands_->place(), config_));
        } catch (const Failure& f) {
            spdlog::error("{}", f.what());
        }
}

/// What cannot be is said, and the slaves go on.
void Server::happen(live::LiveLine& line, const EventEntry& event) {
    Served& s = served_[event.slave];
    line.segment().settle();
    try {
        const Deed deed = do_to(*s.slave, event);
        spdlog::log(deed.good ? spdlog::level::info : spdlog::level::warn, "slave {} {}: {}", s.slave->stored_address().address, s.slave->name(), deed.words);
    } catch (const Failure& f) {
        spdlog::error("{}", f.what());
    }
    line.segment().touch(s.index);
}

Rows Server::rows() const {
    Rows rows{{"ADDR", "NAME", "DP_STATE", "WD_STATE", "BAUD RATE", "MASTER", "EXCHANGES", "OUTPUTS", "INPUTS"}};
    for (const Served& s : served_) {
        const slave::VirtualSlave& v = *s.slave;
        rows.push_back({std::to_string(v.stored_address().address), v.name(), name(v.dp_state()), name(v.wd_state()), rate_text(v),
                        v.owner() == dp::kNoMaster ? "-" : std::to_string(v.owner()), std::to_string(v.counters().exchanges),
                        hex_text(v.outputs(), 8), hex_text(v.inputs(), 8)});
    }
    return rows;
}

void Server::summary(const live::LiveLine& line) const {
    const live::LineCounters& c = line.counters();
    std::printf("served %zu slave%s for %s: %llu telegrams heard, %llu sent, %llu damaged, %llu too late, %llu not taken\n", served_.size(),
                served_.size() == 1 ? "" : "s", time_text(line.now()).c_str(), static_cast<unsigned long long>(c.heard),
                static_cast<unsigned long long>(c.sent), static_cast<unsigned long long>(c.damaged), static_cast<unsigned long long>(c.late),
                static_cast<unsigned long long>(c.unsent));
    Rows rows{{"ADDR", "NAME", "DP_STATE", "EXCHANGES", "SET_PRM", "REFUSED", "CHK_CFG", "REFUSED", "DIAGNOSES", "ENTERED", "LEFT", "WD"}};
    for (const Served& s : served_) {
        const slave::Counters& n = s.slave->counters();
        rows.push_back({std::to_string(s.slave->stored_address().address), s.slave->name(), name(s.slave->dp_state()), std::to_string(n.exchanges),
                        std::to_string(n.set_prm), std::to_string(n.prm_refused), std::to_string(n.chk_cfg), std::to_string(n.cfg_refused),
                        std::to_string(n.slave_diag), std::to_string(n.data_exch_entered), std::to_string(n.data_exch_left),
                        std::to_string(n.watchdog_timeouts)});
    }
    print(rows);
    for (const Served& s : served_) report_dpv2(s.entry, *s.slave);
}

ExitCode Server::run() {
    live::OpenLine open{config_.line.value_or("pty"), live::Role::serve, line_options()};
    live::LiveLine& line = open.line();
    for (Served& s : served_) {
        const auto attached = line.segment().attach(*s.slave, s.slave->name());
        if (!attached) refuse(s.entry.at, title(s.entry) + ": " + segment::name(attached.error()));
        s.index = *attached;
    }
    if (config_.baud_auto) line.follow_baud([this] { return served_.front().slave->chip().state().probe; });
    std::optional<TraceFile> trace;
    if (config_.trace)
        trace.emplace(*config_.trace, line.segment(),
                      live::Recorder::Options{open.port().place(), config_.link_type, live::epoch_ns(line.now()), line.port_station()});
    const Interrupt interrupt{line};
    std::printf("ready %s=%s\n", live::name(open.port().medium()), open.port().place().c_str());
    std::fflush(stdout);
    LiveView view;
    while (!line.stopped()) {
        const Ticks slice = core::milliseconds(view.active() && !commands_ ? 200 : 50);
        line.run(until_event(line.now(), slice), [this] { return changed(); });
        happen(line);
        keep_addresses();
        if (view.active()) view.draw(rows());
        else tell_changes();
    }
    view.clear();
    line.segment().settle();
    keep_addresses();
    summary(line);
    if (trace) spdlog::info("{}: {} telegrams", trace->path(), trace->packets());
    return ExitCode::ok;
}

}  // namespace

void add_serve(CLI::App& app, Job& job) {
    CLI::App* const c = app.add_subcommand("serve", "virtual slaves on a pty, a serial port or TCP");
    const auto a = std::make_shared<Arguments>();
    add_slave_arguments(*c, a->slaves);
    add_line_arguments(*c, a->line);
    add_model_arguments(*c, a->line);
    c->add_option("--state-dir", a->state_dir, "keep addresses of Set_Slave_Add here, a file per slave")->type_name("DIR");
    c->add_option("--commands", a->commands, "do what lines from there say (docs/config.md): - is stdin; a path that is not there becomes a FIFO")->type_name("PATH");
    c->add_flag("--show-options", a->show_options, "list the options of the model and stop");
    c->footer(footer("  dpchip serve --gsd builtin:remote_io --module \"8 DI\" --module \"8 DO\" --address 5 --line pty:dp0\n"
                     "  dpchip serve examples/line.toml --line tcp:9000 --trace start.pcapng\n"
                     "  dpchip serve --gsd builtin:dpv1_io --module \"8 DI / 8 DO\" --address 7 --record 1:4=01020304 --line pty:dp1 --commands dp1.cmd\n"
                     "  echo alarm slave=7 type=diagnostic slot=1 specifier=appears octets=01 >dp1.cmd\n"
                     "The first line on stdout is `ready pty=PATH`, `ready serial=DEVICE` or `ready tcp=HOST:PORT`.\n"
                     "Without --line a new pty is made. SIGINT and SIGTERM end it with a summary."));
    c->callback([a, &job] {
        job = [a] {
            if (a->show_options) {
                std::fputs(options_text().c_str(), stdout);
                return ExitCode::ok;
            }
            LineConfig config = line_config(a->line, a->slaves);
            if (!a->state_dir.empty()) config.state_dir = a->state_dir;
            return Server{config, a->commands}.run();
        };
    });
}

}  // namespace dpchip::cli
