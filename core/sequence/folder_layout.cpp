#include <algorithm>
#include <functional>
#include <set>

#include "quell/sequence/frame_range.h"
#include "quell/sequence/input_spec.h"
#include "quell/text/diagnostic.h"

namespace quell {
namespace {

/// A file name with a frame number before its extension, taken apart: "beauty_", "12", ".exr".
struct NumberedName {
  std::string prefix, number, suffix;
};

std::optional<NumberedName> take_apart(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos || dot == 0) return std::nullopt;
  std::size_t start = dot;
  while (start > 0 && name[start - 1] >= '0' && name[start - 1] <= '9') --start;
  if (start == dot) return std::nullopt;
  if (start > 0 && name[start - 1] == '-') --start;
  if (dot - start > 20 || start < 2 || (name[start - 1] != '.' && name[start - 1] != '_')) return std::nullopt;
  return NumberedName{name.substr(0, start), name.substr(start, dot - start), name.substr(dot)};
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
  if (extension != ".exr") return "";
  if (stem == "beauty" || is_color_with_samples(stem)) return "color";
  if (stem == "ID") return "id";
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
};
using Candidates = std::map<std::string, std::vector<Candidate>>;  // by input

/// One pattern for each way of padding in a group of names that differ in their numbers alone.
std::vector<Candidate> patterns_of(const std::filesystem::path& folder, const std::vector<std::string>& names) {
  const NumberedName name = *take_apart(names.front());
  std::set<int, std::greater<>> paddings;
  for (const std::string& file : names) paddings.insert(padding_of(take_apart(file)->number));
  std::vector<Candidate> found;
  for (const int padding : paddings) {
    const FilePattern pattern(folder, name.prefix, padding, name.suffix);
    const FrameFiles files = find_frames(pattern, names);
    found.push_back({pattern, files.frames});
    if (files.padded_otherwise.empty()) break;  // 0999, 1000: the later ones show no zero, but are padded alike
  }
  return found;
}

Candidates find_candidates(const std::filesystem::path& folder, const std::vector<std::string>& listing) {
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> groups;  // by prefix and suffix
  for (const std::string& file : listing)
    if (const auto parts = take_apart(file)) groups[{parts->prefix, parts->suffix}].push_back(file);
  Candidates candidates;
  for (const auto& [key, names] : groups) {
    const std::string input = input_name(key.first.substr(0, key.first.size() - 1), key.second);
    if (input.empty()) continue;
    for (Candidate& candidate : patterns_of(folder, names)) candidates[input].push_back(std::move(candidate));
  }
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
  if (has("camera", "frame.")) return "one file for each buffer, with camera sidecars";
  return "one file for each buffer";
}

}  // namespace

FolderLayout recognize_folder(const std::filesystem::path& folder, const InputSpecs& elsewhere,
                              const std::optional<std::vector<std::string>>& wanted) {
  const Candidates candidates = find_candidates(folder, list_files(folder));
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
    if (course && input == "id") spec.background = -1;
    layout.inputs.emplace(input, std::move(spec));
  }
  if (!ambiguities.empty()) throw Error(Fault::input, folder.string(), ambiguities);
  return layout;
}

}  // namespace quell
