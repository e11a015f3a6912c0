#include "chunk.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>

#include "quell/graph/preroll.h"
#include "quell/text/error.h"

namespace quell::app {
namespace {

constexpr int kMostChunks = 1'000'000, kMostPreroll = 1'000'000'000;
constexpr double kTolerance = 0.01;

struct Chunk {
  int number = 1, count = 1;
};

Chunk parse_chunk(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos)
    throw Error(Fault::usage, "--chunk", "'" + text + "' is not a chunk; write the second of four as 2/4");
  Chunk chunk;
  chunk.count = parse_count(text.substr(slash + 1), "--chunk", 1, kMostChunks, " chunks, as in 2/4");
  chunk.number = parse_count(text.substr(0, slash), "--chunk", 1, chunk.count, ", as in 2/4");
  return chunk;
}

/// All chunks hold as many frames, or one more than others.
std::vector<std::int64_t> select(const std::vector<std::int64_t>& frames, const Chunk& chunk) {
  if (frames.size() < static_cast<std::size_t>(chunk.count))
    throw Error(Fault::usage, "--chunk",
                std::to_string(chunk.count) + " chunks of " + std::to_string(frames.size()) +
                    " frames would leave some without any; choose fewer");
  const auto begin_of = [&](int number) {
    return frames.begin() +
           static_cast<std::ptrdiff_t>(frames.size() * static_cast<std::size_t>(number) / static_cast<std::size_t>(chunk.count));
  };
  return {begin_of(chunk.number - 1), begin_of(chunk.number)};
}

/// All frames of the sequence that can be computed, whatever --frames says.
std::vector<std::int64_t> list_all(const Job& job) {
  std::vector<std::string> names;
  for (const InputFiles& files : job.inputs) names.push_back(files.input);
  return job.sequence->complete_frames(names);
}

Preroll find_frames(const ChunkArguments& arguments, const Plan& plan) {
  const double tolerance = arguments.tolerance ? parse_number(*arguments.tolerance, "--preroll-tolerance", 0, 1) : kTolerance;
  const std::string wanted = arguments.preroll.value_or("auto");
  if (wanted != "auto") {
    if (arguments.tolerance)
      throw Error(Fault::usage, "--preroll-tolerance", "it is for --preroll auto, and a number of frames is given");
    return {parse_count(wanted, "--preroll", 0, kMostPreroll, ", or 'auto'"), "as asked for"};
  }
  Preroll found = find_preroll(plan, tolerance);
  if (!found.frames)
    throw Error(Fault::usage, "--preroll auto",
                "how many frames the history of '" + plan.graph->name + "' reaches back is not known: " + found.reason +
                    "; give a number with --preroll N, or go on from a checkpoint, which is exact (--checkpoint, --resume)");
  return found;
}

}  // namespace

void add_options(CLI::App& app, ChunkArguments& arguments) {
  app.add_option("--chunk", arguments.chunk,
                 "Compute one of N parts of the frames: 2/4 is the second of four. Implies --preroll.")
      ->type_name("I/N")
      ->group(kScheduleGroup);
  app.add_option(
         "--preroll", arguments.preroll,
         "Frames before --frames or --chunk that warm the history up, and are not written: a number, or auto for what the "
         "passes say of their memory. None by default, auto with --chunk.")
      ->type_name("N")
      ->group(kScheduleGroup);
  app.add_option("--preroll-tolerance", arguments.tolerance,
                 "How much --preroll auto may leave of earlier frames in averages; 0.01 by default. 0: nothing at all.")
      ->type_name("SHARE")
      ->group(kScheduleGroup);
}

Surroundings choose_chunk(const ChunkArguments& arguments, const SequenceArguments& sequence,
                          const std::vector<std::int64_t>& cuts, Job& job) {
  Surroundings around;
  around.history_from = job.frames.front();
  if (!arguments.chunk && !arguments.preroll) {
    if (arguments.tolerance)
      throw Error(Fault::usage, "--preroll-tolerance", "it is for --preroll auto or --chunk, and neither is given");
    return around;
  }
  // A chunk of --frames is a part of a run over these; frames beside them are not its business.
  const std::vector<std::int64_t> all = arguments.chunk ? job.frames : list_all(job);
  if (!arguments.chunk && !sequence.frames)
    throw Error(Fault::usage, "--preroll", "nothing lies before the whole sequence; name a part of it with --frames or --chunk");
  if (arguments.chunk) job.frames = select(job.frames, parse_chunk(*arguments.chunk));

  auto first = std::ranges::lower_bound(all, job.frames.front());
  if (arguments.chunk && first != all.begin()) around.last_of_chunk_before = *(first - 1);
  const Preroll preroll = find_frames(arguments, job.plan);
  around.history_only.assign(first - std::min<std::ptrdiff_t>(*preroll.frames, first - all.begin()), first);
  around.reason = preroll.reason;
  // What lies before a cut, this side of it never sees.
  std::vector<std::int64_t> sorted = cuts;
  std::ranges::sort(sorted);
  const auto cut = std::ranges::upper_bound(sorted, job.frames.front());
  if (cut != sorted.begin() && !around.history_only.empty() && around.history_only.front() < *(cut - 1)) {
    around.history_only.erase(around.history_only.begin(), std::ranges::lower_bound(around.history_only, *(cut - 1)));
    around.reason = "since the cut at frame " + std::to_string(*(cut - 1));
  } else if (!around.history_only.empty() && around.history_only.front() == all.front()) {
    around.reason += around.history_only.size() < static_cast<std::size_t>(*preroll.frames) ? "; there are no more" : "";
  }
  around.history_from = around.history_only.empty() ? job.frames.front() : around.history_only.front();
  around.after.assign(std::ranges::upper_bound(all, job.frames.back()), all.end());
  return around;
}

std::vector<std::int64_t> join(const std::vector<std::int64_t>& first, const std::vector<std::int64_t>& second) {
  std::vector<std::int64_t> all;
  std::ranges::merge(first, second, std::back_inserter(all));
  return all;
}

RunContext context_of(const Surroundings& around) { return {.later = around.after, .history_only = around.history_only}; }

std::string describe(const Surroundings& around) {
  if (around.history_only.empty() || around.reason.empty()) return "";
  return "pre-roll of " + std::to_string(around.history_only.size()) + " frame" + (around.history_only.size() == 1 ? "" : "s") +
         ", " + FrameRange(around.history_only).text() + " (" + around.reason + ")";
}

}  // namespace quell::app
