// SPDX-License-Identifier: Apache-2.0
// `dpchip master run`: drives slaves on a live line.
#include <dpchip/cli/master_session.hpp>
#include <dpchip/cli/master_verbs.hpp>
#include <dpchip/cli/slave_arguments.hpp>

namespace dpchip::cli {
namespace {

struct Arguments {
    LineArguments line;
    LineConfig slaves;
    std::uint64_t cycles = 0;
    double seconds = 0, patience = 10;
    std::string outputs;
    bool json = false;
    int own_address = -1;
};

Ticks duration(double seconds) { return Ticks{static_cast<std::int64_t>(seconds * static_cast<double>(core::kTicksPerSecond))}; }

ExitCode run(const Arguments& a) {
    LineConfig config = line_config(a.line, a.slaves);
    if (a.own_address >= 0) {
        if (config.masters.empty()) config.masters.emplace_back();
        config.masters[0].address = static_cast<std::uint8_t>(a.own_address);
    }
    SessionOptions options;
    if (a.cycles != 0) options.cycles = a.cycles;
    else if (config.cycles) options.cycles = config.cycles;
    if (a.seconds > 0) options.duration = duration(a.seconds);
    options.patience = duration(a.patience);
    if (!a.outputs.empty()) {
        options.outputs = parse_hex(a.outputs);
        if (!options.outputs) throw Failure{ExitCode::usage, "--outputs " + a.outputs + ": hexadecimal octets are expected, such as 01A0"};
    }
    options.json = a.json;
    return MasterSession{config, options}.run();
}

}  // namespace

void add_master_run(CLI::App& master, Job& job) {
    CLI::App* const c = master.add_subcommand("run", "bring slaves into data exchange and keep them there");
    const auto a = std::make_shared<Arguments>();
    add_slave_arguments(*c, a->slaves);
    add_line_arguments(*c, a->line);
    c->add_option("--cycles", a->cycles, "end after so many cycles with all slaves in data exchange")->type_name("N");
    c->add_option("--for", a->seconds, "end after so many seconds of data exchange")->type_name("S")->check(CLI::Range(0.0, 1e9));
    c->add_option("--timeout", a->patience, "give up when slaves are not reached within (10)")->type_name("S")->check(CLI::Range(0.0, 1e6));
    c->add_option("--outputs", a->outputs, "constant outputs, for every slave")->type_name("HEX");
    c->add_option("--master-address", a->own_address, "own address (1, or [[master]])")->type_name("N")->check(CLI::Range(0, 125));
    c->add_flag("--json", a->json, "the report as JSON");
    c->footer(footer("  dpchip master run --line pty:dp0 --gsd builtin:remote_io --module \"8 DI\" --module \"8 DO\" --address 5 --io echo --cycles 100\n"
                     "With --io the outputs change in every cycle and the inputs are checked; without, outputs are 0.\n"
                     "Runs until SIGINT without --cycles and --for. Exit code 1: a slave not reached, lost, or with wrong inputs."));
    c->callback([a, &job] { job = [a] { return run(*a); }; });
}

}  // namespace dpchip::cli
