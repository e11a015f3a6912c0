// Adds to Google Benchmark's own main what a report of the kernels must say: which vector unit computed, and on what.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <exception>

#include "quell/simd/isa.h"
#include "tests/bench/frame.h"
#include "tests/bench/kernel_bench.h"

int main(int argc, char** argv) {
  using namespace quell::bench;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  try {
    quell::pin_isa_from_environment();
    benchmark::AddCustomContext("isa", quell::current_isa());
    benchmark::AddCustomContext("frame", make_frame({16, 16}).from);
    add_ceiling_benchmarks();
    add_joint_bilateral_benchmarks();
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
  benchmark::Shutdown();
  return 0;
}
