// The files that parameters of a node name, so that a change of them is noticed. Private to this box.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "quell/graph/graph.h"

namespace quell {

/// A file as it was found: its time and size, or that it could not be looked at; a folder by its time.
struct FileStamp {
  std::string file;
  std::filesystem::file_time_type time{};
  std::uintmax_t size = 0;
  bool is_there = false;
  bool operator==(const FileStamp&) const = default;
};
using FileStamps = std::vector<FileStamp>;

/// Those of all parameters that are paths.
FileStamps stamp_files(const Node& node);

}  // namespace quell
