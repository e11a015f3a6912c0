// The parts of the program kernel_bench.
#pragma once

#include <benchmark/benchmark.h>

#include "tests/bench/workload.h"

namespace quell::bench {

void add_joint_bilateral_benchmarks();
void add_atrous_benchmarks();
void add_memory_benchmarks();

/// 1, 2, 4, ... and all processors.
std::vector<int> thread_counts();

/// "512x512"
std::string text(Size size);

/// Runs the pass until Google Benchmark has enough, and reports its cost beside the ceilings.
void measure_pass(benchmark::State& state, PassRunner& pass, const Work& work, Kernel kernel, int threads);
/// The work of others, which has no issue bound: `prepare` gets its images ready and returns what is timed.
void add_reference(const std::string& name, const Work& work, const std::function<std::function<void()>()>& prepare);

}  // namespace quell::bench
