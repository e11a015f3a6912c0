// Whole graphs at 1920 x 1080 in memory: what a frame takes once history is there, node by node beside what memory alone would
// take.
#include <algorithm>
#include <cstdio>
#include <numeric>
#include <set>

#include "tests/bench/ceilings.h"
#include "tests/bench/figure.h"
#include "tests/bench/graph_times.h"

namespace quell::bench {
namespace {

constexpr Size kSize{1920, 1080};
double bytes_of(const Shape& shape) {
  if (!shape.present || !is_image(shape.type)) return 0;
  return 4.0 * info(shape.type).channels * shape.size.width * shape.size.height;
}

/// Each image that the node reads read once, however many of its ports it feeds, and each that it yields written once.
double bytes_moved(const Plan& plan, const PlannedNode& planned) {
  std::set<std::pair<Endpoint, int>> read;
  for (const std::vector<Edge>& port : plan.graph->nodes[static_cast<std::size_t>(planned.node)].inputs)
    for (const Edge& edge : port)
      if (!edge.from.is_nothing()) read.emplace(edge.from, edge.delay);
  double bytes = 0;
  for (const auto& [endpoint, delay] : read) bytes += bytes_of(plan.shape(endpoint));
  for (const std::vector<Shape>& port : planned.outputs)
    for (const Shape& shape : port) bytes += bytes_of(shape);
  return bytes;
}

/// A figure for each node. Those of `unbound` passes, whose arithmetic takes longer than memory does, have no bar.
std::vector<Figure> node_figures(const GraphTimes& times, double bytes_per_second, const std::set<std::string>& unbound) {
  std::vector<Figure> figures;
  for (std::size_t i = 0; i < times.best.nodes.size(); ++i) {
    const PlannedNode& planned = times.plan.nodes[i];
    const Node& node = times.plan.graph->nodes[static_cast<std::size_t>(planned.node)];
    const double bound = bytes_moved(times.plan, planned) / bytes_per_second;
    char text[128];
    std::snprintf(text, sizeof text, "%.2f ms, %.2f ns a pixel; memory alone %.2f ms, 1 / %.2f", times.best.nodes[i] * 1e3,
                  times.best.nodes[i] * 1e9 / (kSize.width * kSize.height), bound * 1e3, times.best.nodes[i] / bound);
    Figure figure{.what = node.name + " (" + node.pass->id + "), times its bandwidth bound",
                  .reached = times.best.nodes[i] / bound,
                  .bar = 2,
                  .at_most = true,
                  .note = text};
    if (unbound.contains(node.pass->id)) figure.skipped = figure.note;
    figures.push_back(std::move(figure));
  }
  return figures;
}

std::vector<Figure> graph_figures(const std::string& name, const std::set<std::string>& unbound, double bar) {
  const int threads = acceptance_threads();
  // Before and after, because the neighbors of the machine come and go.
  const double before = measure_copy_bandwidth(threads);
  const GraphTimes times = time_graph(name, kSize, threads);
  const double bytes_per_second = std::max(before, measure_copy_bandwidth(threads));
  char text[160];
  std::snprintf(text, sizeof text, "%.1f ms: nodes %.1f, inputs %.1f; frames of %s; copying %.1f GB/s", 1e3 * times.best.frame,
                1e3 * std::reduce(times.best.nodes.begin(), times.best.nodes.end()), 1e3 * times.best.reading, times.from.c_str(),
                bytes_per_second * 1e-9);
  std::vector<Figure> figures = node_figures(times, bytes_per_second, unbound);
  figures.push_back({.what = "1080p on " + std::to_string(threads) + " threads, ms a frame; the bar is for AVX-512",
                     .reached = times.best.frame * 1e3,
                     .bar = bar,
                     .at_most = true,
                     .note = text});
  return figures;
}

}  // namespace

// Without bars: what it takes is told by those of its filter.
std::vector<Figure> games202_figures() {
  std::vector<Figure> figures = graph_figures("games202", {}, 0);
  for (Figure& figure : figures) figure.skipped = figure.note;
  return figures;
}

std::vector<Figure> svgf_figures() { return graph_figures("svgf", {"atrous"}, 110); }

}  // namespace quell::bench
