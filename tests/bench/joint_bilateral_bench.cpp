// The joint bilateral filter over threads, radii and sizes, and what others take for the same.
#include "tests/bench/kernel_bench.h"

namespace quell::bench {
namespace {

constexpr Size kSize{512, 512};
constexpr int kRadius = 16;

void add_pass(Size size, int radius, int threads) {
  const std::string name =
      "joint_bilateral/" + text(size) + "/radius:" + std::to_string(radius) + "/threads:" + std::to_string(threads);
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) {
                                 PassRunner pass(joint_bilateral_setup(make_frame(size), radius), threads);
                                 measure_pass(state, pass, joint_bilateral_work(size, radius), Kernel::joint_bilateral, threads);
                               })
      ->Unit(benchmark::kMillisecond)
      ->UseManualTime();
}

using Reference = std::vector<Float3>(const InterleavedFrame&, const BilateralSettings&, int);

void add_reference(const std::string& name, Reference* filter, int threads) {
  benchmark::RegisterBenchmark(
      (name + "/512x512/radius:16/threads:" + std::to_string(threads)).c_str(),
      [=](benchmark::State& state) {
        const InterleavedFrame frame = interleave(make_frame(kSize));
        double total = 0;
        for ([[maybe_unused]] auto _ : state) {
          const double seconds = time_call([&] { benchmark::DoNotOptimize(filter(frame, {.radius = kRadius}, threads)); });
          state.SetIterationTime(seconds);
          total += seconds;
        }
        report_cost(state, total / static_cast<double>(state.iterations()), joint_bilateral_work(kSize, kRadius));
      })
      ->Unit(benchmark::kMillisecond)
      ->UseManualTime();
}

}  // namespace

void add_joint_bilateral_benchmarks() {
  const int all = thread_counts().back();
  for (const int threads : thread_counts()) add_pass(kSize, kRadius, threads);
  for (const int radius : {4, 8, 32}) add_pass(kSize, radius, all);
  for (const Size size : {Size{1280, 720}, {1920, 1080}, {2560, 1440}, {3840, 2160}}) add_pass(size, 8, all);
  add_reference("joint_bilateral_of_course", filter_as_the_course, all);
#ifdef QUELL_BENCH_OPENCV
  add_reference("joint_bilateral_of_opencv", filter_with_opencv, all);
#endif
}

}  // namespace quell::bench
