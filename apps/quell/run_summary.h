// What a run tells when it is over: results, failures, and what was wrong with the inputs of all frames, summed up.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "job.h"
#include "quell/runtime/session.h"
#include "results.h"

namespace quell::app {

/// A line for each input that had values that are NaN or infinite, with their number and the frames.
std::vector<std::string> sum_up_replaced(const std::vector<FrameReport>& reports);

struct RunOutcome {
  const Job& job;
  const std::vector<ResultFiles>& results;
  const std::vector<FrameReport>& reports;
  std::uint64_t clamped_pixels = 0;
  double seconds = 0;
  std::size_t peak_bytes = 0;
};

/// Tells all that through the log: info, warnings, errors.
void tell_outcome(const RunOutcome& outcome);
/// Seconds that each node took, over all frames (debug level).
void tell_node_times(const Plan& plan, const std::vector<FrameReport>& reports);

}  // namespace quell::app
