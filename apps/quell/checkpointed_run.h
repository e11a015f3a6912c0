// quell run with --checkpoint: frames in parts, after each of which the history is written.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "checkpoint.h"
#include "chunk.h"

namespace CLI {
class App;
}

namespace quell::app {

struct CheckpointArguments {
  std::optional<std::filesystem::path> folder;
  std::optional<std::string> every;
  bool resume = false;
};

void add_options(CLI::App& app, CheckpointArguments& arguments);

struct Checkpoints {
  CheckpointFolder folder;
  int every = 0;                                  ///< frames
  std::optional<CheckpointManifest> before = {};  ///< what the run goes on with
  PastFrames past = {};                           ///< of `before`, and then of the run, too
  bool ok = true;                                 ///< whether all could be written
};

/// Nothing without --checkpoint. With --resume, takes the frames that are through out of the job's, which may leave none, and
/// the pre-roll, which the history of the checkpoint makes needless, out of what is around. Throws Error(usage) for options that
/// do not go together, a checkpoint of another run, or not of the frame before a chunk, and frames before it that nobody
/// computed.
std::optional<Checkpoints> prepare_checkpoints(const CheckpointArguments& arguments, const SequenceArguments& sequence, Job& job,
                                               Surroundings& around, const SessionOptions& options);

/// As Session::run over the pre-roll and the job's frames. A checkpoint that cannot be written is told, and the run goes on.
std::vector<FrameReport> run_with_checkpoints(Session& session, const Job& job, const Surroundings& around, FrameSink& sink,
                                              Checkpoints& checkpoints, const SessionOptions& options);

/// Tells of frames that failed before the checkpoint; false when there are any.
bool tell_past_failures(const Checkpoints& checkpoints);

}  // namespace quell::app
