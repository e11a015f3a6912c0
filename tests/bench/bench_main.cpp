#include "tests/bench/bench_main.h"

#include <benchmark/benchmark.h>

#include <cstdio>
#include <exception>

#include "quell/simd/isa.h"

namespace quell::bench {

int run_benchmarks(int argc, char** argv, const std::function<void()>& add) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  try {
    pin_isa_from_environment();
    benchmark::AddCustomContext("isa", current_isa());
    if (add) add();
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
  benchmark::Shutdown();
  return 0;
}

}  // namespace quell::bench
