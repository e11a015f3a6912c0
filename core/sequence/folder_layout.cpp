#include <algorithm>
#include <functional>
#include <set>

#include "quell/sequence/frame_range.h"
#include "quell/sequence/image_file.h"
#include "quell/sequence/input_spec.h"
#include "quell/sequence/renderer_names.h"
#include "quell/text/diagnostic.h"

namespace quell {
namespace {

const std::vector<std::string> kImageExtensions = {".exr", ".tif", ".tiff", ".hdr", ".pfm", ".png"};

std::size_t extension_rank(const std::string& extension) {
  return static_cast<std::size_t>(std::find(kImageExtensions.begin(), kImageExtensions.end(), extension) -
                                  kImageExtensions.begin());
}

/// "color_1spp" and "color_64spp": the number of samples is not part of the name.
bool is_color_with_samples(const std::string& stem) {
  if (!stem.starts_with("color_") || !stem.ends_with("spp")) return false;
  const std::string digits = stem.substr(6, stem.size() - std::min<std::size_t>(stem.size(), 9));
  return !digits.empty() && std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// The input that files of this name are; "" for none.
std::string input_name(const std::string& stem, const std::string& extension) {
  if (extension == ".mat") return stem == "matrix" || stem == "camera" ? "camera" : "";
  if (extension == ".json") return stem == "frame" || stem == "camera" ? "camera" : "";
  if (extension_rank(extension) == kImageExtensions.size()) return "";
  if (stem == "beauty" || is_color_with_samples(stem)) return "color";
  if (stem == "ID") return "id";
  for (const RendererName& row : renderer_file_names())
    if (matches(row.layer, stem)) return std::string(row.input);
  return is_input_name(stem) ? stem : "";
}

/// Least number of digits: that of numbers written with leading zeros, else 1.
int padding_of(const std::string& number) {
  const std::string digits = number.substr(number[0] == '-' ? 1 : 0);
  return digits.size() > 1 && digits[0] == '0' ? static_cast<int>(digits.size()) : 1;
}

struct Candidate {
  FilePattern pattern;
  std::vector<std::int64_t> frames;
  int rank = 0;         // of a renderer's file name; smaller wins
  bool shared = false;  // one file for several inputs
};
using Candidates = std::map<std::string, std::vector<Candidate>>;  // by input

int rank_of(const std::string& stem) {
  for (const RendererName& row : renderer_file_names())
    if (matches(row.layer, stem)) return row.rank;
  return 0;
}

/// One pattern for each way of padding in a group of names that differ in their numbers alone.
std::vector<Candidate> patterns_of(const std::filesystem::path& folder, const std::vector<std::string>& names) {
  const NumberedName name = *take_apart(names.front());
  std::set<int, std::greater<>> paddings;
  for (const std::string& file : names) paddings.insert(padding_of(take_apart(file)->number));
  std::vector<Candidate> found;
  for (const int padding : paddings) {
    const FilePattern pattern(folder, name.prefix, padding, name.suffix);
    const FrameFiles files = find_frames(pattern, names);
    found.push_back({pattern, files.frames, rank_of(pattern.stem())});
    if (files.padded_otherwise.empty()) break;  // 0999, 1000: the later ones show no zero, but are padded alike
  }
  return found;
}

/// Whether a stem tells what is in the files, so that nobody has to look into them.
bool tells_its_input(const std::string& input, const std::optional<std::vector<std::string>>& wanted) {
  if (input.empty() || input == "color") return false;  // a beauty file may hold everything else, too
  const auto is_in = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), input) != names.end();
  };
  return port_type(input) || is_in(usual_inputs()) || input == "reference" || input == "noisy" || (wanted && is_in(*wanted));
}

/// The inputs for which a group's first file has layers; none when it is a file of one input.
std::vector<std::string> shared_inputs(const Candidate& files, const std::optional<std::vector<std::string>>& wanted) {
  if (files.frames.empty()) return {};
  try {
    std::vector<std::string> inputs = inputs_in_file(files.pattern.path(files.frames.front()), wanted);
    const auto images = std::count_if(inputs.begin(), inputs.end(), [](const std::string& name) { return name != "alpha"; });
    return images > 1 ? inputs : std::vector<std::string>();
  } catch (const Error&) { return {}; }  // told when somebody wants to read it
}

/// The same picture in several formats is one candidate, that of the first format.
void keep_best_format(std::vector<Candidate>& candidates) {
  const auto extension = [](const Candidate& candidate) {
    return extension_rank(std::filesystem::path(candidate.pattern.name()).extension().string());
  };
  std::vector<Candidate> kept;
  for (Candidate& candidate : candidates) {
    const auto is_same = [&](const Candidate& other) {
      return other.pattern.stem() == candidate.pattern.stem() && other.frames == candidate.frames &&
             extension(other) != extension(candidate);
    };
    const auto other = std::find_if(kept.begin(), kept.end(), is_same);
    if (other == kept.end())
      kept.push_back(std::move(candidate));
    else if (extension(candidate) < extension(*other))
      *other = std::move(candidate);
  }
  candidates = std::move(kept);
}

