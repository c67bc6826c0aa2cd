// SPDX-License-Identifier: Apache-2.0
// The program `dpchip`.
#include <dpchip/cli/commands.hpp>

int main(int argc, char** argv) { return dpchip::cli::run(argc, argv); }
