// Checkpoints: what a run has to keep so that another one can go on where it ended, bit for bit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "checkpoint_manifest.h"
#include "quell/runtime/session.h"

namespace quell::app {

/// A folder with the latest checkpoint: `checkpoint.json`, and beside it a folder with a file for each item of the history.
/// Whatever is killed when, what `checkpoint.json` names is whole: it is replaced when the new history is complete, and the
/// former one is removed after that.
class CheckpointFolder {
 public:
  CheckpointFolder(std::filesystem::path folder, RunTraits traits);

  /// Nothing when the folder has none. Throws Error(input) when it is damaged, Error(usage) with all that differs when it is of a
  /// run with other traits.
  std::optional<CheckpointManifest> find() const;
  /// The history of what find() has found. Throws Error(input).
  SavedHistory read(const CheckpointManifest& manifest, BufferPool& pool) const;
  /// Writes files on the executor's threads. Throws Error(frame).
  void write(const SavedHistory& history, const PastFrames& past, Executor& executor) const;

  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path manifest() const { return folder_ / "checkpoint.json"; }
  std::vector<CheckpointManifest::Kept> write_items(const std::vector<SavedHistory::Kept>& items,
                                                    const std::filesystem::path& folder, Executor& executor) const;
  void remove_folders_but(const std::string& kept) const;

  std::filesystem::path folder_;
  RunTraits traits_;
};

}  // namespace quell::app
