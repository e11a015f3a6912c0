// What a sequence is told about one input: where its files are and what is in them.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "quell/image/port_type.h"
#include "quell/sequence/conventions.h"
#include "quell/sequence/file_pattern.h"

namespace quell {

enum class CameraFormat {
  json,    ///< sidecars with world_to_camera, world_to_pixel, width, height, objects
  mat,     ///< the GAMES202 course's binary matrices
  header,  ///< worldToCamera and worldToNDC in the header of an OpenEXR image
};

struct InputSpec {
  std::string name;
  FilePattern pattern;
  std::string origin;                  ///< for messages: "folder/sequence.json:4:12", "--in", a folder
  std::optional<PortType> type;        ///< stated; the name's type otherwise
  std::string layer;                   ///< stated: of which layer, or the one channel, of the files; empty: recognized
  std::vector<std::string> channels;   ///< stated one by one; empty: those of the layer
  Conventions conventions;             ///< stated
  std::optional<CameraFormat> camera;  ///< stated; by the file name's extension otherwise
  bool shared = false;                 ///< its files serve other inputs, too: what is this one's is told by layers' names alone

  /// The stated type, or the type whose name the input has; `reference`, `emission` and `noisy` are color.
  std::optional<PortType> usual_type() const;
  /// The stated camera format, or that of .json, .mat or .exr by name. Throws Error(input) otherwise.
  CameraFormat camera_format() const;
};

/// By input name.
using InputSpecs = std::map<std::string, InputSpec, std::less<>>;

/// An input's name in a graph: a letter, then letters, digits and underscores.
bool is_input_name(std::string_view name);
std::optional<CameraFormat> camera_format(std::string_view name);

/// Parses `name=pattern[:layer][:key=value]...` of --in. The pattern may be the name of one file that exists; a layer follows an
/// image file's extension and may hold spaces, dots and any letters; the keys are type, channels (R,G,B), format and those of
/// convention_keys(). Relative patterns are taken from the current directory. Throws Error(usage).
InputSpec parse_input_option(const std::string& text);

/// What recognition found.
struct FolderLayout {
  std::string description;  ///< "GAMES202 course layout", ...
  InputSpecs inputs;
};

/// Recognizes a folder by its file names: NAME.####.exr and NAME_#.exr (or .png, .tif, .tiff, .hdr, .pfm) are input NAME
/// (`beauty` and `color_<n>spp` are color, `ID` is id, Falcor's captures what renderer_file_names() says), matrix_#.mat and
/// frame.####.json are the camera; files with several layers serve what inputs_in_file() finds and no file is named after. Of one
/// name in several formats, the first of this list is taken. Inputs named in `elsewhere` are left out. Throws Error(input) when
/// nothing is recognized, or when two patterns could be the same input, with the choices; such an input is left out when it is
/// not among those `wanted`.
FolderLayout recognize_folder(const std::filesystem::path& folder, const InputSpecs& elsewhere,
                              const std::optional<std::vector<std::string>>& wanted = std::nullopt);

/// Recognizes the inputs in files of one pattern, by the layers of their first one, and the camera in sidecars beside them, else
/// in their own headers. Throws Error(input) when there is no such file, it is no image, or nothing in it is recognized.
FolderLayout recognize_files(const FilePattern& pattern, const InputSpecs& elsewhere,
                             const std::optional<std::vector<std::string>>& wanted = std::nullopt);

/// The usual inputs, and those wanted that are named like a type, for which a file has layers; doubtful ones only when they are
/// wanted, or nobody knows what is. Throws Error(input) for a file that is no image.
std::vector<std::string> inputs_in_file(const std::filesystem::path& file, const std::optional<std::vector<std::string>>& wanted);

/// Patterns of the camera files in a folder: frame.####.json, camera.####.json, matrix_#.mat.
std::vector<FilePattern> find_camera_files(const std::filesystem::path& folder, const std::vector<std::string>& listing);

/// The pattern of a sequence given as image files: with a counter, or the name of one file, which is the frame whose number it
/// has (1 when it has none). Throws Error(usage).
FilePattern parse_files(const std::string& text, const std::string& source);

}  // namespace quell
