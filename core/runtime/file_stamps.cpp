#include "quell/runtime/file_stamps.h"

namespace quell {
namespace {

FileStamp stamp(const std::string& file) {
  FileStamp stamp{file};
  std::error_code no_time, no_size;
  stamp.time = std::filesystem::last_write_time(file, no_time);
  stamp.size = std::filesystem::file_size(file, no_size);
  stamp.is_there = !no_time;
  if (no_time) stamp.time = {};
  if (no_size) stamp.size = 0;  // a folder has none
  return stamp;
}

}  // namespace

FileStamps stamp_files(const Node& node) {
  FileStamps stamps;
  for (std::uint32_t i = 0; i < node.pass->param_count; ++i) {
    if (QUELL_AT(quell_param_desc, node.pass->params, i)->type != QUELL_PARAM_PATH) continue;
    for (const std::string& file : std::get<std::vector<std::string>>(node.instance->values()[i].elements))
      if (!file.empty()) stamps.push_back(stamp(file));
  }
  return stamps;
}

}  // namespace quell
