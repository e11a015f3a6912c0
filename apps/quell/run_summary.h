// What a run tells when it is over: results, failures, and what was wrong with the inputs of all frames, summed up.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "job.h"
#include "measuring_sink.h"
#include "quell/runtime/session.h"
#include "results.h"

namespace quell::app {

/// A line for each input that had values that are NaN or infinite, with their number and the frames.
std::vector<std::string> sum_up_replaced(const std::vector<FrameReport>& reports);

/// What became of the frames of a run; each list ascending.
struct FrameSets {
  std::vector<std::int64_t> done, failed, not_computed;
};
FrameSets sort_frames(const std::vector<std::int64_t>& wanted, const std::vector<FrameReport>& reports);

enum class Ending {
  done,
  failed,       ///< some frames failed, the others were computed
  stopped,      ///< because a frame failed; others were not computed
  interrupted,  ///< by a signal
};
Ending ending_of(const FrameSets& frames, bool stop_on_error);

struct RunOutcome {
  const Job& job;
  const std::vector<ResultFiles>& results;
  const std::vector<FrameReport>& reports;
  FrameSets frames;
  Ending ending = Ending::done;
  std::uint64_t clamped_pixels = 0;
  double seconds = 0;
  std::size_t peak_bytes = 0;
  const MeasuringSink* measuring = nullptr;  ///< with --reference
};

/// Tells all that through the log: info, warnings, errors. Why frames were not computed comes last.
void tell_outcome(const RunOutcome& outcome);

}  // namespace quell::app
