// SPDX-License-Identifier: Apache-2.0
// `dpchip master`: a DP master on a live line. Its verbs are in master_*.cpp.
#include <dpchip/cli/commands.hpp>
#include <dpchip/cli/master_verbs.hpp>

namespace dpchip::cli {

void add_master(CLI::App& app, Job& job) {
    CLI::App* const c = app.add_subcommand("master", "a DP master on a live line");
    c->require_subcommand(1);
    c->footer(footer("  dpchip master scan --line /dev/pts/3\n"
                     "  dpchip master run --line tcp:127.0.0.1:9000 --gsd builtin:remote_io --module \"8 DI\" --address 5\n"
                     "`dpchip master VERB --help` says more."));
    add_master_run(*c, job);
    add_master_diag(*c, job);
    add_master_scan(*c, job);
    add_master_read(*c, job);
    add_master_write(*c, job);
    add_master_identify(*c, job);
    add_master_alarms(*c, job);
}

}  // namespace dpchip::cli
