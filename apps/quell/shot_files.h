// What a batch keeps of each shot, beside each other in one folder: what the run said, its --log-json and its --report.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "quell/text/json.h"

namespace quell::app {

struct ShotFiles {
  ShotFiles(const std::filesystem::path& folder, const std::string& shot)
      : log(folder / (shot + ".log")), events(folder / (shot + ".jsonl")), report(folder / (shot + ".json")) {}

  /// Throws Error(usage) when one of them is there, and was not written by a batch.
  void refuse_to_replace_others() const;
  /// Takes away what an earlier run left, and begins the log with the command. Throws Error(usage).
  void begin(const std::vector<std::string>& command) const;

  std::filesystem::path log, events, report;
};

/// What a report tells a batch.
struct ShotReport {
  std::string version, folder, outcome;
  std::string error;  ///< of a run that could not start or go on, else of the first frame that failed
  std::vector<std::string> command;
  std::int64_t done = 0, failed = 0;  ///< frames, with those of earlier runs that it goes on with
  std::int64_t frames = 0;            ///< with those not computed
  int exit_code = -1;
  std::vector<std::string> files;  ///< of the frames that are done
};
/// Nothing when there is no report, or none that can be read.
std::optional<ShotReport> read_shot_report(const std::filesystem::path& file);

/// Reads a --log-json file as it grows.
class EventReader {
 public:
  explicit EventReader(std::filesystem::path file) : file_(std::move(file)) {}
  /// Hands over every event that is complete and new.
  void read(const std::function<void(const Json&)>& take);

 private:
  std::filesystem::path file_;
  std::streamoff read_ = 0;  // bytes
};

}  // namespace quell::app
