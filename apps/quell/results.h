// What a run writes, known before it starts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "chunk.h"
#include "job.h"
#include "quell/sequence/file_sink.h"

namespace quell::app {

/// One series of files: an output or a dump in one format, or all of them as layers.
struct ResultFiles {
  std::string result;                        ///< its name, as the sink is told
  std::string pattern;                       ///< "out/color.####.exr"
  std::vector<std::filesystem::path> files;  ///< of each frame
};

/// Every file that the run of a job writes. Throws Error(usage) when no chosen format can hold an image.
std::vector<ResultFiles> list_results(const Job& job, const FileSink& sink, const FileSinkOptions& options);

/// Throws Error(usage) when a result would replace a file of the sequence, be it read or not.
void refuse_to_replace_inputs(const Job& job, const std::vector<ResultFiles>& results);

/// Throws Error(usage) naming the option when `file` is there, and neither empty nor begins so: it is not what a former run
/// wrote.
void refuse_to_replace_others(const std::filesystem::path& file, std::string_view beginning, const char* option);

/// Makes the folder. Throws Error(usage) naming the option when that fails, or when nothing can be written there.
void prepare_folder(const std::filesystem::path& folder, const char* option = "--out");

/// What would be read, run and written; `more` are lines about something else.
std::string describe_dry_run(const Job& job, const std::vector<ResultFiles>& results, const Surroundings& around,
                             const std::string& more = "");

}  // namespace quell::app
