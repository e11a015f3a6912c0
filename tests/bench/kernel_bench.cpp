#include "tests/bench/kernel_bench.h"

#include <algorithm>

#include "quell/runtime/executor.h"
#include "tests/bench/bench_main.h"

namespace quell::bench {

std::vector<int> thread_counts() {
  std::vector<int> counts;
  for (int count = 1; count < available_threads(); count *= 2) counts.push_back(count);
  counts.push_back(available_threads());
  return counts;
}

std::string text(Size size) { return std::to_string(size.width) + "x" + std::to_string(size.height); }

namespace {

// What the machine can do at best, in the same run as what it is compared with.
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

void report_cost(benchmark::State& state, double seconds, const Work& work) {
  state.counters["ns/px"] = seconds * 1e9 / work.pixels;
  state.counters["ns/tap"] = seconds * 1e9 / work.taps;
}

}  // namespace

void measure_pass(benchmark::State& state, PassRunner& pass, const Work& work, Kernel kernel, int threads) {
  double total = 0;
  for ([[maybe_unused]] auto _ : state) {
    const double seconds = pass.run();
    state.SetIterationTime(seconds);
    total += seconds;
  }
  const double seconds = total / static_cast<double>(state.iterations());
  const double flops = work.units * mix_of(kernel).flops() / seconds, bytes = work.bytes / seconds;
  report_cost(state, seconds, work);
  state.counters["GFLOP/s"] = flops / 1e9;
  state.counters["GB/s"] = bytes / 1e9;
  state.counters["of_peak"] = flops / ceilings(threads).flops;
  state.counters["of_copy"] = bytes / ceilings(threads).bytes_per_second;
  state.counters["of_issue"] = issue_bound(kernel, threads) * work.units / seconds;
}

void add_reference(const std::string& name, const Work& work, const std::function<std::function<void()>()>& prepare) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) {
                                 const std::function<void()> call = prepare();
                                 double total = 0;
                                 for ([[maybe_unused]] auto _ : state) {
                                   const double seconds = time_call(call);
                                   state.SetIterationTime(seconds);
                                   total += seconds;
                                 }
                                 report_cost(state, total / static_cast<double>(state.iterations()), work);
                               })
      ->Unit(benchmark::kMillisecond)
      ->UseManualTime();
}

}  // namespace quell::bench

int main(int argc, char** argv) {
  using namespace quell::bench;
  return run_benchmarks(argc, argv, [] {
    benchmark::AddCustomContext("frame", make_frame({16, 16}).from);
    add_ceiling_benchmarks();
    add_joint_bilateral_benchmarks();
    add_atrous_benchmarks();
    add_memory_benchmarks();
  });
}
