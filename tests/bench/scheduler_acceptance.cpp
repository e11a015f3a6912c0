// What two threads gain in the scheduler.
#include <algorithm>
#include <functional>

#include "quell/runtime/analysis.h"
#include "tests/bench/figure.h"
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

}  // namespace

std::vector<Figure> scheduler_figures() {
  return {{.what = "two independent branches on 2 threads, times as fast as in a row", .reached = gain_of_branches(), .bar = 1.8},
          {.what = "a cheap loop beside costly nodes, part of the bound", .reached = reached_of_bound(), .bar = 0.9}};
}

}  // namespace quell::bench
