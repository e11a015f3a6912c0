// What --watch says of a run that follows another.
#pragma once

#include <string>
#include <vector>

#include "job.h"
#include "quell/runtime/rerun.h"
#include "results.h"

namespace quell::app {

/// "blend: 8 of 8 frames; filter, motion, reproject: kept"
std::string describe_computed(const RerunReport& report);
/// Tells that, why all was computed, and what will have to be computed again for lack of memory.
void tell_computed(const RerunReport& report, bool is_first);
/// Tells of results of the run before that are no more, and whose files are left.
void tell_left_files(const std::vector<ResultFiles>& before, const std::vector<ResultFiles>& now);
/// The results that a run handed out.
std::vector<ResultFiles> select_results(const std::vector<ResultFiles>& all, const RerunReport& report);

/// Whether two graphs read inputs of the same names and types.
bool same_inputs(const Graph& a, const Graph& b);
/// Whether every input that both jobs read comes from the same files.
bool same_files(const Job& a, const Job& b);

}  // namespace quell::app
