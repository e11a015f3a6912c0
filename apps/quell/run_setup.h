// What quell run and quell plan have in common: all that comes before the first frame.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arguments.h"
#include "checkpointed_run.h"
#include "chunk.h"
#include "isa_option.h"
#include "job.h"
#include "measuring_sink.h"
#include "output_options.h"
#include "quell/runtime/rerun.h"
#include "quell/runtime/session.h"
#include "results.h"
#include "run_log.h"
#include "run_options.h"
#include "run_reference.h"
#include "tev_sink.h"
#include "video_sink.h"
#include "watched_files.h"

namespace CLI {
class App;
}

namespace quell::app {

/// All that quell run is told.
struct RunArguments {
  GraphArguments graph;
  SequenceArguments sequence;
  ScheduleArguments schedule;
  IsaArguments isa;
  VerbosityArguments verbosity;
  OutputArguments output;
  ReferenceArguments reference;
  CheckpointArguments checkpoint;
  ChunkArguments chunk;
  std::string on_missing = "auto";
  bool keep_going = false, skip_existing = false;
  std::vector<std::string> dumps;
  RunLogFiles logs;
  std::optional<std::filesystem::path> trace;
  std::optional<std::string> tev;
  std::optional<std::string> frames_per_second;
  bool dry_run = false, watch = false;
};

/// What a run needs before its first frame.
struct Preparation {
  Job job;
  FileSinkOptions output;
  std::unique_ptr<FileSink> sink;
  std::optional<MeasuringOptions> to_measure;  ///< with `measuring`, which takes them
  std::unique_ptr<VideoSink> video;            ///< in place of `sink`; null without a video
  std::unique_ptr<TevSink> tev;                ///< in front of that; null without --tev
  std::unique_ptr<MeasuringSink> measuring;    ///< in front of all; null without --reference
  std::vector<ResultFiles> results;
  std::map<std::string, std::string> labels;  ///< of the results, as label_results() has them
  SessionOptions options;
  std::optional<Checkpoints> checkpoints;
  Surroundings around;
};

/// Runs that follow each other.
struct Watch {
  explicit Watch(const RunArguments& arguments);
  Registry passes;
  std::vector<std::filesystem::path> named;  ///< files of the command line
  WatchedFiles files;
  Rerun rerun;
  std::optional<Preparation> last;  ///< of the last run
};

void add_run_options(CLI::App& app, RunArguments& arguments);

/// Works out what is not said by one option alone. Throws Error(usage) for options that do not go together.
void complete(RunArguments& arguments);

/// Reads all that a run needs to know, and touches no file but those that it reads. `watch`: of a run that follows others. Throws
/// Error for anything that keeps the run from starting.
Preparation prepare(const RunArguments& arguments, Watch* watch = nullptr);

/// Of the results.
std::filesystem::path folder_of(const RunArguments& arguments);
/// Of a video.
double frames_per_second(const RunArguments& arguments);

}  // namespace quell::app
