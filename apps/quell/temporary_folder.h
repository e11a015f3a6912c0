// A folder for what is measured and thrown away.
#pragma once

#include <filesystem>

namespace quell::app {

/// A folder of its own below TMPDIR (or /tmp), removed with all that is in it.
class TemporaryFolder {
 public:
  /// Throws Error(usage) naming TMPDIR when it cannot be made.
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace quell::app
