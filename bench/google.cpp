// SPDX-License-Identifier: Apache-2.0
// The workloads under Google Benchmark, each followed by its floor.
#include <benchmark/benchmark.h>

#include <string>

#include "workloads.hpp"

namespace {

using dpchip::bench::Workload;

void run(benchmark::State& state, const Workload& workload, bool floor) {
    const auto operation = floor ? workload.prepare_floor() : workload.prepare();
    double virtual_ns = 0;
    std::uint64_t operations = 0;
    for (auto _ : state) {
        virtual_ns += operation(2);
        operations += 2;
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(operations));
    if (virtual_ns > 0) state.counters["virtual_s"] = benchmark::Counter(virtual_ns / 1e9, benchmark::Counter::kIsRate);
}

}  // namespace

int main(int argc, char** argv) {
    for (const Workload& w : dpchip::bench::workloads())
        for (const bool floor : {false, true})
            benchmark::RegisterBenchmark((std::string{w.name} + (floor ? "/floor" : "")).c_str(),
                                         [&w, floor](benchmark::State& s) { run(s, w, floor); });
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
}
