#include "comparison_outputs.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <set>

#include "comparison_files.h"
#include "comparison_pictures.h"
#include "metric_options.h"
#include "quell/text/error.h"
#include "results.h"

namespace quell::app {
namespace fs = std::filesystem;

namespace {

/// One of a name of its own.
struct WrittenFile {
  const char* option;
  fs::path path;
  std::string_view beginning;  ///< of what it may replace
};

[[noreturn]] void refuse(const char* option, const std::string& why) { throw Error(Fault::usage, option, why); }

std::vector<WrittenFile> list_files(const ComparisonOutputs& outputs) {
  std::vector<WrittenFile> files;
  if (outputs.json && *outputs.json != kToOutput) files.push_back({"--json", *outputs.json, kComparisonJson});
  if (outputs.csv && *outputs.csv != kToOutput) files.push_back({"--csv", *outputs.csv, kComparisonCsv});
  if (outputs.picture) files.push_back({"--picture", *outputs.picture, "\x89PNG"});
  return files;
}

fs::path full(const fs::path& path) {
  std::error_code error;
  const fs::path found = fs::weakly_canonical(path, error);
  return error ? fs::absolute(path, error) : found;
}

/// Of all frames, also of those that are not compared: rendering them took long.
std::set<fs::path> files_of_images(const ComparisonJob& job) {
  std::set<fs::path> files;
  const auto add = [&](const ImageSeries& series) {
    for (const std::int64_t frame : series.frames()) files.insert(full(series.file(frame)));
  };
  add(job.reference);
  for (const ImageSeries& image : job.images) add(image);
  if (job.motion) add(*job.motion);
  return files;
}

void require_what_is_drawn(const ComparisonOutputs& outputs, const ComparisonJob& job) {
  if (contains(job.options.metrics, Metric::flip) || contains(job.options.metrics, Metric::hdr_flip)) return;
  if (outputs.maps || outputs.picture)
    refuse(outputs.maps ? "--maps" : "--picture", "draws the errors of flip or hdrflip; add one of them to --metrics");
}

void require_files_of_their_own(const ComparisonOutputs& outputs, const ComparisonJob& job) {
  const std::set<fs::path> images = files_of_images(job);
  std::map<fs::path, const char*> writers;
  const auto add = [&](const char* option, const fs::path& path) {
    const fs::path place = full(path);
    if (images.contains(place))
      refuse(option, "would replace " + path.string() + ", which is one of the images; choose another name");
    if (const auto [writer, is_new] = writers.emplace(place, option); !is_new)
      refuse(option, path.string() + " is written by " + writer->second + ", too; choose another name");
  };
  if (outputs.maps)
    for (const fs::path& map : list_maps(*outputs.maps, job)) add("--maps", map);
  for (const WrittenFile& file : list_files(outputs)) add(file.option, file.path);
}

void require_place(const WrittenFile& file) {
  std::error_code error;
  if (fs::exists(file.path, error) && !fs::is_regular_file(file.path, error))
    refuse(file.option, file.path.string() + " is not a file; choose another name");
  refuse_to_replace_others(file.path, file.beginning, file.option);
  const fs::path folder = file.path.has_parent_path() ? file.path.parent_path() : ".";
  if (!fs::is_directory(folder, error)) refuse(file.option, "there is no folder " + folder.string() + "; make it first");
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    refuse(file.option, "nothing can be written to " + folder.string() + ": " + std::strerror(errno));
}

}  // namespace

void prepare_outputs(const ComparisonOutputs& outputs, const ComparisonJob& job) {
  if (outputs.json == kToOutput && outputs.csv == kToOutput)
    refuse("--csv", "--json goes to the standard output, too; name a file for one of them");
  if (outputs.picture && outputs.picture->extension() != ".png")
    refuse("--picture", "'" + outputs.picture->string() + "' is no name of a PNG; let it end in .png");
  if (outputs.maps && outputs.maps->empty()) refuse("--maps", "the name is empty; name a folder");
  require_what_is_drawn(outputs, job);
  require_files_of_their_own(outputs, job);
  if (outputs.maps) prepare_folder(*outputs.maps, "--maps");
  for (const WrittenFile& file : list_files(outputs)) require_place(file);
}

}  // namespace quell::app
