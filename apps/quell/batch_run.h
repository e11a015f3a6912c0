// Runs the shots of a batch side by side, within one budget of threads and memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "batch_list.h"
#include "console.h"
#include "exit_code.h"
#include "shot_files.h"

namespace quell::app {

struct BatchBudget {
  int threads = 1;
  std::size_t memory = 0;  ///< bytes
  int jobs = 1;            ///< most shots at a time, at most `threads`
};

/// As many shots at a time as each can keep busy, within the budget: a share is at least four threads and 2 GiB, as far as there
/// are any. `wanted` is 0, or stated.
int choose_jobs(int wanted, std::size_t shots, int threads, std::size_t memory);

struct BatchOptions {
  BatchBudget budget;
  std::filesystem::path logs;  ///< absolute
  bool stop_on_error = false;  ///< begin no shot after one that failed
  bool resume = false;         ///< leave out what was done by the same command
};

/// What became of a shot.
struct ShotResult {
  std::string outcome;  ///< "done", "failed (exit code 3)", "interrupted", "not begun", ...
  ExitCode code = kOk;  ///< what the batch makes of it
  bool was_run = false;
  std::int64_t done = 0, failed = 0, frames = 0;
  double seconds = 0;
  std::size_t peak_bytes = 0;
};

/// The words of a shot's run, from "run" on.
std::vector<std::string> run_words(const Shot& shot, const ShotFiles& files, int threads, std::size_t memory);

/// What a report says of a shot that the same command has done, and whose files are all there. Threads and memory may differ.
std::optional<ShotResult> done_before(const Shot& shot, const ShotFiles& files);

/// Runs them from the current folder, and tells how it goes. SIGINT and SIGTERM are passed on, the second of them kills. A result
/// for each shot.
std::vector<ShotResult> run_batch(const std::vector<Shot>& shots, const BatchOptions& options, Console& console);

/// A table with a line for each shot, and their sum.
std::string describe(const std::vector<Shot>& shots, const std::vector<ShotResult>& results);

}  // namespace quell::app
