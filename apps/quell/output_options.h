// What a run writes and how, as the command line says it.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "job.h"
#include "quell/sequence/file_sink.h"

namespace CLI {
class App;
}

namespace quell::app {

struct OutputArguments {
  std::filesystem::path folder;
  std::string type = "auto";
  std::string compression = "zip";
  std::string padding;
  std::vector<std::string> formats;
  std::string layers;
  bool is_layered = false;  ///< --layers was given
  bool keep_channels = false;
};

void add_options(CLI::App& app, OutputArguments& arguments);

/// The sink's options that these arguments state. Throws Error(usage) for what cannot be.
FileSinkOptions parse_output(const OutputArguments& arguments);

/// Adds what only the job knows: its images, what their files tell of the run, the files of the picture, and, without --padding,
/// the digits. Throws Error(usage) when images cannot be layers of one file, or channels cannot be kept. The options may be used
/// as long as the job's sequence lives.
/// `inputs` is what files tell of what they were made of (see describe_inputs()).
void complete_output(FileSinkOptions& options, const OutputArguments& arguments, const Job& job, const std::string& inputs);

/// What the files of each image hold beside its values, and how they are called, in one text: while it stays, and the values do,
/// the files do. For complete options.
std::map<std::string, std::string> label_results(const FileSinkOptions& options, const Job& job);

/// Says which channels go over to the results, and which do not.
void tell_kept_channels(const FileSink& sink, const Job& job);

}  // namespace quell::app
