#include "results.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <set>

namespace quell::app {
namespace fs = std::filesystem;

namespace {

struct Result {
  std::string name;
  PortType type;
};

std::vector<Result> find_results(const Plan& plan) {
  std::vector<Result> results;
  for (const PlannedResult& result : plan.results()) results.push_back({result.name, plan.graph->type(result.from)});
  return results;
}

ResultFiles list_series(const Job& job, const FileSink& sink, const FileSinkOptions& options, const Result& result,
                        std::size_t format) {
  ResultFiles series;
  series.result = result.name;
  for (const std::int64_t frame : job.frames) series.files.push_back(sink.files(result.name, frame, result.type)[format]);
  const std::string digits(static_cast<std::size_t>(options.padding), '#');
  const std::string extension = series.files.front().extension().string();
  const bool is_layer = !options.layers.empty() && extension == ".exr";
  series.pattern = (options.folder / ((is_layer ? options.layers : result.name) + "." + digits + extension)).string();
  return series;
}

/// The names of an input's files in the job's frames.
std::set<fs::path> files_of(const Job& job, const InputFiles& input) {
  std::set<fs::path> files;
  for (const std::int64_t frame : job.frames) files.insert(job.sequence->file(input.input, frame).filename());
  return files;
}

std::string pad(const std::string& name, std::size_t width) { return "  " + name + std::string(width - name.size() + 2, ' '); }

}  // namespace

std::vector<ResultFiles> list_results(const Job& job, const FileSink& sink, const FileSinkOptions& options) {
  std::vector<ResultFiles> all;
  for (const Result& result : find_results(job.plan)) {
    const std::size_t formats = sink.files(result.name, job.frames.front(), result.type).size();
    for (std::size_t format = 0; format < formats; ++format) {
      ResultFiles series = list_series(job, sink, options, result, format);
      const auto is_it = [&](const ResultFiles& other) { return other.pattern == series.pattern; };
      if (std::none_of(all.begin(), all.end(), is_it)) all.push_back(std::move(series));  // layers share their files
    }
  }
  return all;
}

void refuse_to_replace_inputs(const Job& job, const std::vector<ResultFiles>& results) {
  for (const InputFiles& input : job.sequence->inputs()) {  // also what the graph does not read: rendering it took long
    const fs::path folder = fs::path(input.pattern).parent_path();
    const std::set<fs::path> names = files_of(job, input);
    for (const ResultFiles& series : results) {
      std::error_code error;
      if (!fs::equivalent(folder.empty() ? "." : folder, series.files.front().parent_path(), error)) continue;
      for (const fs::path& file : series.files)
        if (names.contains(file.filename()) && fs::exists(file, error))
          throw Error(Fault::usage, "--out",
                      "the results would replace " + file.string() + ", which is '" + input.input +
                          "' of the sequence; choose another folder");
    }
  }
}

void refuse_to_replace_others(const fs::path& file, std::string_view beginning, const char* option) {
  if (file.empty()) throw Error(Fault::usage, option, "the name is empty; name a file");
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return;
  std::string found(beginning.size(), ' ');
  std::ifstream stream(file, std::ios::binary);
  stream.read(found.data(), static_cast<std::streamsize>(found.size()));
  if (stream.gcount() > 0 && found != beginning)
    throw Error(Fault::usage, option, file.string() + " is there, and was not written by this option; choose another name");
}

void prepare_folder(const fs::path& folder, const char* option) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    throw Error(Fault::usage, option, folder.string() + " is a file; name a folder for the results");
  fs::create_directories(folder, error);
  if (error) throw Error(Fault::usage, option, "the folder " + folder.string() + " cannot be made: " + error.message());
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw Error(Fault::usage, option, "nothing can be written to " + folder.string() + ": " + std::strerror(errno));
}

std::string describe_dry_run(const Job& job, const std::vector<ResultFiles>& results, const Surroundings& around,
                             const std::string& more) {
  std::size_t width = 0;
  for (const InputFiles& input : job.inputs) width = std::max(width, input.input.size());
  std::string text = "would read, for frames " + FrameRange(job.frames).text() + ":\n";
  for (const InputFiles& input : job.inputs) text += pad(input.input, width) + input.pattern + "\n";
  if (!around.history_only.empty())
    text += "would compute for their history alone: frames " + FrameRange(around.history_only).text() +
            (around.reason.empty() ? "" : " (" + around.reason + ")") + "\n";
  text += "would run:\n" + describe(job.plan);
  text += "would write:\n";
  std::size_t replaced = 0;
  for (const ResultFiles& series : results) {
    text += "  " + series.pattern + "  (" + std::to_string(series.files.size()) + " files)\n";
    for (const fs::path& file : series.files) {
      std::error_code error;
      replaced += fs::exists(file, error) ? 1 : 0;
    }
  }
  if (replaced > 0) text += "  " + std::to_string(replaced) + " of these files exist and would be replaced\n";
  return text + more + "dry run: nothing was computed or written\n";
}

}  // namespace quell::app
