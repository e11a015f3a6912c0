// Whole sequences at the speed of the machine: what a graph takes at several sizes and on several threads, what fusion gains, and
// what the framework costs in time and memory.
#include <algorithm>
#include <cstdio>
#include <iterator>
#include <limits>

#include "tests/bench/figure.h"
#include "tests/bench/graph_times.h"
#include "tests/bench/in_memory.h"

namespace quell::bench {
namespace {

constexpr Size kFullHd{1920, 1080}, kUltraHd{3840, 2160};
constexpr int kLaps = 5;
constexpr int kFewFrames = 4;  // of 3840 x 2160, each 0.6 GB

std::string text_of(const char* format, double a, double b = 0, double c = 0) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

std::vector<Figure> svgf_figures_of_all_sizes() {
  GraphLaps two("svgf", kFullHd, {.threads = acceptance_threads()});
  GraphLaps one(two, {.threads = 1});
  GraphLaps unfused(two, {.threads = acceptance_threads(), .fuse = false});
  GraphLaps large("svgf", kUltraHd, {.threads = acceptance_threads()}, kFewFrames);
  double rest = std::numeric_limits<double>::infinity();  // the part of a lap that the neighbors of the machine disturbed least
  const std::vector<double> best = time_alternately(
      kLaps, {[&] {
                const LapTimes times = two.next();
                rest = std::min(rest, times.rest() / times.frame);
                return times.frame;
              },
              [&] { return one.next().frame; }, [&] { return unfused.next().frame; }, [&] { return large.next().frame; }});
  const std::string threads = std::to_string(acceptance_threads()) + " threads";
  return {{.what = "svgf, 1080p on " + threads + ", ms a frame; the bar is for AVX-512",
           .reached = best[0] * 1e3,
           .bar = 85,
           .at_most = true,
           .note = "frames of " + two.from()},
          {.what = "svgf, 2160p, times 1080p",
           .reached = best[3] / best[0],
           .bar = 4.2,
           .at_most = true,
           .note = in_milliseconds(best[3], best[0])},
          {.what = "svgf, 1080p, 2 threads, times as fast as 1",
           .reached = best[1] / best[0],
           .bar = 1.85,
           .note = in_milliseconds(best[1], best[0])},
          {.what = "svgf, 1080p, fused, times as fast as unfused",
           .reached = best[2] / best[0],
           .bar = 1.15,
           .note = in_milliseconds(best[2], best[0])},
          {.what = "svgf, 1080p, part of a frame that is neither nodes nor reading",
           .reached = rest,
           .bar = 0.01,
           .at_most = true,
           .note = "of the best lap"}};
}

/// 20 passes that do nothing.
std::string empty_chain() {
  std::string text = R"({"quell": 1, "inputs": {"color": "color"}, "nodes": {)";
  for (int i = 0; i < 20; ++i)
    text += (i == 0 ? "" : ", ") + std::string("\"n") + std::to_string(i) + R"(": {"pass": "empty", "in": {"color": ")" +
            (i == 0 ? "color" : "n" + std::to_string(i - 1) + ".color") + "\"}}";
  return text + R"(}, "outputs": {"color": "n19.color"}})";
}

Figure frames_a_second() {
  const auto graph = make_graph(empty_chain());
  constexpr int kFrames = 4000;
  double best = 0;
  int best_window = 0;
  for (int repeat = 0; repeat < 3; ++repeat)
    for (const int window : {1, 2, 3, 4, 8, 16})
      if (const double rate =
              kFrames / time_run(graph, {64, 64}, kFrames, {.threads = acceptance_threads(), .frames_in_flight = window});
          rate > best)
        best = rate, best_window = window;
  return {.what = "20 passes that do nothing, 64x64, frames a second",
          .reached = best,
          .bar = 20000,
          .note = std::to_string(best_window) + " frames in flight"};
}

/// What the pool held at most, beside what the plan says of so many frames in flight.
Figure peak_of_plan() {
  constexpr int kInFlight = 4;
  static const Registry passes = load_plugins();
  const auto graph = load_graph(std::filesystem::path(QUELL_SOURCE_DIR) / "graphs/svgf.json", passes);
  constexpr Size kSize{960, 540};
  GraphFrames frames(graph->inputs, kSize);
  Nowhere sink;
  Session session(graph, {.threads = acceptance_threads(), .frames_in_flight = kInFlight});
  std::vector<std::int64_t> all;
  for (int lap = 0; lap < 4; ++lap) std::ranges::copy(frames.lap(lap), std::back_inserter(all));
  session.run(all, frames, sink);
  const Plan& plan = *session.plan();
  std::size_t inputs = 0;  // which the source holds
  for (std::size_t i = 0; i < plan.inputs.size(); ++i)
    if (plan.input_used[i]) inputs += plan.bytes({-1, static_cast<int>(i), 0});
  const auto planned = static_cast<double>(plan.history_bytes + kInFlight * (plan.frame_bytes - inputs));
  const auto peak = static_cast<double>(session.pool().usage().peak);
  return {.what = "svgf, 540p, most that the pool held, times what is planned",
          .reached = peak / planned,
          .bar = 1.25,
          .at_most = true,
          .note = text_of("%.0f and %.0f MiB for 4 frames in flight", peak / (1 << 20), planned / (1 << 20))};
}

/// A chain of fused nodes on images of any size.
double seconds_a_pixel(Size size) {
  const auto graph = make_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"a": {"pass": "burn", "in": {"color": "color"}, "params": {"parallel": true}},
              "b": {"pass": "burn", "in": {"color": "a.color", "other": "color"}, "params": {"parallel": true}}},
    "outputs": {"color": "b.color"}})");
  return time_run(graph, size, 3, {.threads = acceptance_threads(), .schedule = Schedule::serial}) / 3 /
         (double{1} * size.width * size.height);
}

/// Beside 2560x1440, of which no processor's last-level cache keeps both images; smaller ones cost less.
std::vector<Figure> large_frames() {
  const std::vector<double> best = time_alternately(3, {[] {
                                                          return seconds_a_pixel({2560, 1440});
                                                        },
                                                        [] {
                                                          return seconds_a_pixel({4096, 2160});
                                                        },
                                                        [] {
                                                          return seconds_a_pixel({16384, 8192});
                                                        }});
  const std::string note = in_nanoseconds(best, "ns a pixel at 2560x1440, 4096x2160 and 16384x8192");
  return {{.what = "two passes, 4096x2160, time a pixel over that of 2560x1440",
           .reached = best[1] / best[0],
           .bar = 1.2,
           .at_most = true,
           .note = note},
          {.what = "two passes, 16384x8192, time a pixel over that of 2560x1440",
           .reached = best[2] / best[0],
           .bar = 1.2,
           .at_most = true,
           .note = note}};
}

}  // namespace

std::vector<Figure> throughput_figures() {
  std::vector<Figure> figures = svgf_figures_of_all_sizes();
  figures.push_back(frames_a_second());
  figures.push_back(peak_of_plan());
  for (Figure& figure : large_frames()) figures.push_back(std::move(figure));
  return figures;
}

}  // namespace quell::bench
