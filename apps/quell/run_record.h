// What a run tells programs, as JSON: the same in the lines of --log-json and in the file of --report. The fields are described
// in README.md.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "json_lines.h"
#include "measuring_sink.h"
#include "quell/runtime/window.h"
#include "run_summary.h"

namespace quell::app {

/// Frames as --frames takes them; "" for none, so that it can be tested.
std::string range_text(const std::vector<std::int64_t>& frames);

/// Graph, files, frames and options, before the first frame.
JsonObject record_start(const Job& job, const std::vector<ResultFiles>& results, const SessionOptions& options,
                        const Window& window);

/// `measured` of the frame's outputs, in these metrics.
JsonObject record_frame(const FrameReport& report, const Plan& plan, const BufferPool::Usage& usage,
                        const std::vector<MeasuredOutput>& measured, const std::vector<Metric>& metrics);

/// Outcome, frames and times, without the exit code.
JsonObject record_end(const RunOutcome& outcome);
/// Of a run that could not start, or not go on.
JsonObject record_end(std::string_view error);

}  // namespace quell::app
