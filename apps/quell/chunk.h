// quell run with --chunk and --preroll: a part of a sequence, computed as if by a run over all of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "job.h"
#include "quell/runtime/session.h"

namespace CLI {
class App;
}

namespace quell::app {

struct ChunkArguments {
  std::optional<std::string> chunk, preroll, tolerance;
};

void add_options(CLI::App& app, ChunkArguments& arguments);

/// What lies around the frames of a job.
struct Surroundings {
  std::vector<std::int64_t> history_only;            ///< frames that warm the history up, and are not written; ascending
  std::vector<std::int64_t> after;                   ///< frames that edges may look ahead at, ascending
  std::int64_t history_from = 0;                     ///< the first frame that the history of the results knows
  std::string reason;                                ///< of the pre-roll, for people: why so many
  std::optional<std::int64_t> last_of_chunk_before;  ///< of --chunk, where it is not the first
};

/// Takes the frames of other chunks out of the job's. Throws Error(usage) when options do not go together, there are fewer frames
/// than chunks, or the graph does not say how far back its history reaches.
Surroundings choose_chunk(const ChunkArguments& arguments, const SequenceArguments& sequence,
                          const std::vector<std::int64_t>& cuts, Job& job);

/// All of two ascending lists, ascending.
std::vector<std::int64_t> join(const std::vector<std::int64_t>& first, const std::vector<std::int64_t>& second);
RunContext context_of(const Surroundings& around);

/// A line about the pre-roll; "" when there is none.
std::string describe(const Surroundings& around);

}  // namespace quell::app
