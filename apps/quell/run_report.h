// What --report writes: one file about a whole run, for a farm to read when it is over. The fields are described in README.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "checkpoint_manifest.h"
#include "exit_code.h"
#include "json_lines.h"
#include "run_record.h"

namespace quell::app {

/// How each report begins.
inline constexpr std::string_view kRunReportBeginning = R"({"quell_run":)";

/// Collects while the run goes on, and writes once, when it is over: the file is whole or not there. Not thread-safe, except
/// message().
class RunReport {
 public:
  /// Takes a former report away, so that the file, when it is there, is about this run. Throws Error(usage) when something else
  /// stands there, or nothing can be written.
  explicit RunReport(std::filesystem::path file);

  /// The frames that the run does not compute again.
  void resume(const PastFrames& past);
  void start(const Job& job, const std::vector<ResultFiles>& results, const JsonObject& record);
  /// Adds the files of a frame that is done.
  void frame(const FrameReport& report, const Plan& plan, JsonObject record);
  void message(const JsonObject& record);
  /// Writes the file. `end` is what record_end() made. False when that fails, which is told.
  bool end(const JsonObject& end, ExitCode code);

 private:
  JsonObject totals() const;
  void forget();
  std::string text(const JsonObject& end, ExitCode code) const;

  std::filesystem::path file_;
  std::string started_;
  JsonObject before_, run_;
  std::vector<JsonObject> frames_;
  std::mutex mutex_;  // of messages_
  std::vector<JsonObject> messages_;
  std::map<std::int64_t, std::vector<std::string>> files_;  // of each frame
  std::map<std::string, std::int64_t> replaced_;            // by input
  std::map<std::string, double> node_seconds_;
  double read_seconds_ = 0, write_seconds_ = 0;
};

}  // namespace quell::app
