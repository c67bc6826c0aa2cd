// SPDX-License-Identifier: Apache-2.0
// The command line as a whole: subcommands, common flags, exceptions to exit codes.
#include <cstdio>
#include <exception>
#include <iostream>

#include <dpchip/cli/commands.hpp>
#include <dpchip/cli/log.hpp>
#include <dpchip/gsd/diagnostic.hpp>
#include <dpchip/live/line_error.hpp>
#include <dpchip/slave/error.hpp>
#include <dpchip/version.h>

namespace dpchip::cli {
namespace {

/// In the order of `dpchip --help`.
constexpr void (*kCommands[])(CLI::App&, Job&){add_serve, add_sim, add_master, add_gsd, add_decode, add_regs, add_bench, add_demo};

ExitCode complain(ExitCode code, const char* what) {
    std::fflush(stdout);
    // Messages about files begin with the file, as compilers do it.
    if (code == ExitCode::input) std::fprintf(stderr, "%s\n", what);
    else spdlog::error("{}", what);
    return code;
}

/// Malformed names of lines are the command line's fault, everything else is the line's.
ExitCode code_of(const live::LineError& e) { return e.kind() == live::LineErrorKind::malformed ? ExitCode::usage : ExitCode::line; }

/// Runs `work` and turns what it throws into a message and a code.
template <class F>
ExitCode guarded(F&& work) {
    try {
        return work();
    } catch (const Failure& e) {
        return complain(e.code(), e.what());
    } catch (const live::LineError& e) {
        return complain(code_of(e), e.what());
    } catch (const gsd::GsdError& e) {
        return complain(ExitCode::input, e.what());
    } catch (const slave::SlaveError& e) {
        return complain(ExitCode::usage, e.what());
    } catch (const CLI::ParseError&) {
        throw;
    } catch (const std::exception& e) {
        return complain(ExitCode::failed, e.what());
    }
}

}  // namespace

std::string footer(const std::string& examples) { return "Example:\n" + examples + "\n\n" + kExitCodes; }

int run(int argc, char** argv) {
    CLI::App app{"PROFIBUS DP slave controllers in software: virtual slaves, a master, a bus in virtual time.", "dpchip"};
    app.set_version_flag("--version", "dpchip " DPCHIP_VERSION);
    app.get_formatter()->column_width(34);
    app.require_subcommand(1);
    app.footer(footer("  dpchip demo\n  dpchip serve --gsd builtin:remote_io --module \"16 DI / 16 DO\" --address 5 --line pty:dp0"));
    bool quiet = false, verbose = false;
    app.add_flag("-q,--quiet", quiet, "errors only on stderr");
    app.add_flag("-v,--verbose", verbose, "more on stderr");
    start_log(Loudness::normal);
    app.fallthrough();  // subcommands inherit it: -q and -v may stand behind them
    Job job;
    for (const auto add : kCommands) add(app, job);
    ExitCode code = ExitCode::usage;
    try {
        code = guarded([&] {
            app.parse(argc, argv);
            start_log(quiet ? Loudness::quiet : verbose ? Loudness::verbose : Loudness::normal);
            return job();
        });
    } catch (const CLI::ParseError& e) {
        const int said = app.exit(e, std::cout, std::cerr);  // prints --help, --version and errors
        code = said == 0 ? ExitCode::ok : ExitCode::usage;
    }
    std::fflush(stdout);
    return static_cast<int>(code);
}

}  // namespace dpchip::cli
