// The joint bilateral filter over threads, radii and sizes, and what others take for the same.
#include "tests/bench/kernel_bench.h"

namespace quell::bench {
namespace {

constexpr Size kSize{512, 512};
constexpr int kRadius = 16;

std::string name_of(const std::string& what, Size size, int radius, int threads) {
  return what + "/" + text(size) + "/radius:" + std::to_string(radius) + "/threads:" + std::to_string(threads);
}

void add_pass(Size size, int radius, int threads) {
  benchmark::RegisterBenchmark(name_of("joint_bilateral", size, radius, threads).c_str(),
                               [=](benchmark::State& state) {
                                 PassRunner pass(joint_bilateral_setup(make_frame(size), radius), threads);
                                 measure_pass(state, pass, joint_bilateral_work(size, radius), Kernel::joint_bilateral, threads);
                               })
      ->Unit(benchmark::kMillisecond)
      ->UseManualTime();
}

using Filter = std::vector<Float3>(const InterleavedFrame&, const BilateralSettings&, int);

void add_other(const std::string& what, Filter* filter, int threads) {
  add_reference(name_of(what, kSize, kRadius, threads), joint_bilateral_work(kSize, kRadius), [=] {
    const InterleavedFrame frame = interleave(make_frame(kSize));
    return [=] { benchmark::DoNotOptimize(filter(frame, {.radius = kRadius}, threads)); };
  });
}

}  // namespace

void add_joint_bilateral_benchmarks() {
  const int all = thread_counts().back();
  for (const int threads : thread_counts()) add_pass(kSize, kRadius, threads);
  for (const int radius : {4, 8, 32}) add_pass(kSize, radius, all);
  for (const Size size : {Size{1280, 720}, {1920, 1080}, {2560, 1440}, {3840, 2160}}) add_pass(size, 8, all);
  add_other("joint_bilateral_of_course", filter_as_the_course, all);
#ifdef QUELL_BENCH_OPENCV
  add_other("joint_bilateral_of_opencv", filter_with_opencv, all);
#endif
}

}  // namespace quell::bench
