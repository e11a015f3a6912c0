#include "inspection.h"

#include <algorithm>
#include <map>

#include "quell/sequence/checks/checks.h"
#include "quell/sequence/checks/load_frame.h"
#include "quell/text/shell_word.h"

namespace quell::app {
namespace {

constexpr const char* kFilesSubject = "files are complete";
constexpr std::size_t kMostListed = 5;

std::string count_text(std::size_t n, const std::string& noun) { return std::to_string(n) + " " + noun + (n == 1 ? "" : "s"); }

std::vector<std::string> inputs_with_files(const Sequence& sequence) {
  std::vector<std::string> names;
  for (const InputFiles& input : sequence.inputs())
    if (!input.frames.empty()) names.push_back(input.input);
  return names;
}

Finding check_files(const Sequence& sequence) {
  Finding finding{Verdict::ok, kFilesSubject, ""};
  std::string empty, text;
  for (const InputFiles& input : sequence.inputs())
    if (input.frames.empty()) empty += (empty.empty() ? "" : ", ") + input.input;
  const std::vector<MissingFile> missing = sequence.missing(inputs_with_files(sequence));
  for (std::size_t i = 0; i < std::min(missing.size(), kMostListed); ++i)
    text += (i == 0 ? "" : ", ") + missing[i].input + " of frame " + std::to_string(missing[i].frame);
  if (missing.size() > kMostListed) text += " and " + std::to_string(missing.size() - kMostListed) + " more";
  if (!missing.empty()) text = "missing are " + text;
  if (!empty.empty()) text += (text.empty() ? "" : "; ") + std::string("no file at all for ") + empty;
  const std::vector<std::int64_t> frames = all_frames(sequence);
  finding.figures = {{"missing", static_cast<double>(missing.size())}};
  if (text.empty())
    finding.text = count_text(frames.size(), "frame") + " (" + FrameRange(frames).text() + ") with all of " +
                   count_text(inputs_with_files(sequence).size(), "input");
  else
    finding.verdict = Verdict::suspicious, finding.text = text;
  return finding;
}

/// The option that states everything about the input that is known, and what has to change.
std::string option_for(const Remedy& remedy, const FrameData& frame, const Sequence& sequence) {
  std::string option = remedy.input + "=";
  for (const InputFiles& input : sequence.inputs())
    if (input.input == remedy.input) option += input.pattern;
  Conventions all = remedy.settings;
  for (const CheckedImage* image : list_images(frame)) {
    if (image->name != remedy.input) continue;
    if (!image->layer.empty()) option += ":" + image->layer;
    all = remedy.settings.or_else(image->read_as);
  }
  std::string settings = describe(all);
  for (std::size_t at = settings.find(", "); at != std::string::npos; at = settings.find(", ")) settings.replace(at, 2, ":");
  return "--in " + shell_word(option + ":" + settings);
}

std::size_t count_tested(const std::vector<Finding>& findings) {
  return static_cast<std::size_t>(
      std::count_if(findings.begin(), findings.end(), [](const Finding& f) { return f.verdict != Verdict::not_tested; }));
}

}  // namespace

std::size_t Inspection::count(Verdict verdict) const {
  return static_cast<std::size_t>(
      std::count_if(told.begin(), told.end(), [&](const Told& t) { return t.finding.verdict == verdict; }));
}

std::vector<std::int64_t> all_frames(const Sequence& sequence) {
  std::vector<std::int64_t> common = sequence.frames(inputs_with_files(sequence));
  if (!common.empty()) return common;
  for (const InputFiles& input : sequence.inputs()) common.insert(common.end(), input.frames.begin(), input.frames.end());
  return FrameRange(std::move(common)).frames();
}

std::vector<std::int64_t> choose_frames(const std::vector<std::int64_t>& all) {
  std::vector<std::int64_t> chosen(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(all.size(), 3)));
  if (all.size() > 5) chosen.push_back(all[all.size() / 2]);
  return chosen;
}

Inspection inspect(Sequence& sequence, const std::vector<std::int64_t>& frames,
                   const std::function<void(std::size_t)>& progress) {
  Inspection inspection;
  inspection.frames = frames;
  std::vector<Finding> all{check_files(sequence)};
  std::map<std::pair<std::string, std::int64_t>, std::string> options;  // by subject and frame
  std::size_t most_tested = 0;
  BufferPool pool;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    progress(i);
    std::vector<Finding> findings;
    FrameData frame = load_frame(sequence, frames[i], pool, findings);
    for (Finding& finding : check_frame(frame)) findings.push_back(std::move(finding));
    for (const Finding& finding : findings)
      if (finding.remedy) options[{finding.subject, finding.frame}] = option_for(*finding.remedy, frame, sequence);
    if (const std::size_t tested = count_tested(findings); tested > most_tested) {
      most_tested = tested;
      inspection.picture = std::move(frame);
      inspection.picture_findings = findings;
    }
    for (Finding& finding : findings) {
      finding.errors = Image();  // of many frames, these would fill the memory
      all.push_back(std::move(finding));
    }
  }
  for (Finding& finding : worst_of(all)) {
    const auto option = options.find({finding.subject, finding.frame});
    inspection.told.push_back({std::move(finding), option == options.end() ? "" : option->second});
  }
  return inspection;
}

}  // namespace quell::app
