// SPDX-License-Identifier: Apache-2.0
// `dpchip sim`: a scenario in virtual time, and what came of it.
#include <chrono>
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <dpchip/cli/commands.hpp>
#include <dpchip/cli/dpv2_report.hpp>
#include <dpchip/cli/live_view.hpp>
#include <dpchip/cli/log.hpp>
#include <dpchip/cli/settings.hpp>
#include <dpchip/cli/simulation.hpp>
#include <dpchip/cli/stop_signal.hpp>

namespace dpchip::cli {
namespace {

struct Arguments {
    std::string file, duration, baud, trace;
    std::string vcd, vcd_from, vcd_to, vcd_timescale = "1ps";
    std::vector<std::string> signals;
    int link_type = 147;
    std::uint64_t cycles = 0;
    std::vector<std::string> options;
    bool json = false;
};

std::uint64_t exchanges(const Simulation::Member& m) { return m.exchanges + (m.on ? m.slave->counters().exchanges : 0); }

std::string state(const Simulation::Member& m) {
    if (!m.on) return "no power";
    if (!m.plugged) return "unplugged";
    return name(m.slave->dp_state());
}

double in_us(Ticks t) { return static_cast<double>(t.n) / static_cast<double>(core::kTicksPerNs) / 1e3; }

void report_alarms(const Simulation& s) {
    for (const AlarmDesk::Line& a : s.alarms()) {
        std::printf("%s %s: %s\n", time_text(a.at).c_str(), title(s.members()[a.slave].entry).c_str(), a.text.c_str());
        for (const std::string& detail : a.details) std::printf("  %s\n", detail.c_str());
    }
    if (s.alarm_desk().empty() && s.unheard() == 0) return;
    std::printf("%llu alarms received, %llu acknowledged; %llu status messages; %llu that the master did not hear of\n",
                static_cast<unsigned long long>(s.alarm_desk().alarms()), static_cast<unsigned long long>(s.alarm_desk().acknowledged()),
                static_cast<unsigned long long>(s.alarm_desk().status_messages()), static_cast<unsigned long long>(s.unheard()));
}

void report_text(const Simulation& s, double seconds) {
    const master::Master& m = s.master();
    Rows rows{{"ADDR", "NAME", "SLAVE", "MASTER SAYS", "EXCHANGES", "COMPARED", "WRONG", "RETRIES", "LOST"}};
    for (std::size_t n = 0; n < s.members().size(); ++n) {
        const Application::Checked& c = s.application().checked(n);
        rows.push_back({std::to_string(m.slave(n).config().address), m.slave(n).config().name, state(s.members()[n]), master::name(m.slave(n).state()),
                        std::to_string(exchanges(s.members()[n])), std::to_string(c.compared), std::to_string(c.wrong),
                        std::to_string(m.slave(n).counters().retries), std::to_string(m.slave(n).counters().lost)});
    }
    print(rows);
    const double virtual_s = in_us(s.now()) / 1e6;
    std::printf("%s of line time at %s in %.2f s (%.1f times as fast)\n", time_text(s.now()).c_str(), fdl::baud(m.config().baud).name.data(), seconds,
                seconds > 0 ? virtual_s / seconds : 0.0);
    if (s.reached()) std::printf("all slaves in data exchange after %s\n", time_text(*s.reached()).c_str());
    const master::CycleStatistics& cycle = m.cycle();
    if (cycle.cycles != 0)
        std::printf("%llu cycles, %.6f to %.6f us each, %lld to %lld tBit\n", static_cast<unsigned long long>(cycle.cycles), in_us(cycle.min), in_us(cycle.max),
                    static_cast<long long>(cycle.min / fdl::baud(m.config().baud).bit), static_cast<long long>(cycle.max / fdl::baud(m.config().baud).bit));
    std::printf("%llu inputs compared, %llu wrong; %llu faults injected; the judge saw %llu telegrams and %llu violations\n",
                static_cast<unsigned long long>(s.application().compared()), static_cast<unsigned long long>(s.application().wrong()),
                static_cast<unsigned long long>(s.faults()), static_cast<unsigned long long>(s.judge().telegrams()),
                static_cast<unsigned long long>(s.judge().total()));
    report_alarms(s);
    report_dpv2(s);
    for (std::size_t n = 0; n < s.members().size(); ++n)
        if (s.application().checked(n).wrong != 0) spdlog::error("{}: {}", title(s.members()[n].entry), s.application().checked(n).first_wrong);
    for (const segment::Violated& v : s.judge().violations().first(std::min<std::size_t>(s.judge().violations().size(), 10)))
        spdlog::warn("{}: {} by station {}", time_text(v.at), segment::name(v.rule), v.sender == segment::kNobody ? std::string{"nobody"} : std::to_string(v.sender));
}

void report_json(const Simulation& s, double seconds) {
    const master::Master& m = s.master();
    nlohmann::ordered_json j;
    j["ok"] = s.good();
    j["baud"] = fdl::baud(m.config().baud).bits_per_s;
    j["line_ns"] = core::to_ns(s.now());
    j["wall_s"] = seconds;
    j["reached_ns"] = s.reached() ? nlohmann::ordered_json(core::to_ns(*s.reached())) : nlohmann::ordered_json(nullptr);
    j["cycles"] = m.cycle().cycles;
    if (m.cycle().cycles != 0) j["cycle_ticks"] = {{"min", m.cycle().min.n}, {"max", m.cycle().max.n}, {"per_tbit", fdl::baud(m.config().baud).bit.n}};
    j["requests"] = m.counters().requests;
    j["retries"] = m.counters().retries;
    j["faults"] = s.faults();
    j["violations"] = s.judge().total();
    if (!s.alarm_desk().empty()) {
        j["alarms_acknowledged"] = s.alarm_desk().acknowledged();
        j["alarms"] = nlohmann::ordered_json::array();
        for (const AlarmDesk::Line& a : s.alarms())
            j["alarms"].push_back({{"line_ns", core::to_ns(a.at)}, {"address", m.slave(a.slave).config().address}, {"kind", a.status ? "status" : "alarm"},
                                   {"text", a.text}, {"details", a.details}});
    }
    for (std::size_t n = 0; n < s.members().size(); ++n) {
        const Application::Checked& c = s.application().checked(n);
        nlohmann::ordered_json e;
        e["address"] = m.slave(n).config().address;
        e["name"] = m.slave(n).config().name;
        e["state"] = state(s.members()[n]);
        e["data_exchange"] = m.slave(n).exchanging();
        e["exchanges"] = exchanges(s.members()[n]);
        e["compared"] = c.compared;
        e["wrong"] = c.wrong;
        e["retries"] = m.slave(n).counters().retries;
        e["lost"] = m.slave(n).counters().lost;
        report_dpv2(s, n, e);
        j["slaves"].push_back(std::move(e));
    }
    std::printf("%s\n", j.dump(2).c_str());
}

Ticks moment(const char* option, const std::string& text, Ticks otherwise) {
    if (text.empty()) return otherwise;
    const std::optional<Ticks> at = parse_duration(text);
    if (!at) throw Failure{ExitCode::usage, std::string{option} + ' ' + text + ": write 2ms, 250us or 1.5s"};
    return *at;
}

WaveOptions wave_options(const Arguments& a) {
    WaveOptions o{a.vcd, {}};
    o.drawn.signals = a.signals;
    o.drawn.from = moment("--from", a.vcd_from, {});
    o.drawn.to = moment("--to", a.vcd_to, core::kNever);
    const auto timescale = trace::parse_timescale(a.vcd_timescale);
    if (!timescale) throw Failure{ExitCode::usage, "--vcd-timescale " + a.vcd_timescale + ": write 1, 10 or 100 and fs, ps, ns, us, ms or s, as in 100ns"};
    o.drawn.timescale = *timescale;
    if (o.drawn.from >= o.drawn.to) throw Failure{ExitCode::usage, "--from " + a.vcd_from + " is not before --to " + a.vcd_to};
    const bool used = !a.signals.empty() || !a.vcd_from.empty() || !a.vcd_to.empty() || a.vcd_timescale != "1ps";
    if (a.vcd.empty() && used) throw Failure{ExitCode::usage, "--signals, --from, --to and --vcd-timescale are about waveforms: say --vcd FILE, too"};
    return o;
}

ExitCode run(const Arguments& a) {
    const WaveOptions waves = wave_options(a);
    LineConfig config = read_line_config(a.file);
    if (!a.baud.empty()) config.baud = parse_baud(a.baud);
    if (!a.baud.empty() && !config.baud) throw Failure{ExitCode::usage, "--baud " + a.baud + ": none of the ten rates"};
    if (!a.trace.empty()) {
        config.trace = a.trace;
        config.link_type = static_cast<trace::LinkType>(a.link_type);
    }
    for (SlaveEntry& s : config.slaves)
        for (const std::string& option : a.options) set_option(s.options, option, {});
    std::optional<Ticks> duration = config.duration;
    std::optional<std::uint64_t> cycles = config.cycles;
    if (!a.duration.empty()) {
        duration = parse_duration(a.duration);
        cycles.reset();
        if (!duration) throw Failure{ExitCode::usage, "--for " + a.duration + ": write 2ms, 250us or 1.5s"};
    }
    if (a.cycles != 0) {
        cycles = a.cycles;
        duration.reset();
    }
    const StopSignal signal;
    Simulation simulation{config};
    if (!waves.path.empty()) simulation.show_waves(waves);
    const auto begin = std::chrono::steady_clock::now();
    simulation.run(duration, cycles);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (StopSignal::stopped()) spdlog::warn("stopped after {} of line time", time_text(simulation.now()));
    if (a.json) report_json(simulation, seconds);
    else report_text(simulation, seconds);
    for (std::size_t n = 0; n < simulation.members().size(); ++n)
        if (simulation.members()[n].plugged && !simulation.master().slave(n).exchanging())
            spdlog::error("{}: not in data exchange: {}", title(simulation.members()[n].entry), master::name(simulation.master().slave(n).state()));
    return simulation.good() ? ExitCode::ok : ExitCode::failed;
}

}  // namespace

void add_sim(CLI::App& app, Job& job) {
    CLI::App* const c = app.add_subcommand("sim", "a master and slaves in virtual time, from a scenario");
    const auto a = std::make_shared<Arguments>();
    c->add_option("file", a->file, "the scenario; - reads stdin")->type_name("SCENARIO.toml")->required();
    c->add_option("--cycles", a->cycles, "end after so many cycles with all slaves in data exchange")->type_name("N");
    c->add_option("--for", a->duration, "end after so much line time: 10ms, 2s")->type_name("TIME");
    c->add_option("--baud", a->baud, "another rate than the scenario's")->type_name("RATE");
    c->add_option("--option", a->options, "an option of the model, for all slaves")->type_name("NAME=VALUE")->expected(1)->take_all();
    c->add_option("--trace", a->trace, "record everything on the line")->type_name("FILE.pcapng");
    c->add_option("--link-type", a->link_type, "link type of the trace")->check(CLI::IsMember({147, 257}));
    c->add_option("--vcd", a->vcd, "write waveforms: levels of the line bit by bit, pins and state machines of the slaves")->type_name("FILE.vcd");
    c->add_option("--signals", a->signals, "only these: SCOPE.NAME, with * and ?; several with commas: 'Press.*XD,line.*'; an unknown one lists all")
        ->type_name("PATTERN")->delimiter(',')->expected(1)->take_all();
    c->add_option("--from", a->vcd_from, "waveforms from this line time on")->type_name("TIME");
    c->add_option("--to", a->vcd_to, "waveforms up to this line time")->type_name("TIME");
    c->add_option("--vcd-timescale", a->vcd_timescale, "resolution of the waveforms: 1ps (default), 10ns, 100ns, ...")->type_name("UNIT");
    c->add_flag("--json", a->json, "the report as JSON");
    c->footer(footer("  dpchip sim examples/scenario.toml --trace scenario.pcapng\n"
                     "  dpchip sim examples/scenario.toml --vcd scenario.vcd --to 20ms --signals 'line.*,Press.*'\n"
                     "Line time is virtual and exact; the file decides what happens when (docs/config.md).\n"
                     "Exit code 1: a slave not in data exchange at the end, wrong inputs, or rules of the bus broken without injected fault."));
    c->callback([a, &job] { job = [a] { return run(*a); }; });
}

}  // namespace dpchip::cli
