// Which inputs the files of one pattern serve.
#include <algorithm>
#include <charconv>

#include "quell/sequence/header_camera.h"
#include "quell/sequence/input_spec.h"
#include "quell/sequence/renderer_names.h"
#include "quell/text/diagnostic.h"
#include "quell/text/shell_word.h"

namespace quell {
namespace {

using Wanted = std::optional<std::vector<std::string>>;

PortType type_of(const std::string& input) {
  InputSpec spec;
  spec.name = input;
  return spec.usual_type().value_or(QUELL_TYPE_VALUE);
}

[[noreturn]] void fail_unrecognized(const std::filesystem::path& file) {
  std::string text = "no input is recognized by the names of its layers:";
  const std::vector<Layer> layers = group_layers(ImageFile(file).channels());
  for (const Layer& layer : layers) {
    const std::size_t count = layer.channels.size();
    const std::string channels = std::to_string(count) + (count == 1 ? " channel" : " channels");
    text += "\n  " + (layer.name.empty() ? "without a layer, " + channels : layer.name);
  }
  const bool is_plain = layers.size() == 1 && layers.front().name.empty();  // as it is, it may be any input
  throw Error(Fault::input, file.string(),
              text + "\nsay what it is, for example: --in " + shell_word("depth=" + file.string() + (is_plain ? "" : ":LAYER")));
}

/// Sidecars beside the files, else the files themselves when they have matrices in their headers; nothing when neither is there.
std::optional<FilePattern> find_camera(const FilePattern& files, const std::filesystem::path& first, const Wanted& wanted) {
  const std::vector<FilePattern> beside = find_camera_files(files.folder(), list_files(files.folder()));
  if (beside.size() == 1) return beside.front();
  const bool is_wanted = wanted && std::find(wanted->begin(), wanted->end(), "camera") != wanted->end();
  if (beside.size() > 1 && !is_wanted) return std::nullopt;
  if (beside.size() > 1) {
    std::string text = "several files could be the input 'camera':";
    for (const FilePattern& pattern : beside) text += "\n  " + pattern.name();
    throw Error(Fault::input, files.folder().string(), text + "\nsay which, for example: --in camera=" + beside.front().text());
  }
  const ImageFile file(first);
  if (file.matrix("worldToCamera") && file.matrix("worldToNDC")) return files;
  return std::nullopt;
}

}  // namespace

std::vector<std::string> inputs_in_file(const std::filesystem::path& file, const Wanted& wanted) {
  const ImageFile image(file);
  std::vector<std::string> names = usual_inputs(), found;
  for (const std::string& name : wanted.value_or(std::vector<std::string>()))
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  for (const std::string& name : names) {
    const PortType type = type_of(name);
    if (!is_image(type)) continue;
    const std::size_t candidates = recognize(image.channels(), name, type).size();
    const bool is_wanted = !wanted || std::find(wanted->begin(), wanted->end(), name) != wanted->end();
    if (candidates == 1 || (candidates > 1 && is_wanted)) found.push_back(name);
  }
  return found;
}

FilePattern parse_files(const std::string& text, const std::string& source) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(text, error)) return FilePattern::parse(text, {}, source);
  const auto numbered = take_apart(std::filesystem::path(text).filename().string());
  std::int64_t frame = 1;
  if (numbered) std::from_chars(numbered->number.data(), numbered->number.data() + numbered->number.size(), frame);
  return FilePattern::single(text, frame);
}

FolderLayout recognize_files(const FilePattern& pattern, const InputSpecs& elsewhere, const Wanted& wanted) {
  const FrameFiles files = find_frames(pattern, list_files(pattern.folder()));
  if (files.frames.empty())
    throw Error(Fault::input, pattern.text(),
                "there is no file of this name" +
                    (files.padded_otherwise.empty() ? std::string() : "; the folder has " + files.padded_otherwise.front()));
  const std::filesystem::path first = pattern.path(files.frames.front());
  FolderLayout layout{"one file for all inputs", {}};
  const auto add = [&](const std::string& name, const FilePattern& from) {
    InputSpec spec;
    spec.name = name;
    spec.pattern = from;
    spec.origin = pattern.text();
    spec.shared = name != "camera";
    layout.inputs.emplace(name, std::move(spec));
  };
  const std::vector<std::string> inputs = inputs_in_file(first, wanted);
  if (inputs.empty() && elsewhere.empty()) fail_unrecognized(first);
  for (const std::string& name : inputs)
    if (!elsewhere.contains(name)) add(name, pattern);
  if (!elsewhere.contains("camera"))
    if (const auto camera = find_camera(pattern, first, wanted)) add("camera", *camera);
  return layout;
}

}  // namespace quell
