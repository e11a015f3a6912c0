#include "missing_files.h"

#include <algorithm>
#include <utility>

#include "console.h"

namespace quell::app {
namespace {

constexpr std::size_t kMostListed = 10;

}  // namespace

std::string list_missing(const std::vector<MissingFile>& missing) {
  std::string text;
  for (std::size_t i = 0; i < std::min(missing.size(), kMostListed); ++i)
    text += "\n  frame " + std::to_string(missing[i].frame) + ", " + missing[i].input + ": " + missing[i].file.string();
  if (missing.size() >= Sequence::kMostMissing)
    text += "\n  and many more";
  else if (missing.size() > kMostListed)
    text += "\n  and " + std::to_string(missing.size() - kMostListed) + " more";
  return text;
}

void warn_of_missing(const std::vector<MissingFile>& missing) {
  if (missing.empty()) return;
  std::vector<std::int64_t> dropped;
  for (const MissingFile& file : missing) dropped.push_back(file.frame);
  const FrameRange range(std::move(dropped));
  const bool one = range.frames().size() == 1;
  spdlog::warn("{} {} left out, because files are missing:{}", one ? "frame" : "frames", range.text() + (one ? " is" : " are"),
               list_missing(missing));
}

}  // namespace quell::app
