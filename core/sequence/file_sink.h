// Writes results as image files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "quell/image/stream.h"

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

struct FileSinkOptions {
  std::filesystem::path folder;
  std::vector<FileFormat> formats = {FileFormat::exr};  ///< each image is written once in every format that can hold it
  PixelType type = PixelType::automatic;                ///< of EXR; ids are always uint
  std::string compression = "zip";                      ///< of EXR
  int padding = 4;                                      ///< digits of the frame number, 1..20
};

/// Writes FOLDER/<output>.<frame>.exr. Channels: R,G,B for color and albedo, X,Y,Z for normal and position, X,Y for motion and
/// moments, Z for depth, A for alpha, Y for other single planes. Cameras and values become .json text. PNG is 8 bit with the
/// sRGB transfer curve, clamped to 0..1; it holds color and albedo, and single planes (but ids) as gray.
///
/// Every file is written under a temporary name in the same folder and renamed when complete, so that a file under its final
/// name is never partial; a write that fails leaves nothing behind. Thread-safe.
class FileSink final : public FrameSink {
 public:
  /// Throws Error(usage) for an unknown compression (with the list) or a padding out of range. Touches no file.
  explicit FileSink(FileSinkOptions options);
  ~FileSink() override;

  /// The files that write() would write. Throws Error(usage) when no chosen format can hold the type.
  std::vector<std::filesystem::path> files(std::string_view output, std::int64_t frame, PortType type) const;
  /// Makes the folder when needed. Throws Error(frame) when a file cannot be written.
  void write(std::string_view output, std::int64_t frame, const Item& item) override;
  bool uses_processor() const override { return true; }

  /// The files written so far, sorted.
  std::vector<std::filesystem::path> written() const;
  /// Pixels of half images whose value was beyond +-65504 and was clamped to it.
  std::uint64_t clamped_pixels() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace quell
