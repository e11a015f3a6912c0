#include "tests/bench/graph_times.h"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "quell/runtime/session.h"
#include "tests/bench/graph_frames.h"
#include "tests/bench/in_memory.h"

namespace quell::bench {
namespace {

constexpr int kLaps = 5;
constexpr std::size_t kWarm = 3;  // frames of a lap after which the history is as long as it matters
constexpr double kNone = std::numeric_limits<double>::infinity();

}  // namespace

GraphTimes time_graph(const std::string& name, Size size, int threads) {
  const Registry passes = load_plugins();
  const auto graph = load_graph(std::filesystem::path(QUELL_SOURCE_DIR) / "graphs" / (name + ".json"), passes);
  GraphFrames frames(graph->inputs, size);
  Nowhere sink;
  Session session(graph, {.threads = threads, .schedule = Schedule::serial});
  GraphTimes times{.from = frames.from(), .frame = kNone, .reading = kNone};
  for (int lap = 0; lap < kLaps; ++lap) {
    const std::vector<FrameReport> reports = session.run(frames.lap(lap), frames, sink);
    std::vector<double> nodes(session.plan()->nodes.size());
    double frame = 0, reading = 0;
    for (std::size_t i = 0; i < reports.size(); ++i) {
      if (!reports[i].ok) throw Error(Fault::frame, name, reports[i].error);
      if (i < kWarm) continue;
      const auto share = 1 / static_cast<double>(reports.size() - kWarm);
      frame += share * reports[i].seconds, reading += share * reports[i].read_seconds;
      for (std::size_t node = 0; node < nodes.size(); ++node) nodes[node] += share * reports[i].node_seconds[node];
    }
    if (times.nodes.empty()) times.nodes.assign(nodes.size(), kNone);
    std::ranges::transform(nodes, times.nodes, times.nodes.begin(), [](double a, double b) { return std::min(a, b); });
    times.frame = std::min(times.frame, frame), times.reading = std::min(times.reading, reading);
  }
  times.plan = *session.plan();
  return times;
}

}  // namespace quell::bench
