#include "gaps.h"

#include <algorithm>

#include "console.h"
#include "missing_files.h"
#include "quell/text/error.h"

namespace quell::app {
namespace {

std::vector<std::int64_t> frames_of(const std::vector<MissingFile>& missing) {
  std::vector<std::int64_t> frames;
  for (const MissingFile& file : missing)
    if (frames.empty() || frames.back() != file.frame) frames.push_back(file.frame);
  return frames;
}

std::vector<std::int64_t> unite(const std::vector<std::int64_t>& a, const std::vector<std::int64_t>& b) {
  std::vector<std::int64_t> all;
  std::ranges::set_union(a, b, std::back_inserter(all));
  return all;
}

/// The latest file before each missing one.
void hold(const Sequence& sequence, const std::vector<MissingFile>& missing, const std::string& place, ChosenFrames& chosen) {
  std::vector<MissingFile> lost;
  const std::vector<InputFiles> inputs = sequence.inputs();
  for (const MissingFile& file : missing) {
    const auto input = std::ranges::find(inputs, file.input, &InputFiles::input);
    const auto later =
        input == inputs.end() ? std::vector<std::int64_t>::const_iterator() : std::ranges::lower_bound(input->frames, file.frame);
    if (input == inputs.end() || later == input->frames.begin())
      lost.push_back(file);
    else
      chosen.holds[{file.input, file.frame}] = *(later - 1);
  }
  if (!lost.empty())
    throw Error(Fault::input, place, "files are missing, and there is no earlier one to hold:" + list_missing(lost));
  const std::vector<std::int64_t> frames = frames_of(missing);
  chosen.frames = unite(chosen.frames, frames);
  if (!frames.empty())
    spdlog::warn("frames {}: earlier files stand in for those that are missing:{}", FrameRange(frames).text(),
                 list_missing(missing));
}

/// Those that can be computed; the one after each gap begins anew.
void leave_out(const std::vector<MissingFile>& missing, ChosenFrames& chosen) {
  const std::vector<std::int64_t> gaps = frames_of(missing);
  std::vector<std::int64_t> left;
  std::ranges::set_difference(chosen.frames, gaps, std::back_inserter(left));
  chosen.frames = std::move(left);
  for (const std::int64_t gap : gaps) {
    const auto next = std::ranges::upper_bound(chosen.frames, gap);
    if (next != chosen.frames.end() && (chosen.cuts.empty() || chosen.cuts.back() != *next)) chosen.cuts.push_back(*next);
  }
  warn_of_missing(missing);
}

}  // namespace

ChosenFrames choose_frames(const Sequence& sequence, const std::vector<std::string>& inputs, OnMissing on_missing,
                           const std::string& place) {
  ChosenFrames chosen{sequence.frames(inputs), {}, {}};
  const std::vector<MissingFile> missing = sequence.missing(inputs);
  const auto is_asked_for = [&](const MissingFile& file) { return std::ranges::binary_search(chosen.frames, file.frame); };
  const bool is_error = on_missing == OnMissing::error || on_missing == OnMissing::usual;
  const bool any_asked_for = std::ranges::any_of(missing, is_asked_for);
  if (is_error && !missing.empty() && (any_asked_for || on_missing == OnMissing::error))
    throw Error(Fault::input, place,
                std::string(any_asked_for ? "files of the frames asked for are missing:" : "files are missing:") +
                    list_missing(missing) + "\n--on-missing hold or reset, or --keep-going, computes the others");
  if (on_missing == OnMissing::hold) hold(sequence, missing, place, chosen);
  if (on_missing == OnMissing::reset) leave_out(missing, chosen);
  if (on_missing == OnMissing::fail) chosen.frames = unite(chosen.frames, frames_of(missing));
  if (chosen.frames.empty())
    throw Error(Fault::input, place,
                "there is no frame for which every input exists" +
                    (missing.empty() ? std::string() : "; missing are:" + list_missing(missing)));
  if (on_missing == OnMissing::usual) warn_of_missing(missing);
  return chosen;
}

Item HoldingSource::read(std::string_view input, std::int64_t frame, BufferPool& pool) {
  const auto held = holds_.find({std::string(input), frame});
  return sequence_->read(input, held == holds_.end() ? frame : held->second, pool);
}

}  // namespace quell::app
