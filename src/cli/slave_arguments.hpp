// SPDX-License-Identifier: Apache-2.0
// Slaves on the command line: each --gsd begins one, and what follows belongs to it.
#pragma once

#include <CLI/CLI.hpp>

#include <dpchip/cli/line_config.hpp>

namespace dpchip::cli {

/// Adds --gsd, --module, --address, --chip, --io, --name and --parameter to `command`; they fill `config.slaves`, which
/// must outlive the parsing.
void add_slave_arguments(CLI::App& command, LineConfig& config);

/// Options of the line as texts, until parsed.
struct LineArguments {
    std::string file, line, baud, slot_time, pace, trace;
    int link_type = 147;
    std::vector<std::string> options;
    int min_tsdr = 0;
};
/// Adds --line, --baud, --slot-time, --trace, --link-type and the file.
void add_line_arguments(CLI::App& command, LineArguments& arguments);
/// --option, --min-tsdr and --pace: for lines with virtual slaves.
void add_model_arguments(CLI::App& command, LineArguments& arguments);
/// The file's config, if there is one, changed by what the command line says. `from_arguments` has slaves from the
/// command line; a file and slaves on the command line do not go together.
LineConfig line_config(const LineArguments& arguments, LineConfig from_arguments);

}  // namespace dpchip::cli
