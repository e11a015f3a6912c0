// Writes results as image files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "quell/image/stream.h"
#include "quell/sequence/image_file.h"

namespace quell {

enum class PixelType {
  automatic,  ///< half for color and albedo, float for other images
  half,
  single,  ///< float
};
enum class FileFormat { exr, png };

/// "auto", "half" or "float". Throws Error(usage) naming `--type`.
PixelType parse_pixel_type(std::string_view text);
/// "exr" or "png". Throws Error(usage) naming `--format`.
FileFormat parse_file_format(std::string_view text);
/// What OpenEXR can compress with: "none", "rle", "zips", "zip", "piz", ... (dwaa and dwab are for color: OpenImageIO writes
/// images of fewer than three channels with zip instead).
const std::vector<std::string>& exr_compressions();

/// A text in the header of every image file.
struct FileAttribute {
  std::string name, text;
};

/// The file that a frame's picture was read from. Results take over where its pixels lie, and what its header tells of it: all
/// attributes, with their types, but for those about how the file itself is stored.
struct Original {
  std::filesystem::path file;
  std::vector<std::string> color;        ///< full names of the channels that are the picture (see FileChannel)
  std::vector<std::string> read = {};    ///< full names of all channels that are not to be kept, `color` among them
  std::optional<Rectangle> window = {};  ///< what was read, from the display window's upper left corner; nothing: all of it
};

/// An image that every frame has.
struct ResultImage {
  std::string name;  ///< as FrameSink::write() is told it
  PortType type = QUELL_TYPE_COLOR;
  std::vector<FileAttribute> attributes = {};  ///< of its own file, beside those of all files
};

struct FileSinkOptions {
  std::filesystem::path folder;
  std::vector<FileFormat> formats = {FileFormat::exr};  ///< each image is written once in every format that can hold it
  PixelType type = PixelType::automatic;                ///< of EXR; ids are always uint
  std::string compression = "zip";                      ///< of EXR
  int padding = 4;                                      ///< digits of the frame number, 1..20
  std::vector<FileAttribute> attributes = {};
  std::vector<FileAttribute> layered_attributes = {};  ///< of files of layers, beside these
  std::vector<ResultImage> images =
      {};  ///< all of a frame, for `layers` and `keep_channels`; `color`, else the first, is the main one
  /// Name of the one EXR file that holds all images of a frame as layers; empty: a file each.
  std::string layers = {};
  /// Called from any thread, for any frame; nothing: files carry no more than the results. Throws Error(input).
  std::function<std::optional<Original>(std::int64_t frame)> original = {};
  /// Whether channels of the original that the graph does not read go to the main image's file; to a PNG, only alpha.
  bool keep_channels = false;
};

/// Writes FOLDER/<output>.<frame>.exr. Channels: R,G,B for color and albedo, X,Y,Z for normal and position, X,Y for motion and
/// moments, Z for depth, A for alpha, Y for other single planes. Cameras and values become .json text. PNG is 8 bit with the
/// sRGB transfer curve, clamped to 0..1; it holds color and albedo, and single planes (but ids) as gray.
///
/// As layers, the main image's channels have these names, and those of others `<output>.` before them. The file of a frame is
/// written with the last of its images, which until then are held; when one of them fails, none is.
///
/// Files tell the frame (`quell:frame`). Where the original has pixels in a part of the picture alone, only that part is written.
/// A result of another size than the picture has windows of its own.
///
/// Every file is written under a temporary name in the same folder and renamed when complete, so that a file under its final
/// name is never partial; a write that fails leaves nothing behind. Thread-safe.
class FileSink final : public FrameSink {
 public:
  /// Throws Error(usage) for an unknown compression (with the list), a padding out of range, a name of layers that cannot be a
  /// file's, or layers without EXR. Touches no file.
  explicit FileSink(FileSinkOptions options);
  ~FileSink() override;

  /// The files that write() would write. Throws Error(usage) when no chosen format can hold the type.
  std::vector<std::filesystem::path> files(std::string_view output, std::int64_t frame, PortType type) const;
  /// Makes the folder when needed. Throws Error(frame) when a file cannot be written.
  void write(std::string_view output, std::int64_t frame, const Item& item) override;
  bool uses_processor() const override { return true; }

  /// Names of channels that `keep_channels` concerns.
  struct KeptChannels {
    std::vector<std::string> kept;      ///< in the results
    std::vector<std::string> left_out;  ///< in the original: a result has their name
  };
  /// Those of a frame, by opening its original. Throws Error(input).
  KeptChannels kept_channels(std::int64_t frame) const;

  /// The files written so far, sorted.
  std::vector<std::filesystem::path> written() const;
  /// Pixels of half images whose value was beyond +-65504 and was clamped to it.
  std::uint64_t clamped_pixels() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace quell
