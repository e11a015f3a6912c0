#include "trial.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "figure_text.h"
#include "interrupt.h"
#include "quell/text/diagnostic.h"
#include "quell/text/error.h"

namespace quell::app {
namespace {

constexpr double kLeast = 1e-12;  // of a figure that is 0 when nothing is wrong

class Nowhere final : public FrameSink {
 public:
  void write(std::string_view, std::int64_t, const Item&) override {}
};

double mix(const Figures& figures, const Figures& start) {
  double logs = 0;
  for (std::size_t i = 0; i < figures.size(); ++i) logs += std::log(std::max(figures[i], kLeast) / std::max(start[i], kLeast));
  return std::exp(logs / static_cast<double>(figures.size()));
}

}  // namespace

Goal parse_goal(const std::string& name) {
  if (name == "mixed") return {name, {Metric::mse, Metric::relmse, Metric::flip}};
  std::vector<std::string> names{"mixed"};
  for (const MetricInfo& about : metrics()) {
    if (about.is_temporal) continue;
    if (about.name == name) return {name, {about.metric}};
    names.emplace_back(about.name);
  }
  throw Error(Fault::usage, "--metric",
              "'" + name + "' cannot be searched by" + did_you_mean(name, names) + "; choose " + list_names(names));
}

double cost(const Goal& goal, const Figures& figures, const Figures& start) {
  if (goal.metrics.size() > 1) return mix(figures, start);
  return info(goal.metrics.front()).higher_is_better ? -figures.front() : figures.front();
}

std::string figures_text(const Goal& goal, const Figures& figures, const Figures& start) {
  std::string text;
  for (std::size_t i = 0; i < figures.size(); ++i) text += (i == 0 ? "" : "  ") + named_figure(goal.metrics[i], figures[i]);
  if (goal.metrics.size() == 1) return text;
  return goal.name + " " + figure_text(mix(figures, start), 4) + " (" + text + ")";
}

Trials::Trials(const Job& job, MeasuringOptions options, SessionOptions session)
    : job_(job), options_(std::move(options)), session_(std::move(session)) {
  if (options_.outputs.size() > 1) {
    const auto first = std::ranges::find_if(job.graph->outputs,
                                            [&](const GraphOutput& output) { return options_.outputs.contains(output.name); });
    options_.outputs = {first->name};
  }
  session_.cancelled = interrupted;
  session_.on_error = OnError::stop;
}

std::vector<Figures> Trials::run(const std::shared_ptr<const Graph>& graph, const std::vector<std::vector<std::int64_t>>& sets) {
  std::int64_t last = job_.frames.front();
  for (const std::vector<std::int64_t>& set : sets) last = std::max(last, std::ranges::max(set));
  std::vector<std::int64_t> frames;
  std::ranges::copy_if(job_.frames, std::back_inserter(frames), [&](std::int64_t frame) { return frame <= last; });

  Nowhere nowhere;
  MeasuringSink sink(nowhere, options_);
  std::map<std::int64_t, std::vector<Score>> scores;
  std::string failed;
  rerun_.on_restart([&] { sink.restart(), scores.clear(); });
  SessionOptions session = session_;
  session.on_frame = [&](const FrameReport& report) {
    if (!report.ok && failed.empty()) failed = "frame " + std::to_string(report.frame) + ": " + report.error;
    if (!report.ok) return sink.forget(report.frame);
    for (const MeasuredOutput& measured : sink.take(report.frame)) scores[report.frame] = measured.scores;
  };
  // A new label, so that an output is handed out, and measured, that none of the changed parameters can affect.
  const std::string output = *options_.outputs.begin();
  rerun_.run(graph, frames, *job_.sequence, sink, session, {{output, "trial " + std::to_string(++count_)}});
  if (interrupted()) throw Interrupted{};
  if (!failed.empty()) throw Error(Fault::frame, graph->name, failed);

  std::vector<Figures> figures;
  for (const std::vector<std::int64_t>& set : sets) {
    std::vector<Score> sums(options_.compare.metrics.size());
    for (const std::int64_t frame : set) {
      const auto found = scores.find(frame);
      if (found == scores.end())
        throw Error(Fault::input, "--reference", "frame " + std::to_string(frame) + " could not be measured against it");
      for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += found->second[i];
    }
    Figures& own = figures.emplace_back();
    for (std::size_t i = 0; i < sums.size(); ++i) own.push_back(value(options_.compare.metrics[i], sums[i]));
  }
  return figures;
}

}  // namespace quell::app
