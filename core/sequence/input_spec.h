// What a sequence is told about one input: where its files are and what is in them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "quell/image/port_type.h"
#include "quell/sequence/file_pattern.h"

namespace quell {

enum class CameraFormat {
  json,  ///< sidecars with world_to_camera, world_to_pixel, width, height, objects
  mat,   ///< the GAMES202 course's binary matrices
};

struct InputSpec {
  std::string name;
  FilePattern pattern;
  std::string origin;                      ///< for messages: "folder/sequence.json:4:12", "--in", a folder
  std::optional<PortType> type;            ///< stated; the name's type otherwise
  std::vector<std::string> channels;       ///< stated; by the usual names otherwise
  std::optional<std::int64_t> background;  ///< value of an id file where there is no surface; see id_background()
  std::optional<CameraFormat> camera;      ///< stated; by the file name's extension otherwise

  /// The stated type, or the type whose name the input has; `reference`, `emission` and `noisy` are color.
  std::optional<PortType> usual_type() const;
  /// The stated camera format, or .json or .mat by name. Throws Error(input) otherwise.
  CameraFormat camera_format() const;
};

/// By input name.
using InputSpecs = std::map<std::string, InputSpec, std::less<>>;

/// An input's name in a graph: a letter, then letters, digits and underscores.
bool is_input_name(std::string_view name);
std::optional<CameraFormat> camera_format(std::string_view name);

/// Parses `name=pattern[:key=value]...` of --in; the keys are type, channels (R,G,B), background and format. Relative patterns
/// are taken from the current directory. Throws Error(usage).
InputSpec parse_input_option(const std::string& text);

/// What the recognition of a folder found.
struct FolderLayout {
  std::string description;  ///< "GAMES202 course layout", ...
  InputSpecs inputs;
};

/// Recognizes a folder by its file names: NAME.####.exr and NAME_#.exr are input NAME (`beauty` and `color_<n>spp` are color,
/// `ID` is id), matrix_#.mat and frame.####.json are the camera. Inputs named in `elsewhere` are left out. Throws Error(input)
/// when nothing is recognized, or when two patterns could be the same input, with the choices; such an input is left out when it
/// is not among those `wanted`.
FolderLayout recognize_folder(const std::filesystem::path& folder, const InputSpecs& elsewhere,
                              const std::optional<std::vector<std::string>>& wanted = std::nullopt);

}  // namespace quell
