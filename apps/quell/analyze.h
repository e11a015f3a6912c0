// quell graph --analyze: measures a graph on a sequence, and tells what bounds its throughput.
#pragma once

#include "console.h"
#include "exit_code.h"
#include "job.h"

namespace quell::app {

/// Runs the job's frames twice, on one thread and on `threads` (0: as many as there are processors), with results in a temporary
/// folder that does not outlast the call, and prints the analysis. Throws Error(frame) when a frame fails.
ExitCode analyze_job(Job& job, int threads, Console& console);

}  // namespace quell::app
