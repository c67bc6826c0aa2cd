// SPDX-License-Identifier: Apache-2.0
// The benchmark workloads, shared by `dpchip bench` and the Google Benchmark program: each beside its floor.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dpchip::bench {

/// How one workload fared. Times are per operation; the floor is the least that any program must do for the same octets,
/// measured in the same run, in turns with the workload, so that only the ratio means something on a shared machine.
struct Result {
    std::string name, operation;
    std::uint64_t operations{};
    std::uint64_t repetitions{};
    double ns_min{}, ns_median{}, ns_max{};
    double floor_ns{};        ///< median
    std::string floor;        ///< what the floor does
    double real_time{};       ///< virtual time passed / time spent; 0: there is no virtual time
};

/// Something to measure.
struct Workload {
    std::string_view name, operation, floor, description;
    /// Makes it ready and returns a function that does `n` operations and returns the nanoseconds of virtual time passed.
    std::function<std::function<double(std::uint64_t)>()> prepare, prepare_floor;
    std::uint64_t operations;  ///< of one repetition
};

/// exchange, segment, registers.
std::span<const Workload> workloads();

/// Measures one workload: `repetitions` times, `scale` times its usual operations.
Result measure(const Workload& workload, std::uint64_t repetitions, double scale);

}  // namespace dpchip::bench
