// SPDX-License-Identifier: Apache-2.0
// `dpchip bench`: how fast the model is on this machine, each workload beside its floor.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <dpchip/cli/commands.hpp>

#include "uart_tolerance.hpp"
#include "workloads.hpp"

namespace dpchip::cli {
namespace {

struct Options {
    std::vector<std::string> names;
    std::uint64_t repetitions = 5;
    double scale = 1;
    bool json = false;
    bool uart = false;
    std::string svg;
};

const bench::Workload& find(const std::string& name) {
    const auto all = bench::workloads();
    const auto found = std::find_if(all.begin(), all.end(), [&](const bench::Workload& w) { return w.name == name; });
    if (found != all.end()) return *found;
    std::string known;
    for (const bench::Workload& w : all) known += (known.empty() ? "" : ", ") + std::string{w.name};
    throw Failure{ExitCode::usage, "no workload is called '" + name + "'; there are " + known};
}

nlohmann::json to_json(const bench::Result& r) {
    nlohmann::json j{{"name", r.name},         {"operation", r.operation}, {"operations", r.operations}, {"repetitions", r.repetitions},
                     {"ns_min", r.ns_min},     {"ns_median", r.ns_median}, {"ns_max", r.ns_max},         {"floor", r.floor},
                     {"floor_ns", r.floor_ns}, {"times_floor", r.ns_median / r.floor_ns}, {"per_second", 1e9 / r.ns_median}};
    if (r.real_time > 0) j["times_real_time"] = r.real_time;
    return j;
}

void print(const bench::Result& r) {
    fmt::print("{}: {}\n", r.name, r.operation);
    fmt::print("  {:.1f} ns (min {:.1f}, max {:.1f}), {:.3g} per second\n", r.ns_median, r.ns_min, r.ns_max, 1e9 / r.ns_median);
    fmt::print("  floor {:.1f} ns ({}): {:.1f} times the floor\n", r.floor_ns, r.floor, r.ns_median / r.floor_ns);
    if (r.real_time > 0) fmt::print("  {:.0f} times real time\n", r.real_time);
}

/// What the UART's receiver bears, as text and as a drawing.
ExitCode uart_tolerance(const Options& o) {
    const bench::ToleranceMap controlled = bench::measure_tolerance(true), uncontrolled = bench::measure_tolerance(false);
    fmt::print("{}\n{}", bench::tolerance_text(controlled), bench::tolerance_text(uncontrolled));
    if (o.svg.empty()) return ExitCode::ok;
    std::ofstream file{o.svg, std::ios::binary | std::ios::trunc};
    file << bench::tolerance_svg(controlled, uncontrolled);
    file.close();
    if (!file) throw Failure{ExitCode::failed, o.svg + ": cannot be written"};
    return ExitCode::ok;
}

ExitCode run(const Options& o) {
    if (!o.svg.empty() && !o.uart) throw Failure{ExitCode::usage, "--svg is the drawing of --uart"};
    if (o.uart) return uart_tolerance(o);
    std::vector<const bench::Workload*> chosen;
    for (const std::string& name : o.names) chosen.push_back(&find(name));
    if (chosen.empty())
        for (const bench::Workload& w : bench::workloads()) chosen.push_back(&w);
    nlohmann::json all = nlohmann::json::array();
    for (const bench::Workload* w : chosen) {
        std::fprintf(stderr, "%.*s ...\n", static_cast<int>(w->name.size()), w->name.data());
        const bench::Result r = bench::measure(*w, o.repetitions, o.scale);
        if (o.json) all.push_back(to_json(r));
        else print(r);
        std::fflush(stdout);
    }
    if (o.json) fmt::print("{}\n", all.dump(2));
    return ExitCode::ok;
}

}  // namespace

void add_bench(CLI::App& app, Job& job) {
    auto o = std::make_shared<Options>();
    CLI::App* sub = app.add_subcommand("bench", "Measures the model on this machine: exchange, segment, registers.");
    sub->add_option("NAME", o->names, "workloads; all of them when none is named");
    sub->add_option("--repetitions", o->repetitions, "measurements of each; the median counts")->capture_default_str()->check(CLI::Range(1, 1000));
    sub->add_option("--scale", o->scale, "times the usual number of operations")->capture_default_str()->check(CLI::Range(0.0001, 1000.0));
    sub->add_flag("--json", o->json, "an array of objects on stdout");
    sub->add_flag("--uart", o->uart, "instead: which errors of the rate and which distortion of bits the receiver bears (docs/uart.md)");
    sub->add_option("--svg", o->svg, "with --uart: a drawing of it")->type_name("FILE.svg");
    sub->footer(footer("  dpchip bench exchange --repetitions 9\n  dpchip bench --uart --svg docs/uart_tolerance.svg\nOnly ratios taken in one run mean anything on a shared machine."));
    sub->callback([o, &job] { job = [o] { return run(*o); }; });
}

}  // namespace dpchip::cli
