// What --trace writes: a Chrome trace, which has its name when it is complete.
#pragma once

#include <filesystem>
#include <fstream>

#include "quell/runtime/trace.h"
#include "quell/sequence/pending_file.h"

namespace quell::app {

class TraceFile {
 public:
  /// Throws Error(usage) when the file cannot be written, or is something else than a trace.
  explicit TraceFile(const std::filesystem::path& file);

  Trace& trace() { return trace_; }
  /// Gives the file its name. Throws Error(frame) when it could not be written.
  void commit();

 private:
  PendingFile file_;
  std::ofstream stream_;
  Trace trace_;
};

}  // namespace quell::app
