// What each metric costs for a frame of 1920 x 1080 on one thread, with what all of them need: leaving out what is not finite,
// and display values. "plain" are all but those of FLIP, together.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string>
#include <vector>

#include "quell/metrics/comparison.h"
#include "tests/bench/bench_main.h"

namespace quell::bench {
namespace {

constexpr Size kSize{1920, 1080};

BufferPool& pool() {
  static BufferPool one;
  return one;
}

Image make_image(PortType type, float (*value)(int x, int y, int c)) {
  Image image(type, kSize, pool());
  const FloatOutput out = image.writable_floats();
  for (int c = 0; c < out.channels; ++c)
    for (int y = 0; y < out.height; ++y)
      for (int x = 0; x < out.width; ++x) out.at(x, y, c) = value(x, y, c);
  return image;
}

float radiance(int x, int y, int c) { return static_cast<float>(std::exp(3 * std::sin(0.01 * x + c) * std::cos(0.013 * y))); }
float noisy(int x, int y, int c) { return radiance(x, y, c) * static_cast<float>((x * 7919 + y * 104729 + c * 31) % 97) / 48; }

const CompareInput& input() {
  static const CompareInput one = [] {
    const ImagePair pair{make_image(QUELL_TYPE_COLOR, radiance), make_image(QUELL_TYPE_COLOR, noisy)};
    const ImagePair before{pair.image, pair.reference};
    return CompareInput{pair, before,
                        make_image(QUELL_TYPE_MOTION, [](int x, int y, int c) { return c == 0 ? 0.01F * y : -0.02F * x; })};
  }();
  return one;
}

void compare_frames(benchmark::State& state, const std::vector<Metric>& metrics, DisplayTransform display) {
  const CompareOptions options{.metrics = metrics, .display = display};
  const CompareInput& frames = input();
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(compare(frames, options, false, pool()).scores[0].sum);
  state.counters["MP/s"] = benchmark::Counter(kSize.width * kSize.height * 1e-6, benchmark::Counter::kIsIterationInvariantRate);
}

std::vector<Metric> plain_metrics() {
  std::vector<Metric> plain;
  for (const MetricInfo& metric : metrics())
    if (metric.metric != Metric::flip && metric.metric != Metric::hdr_flip) plain.push_back(metric.metric);
  return plain;
}

void add(const std::string& name, const std::vector<Metric>& metrics, DisplayTransform display) {
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    compare_frames(state, metrics, display);
  })->Unit(benchmark::kMillisecond);
}

const bool kAdded = [] {
  for (const Metric metric : plain_metrics())
    add("metric/" + std::string(info(metric).name) + "/1920x1080", {metric}, DisplayTransform::reinhard);
  add("metric/plain/1920x1080", plain_metrics(), DisplayTransform::reinhard);
  for (const DisplayInfo& display : display_transforms())
    add("display/" + std::string(display.name) + "/1920x1080", {Metric::mse}, display.transform);
  return true;
}();

}  // namespace
}  // namespace quell::bench

int main(int argc, char** argv) { return quell::bench::run_benchmarks(argc, argv); }
