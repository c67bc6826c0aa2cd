// SPDX-License-Identifier: Apache-2.0
// The verbs of `dpchip master`.
#pragma once

#include <dpchip/cli/commands.hpp>

namespace dpchip::cli {

void add_master_run(CLI::App& master, Job& job);
void add_master_diag(CLI::App& master, Job& job);
void add_master_scan(CLI::App& master, Job& job);
void add_master_read(CLI::App& master, Job& job);
void add_master_write(CLI::App& master, Job& job);
void add_master_identify(CLI::App& master, Job& job);
void add_master_alarms(CLI::App& master, Job& job);

}  // namespace dpchip::cli
