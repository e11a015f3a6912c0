// A level of the à-trous wavelet with the stops of SVGF over threads, levels and sizes, and what a plain version takes.
#include "tests/bench/kernel_bench.h"

namespace quell::bench {
namespace {

constexpr Size kSize{1920, 1080};

void add_pass(Size size, int level, int threads) {
  const std::string name =
      "atrous_svgf/" + text(size) + "/level:" + std::to_string(level) + "/threads:" + std::to_string(threads);
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) {
                                 PassRunner pass(atrous_setup(make_frame(size), level), threads);
                                 measure_pass(state, pass, atrous_work(size, level), Kernel::atrous, threads);
                               })
      ->Unit(benchmark::kMillisecond)
      ->UseManualTime();
}

}  // namespace

void add_atrous_benchmarks() {
  const int all = thread_counts().back();
  for (const int threads : thread_counts()) add_pass(kSize, 0, threads);
  for (const int level : {1, 2, 3, 4}) add_pass(kSize, level, all);
  for (const Size size : {Size{1280, 720}, {2560, 1440}, {3840, 2160}}) add_pass(size, 0, all);
  add_reference("atrous_svgf_of_paper/1920x1080/level:0/threads:" + std::to_string(all), atrous_work(kSize, 0), [=] {
    const AtrousFrame frame = interleave_for_atrous(make_frame(kSize));
    return [=] { benchmark::DoNotOptimize(filter_as_the_paper(frame, {}, all)); };
  });
}

}  // namespace quell::bench
