// What the scheduler costs, and what overlap gains.
#include <benchmark/benchmark.h>

#include "tests/bench/in_memory.h"

namespace quell::bench {
namespace {

/// A chain of passes that copy.
std::string chain(int nodes) {
  std::string text = R"({"quell": 1, "inputs": {"color": "color"}, "nodes": {)";
  for (int i = 0; i < nodes; ++i)
    text += (i == 0 ? "" : ", ") + std::string("\"n") + std::to_string(i) + R"(": {"pass": "burn", "in": {"color": ")" +
            (i == 0 ? "color" : "n" + std::to_string(i - 1) + ".color") + "\"}}";
  return text + R"(}, "outputs": {"color": "n)" + std::to_string(nodes - 1) + ".color\"}}";
}

void small_frames(benchmark::State& state, Schedule schedule) {
  const auto graph = make_graph(chain(20));
  const int frames = 2000;
  double seconds = 0;
  std::int64_t count = 0;
  for ([[maybe_unused]] auto _ : state) {
    const double run =
        time_run(graph, {64, 64}, frames, {.schedule = schedule, .frames_in_flight = static_cast<int>(state.range(0))});
    state.SetIterationTime(run);
    seconds += run;
    count += frames;
  }
  state.counters["frames/s"] = static_cast<double>(count) / seconds;
  state.counters["ns/node"] = seconds * 1e9 / static_cast<double>(count) / 20;
}

void SmallFramesSerial(benchmark::State& state) { small_frames(state, Schedule::serial); }
void SmallFramesConcurrent(benchmark::State& state) { small_frames(state, Schedule::concurrent); }

BENCHMARK(SmallFramesSerial)->ArgName("window")->Arg(1)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(SmallFramesConcurrent)->ArgName("window")->Arg(1)->Arg(4)->Arg(8)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace quell::bench

BENCHMARK_MAIN();
