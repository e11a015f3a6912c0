// What --log-json writes. The fields are described in README.md.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "exit_code.h"
#include "measuring_sink.h"
#include "quell/runtime/window.h"
#include "run_summary.h"

namespace quell::app {

/// Takes every warning and error of the runner from spdlog as long as it lives. Thread-safe.
class RunLog {
 public:
  /// Writes nothing without a file. Throws Error(usage) when it cannot be written, or is something else than such a log.
  explicit RunLog(const std::optional<std::filesystem::path>& file);
  ~RunLog();
  RunLog(const RunLog&) = delete;
  RunLog& operator=(const RunLog&) = delete;

  void start(const Job& job, const std::vector<ResultFiles>& results, const SessionOptions& options, const Window& window);
  /// `measured` of its outputs, in these metrics.
  void frame(const FrameReport& report, const Plan& plan, const BufferPool::Usage& usage,
             const std::vector<MeasuredOutput>& measured = {}, const std::vector<Metric>& metrics = {});
  void message(int level, std::string_view text);  ///< levels QUELL_LOG_*
  void end(const RunOutcome& outcome, ExitCode code);
  /// The end of a run that could not start, or not go on.
  void end(std::string_view error, ExitCode code);
  /// Whether all is in the file.
  bool ok() const;

 private:
  struct State;
  std::unique_ptr<State> state_;  // null: off
};

}  // namespace quell::app
