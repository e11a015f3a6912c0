// Graphs that ship, frames after frames: by size and threads, in memory and from files to files.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "quell/graph/graph.h"
#include "quell/plugin/loader.h"
#include "quell/runtime/executor.h"
#include "quell/runtime/session.h"
#include "quell/sequence/file_sink.h"
#include "quell/sequence/sequence.h"
#include "tests/bench/figure.h"
#include "tests/bench/graph_frames.h"

namespace quell::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 3;  // of 3840 x 2160, each 0.6 GB

class Nowhere final : public FrameSink {
 public:
  void write(std::string_view, std::int64_t, const Item&) override {}
};

std::shared_ptr<const Graph> graph_of(const std::string& name) {
  static const Registry passes = load_plugins();
  return load_graph(fs::path(QUELL_SOURCE_DIR) / "graphs" / (name + ".json"), passes);
}

// Of one size at a time: frames are large.
struct Frames {
  std::string name;
  Size size;
  std::shared_ptr<const Graph> graph;
  std::unique_ptr<GraphFrames> source;
};

Frames& frames_of(const std::string& name, Size size) {
  static Frames kept;
  if (kept.name == name && kept.size == size) return kept;
  kept = {};
  const auto graph = graph_of(name);
  kept = {name, size, graph, std::make_unique<GraphFrames>(graph->inputs, size, kFrames)};
  return kept;
}

void tell(benchmark::State& state, Session& session, Size size, double seconds, int frames) {
  const double each = seconds / frames;
  const auto planned = static_cast<double>(session.plan()->history_bytes + session.plan()->frame_bytes);
  state.counters["ms/frame"] = each * 1e3;
  state.counters["MP/s"] = 1e-6 * size.width * size.height / each;
  state.counters["peak_MiB"] = static_cast<double>(session.pool().usage().peak) / (1 << 20);
  state.counters["plan_MiB"] = planned / (1 << 20);  // of one frame and its history
}

double time_frames(Session& session, const std::vector<std::int64_t>& frames, FrameSource& source, FrameSink& sink) {
  const auto start = std::chrono::steady_clock::now();
  for (const FrameReport& report : session.run(frames, source, sink))
    if (!report.ok) throw Error(Fault::frame, "frame " + std::to_string(report.frame), report.error);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void in_memory(benchmark::State& state, const std::string& name, Size size, int threads) {
  Frames& frames = frames_of(name, size);
  Session session(frames.graph, {.threads = threads});
  Nowhere sink;
  int lap = 0, count = 0;
  double seconds = 0;
  time_frames(session, frames.source->lap(lap++), *frames.source, sink);  // makes what lasts
  for ([[maybe_unused]] auto _ : state) {
    const double run = time_frames(session, frames.source->lap(lap++), *frames.source, sink);
    state.SetIterationTime(run);
    seconds += run, count += kFrames;
  }
  tell(state, session, size, seconds, count);
}

// Files as renderers write them (float, ZIP), and results likewise; gone when the benchmark is over.
class Files {
 public:
  explicit Files(Frames& frames) {
    std::string folder = (fs::temp_directory_path() / "quell-bench-XXXXXX").string();
    if (!mkdtemp(folder.data())) throw Error(Fault::frame, folder, "cannot be made");
    path_ = folder;
    FileSink sink({.folder = path_ / "in", .type = PixelType::single});
    BufferPool pool;
    for (const GraphInput& input : frames.graph->inputs)
      for (const std::int64_t frame : frames.source->lap(0))
        if (frames.source->shape(input.name)) sink.write(input.name, frame + 1, frames.source->read(input.name, frame, pool));
    sequence_ = Sequence::open(path_ / "in");
    for (const GraphInput& input : frames.graph->inputs) sequence_->expect(input.name, input.type);
    for (const std::int64_t frame : frames.source->lap(0)) numbers_.push_back(frame + 1);
  }
  ~Files() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  double time(Session& session) {
    FileSink sink({.folder = path_ / "out", .type = PixelType::single});
    return time_frames(session, numbers_, *sequence_, sink);
  }

 private:
  fs::path path_;
  std::unique_ptr<Sequence> sequence_;
  std::vector<std::int64_t> numbers_;
};

void from_files(benchmark::State& state, const std::string& name, Size size, int threads) {
  Frames& frames = frames_of(name, size);
  Files files(frames);
  Session session(frames.graph, {.threads = threads});
  int count = 0;
  double seconds = 0;
  for ([[maybe_unused]] auto _ : state) {
    const double run = files.time(session);
    state.SetIterationTime(run);
    seconds += run, count += kFrames;
  }
  tell(state, session, size, seconds, count);
}

void add(const std::string& name) {
  const std::map<std::string, Size> sizes = {{"720p", {1280, 720}}, {"1080p", {1920, 1080}}, {"2160p", {3840, 2160}}};
  const int all = available_threads();
  for (const auto& [label, size] : sizes) {
    for (int threads = 1; threads <= all; threads = threads < all ? std::min(2 * threads, all) : all + 1)
      benchmark::RegisterBenchmark((name + "/memory/" + label + "/threads:" + std::to_string(threads)).c_str(),
                                   [=, size = size](benchmark::State& state) { in_memory(state, name, size, threads); })
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark((name + "/files/" + label + "/threads:" + std::to_string(all)).c_str(),
                                 [=, size = size](benchmark::State& state) { from_files(state, name, size, all); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace
}  // namespace quell::bench

int main(int argc, char** argv) {
  for (const char* graph : {"svgf", "games202", "spatial_only"}) quell::bench::add(graph);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
