#include "run_summary.h"

#include <algorithm>
#include <numeric>

#include "console.h"
#include "progress.h"

namespace quell::app {
namespace {

constexpr std::size_t kMostFailuresListed = 20;

std::string frames_text(const std::vector<std::int64_t>& frames) {
  return (frames.size() == 1 ? "frame " : "frames ") + FrameRange(frames).text();
}

void tell_failures(const std::vector<FrameReport>& reports) {
  std::vector<const FrameReport*> failed;
  for (const FrameReport& report : reports)
    if (!report.ok) failed.push_back(&report);
  if (failed.empty()) return;
  std::string list;
  for (std::size_t i = 0; i < std::min(failed.size(), kMostFailuresListed); ++i)
    list += "\n  frame " + std::to_string(failed[i]->frame) + ": " + failed[i]->error;
  if (failed.size() > kMostFailuresListed) list += "\n  and " + std::to_string(failed.size() - kMostFailuresListed) + " more";
  spdlog::error("{} of {} frames failed:{}", failed.size(), reports.size(), list);
}

}  // namespace

std::vector<std::string> sum_up_replaced(const std::vector<FrameReport>& reports) {
  struct Sum {
    ReplacedValues values;
    std::vector<std::int64_t> frames;
  };
  std::map<std::string, Sum> sums;  // by input
  for (const FrameReport& report : reports)
    for (const ReplacedValues& replaced : report.replaced) {
      Sum& sum = sums.try_emplace(replaced.input, Sum{{replaced.input, replaced.type, 0}, {}}).first->second;
      sum.values.count += replaced.count;
      sum.frames.push_back(report.frame);
    }
  std::vector<std::string> lines;
  for (const auto& [input, sum] : sums) lines.push_back(describe(sum.values) + " (" + frames_text(sum.frames) + ")");
  return lines;
}

void tell_outcome(const RunOutcome& outcome) {
  for (const std::string& warning : sum_up_replaced(outcome.reports)) spdlog::warn(warning);
  if (outcome.clamped_pixels > 0)
    spdlog::warn("{} pixels were too bright for half floats and were clamped to 65504; --type float keeps them as they are",
                 outcome.clamped_pixels);
  std::vector<std::int64_t> done;
  for (const FrameReport& report : outcome.reports)
    if (report.ok) done.push_back(report.frame);
  const double rate = outcome.seconds > 0 ? static_cast<double>(outcome.reports.size()) / outcome.seconds : 0;
  spdlog::info("{} of {} frames done in {} ({} frames/s), with up to {} of images", done.size(), outcome.job.frames.size(),
               format_duration(outcome.seconds), format_rate(rate), format_bytes(outcome.peak_bytes));
  if (!done.empty())
    for (const ResultFiles& series : outcome.results) spdlog::info("  {}  {}", series.pattern, frames_text(done));
  tell_failures(outcome.reports);
}

void tell_node_times(const Plan& plan, const std::vector<FrameReport>& reports) {
  std::vector<double> sums(plan.nodes.size(), 0.0);
  for (const FrameReport& report : reports)
    if (report.node_seconds.size() == sums.size())
      std::transform(sums.begin(), sums.end(), report.node_seconds.begin(), sums.begin(), std::plus<>());
  std::size_t width = 0;
  const auto name = [&](std::size_t i) { return plan.graph->nodes[static_cast<std::size_t>(plan.nodes[i].node)].name; };
  for (std::size_t i = 0; i < sums.size(); ++i) width = std::max(width, name(i).size());
  spdlog::debug("time in the nodes:");
  for (std::size_t i = 0; i < sums.size(); ++i) spdlog::debug("  {:<{}}  {}", name(i), width, format_duration(sums[i]));
}

}  // namespace quell::app
