#include "analysis_text.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "progress.h"
#include "text_layout.h"

namespace quell::app {
namespace {

using spdlog::fmt_lib::format;

std::string milliseconds(double seconds) { return format("{:.3f} ms", seconds * 1e3); }

template <class Number>
std::string count(Number number, const char* noun) {
  return format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

std::string percent(double part, double whole) { return format("{:.0f} %", whole > 0 ? 100 * part / whole : 0); }

/// Rows of a name, numbers and a remark. Numbers end below each other.
class Rows {
 public:
  void add(std::string name, std::vector<std::string> numbers, std::string remark = {}) {
    rows_.push_back({std::move(name), std::move(numbers), std::move(remark)});
  }
  std::string text() const {
    std::string text;
    for (const Row& row : rows_) {
      std::string line = format("  {:<{}}", row.name, width([](const Row& r) { return r.name.size(); }));
      for (std::size_t i = 0; i < row.numbers.size(); ++i)
        line += format("  {:>{}}", row.numbers[i],
                       width([&](const Row& r) { return i < r.numbers.size() ? r.numbers[i].size() : 0; }));
      text += line + (row.remark.empty() ? "" : "  " + row.remark) + "\n";
    }
    return text;
  }

 private:
  struct Row {
    std::string name;
    std::vector<std::string> numbers;
    std::string remark;
  };
  template <class Size>
  std::size_t width(Size&& size) const {
    std::size_t most = 0;
    for (const Row& row : rows_) most = std::max(most, size(row));
    return most;
  }
  std::vector<Row> rows_;
};

const std::string& name_of(const Plan& plan, int node) { return plan.graph->nodes[static_cast<std::size_t>(node)].name; }

/// "a -> b -> a"
std::string describe(const Plan& plan, const Cycle& cycle) {
  std::string text;
  for (const int node : cycle.nodes) text += name_of(plan, node) + " -> ";
  return text + name_of(plan, cycle.nodes.front());
}

double sum(const std::vector<double>& values) {
  double total = 0;
  for (const double value : values) total += value;
  return total;
}

void add_times(Rows& rows, const std::string& name, double one, double all, int threads) {
  if (threads == 1)
    rows.add(name, {milliseconds(one)});
  else
    rows.add(name, {milliseconds(one), milliseconds(all), all > 0 ? format("{:.2f}", one / all) : "-"});
}

std::string describe_times(const Plan& plan, const FrameTimes& times) {
  Rows rows;
  if (times.threads == 1)
    rows.add("", {"1 thread"});
  else
    rows.add("", {"1 thread", count(times.threads, "thread"), "speedup"});
  for (std::size_t i = 0; i < plan.nodes.size(); ++i)
    add_times(rows, name_of(plan, plan.nodes[i].node), times.on_one_thread[i], times.on_all_threads[i], times.threads);
  add_times(rows, "all nodes", sum(times.on_one_thread), sum(times.on_all_threads), times.threads);
  rows.add("reading", {milliseconds(times.reading)});
  rows.add("writing", {milliseconds(times.writing)});
  return "\ntime of a frame, one thing after the other" +
         (times.frames > 1 ? ": medians of " + count(times.frames, "frame") : std::string()) + "\n" + rows.text();
}

std::string describe_cycles(const Plan& plan, const Analysis& analysis) {
  std::string text = analysis.cycles.empty() ? "" : "\nslowest cycle of each loop\n";
  for (const Cycle& cycle : analysis.cycles)
    text += wrap(describe(plan, cycle), 2) + format("    {} / {} = {} per frame\n", milliseconds(cycle.seconds),
                                                    count(cycle.delay, "frame"), milliseconds(cycle.seconds_per_frame()));
  return text;
}

std::string describe_bound(const FrameTimes& times, const Analysis& analysis) {
  const double most = analysis.seconds_per_frame();
  Rows rows;
  rows.add("loops", {milliseconds(analysis.loop)},
           analysis.cycles.empty() ? "there are none" : "the slowest cycle: a frame waits in it for an earlier one");
  rows.add("work", {milliseconds(analysis.work)},
           "nodes, reading and writing, shared evenly by " + count(times.threads, "thread"));
  rows.add("I/O", {milliseconds(analysis.io)}, "reading and writing, if all threads did nothing else");
  rows.add("bound", {milliseconds(most)},
           most > 0 ? "per frame at least: at most " + format_rate(1 / most) + " frames/s" : "per frame at least");
  return "\nwhat a frame takes at least, with any number of frames in flight\n" + rows.text();
}

/// How much faster the cycle's nodes are on all threads than on one.
double speedup(const Plan& plan, const FrameTimes& times, const Cycle& cycle) {
  double one = 0, all = 0;
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    if (std::find(cycle.nodes.begin(), cycle.nodes.end(), plan.nodes[i].node) == cycle.nodes.end()) continue;
    one += times.on_one_thread[i];
    all += times.on_all_threads[i];
  }
  return all > 0 ? one / all : 1;
}

std::string explain_loop(const Plan& plan, const FrameTimes& times, const Cycle& cycle) {
  constexpr double kNoticeable = 1.1;
  std::string text = "the loop " + describe(plan, cycle) + " binds: ";
  const double faster = speedup(plan, times, cycle);
  if (times.threads == 1)
    text += "more threads would help only as far as its nodes run faster on them";
  else if (faster < kNoticeable)
    text += "more threads would not help";
  else
    text += format("more threads would help only as far as its nodes run faster on them ({:.2f} times as fast on {} as on 1)",
                   faster, times.threads);
  return text + "; cheaper nodes in it would, and so would a longer delay";
}

std::string explain_work(const Plan& plan, const FrameTimes& times, const Analysis& analysis) {
  const double whole = analysis.work * times.threads;
  const double files = whole - sum(times.on_one_thread);
  const std::string share = files > 0 ? " (" + percent(files, whole) + " of it reading and writing)" : "";
  std::string text = "work binds" + share + ": more threads on as many processors would help";
  constexpr double kSoMany = 1000;
  if (analysis.loop * kSoMany < whole) return text;
  return text + format(", up to about {:.0f}; then the loop {} would bind", std::ceil(whole / analysis.loop),
                       describe(plan, *analysis.slowest()));
}

std::string explain_window(const Window& window) {
  return "a run keeps up to " + count(window.frames, "frame") + " in flight (" + window.reason + "), each of " +
         format_bytes(window.bytes_per_frame) + ", beside " + format_bytes(window.fixed_bytes) + " of history and constants";
}

}  // namespace

std::string explain_limit(const Plan& plan, const FrameTimes& times, const Analysis& analysis) {
  switch (analysis.limit) {
    case Analysis::Limit::loop:
      return explain_loop(plan, times, *analysis.slowest());
    case Analysis::Limit::io:
      return "reading and writing bind: a faster source or sink would help, and more threads, which read and write side by side";
    case Analysis::Limit::work:
      return explain_work(plan, times, analysis);
  }
  return "";
}

std::string describe(const Plan& plan, const FrameTimes& times, const Analysis& analysis, const Window& window) {
  return describe_times(plan, times) + describe_cycles(plan, analysis) + describe_bound(times, analysis) + "\n" +
         wrap(explain_limit(plan, times, analysis)) + wrap(explain_window(window));
}

}  // namespace quell::app
