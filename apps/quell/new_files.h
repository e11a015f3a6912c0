// Files that are written together, or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace quell::app {

class NewFiles {
 public:
  /// A file that must not exist yet. Its folders are made.
  void add(std::filesystem::path file, std::string text);
  /// A file that takes the place of another; last, and one at most.
  void replace(std::filesystem::path file, std::string text);

  /// Writes each file beside its final place, then gives all of them their names. Throws Error(usage) when a file to be added
  /// exists, Error(frame) when one cannot be written; everything is then as it was before.
  void commit() const;

 private:
  struct File {
    std::filesystem::path path;
    std::string text;
    bool replaces;
  };
  std::vector<File> files_;
};

}  // namespace quell::app
