#include <algorithm>

#include "quell/sequence/input_spec.h"
#include "quell/text/diagnostic.h"

namespace quell {
namespace {

std::vector<std::string> known_keys() {
  std::vector<std::string> keys = {"type", "channels", "format"};
  for (const ConventionKey& known : convention_keys()) keys.emplace_back(known.key);
  return keys;
}

[[noreturn]] void fail(const std::string& text, const std::string& what) {
  throw Error(Fault::usage, "--in " + text, what + "; an example: --in id=ID_%d.exr:background=-1");
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (;;) {
    const std::size_t at = text.find(separator);
    parts.emplace_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

/// Start of the first ":key=" in a text: a colon, lower-case letters and an equals sign. Other colons belong to the file's name.
std::size_t find_settings(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != ':') continue;
    const std::size_t end = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz_", i + 1);
    if (end != std::string_view::npos && end > i + 1 && text[end] == '=') return i;
  }
  return text.size();
}

/// Where the name of an image file ends and a colon with a layer's name follows; npos when there is none.
std::size_t find_layer(std::string_view text) {
  std::size_t first = std::string_view::npos;
  const std::string lower = [&] {
    std::string copy(text);
    for (char& c : copy)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return copy;
  }();
  for (const std::string_view extension : {".exr:", ".tif:", ".tiff:", ".png:", ".hdr:", ".pfm:"})
    if (const std::size_t at = lower.find(extension); at != std::string::npos) first = std::min(first, at + extension.size() - 1);
  return first;
}

void apply(InputSpec& spec, const std::string& key, const std::string& value, const std::string& text) {
  if (key == "type") {
    spec.type = port_type(value);
    if (!spec.type) fail(text, "there is no type '" + value + "'");
  } else if (key == "channels") {
    spec.channels = split(value, ',');
    if (std::count(spec.channels.begin(), spec.channels.end(), "")) fail(text, "a channel's name is empty");
  } else if (key == "format") {
    spec.camera = camera_format(value);
    if (!spec.camera) fail(text, "there is no camera format '" + value + "'; it is json, mat or header");
  } else if (const auto keys = known_keys(); std::find(keys.begin(), keys.end(), key) == keys.end()) {
    fail(text, "there is no setting '" + key + "'" + did_you_mean(key, keys) + "; there are " + list_names(keys, "and"));
  } else if (const auto wrong = set_convention(spec.conventions, key, value)) {
    fail(text, *wrong);
  }
}

}  // namespace

bool is_input_name(std::string_view name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto inner = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && letter(name[0]) && std::all_of(name.begin(), name.end(), inner);
}

std::optional<CameraFormat> camera_format(std::string_view name) {
  if (name == "json") return CameraFormat::json;
  if (name == "mat") return CameraFormat::mat;
  if (name == "header") return CameraFormat::header;
  return std::nullopt;
}

std::optional<PortType> InputSpec::usual_type() const {
  if (type) return type;
  if (name == "reference" || name == "emission" || name == "noisy") return QUELL_TYPE_COLOR;
  return port_type(name);
}

CameraFormat InputSpec::camera_format() const {
  if (camera) return *camera;
  const std::string extension = std::filesystem::path(pattern.name()).extension().string();
  if (extension == ".json") return CameraFormat::json;
  if (extension == ".mat") return CameraFormat::mat;
  if (extension == ".exr") return CameraFormat::header;
  throw Error(Fault::input, pattern.text(),
              "the camera's format is not told by the file name; state \"json\", \"mat\" or \"header\"");
}

InputSpec parse_input_option(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) fail(text, "an input is given as name=pattern");
  InputSpec spec;
  spec.name = text.substr(0, equals);
  spec.origin = "--in " + text;
  if (!is_input_name(spec.name)) fail(text, "'" + spec.name + "' cannot be an input's name");

  const std::string rest = text.substr(equals + 1);
  const std::size_t settings = find_settings(rest);
  const std::size_t layer = std::min(find_layer(rest), settings);
  if (layer < settings) {
    spec.layer = rest.substr(layer + 1, settings - layer - 1);
    if (spec.layer.empty()) fail(text, "the layer's name after the colon is empty");
  }
  spec.pattern = parse_files(rest.substr(0, layer), "--in");
  for (std::string left = rest.substr(settings); !left.empty();) {
    left.erase(0, 1);
    const std::size_t value = left.find('=') + 1;
    const std::size_t end = find_settings(left);
    apply(spec, left.substr(0, value - 1), left.substr(value, end - value), text);
    left.erase(0, end);
  }
  if (!spec.layer.empty() && !spec.channels.empty()) fail(text, "name a layer or its channels, not both");
  if (const auto type = spec.usual_type())
    if (const auto wrong = find_misplaced(spec.conventions, *type)) fail(text, *wrong);
  return spec;
}

}  // namespace quell
