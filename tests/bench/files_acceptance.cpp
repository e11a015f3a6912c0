// From files to files: how near a run comes to the sum of its parts, each measured alone.
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <numeric>
#include <string>

#include "quell/sequence/file_sink.h"
#include "quell/sequence/sequence.h"
#include "tests/bench/figure.h"
#include "tests/bench/graph_frames.h"
#include "tests/bench/in_memory.h"

namespace quell::bench {
namespace {

namespace fs = std::filesystem;

constexpr Size kSize{1920, 1080};
constexpr int kLaps = 4;  // of GraphFrames::kFrames, so that the first and the last frame weigh little
constexpr int kRepeats = 2;

/// A folder that is gone when the measurement is over.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "quell-bench-XXXXXX").string();
    if (!mkdtemp(name.data())) throw Error(Fault::frame, name, "cannot be made");
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

FileSinkOptions in_folder(const fs::path& folder) { return {.folder = folder, .type = PixelType::single}; }

std::vector<std::int64_t> all_frames(const GraphFrames& frames) {
  std::vector<std::int64_t> all;
  for (int lap = 0; lap < kLaps; ++lap)
    for (const std::int64_t frame : frames.lap(lap)) all.push_back(frame + 1);
  return all;
}

std::unique_ptr<Sequence> open(const fs::path& folder, const Graph& graph) {
  std::unique_ptr<Sequence> sequence = Sequence::open(folder);
  for (const GraphInput& input : graph.inputs) sequence->expect(input.name, input.type);
  return sequence;
}

/// What a graph makes is harder to compress than what it is made of, whose pixels are repeated.
class LastResult final : public FrameSink {
 public:
  void write(std::string_view, std::int64_t, const Item& result) override { item = result; }
  Item item;
};

/// Seconds that this process's threads have computed.
double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}
double wall_seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Core seconds of reading and of writing, which are measured by the processor's clock as they go, and of the nodes on one
/// thread.
struct Parts {
  double decode = 0, compute = 0, encode = 0;
  double all() const { return decode + compute + encode; }
};

class Bench {
 public:
  Bench() : graph_(load_graph(fs::path(QUELL_SOURCE_DIR) / "graphs/svgf.json", passes())), in_memory_(graph_->inputs, kSize) {
    frames_ = all_frames(in_memory_);
    FileSink inputs(in_folder(folder_.path() / "in"));
    for (const GraphInput& input : graph_->inputs)
      for (const std::int64_t frame : frames_)
        if (in_memory_.shape(input.name)) inputs.write(input.name, frame, in_memory_.read(input.name, frame - 1, pool_));
  }

  Parts measure_parts() {
    Parts parts;
    const auto sequence = open(folder_.path() / "in", *graph_);
    double start = processor_seconds();
    for (const std::int64_t frame : frames_)
      for (const GraphInput& input : graph_->inputs)
        if (sequence->shape(input.name)) sequence->read(input.name, frame, pool_);
    parts.decode = processor_seconds() - start;

    LastResult result;
    Session session(graph_, {.threads = 1, .schedule = Schedule::serial});
    for (int lap = 0; lap < kLaps; ++lap)
      for (const FrameReport& report : session.run(in_memory_.lap(lap), in_memory_, result)) parts.compute += report.seconds;

    FileSink sink(in_folder(folder_.path() / "alone"));
    start = processor_seconds();
    for (const std::int64_t frame : frames_) sink.write("color", frame, result.item);
    parts.encode = processor_seconds() - start;
    return parts;
  }

  double measure_run() {
    const auto sequence = open(folder_.path() / "in", *graph_);
    FileSink sink(in_folder(folder_.path() / "out"));
    Session session(graph_, {.threads = acceptance_threads()});
    const double start = wall_seconds();
    for (const FrameReport& report : session.run(frames_, *sequence, sink))
      if (!report.ok) throw Error(Fault::frame, "frame " + std::to_string(report.frame), report.error);
    return wall_seconds() - start;
  }

  std::size_t count() const { return frames_.size(); }

 private:
  static const Registry& passes() {
    static const Registry registry = load_plugins();
    return registry;
  }
  Folder folder_;
  BufferPool pool_;
  std::shared_ptr<const Graph> graph_;
  GraphFrames in_memory_;
  std::vector<std::int64_t> frames_;
};

}  // namespace

std::vector<Figure> file_figures() {
  Bench bench;
  Parts best;
  double wall = 0;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const Parts parts = bench.measure_parts();
    if (repeat == 0 || parts.all() < best.all()) best = parts;
    const double run = bench.measure_run();
    if (repeat == 0 || run < wall) wall = run;
  }
  const auto frames = static_cast<double>(bench.count());
  char text[160];
  std::snprintf(text, sizeof text, "%.0f ms a frame on %d; decode %.0f, compute %.0f, encode %.0f ms of one core",
                1e3 * wall / frames, acceptance_threads(), 1e3 * best.decode / frames, 1e3 * best.compute / frames,
                1e3 * best.encode / frames);
  return {{.what = "svgf, 1080p from EXR to EXR (float, ZIP), times the parts by the cores",
           .reached = wall / (best.all() / acceptance_threads()),
           .bar = 1.1,
           .at_most = true,
           .note = text}};
}

}  // namespace quell::bench
