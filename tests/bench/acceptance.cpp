// Figures that must be reached, each a ratio within one run, so that it holds on slow and fast machines alike.
//
// Prints a line for each, and returns 1 when one is missed. Wants a machine that has nothing else to do.
#include <algorithm>
#include <cstdio>
#include <functional>

#include "quell/runtime/analysis.h"
#include "tests/bench/in_memory.h"

namespace quell::bench {
namespace {

constexpr Size kSize{64, 64};
constexpr int kFrames = 24;
constexpr int kRepeats = 5;

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

double median_of_repeats(const std::function<double()>& measure) {
  std::vector<double> figures;
  for (int i = 0; i < kRepeats; ++i) figures.push_back(measure());
  return median(figures);
}

/// About 20 ms of one thread in each branch.
const char* const kBranches = R"({"quell": 1, "inputs": {"color": "color"},
  "nodes": {"left":  {"pass": "burn", "in": {"color": "color"}, "params": {"rounds": 15000000}},
            "right": {"pass": "burn", "in": {"color": "color"}, "params": {"rounds": 15000000}},
            "sum":   {"pass": "burn", "in": {"color": "left.color", "other": "right.color"}}},
  "outputs": {"color": "sum.color"}})";

/// A loop of 2 ms, and 40 ms beside it that one thread at a time can do.
const char* const kCheapLoop = R"({"quell": 1, "inputs": {"color": "color"},
  "nodes": {"loop": {"pass": "burn", "in": {"color": "color", "other": {"from": "loop.color", "delay": 1, "initial": "none"}},
                     "params": {"rounds": 1500000}},
            "a": {"pass": "burn", "in": {"color": "loop.color"}, "params": {"rounds": 15000000}},
            "b": {"pass": "burn", "in": {"color": "a.color"}, "params": {"rounds": 15000000}}},
  "outputs": {"color": "b.color"}})";

/// Two independent branches on two threads, against one node after the other.
double gain_of_branches() {
  const auto graph = make_graph(kBranches);
  return median_of_repeats([&] {
    const double serial = time_run(graph, kSize, kFrames, {.threads = 2, .schedule = Schedule::serial});
    return serial / time_run(graph, kSize, kFrames, {.threads = 2, .frames_in_flight = 1});
  });
}

/// The time of a frame that analyze() says cannot be beaten, against the time that it takes.
double reached_of_bound() {
  const auto graph = make_graph(kCheapLoop);
  return median_of_repeats([&] {
    OneImage source(kSize);
    Nowhere sink;
    const Plan plan = make_plan(graph, {{"color", source.shape("color")}});
    const Analysis analysis = analyze(plan, measure(graph, first_frames(6), source, sink, {.threads = 2}));
    const double taken = time_run(graph, kSize, kFrames, {.threads = 2}) / kFrames;
    return analysis.seconds_per_frame() / taken;
  });
}

struct Figure {
  const char* what;
  double wanted;
  std::function<double()> measure;
};

}  // namespace
}  // namespace quell::bench

int main() {
  using namespace quell::bench;
  const std::vector<Figure> figures = {
      {"two independent branches on two threads, times as fast as one after the other", 1.8, gain_of_branches},
      {"a cheap loop beside costly nodes, part of the bound that is reached", 0.9, reached_of_bound},
  };
  bool all = true;
  for (const Figure& figure : figures) {
    const double reached = figure.measure();
    all = all && reached >= figure.wanted;
    std::printf("%-6s %.3f, at least %.2f is wanted: %s\n", reached >= figure.wanted ? "ok" : "MISSED", reached, figure.wanted,
                figure.what);
    std::fflush(stdout);
  }
  return all ? 0 : 1;
}
