#include "run_summary.h"

#include <algorithm>

#include "console.h"
#include "node_times.h"
#include "progress.h"
#include "run_reference.h"

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

void tell_not_computed(const RunOutcome& outcome) {
  if (outcome.frames.not_computed.empty()) return;
  const std::string why =
      outcome.ending == Ending::interrupted
          ? "interrupted"
          : "stopped at frame " + std::to_string(outcome.frames.failed.front()) + " because of --on-error stop";
  spdlog::error("{}; frames done: {}; not computed: {}", why, FrameRange(outcome.frames.done).text(),
                FrameRange(outcome.frames.not_computed).text());
}

}  // namespace

FrameSets sort_frames(const std::vector<std::int64_t>& wanted, const std::vector<FrameReport>& reports) {
  std::map<std::int64_t, bool> known;  // whether it is done
  for (const FrameReport& report : reports) known[report.frame] = report.ok;
  FrameSets sets;
  for (const std::int64_t frame : wanted) {
    const auto report = known.find(frame);
    (report == known.end() ? sets.not_computed : report->second ? sets.done : sets.failed).push_back(frame);
  }
  return sets;
}

Ending ending_of(const FrameSets& frames, bool stop_on_error) {
  if (frames.not_computed.empty()) return frames.failed.empty() ? Ending::done : Ending::failed;
  return stop_on_error && !frames.failed.empty() ? Ending::stopped : Ending::interrupted;
}

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
  const double rate = outcome.seconds > 0 ? static_cast<double>(outcome.reports.size()) / outcome.seconds : 0;
  spdlog::info("{} of {} frames done in {} ({} frames/s), with up to {} of images", outcome.frames.done.size(),
               outcome.job.frames.size(), format_duration(outcome.seconds), format_rate(rate), format_bytes(outcome.peak_bytes));
  if (!outcome.frames.done.empty())
    for (const ResultFiles& series : outcome.results) spdlog::info("  {}  {}", series.pattern, frames_text(outcome.frames.done));
  if (outcome.measuring) tell_measured(*outcome.measuring);
  if (const std::string table = time_table(outcome.job.plan, outcome.reports, outcome.seconds); !table.empty())
    spdlog::info(table);
  tell_failures(outcome.reports);
  tell_not_computed(outcome);
}

}  // namespace quell::app
