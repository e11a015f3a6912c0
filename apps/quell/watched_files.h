// Waiting until somebody saves a file.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace quell::app {

/// Watches folders, since editors write beside a file and rename. Files that are saved while nobody waits are noticed afterwards.
class WatchedFiles {
 public:
  /// Throws Error(usage) naming --watch when the system cannot watch any more.
  WatchedFiles();
  ~WatchedFiles();
  WatchedFiles(const WatchedFiles&) = delete;
  WatchedFiles& operator=(const WatchedFiles&) = delete;

  /// From now on waits for these, too; for the file behind a link as well. Throws Error(usage) as above.
  void add(const std::vector<std::filesystem::path>& files);
  /// Until one of the files was written, or was replaced by another, and nothing more happens for 100 ms; with `or_any_graph`,
  /// until any *.json in their folders was. False when `stop_event` can be read before. Throws Error(usage) when a folder is
  /// removed, since one of the same name that comes later is another.
  bool wait(bool or_any_graph, int stop_event);

 private:
  void add_one(const std::filesystem::path& file);
  bool read_events(bool or_any_graph);
  int notifier_ = -1;

  struct Folder {
    std::filesystem::path path;
    std::set<std::string> names;  // of files
  };
  std::map<int, Folder> folders_;  // by number
};

}  // namespace quell::app
