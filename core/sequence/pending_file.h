// A file that takes its final name only when it is complete.
#pragma once

#include <filesystem>

namespace quell {

/// Names a temporary file in the final one's folder. Unless committed, the temporary file is removed at the end of its life.
class PendingFile {
 public:
  explicit PendingFile(std::filesystem::path final_path);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// Where to write: hidden (a leading dot), unique in this folder, never matched by a file pattern.
  const std::filesystem::path& path() const { return temporary_; }
  /// Gives the file its final name, replacing another file of that name. Throws Error(frame).
  void commit();

 private:
  std::filesystem::path final_, temporary_;
  bool committed_ = false;
};

}  // namespace quell
