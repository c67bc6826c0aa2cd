// SPDX-License-Identifier: Apache-2.0
// The subcommands: each adds itself to the program and leaves what is to be run.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include <dpchip/cli/failure.hpp>

namespace dpchip::cli {

/// What the chosen subcommand does; set by it while the command line is parsed.
using Job = std::function<ExitCode()>;

/// A subcommand's own file defines one of these. `job` outlives the parsing; state lives in shared pointers of the job.
void add_serve(CLI::App& app, Job& job);
void add_sim(CLI::App& app, Job& job);
void add_master(CLI::App& app, Job& job);
void add_gsd(CLI::App& app, Job& job);
void add_decode(CLI::App& app, Job& job);
void add_regs(CLI::App& app, Job& job);
void add_demo(CLI::App& app, Job& job);
void add_bench(CLI::App& app, Job& job);

/// The whole program: parses, runs, and turns exceptions into messages and exit codes.
int run(int argc, char** argv);

/// "Example:\n  dpchip ..." and the exit codes, for a subcommand's --help.
std::string footer(const std::string& examples);

}  // namespace dpchip::cli
