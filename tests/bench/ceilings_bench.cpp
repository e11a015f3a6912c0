// What the machine can do at best, in the same run as what it is compared with.
#include "tests/bench/kernel_bench.h"

namespace quell::bench {
namespace {

void add_ceiling(const std::string& name, const char* unit, double divisor, const std::function<double()>& measure) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) {
                                 double figure = 0;
                                 for ([[maybe_unused]] auto _ : state) figure = measure();
                                 state.counters[unit] = figure / divisor;
                               })
      ->Unit(benchmark::kMillisecond)
      ->Iterations(1);
}

}  // namespace

void add_ceiling_benchmarks() {
  for (const int threads : thread_counts()) {
    const std::string suffix = "/threads:" + std::to_string(threads);
    add_ceiling("ceiling/copy" + suffix, "GB/s", 1e9, [=] { return measure_copy_bandwidth(threads); });
    add_ceiling("ceiling/fma" + suffix, "GFLOP/s", 1e9, [=] { return measure_peak_flops(threads); });
    add_ceiling("ceiling/issue/joint_bilateral" + suffix, "ns/tap", 1e-9,
                [=] { return measure_issue_bound(Kernel::joint_bilateral, threads); });
    add_ceiling("ceiling/issue/atrous_svgf" + suffix, "ns/px", 1e-9,
                [=] { return measure_issue_bound(Kernel::atrous, threads); });
  }
}

}  // namespace quell::bench
