#include "checkpointed_run.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>

#include "interrupt.h"
#include "quell/text/error.h"

namespace quell::app {
namespace {

constexpr int kEvery = 100, kMostEvery = 1'000'000'000;

void require_done(const std::vector<std::int64_t>& wanted, const CheckpointManifest& before) {
  std::vector<std::int64_t> through = before.past.done, missing;
  through.insert(through.end(), before.past.failed.begin(), before.past.failed.end());
  std::ranges::sort(through);
  std::ranges::set_difference(wanted, through, std::back_inserter(missing));
  if (missing.empty()) return;
  throw Error(Fault::usage, "--resume",
              "the checkpoint is of frame " + std::to_string(before.frame) + ", and of the frames until then " +
                  FrameRange(missing).text() + " are not done; leave them out of --frames, or begin anew without --resume");
}

/// Chunks that follow each other by checkpoints are one run, of which none may be left out.
void require_neighbor(std::int64_t frame, const Job& job, const Surroundings& around) {
  if (!around.last_of_chunk_before || frame >= *around.last_of_chunk_before) return;
  throw Error(Fault::usage, "--resume",
              "the checkpoint is of frame " + std::to_string(frame) + ", and the chunk begins with frame " +
                  std::to_string(job.frames.front()) + "; compute the chunks between them first");
}

/// Takes the frames that are through out of the job's.
void go_on(Checkpoints& checkpoints, Job& job, Surroundings& around) {
  checkpoints.before = checkpoints.folder.find();
  if (!checkpoints.before) return spdlog::info("there is no checkpoint in {} yet", checkpoints.folder.folder().string());
  require_neighbor(checkpoints.before->frame, job, around);
  checkpoints.past = checkpoints.before->past;
  around.history_only.clear();
  around.history_from = checkpoints.past.history_from;
  const auto first_left = std::ranges::upper_bound(job.frames, checkpoints.before->frame);
  require_done({job.frames.begin(), first_left}, *checkpoints.before);
  job.frames.erase(job.frames.begin(), first_left);
  spdlog::info("going on after frame {}: {} frame{} left", checkpoints.before->frame, job.frames.size(),
               job.frames.size() == 1 ? " is" : "s are");
}

void add_to_past(PastFrames& past, const std::vector<FrameReport>& reports, std::int64_t last) {
  for (const FrameReport& report : reports)
    if (report.frame <= last && !report.history_only) (report.ok ? past.done : past.failed).push_back(report.frame);
}

/// What the session has kept, if that is more than the last checkpoint has.
void write_checkpoint(Session& session, Checkpoints& checkpoints, const std::vector<FrameReport>& reports, Executor& executor) {
  const std::optional<SavedHistory> saved = session.save();
  if (!saved || (checkpoints.before && checkpoints.before->frame == saved->frame)) return;
  PastFrames past = checkpoints.past;
  add_to_past(past, reports, saved->frame);
  try {
    checkpoints.folder.write(*saved, past, executor);
    spdlog::debug("checkpoint after frame {}", saved->frame);
  } catch (const Error& error) {
    spdlog::error(error.what());
    checkpoints.ok = false;
  }
}

}  // namespace

void add_options(CLI::App& app, CheckpointArguments& arguments) {
  app.add_option("--checkpoint", arguments.folder,
                 "A folder to keep the history in, so that --resume can go on with it, bit for bit.")
      ->type_name("FOLDER")
      ->group(kScheduleGroup);
  app.add_option("--every", arguments.every, "Frames between checkpoints; 100 by default. One is written at the end as well.")
      ->type_name("N")
      ->group(kScheduleGroup);
  app.add_flag("--resume", arguments.resume, "Go on after the checkpoint's frame; begin where there is none yet.")
      ->disable_flag_override()
      ->group(kScheduleGroup);
}

std::optional<Checkpoints> prepare_checkpoints(const CheckpointArguments& arguments, const SequenceArguments& sequence, Job& job,
                                               Surroundings& around, const SessionOptions& options) {
  if (!arguments.folder) {
    if (arguments.resume) throw Error(Fault::usage, "--resume", "name the folder to go on from with --checkpoint FOLDER");
    if (arguments.every)
      throw Error(Fault::usage, "--every", "it is about checkpoints; name their folder with --checkpoint FOLDER");
    return std::nullopt;
  }
  const int every = arguments.every ? parse_count(*arguments.every, "--every", 1, kMostEvery) : kEvery;
  Checkpoints checkpoints{.folder = CheckpointFolder(*arguments.folder, traits_of(job, sequence, options)), .every = every};
  if (arguments.resume) go_on(checkpoints, job, around);
  checkpoints.past.history_from = around.history_from;
  return checkpoints;
}

std::vector<FrameReport> run_with_checkpoints(Session& session, const Job& job, const Surroundings& around, FrameSink& sink,
                                              Checkpoints& checkpoints, const SessionOptions& options) {
  if (checkpoints.before) session.restore(checkpoints.folder.read(*checkpoints.before, session.pool()));
  Executor executor(options.threads);
  std::vector<FrameReport> reports;
  for (auto begin = job.frames.begin(); begin != job.frames.end();) {
    const auto end = begin + std::min<std::ptrdiff_t>(checkpoints.every, job.frames.end() - begin);
    std::vector<std::int64_t> part(begin, end);
    if (begin == job.frames.begin()) part = join(around.history_only, part);
    RunContext context = context_of(around);
    context.later = join({end, job.frames.end()}, around.after);
    std::vector<FrameReport> of_part = session.run(part, *job.source, sink, context);
    std::ranges::move(of_part, std::back_inserter(reports));
    // Where a failed frame ends the run, what went wrong is put right, and that frame is computed again.
    const auto failed = [](const FrameReport& report) { return !report.ok; };
    if (options.on_error == OnError::stop && std::ranges::any_of(reports, failed)) break;
    write_checkpoint(session, checkpoints, reports, executor);
    if (interrupted()) break;
    begin = end;
  }
  return reports;
}

bool tell_past_failures(const Checkpoints& checkpoints) {
  if (checkpoints.past.failed.empty()) return true;
  spdlog::error("before the checkpoint, these frames failed: {}", FrameRange(checkpoints.past.failed).text());
  return false;
}

}  // namespace quell::app