void keep_best(std::vector<Candidate>& candidates) {
  const bool named = std::any_of(candidates.begin(), candidates.end(), [](const Candidate& each) { return !each.shared; });
  if (named) std::erase_if(candidates, [](const Candidate& each) { return each.shared; });
  const auto best = std::min_element(candidates.begin(), candidates.end(),
                                     [](const Candidate& a, const Candidate& b) { return a.rank < b.rank; });
  std::erase_if(candidates, [rank = best->rank](const Candidate& each) { return each.rank > rank; });
  keep_best_format(candidates);
}

Candidates find_candidates(const std::filesystem::path& folder, const std::vector<std::string>& listing,
                           const std::optional<std::vector<std::string>>& wanted) {
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> groups;  // by prefix and suffix
  for (const std::string& file : listing)
    if (const auto parts = take_apart(file)) groups[{parts->prefix, parts->suffix}].push_back(file);
  Candidates candidates;
  for (const auto& [key, names] : groups) {
    const std::string input = input_name(key.first.substr(0, key.first.size() - 1), key.second);
    const bool is_picture = extension_rank(key.second) < kImageExtensions.size();
    for (Candidate& candidate : patterns_of(folder, names)) {
      if (is_picture && !tells_its_input(input, wanted)) {
        Candidate shared = candidate;
        shared.shared = true;
        const std::vector<std::string> inputs = shared_inputs(candidate, wanted);
        for (const std::string& each : inputs) candidates[each].push_back(shared);
        if (!inputs.empty()) continue;
      }
      if (!input.empty()) candidates[input].push_back(std::move(candidate));
    }
  }
  for (auto& [input, choices] : candidates) keep_best(choices);
  return candidates;
}

std::string describe_choices(const std::string& input, const std::vector<Candidate>& choices) {
  std::string text = "several files could be the input '" + input + "':";
  for (const Candidate& choice : choices)
    text += "\n  " + choice.pattern.name() + "  (frames " + FrameRange(choice.frames).text() + ")";
  return text + "\nsay which, for example: --in " + input + "=" + choices.front().pattern.text();
}

std::string describe_layout(const Candidates& candidates) {
  const auto has = [&](const std::string& input, const std::string& prefix) {
    const auto found = candidates.find(input);
    return found != candidates.end() && found->second.front().pattern.name().starts_with(prefix);
  };
  if (has("color", "beauty_")) return "GAMES202 course layout";
  const auto is_shared = [](const auto& each) { return each.second.front().shared; };
  if (std::any_of(candidates.begin(), candidates.end(), is_shared)) return "files with several layers";
  if (has("camera", "frame.")) return "one file for each buffer, with camera sidecars";
  return "one file for each buffer";
}

/// The camera in the headers of files with layers, as when they are given by a pattern.
void add_header_camera(FolderLayout& layout, const Candidates& candidates) {
  for (const auto& [input, choices] : candidates) {
    const Candidate& files = choices.front();
    if (!files.shared || !layout.inputs.contains(input)) continue;
    const ImageFile first(files.pattern.path(files.frames.front()));
    if (!first.matrix("worldToCamera") || !first.matrix("worldToNDC")) continue;
    InputSpec spec = layout.inputs.at(input);
    spec.name = "camera", spec.shared = false;
    layout.inputs.emplace("camera", std::move(spec));
    return;
  }
}

}  // namespace

FolderLayout recognize_folder(const std::filesystem::path& folder, const InputSpecs& elsewhere,
                              const std::optional<std::vector<std::string>>& wanted) {
  const Candidates candidates = find_candidates(folder, list_files(folder), wanted);
  if (candidates.empty())
    throw Error(
        Fault::input, folder.string(),
        "no sequence is recognized here; expected files such as color.0001.exr, color_1spp.0001.exr or beauty_0.exr, or a "
        "sequence.json");
  FolderLayout layout{describe_layout(candidates), {}};
  const bool course = layout.description.starts_with("GAMES202");
  std::string ambiguities;
  for (const auto& [input, choices] : candidates) {
    if (elsewhere.contains(input)) continue;
    const bool is_wanted = !wanted || std::find(wanted->begin(), wanted->end(), input) != wanted->end();
    if (choices.size() > 1 && !is_wanted) continue;
    if (choices.size() > 1) ambiguities += (ambiguities.empty() ? "" : "\n") + describe_choices(input, choices);
    InputSpec spec;
    spec.name = input;
    spec.pattern = choices.front().pattern;
    spec.origin = folder.string();
    spec.shared = choices.front().shared;
    if (course && input == "id") spec.conventions.background = -1;
    layout.inputs.emplace(input, std::move(spec));
  }
  if (!ambiguities.empty()) throw Error(Fault::input, folder.string(), ambiguities);
  if (!candidates.contains("camera") && !elsewhere.contains("camera")) add_header_camera(layout, candidates);
  return layout;
}

std::vector<FilePattern> find_camera_files(const std::filesystem::path& folder, const std::vector<std::string>& listing) {
  std::vector<std::string> others;  // images are not looked into for this
  for (const std::string& file : listing)
    if (extension_rank(std::filesystem::path(file).extension().string()) == kImageExtensions.size()) others.push_back(file);
  std::vector<FilePattern> found;
  const Candidates candidates = find_candidates(folder, others, std::nullopt);
  if (const auto cameras = candidates.find("camera"); cameras != candidates.end())
    for (const Candidate& candidate : cameras->second) found.push_back(candidate.pattern);
  return found;
}

}  // namespace quell
