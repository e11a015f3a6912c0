#include "run_summary.h"

#include <algorithm>
#include <charconv>
#include <numeric>

#include "console.h"
#include "progress.h"

namespace quell::app {
namespace {

constexpr std::size_t kMostFailuresListed = 20;

/// "color: 3 values were bad" as "color: ", 3, " values were bad"; the whole as `before` when it is not of that form.
struct CountedText {
  std::string before, after;
  std::int64_t count = 0;
  bool has_count = false;
};

CountedText take_apart(const std::string& text) {
  const std::size_t colon = text.find(": ");
  if (colon == std::string::npos) return {text, "", 0, false};
  const char* digits = text.data() + colon + 2;
  std::int64_t count = 0;
  const auto [end, error] = std::from_chars(digits, text.data() + text.size(), count);
  if (error != std::errc() || end == text.data() + text.size() || *end != ' ') return {text, "", 0, false};
  return {text.substr(0, colon + 2), end, count, true};
}

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

std::vector<std::string> sum_up_warnings(const std::vector<FrameReport>& reports) {
  struct Sum {
    std::int64_t count = 0;
    bool has_count = false;
    std::vector<std::int64_t> frames;
  };
  std::map<std::pair<std::string, std::string>, Sum> sums;
  for (const FrameReport& report : reports)
    for (const std::string& warning : report.warnings) {
      const CountedText parts = take_apart(warning);
      Sum& sum = sums[{parts.before, parts.after}];
      sum.count += parts.count;
      sum.has_count = parts.has_count;
      sum.frames.push_back(report.frame);
    }
  std::vector<std::string> lines;
  for (const auto& [text, sum] : sums)
    lines.push_back(text.first + (sum.has_count ? std::to_string(sum.count) : "") + text.second + " (" + frames_text(sum.frames) +
                    ")");
  return lines;
}

void tell_outcome(const RunOutcome& outcome) {
  for (const std::string& warning : sum_up_warnings(outcome.reports)) spdlog::warn(warning);
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
