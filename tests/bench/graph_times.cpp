#include "tests/bench/graph_times.h"

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "tests/bench/in_memory.h"

namespace quell::bench {
namespace {

constexpr int kLaps = 5;
constexpr std::size_t kWarm = 3;  // frames of a lap after which the history is as long as it matters

}  // namespace

double LapTimes::rest() const { return frame - reading - std::reduce(nodes.begin(), nodes.end()); }

GraphLaps::GraphLaps(const std::string& name, Size size, SessionOptions options, int count) {
  static const Registry passes = load_plugins();
  graph_ = load_graph(std::filesystem::path(QUELL_SOURCE_DIR) / "graphs" / (name + ".json"), passes);
  frames_ = std::make_shared<GraphFrames>(graph_->inputs, size, count);
  options.schedule = Schedule::serial;
  session_ = std::make_unique<Session>(graph_, std::move(options));
}

GraphLaps::GraphLaps(const GraphLaps& other, SessionOptions options) : graph_(other.graph_), frames_(other.frames_) {
  options.schedule = Schedule::serial;
  session_ = std::make_unique<Session>(graph_, std::move(options));
}

LapTimes GraphLaps::next() {
  Nowhere sink;
  const std::vector<FrameReport> reports = session_->run(frames_->lap(lap_++), *frames_, sink);
  LapTimes times;
  times.nodes.resize(plan().nodes.size());
  for (std::size_t i = 0; i < reports.size(); ++i) {
    if (!reports[i].ok) throw Error(Fault::frame, graph_->name, reports[i].error);
    if (i < kWarm) continue;
    const auto share = 1 / static_cast<double>(reports.size() - kWarm);
    times.frame += share * reports[i].seconds, times.reading += share * reports[i].read_seconds;
    for (std::size_t node = 0; node < times.nodes.size(); ++node) times.nodes[node] += share * reports[i].node_seconds[node];
  }
  return times;
}

GraphTimes time_graph(const std::string& name, Size size, int threads) {
  GraphLaps laps(name, size, {.threads = threads});
  GraphTimes times;
  for (int lap = 0; lap < kLaps; ++lap) {
    const LapTimes next = laps.next();
    LapTimes& best = times.best;
    if (lap == 0) best = next;
    std::ranges::transform(next.nodes, best.nodes, best.nodes.begin(), [](double a, double b) { return std::min(a, b); });
    best.frame = std::min(best.frame, next.frame), best.reading = std::min(best.reading, next.reading);
  }
  times.plan = laps.plan();
  times.from = laps.from();
  return times;
}

}  // namespace quell::bench
