// SPDX-License-Identifier: Apache-2.0
// Runs the boards named, or all of them: example_boards [--wiring] [NAME...]; with --wiring it shows what is on each pin instead.
#include <algorithm>
#include <iostream>

#include "board.hpp"

int main(int argc, char** argv) {
    std::vector<std::string_view> names(argv + 1, argv + argc);
    const bool wiring = std::erase(names, "--wiring") != 0;
    const std::vector<boards::Plan> plans = boards::all_boards();
    bool good = true;
    for (const std::string_view name : names) {
        if (std::ranges::find(plans, name, &boards::Plan::name) != plans.end()) continue;
        std::cerr << "no such board: " << name << '\n';
        good = false;
    }
    for (const boards::Plan& plan : plans) {
        if (!names.empty() && std::ranges::find(names, plan.name) == names.end()) continue;
        if (wiring) {
            std::cout << plan.name << ": " << plan.processor << ", " << plan.figure << '\n';
            boards::print_wiring(std::cout, plan);
            continue;
        }
        const boards::Report report = boards::run(plan);
        boards::print(std::cout, plan, report);
        good = good && report.good(plan);
    }
    return good ? 0 : 1;
}
