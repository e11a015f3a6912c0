// The text file of a checkpoint. Its fields are described in README.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "quell/image/item.h"
#include "quell/text/json.h"
#include "run_traits.h"

namespace quell::app {

/// Frames that are through, in this run and in those that it goes on with; each ascending.
struct PastFrames {
  std::vector<std::int64_t> done, failed;
  std::int64_t history_from = 0;  ///< the first frame of all, those of a pre-roll included
};

struct CheckpointManifest {
  struct Kept {
    std::string from;  ///< as in SavedHistory
    std::int64_t frame = 0;
    PortType type = QUELL_TYPE_COLOR;
    std::string file;  ///< in `folder`
  };
  std::int64_t frame = 0;
  PastFrames past;
  RunTraits run;
  InputShapes shapes;
  std::vector<std::vector<std::int64_t>> resets;
  std::string folder;  ///< beside the manifest
  std::vector<Kept> history;
};

std::string write_manifest(const CheckpointManifest& manifest);

/// Throws Error(input) with all that is wrong and where: what it holds comes from a file that anybody may have written. Names of
/// files lead nowhere else.
CheckpointManifest read_manifest(const std::filesystem::path& file);

}  // namespace quell::app
