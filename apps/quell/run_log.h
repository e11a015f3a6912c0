// What --log-json and --report are told. The fields are described in README.md.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "checkpoint_manifest.h"
#include "exit_code.h"
#include "measuring_sink.h"
#include "quell/runtime/window.h"
#include "run_summary.h"

namespace quell::app {

/// Nothing is written where there is no file.
struct RunLogFiles {
  std::optional<std::filesystem::path> lines;   ///< --log-json
  std::optional<std::filesystem::path> report;  ///< --report
};

/// Takes every warning and error of the runner from spdlog as long as it lives. Thread-safe.
class RunLog {
 public:
  /// Throws Error(usage) when a file cannot be written, or is something else than such a log or report.
  explicit RunLog(const RunLogFiles& files);
  ~RunLog();
  RunLog(const RunLog&) = delete;
  RunLog& operator=(const RunLog&) = delete;

  /// The frames that a run with --resume does not compute again.
  void resume(const PastFrames& past);
  void start(const Job& job, const std::vector<ResultFiles>& results, const SessionOptions& options, const Window& window);
  /// `measured` of its outputs, in these metrics.
  void frame(const FrameReport& report, const Plan& plan, const BufferPool::Usage& usage,
             const std::vector<MeasuredOutput>& measured = {}, const std::vector<Metric>& metrics = {});
  void message(int level, std::string_view text);  ///< levels QUELL_LOG_*
  void message(std::string_view level, std::string_view text);
  /// Tells when the files are not whole.
  void end(const RunOutcome& outcome, ExitCode code);
  /// The end of a run that could not start, or not go on.
  void end(std::string_view error, ExitCode code);
  /// Whether all is in the files.
  bool ok() const;

 private:
  struct State;
  std::unique_ptr<State> state_;  // null: off
};

}  // namespace quell::app
