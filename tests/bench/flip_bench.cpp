// FLIP beside plain loops that do the same, on the same threads.
#include <benchmark/benchmark.h>

#include <functional>

#include "tests/bench/flip_plain.h"
#include "tests/bench/flip_scene.h"

namespace quell::bench {
namespace {

constexpr Exposures kExposures{-2, 2, 4};

using Measure = std::function<Score(const FlipImages& images, FloatOutput map, BufferPool& pool, const Parallel& parallel)>;

// Threads are the benchmark's argument.
void run(benchmark::State& state, const Measure& measure) {
  BufferPool pool;
  const FlipScene scene = make_flip_scene({1920, 1080}, pool);
  Image map(QUELL_TYPE_SCALAR, scene.image.size(), pool);
  const Parallel parallel = on_threads(static_cast<int>(state.range(0)));
  Score score;
  for ([[maybe_unused]] auto _ : state) score = measure(scene.views(), map.writable_floats(), pool, parallel);
  state.counters["MP/s"] = benchmark::Counter(1920 * 1080 * 1e-6, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["mean"] = score.sum / static_cast<double>(score.count);
}

void FlipPlain(benchmark::State& state) {
  run(state, [](const FlipImages& images, FloatOutput map, BufferPool&, const Parallel& parallel) {
    return plain_flip(images, kPixelsPerDegree, map, parallel);
  });
}
void FlipQuell(benchmark::State& state) {
  run(state, [](const FlipImages& images, FloatOutput map, BufferPool& pool, const Parallel& parallel) {
    return flip(images, kPixelsPerDegree, map, pool, parallel);
  });
}
void HdrFlipPlain(benchmark::State& state) {
  run(state, [](const FlipImages& images, FloatOutput map, BufferPool&, const Parallel& parallel) {
    return plain_hdr_flip(images, kExposures, kPixelsPerDegree, map, parallel);
  });
}
void HdrFlipQuell(benchmark::State& state) {
  run(state, [](const FlipImages& images, FloatOutput map, BufferPool& pool, const Parallel& parallel) {
    return hdr_flip(images, kExposures, kPixelsPerDegree, map, pool, parallel);
  });
}
void LuminanceRangeQuell(benchmark::State& state) {
  run(state, [](const FlipImages& images, FloatOutput, BufferPool& pool, const Parallel& parallel) {
    const LuminanceRange range = luminance_range(images.reference, pool, parallel);
    return Score{.sum = range.median, .count = 1};
  });
}

// Both in turn.
void FlipRatio(benchmark::State& state) {
  FlipTimes times;
  for ([[maybe_unused]] auto _ : state) times = best_flip_times({1920, 1080}, static_cast<int>(state.range(0)));
  state.counters["plain/quell"] = times.plain / times.quell;
}

void both_threads(benchmark::internal::Benchmark* bench) {
  bench->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
}
BENCHMARK(FlipPlain)->Name("Flip/plain/1920x1080")->Apply(both_threads);
BENCHMARK(FlipQuell)->Name("Flip/quell/1920x1080")->Apply(both_threads);
BENCHMARK(FlipRatio)->Name("Flip/ratio/1920x1080")->Apply(both_threads)->Iterations(1);
BENCHMARK(HdrFlipPlain)->Name("HdrFlip/plain/1920x1080/4_exposures")->Apply(both_threads);
BENCHMARK(HdrFlipQuell)->Name("HdrFlip/quell/1920x1080/4_exposures")->Apply(both_threads);
BENCHMARK(LuminanceRangeQuell)->Name("LuminanceRange/quell/1920x1080")->Apply(both_threads);

}  // namespace
}  // namespace quell::bench
