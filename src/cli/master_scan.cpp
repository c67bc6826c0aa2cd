// SPDX-License-Identifier: Apache-2.0
// `dpchip master scan`: the live list with ident numbers.
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <dpchip/cli/interrupt.hpp>
#include <dpchip/cli/live_master.hpp>
#include <dpchip/cli/live_view.hpp>
#include <dpchip/cli/log.hpp>
#include <dpchip/cli/master_verbs.hpp>
#include <dpchip/cli/slave_arguments.hpp>

namespace dpchip::cli {
namespace {

struct Arguments {
    LineArguments line;
    double wake = 2;
    bool json = false;
};

/// 126 absent stations take this long each; answers of a program come within a few milliseconds.
constexpr Ticks kScanPatience = core::milliseconds(30);

const char* station_text(fdl::StationType type) {
    switch (type) {
    case fdl::StationType::slave: return "slave";
    case fdl::StationType::master_not_ready: return "master, not ready";
    case fdl::StationType::master_ready: return "master, ready";
    case fdl::StationType::master_in_ring: return "master in the ring";
    }
    return "?";
}

ExitCode report(const std::array<master::Found, 127>& found, bool json) {
    nlohmann::ordered_json j = nlohmann::ordered_json::array();
    Rows rows{{"ADDR", "STATION", "IDENT", "MASTER"}};
    for (std::size_t address = 0; address < found.size(); ++address) {
        const master::Found& f = found[address];
        if (!f.present) continue;
        const bool owned = f.diagnosed && f.master_add != dp::kNoMaster;
        std::string ident = "-", master = "-";
        if (f.diagnosed) ident = fmt::format("0x{:04X}", f.ident);
        if (owned) master = std::to_string(f.master_add);
        rows.push_back({std::to_string(address), station_text(f.type), std::move(ident), std::move(master)});
        nlohmann::ordered_json e;
        e["address"] = address;
        e["station"] = station_text(f.type);
        if (f.diagnosed) e["ident"] = fmt::format("0x{:04X}", f.ident);
        if (owned) e["master"] = f.master_add;
        j.push_back(std::move(e));
    }
    if (json) std::printf("%s\n", j.dump(2).c_str());
    else if (rows.size() > 1) print(rows);
    if (rows.size() > 1) return ExitCode::ok;
    spdlog::error("nobody answers");
    return ExitCode::failed;
}

/// Requests that nobody need answer, so that slaves find the baud rate: tokens do not prove it (reference 4.10). One round
/// of their search takes less than two seconds.
void wake(LiveMaster& live, Ticks duration) {
    master::Job job = master::Job::fdl_status(dp::kMaxSlaveAddress + 1);
    live.master().submit(job);
    const auto again = [&] {
        if (job.finished()) live.master().submit(job);
        return false;
    };
    live.run_until(again, duration);
    live.master().cancel(job);
}

ExitCode run(const Arguments& a) {
    LineConfig config = line_config(a.line, {});
    config.slaves.clear();
    LiveMaster live{config, {.mode = master::Mode::stop, .slot_time = kScanPatience}};
    const Interrupt interrupt{live.line()};
    wake(live, Ticks{static_cast<std::int64_t>(a.wake * static_cast<double>(core::kTicksPerSecond))});
    live.master().start_scan();
    while (live.master().scanning() && !live.line().stopped()) live.line().run(core::milliseconds(100), [&] { return !live.master().scanning(); });
    if (live.line().stopped()) spdlog::warn("stopped before the scan was complete");
    return report(live.master().found(), a.json);
}

}  // namespace

void add_master_scan(CLI::App& master, Job& job) {
    CLI::App* const c = master.add_subcommand("scan", "list the stations that answer, with ident numbers");
    const auto a = std::make_shared<Arguments>();
    add_line_arguments(*c, a->line);
    c->add_option("--wake", a->wake, "requests for so long before the scan, for slaves that search the baud rate (2)")->type_name("S")->check(CLI::Range(0.0, 60.0));
    c->add_flag("--json", a->json, "as JSON");
    c->footer(footer("  dpchip master scan --line pty:dp0\n"
                     "Takes about six seconds: absent stations cost 30 ms each, or what --slot-time says."));
    c->callback([a, &job] { job = [a] { return run(*a); }; });
}

}  // namespace dpchip::cli
