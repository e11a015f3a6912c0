#include "quell/runtime/analysis.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "quell/runtime/host.h"
#include "quell/text/error.h"

namespace quell {
namespace {

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

std::size_t first_that_counts(std::size_t frames) { return frames > 2 ? 1 : 0; }

/// The median of something over the frames that count.
template <class What>
double median_of(const std::vector<FrameReport>& reports, What&& what) {
  std::vector<double> values;
  for (std::size_t i = first_that_counts(reports.size()); i < reports.size(); ++i) values.push_back(what(reports[i]));
  return median(std::move(values));
}

std::vector<double> node_medians(const std::vector<FrameReport>& reports) {
  std::vector<double> medians;
  for (std::size_t node = 0; node < reports.front().node_seconds.size(); ++node)
    medians.push_back(median_of(reports, [&](const FrameReport& report) { return report.node_seconds[node]; }));
  return medians;
}

std::vector<FrameReport> run_all(const std::shared_ptr<const Graph>& graph, const std::vector<std::int64_t>& frames,
                                 FrameSource& source, FrameSink& sink, const SessionOptions& options) {
  Session session(graph, options);
  std::vector<FrameReport> reports = session.run(frames, source, sink);
  for (const FrameReport& report : reports)
    if (!report.ok) throw Error(Fault::frame, "frame " + std::to_string(report.frame), report.error);
  if (reports.size() < frames.size()) throw Cancelled();
  return reports;
}

}  // namespace

const Cycle* Analysis::slowest() const {
  const auto faster = [](const Cycle& a, const Cycle& b) { return a.seconds_per_frame() < b.seconds_per_frame(); };
  const auto found = std::max_element(cycles.begin(), cycles.end(), faster);
  return found == cycles.end() ? nullptr : &*found;
}

double Analysis::seconds_per_frame() const { return std::max({loop, io, work}); }

Analysis analyze(const Plan& plan, const FrameTimes& times) {
  std::vector<double> fastest;
  for (std::size_t i = 0; i < times.on_one_thread.size(); ++i)
    fastest.push_back(std::min(times.on_one_thread[i], times.on_all_threads[i]));
  Analysis analysis;
  analysis.cycles = find_slowest_cycles(plan, fastest);
  if (const Cycle* cycle = analysis.slowest()) analysis.loop = cycle->seconds_per_frame();

  const double coding = (times.source_uses_processor ? times.reading : 0) + (times.sink_uses_processor ? times.writing : 0);
  const double nodes = std::reduce(times.on_one_thread.begin(), times.on_one_thread.end());
  analysis.work = (nodes + coding) / times.threads;
  analysis.io = std::max(coding / times.threads, (times.reading + times.writing) / (times.threads + 1));

  const double most = analysis.seconds_per_frame();
  if (analysis.slowest() && analysis.loop == most)
    analysis.limit = Analysis::Limit::loop;
  else
    analysis.limit = analysis.io == most ? Analysis::Limit::io : Analysis::Limit::work;
  return analysis;
}

FrameTimes measure(const std::shared_ptr<const Graph>& graph, const std::vector<std::int64_t>& frames, FrameSource& source,
                   FrameSink& sink, SessionOptions options) {
  if (frames.empty()) throw Error(Fault::usage, graph->name, "there is no frame to measure; name at least one");
  FrameTimes times;
  times.frames = frames.size() - first_that_counts(frames.size());
  times.threads = options.threads > 0 ? options.threads : available_threads();
  times.source_uses_processor = source.uses_processor();
  times.sink_uses_processor = sink.uses_processor();

  options.schedule = Schedule::serial;
  options.threads = 1;
  const std::vector<FrameReport> alone = run_all(graph, frames, source, sink, options);
  times.on_one_thread = times.on_all_threads = node_medians(alone);
  times.reading = median_of(alone, [](const FrameReport& report) { return report.read_seconds; });
  times.writing = median_of(alone, [](const FrameReport& report) { return report.write_seconds; });
  if (times.threads == 1) return times;

  options.threads = times.threads;
  times.on_all_threads = node_medians(run_all(graph, frames, source, sink, options));
  return times;
}

}  // namespace quell
