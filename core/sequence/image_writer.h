// Images and other items to files. Private to core/sequence.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "quell/image/item.h"
#include "quell/sequence/file_sink.h"
#include "quell/sequence/original_file.h"

namespace quell {

/// The names of a type's planes in a file: R,G,B for color and albedo, X,Y,Z for normal and position, and so on; with a layer,
/// "normal.X", "normal.Y", "normal.Z".
std::vector<std::string> channel_names(PortType type, const std::string& layer = "");

/// An image in a file.
struct WrittenLayer {
  Image image;
  std::string name;   ///< before the names of its channels; "": nothing
  bool half = false;  ///< numbers of 16 bits instead of 32; ids are uint
};

/// What a file holds.
struct FileContent {
  std::vector<WrittenLayer> layers;            ///< images of one size
  std::optional<std::int64_t> frame;           ///< nothing for a picture that is of no frame
  OriginalFile* original = nullptr;            ///< for attributes and windows
  bool keep_channels = false;                  ///< of `original`
  std::vector<FileAttribute> attributes = {};  ///< beside those of the options
};

/// Where the layers lie. Throws Error(frame) when channels are to be kept that have another size.
Placement place(const FileContent& content);
/// Those of the original, those of the options, its own, and the frame.
void add_attributes(OIIO::ImageSpec& spec, const FileContent& content, const FileSinkOptions& options);

/// Writes an EXR file. With `half`, values beyond +-65504 are clamped to it; the number of pixels in which that happened is
/// returned. The same content gives the same bytes. Throws Error(frame), Error(input) when `original` cannot be read.
std::uint64_t write_exr(const FileContent& content, const FileSinkOptions& options, const std::filesystem::path& file);

/// Whether a PNG can show the type: color, albedo, and single planes of floats (as gray).
bool png_can_hold(PortType type);
/// Writes the only layer as an 8-bit PNG with the sRGB transfer curve; values are clamped to 0..1, NaN is 0. Alpha of `original`
/// is kept with a picture of three channels, which is divided by it, since PNG wants it so. Throws as write_exr() does.
void write_png(const FileContent& content, const FileSinkOptions& options, const std::filesystem::path& file);
/// The sRGB transfer curve (IEC 61966-2-1), rounded to 8 bits.
std::uint8_t to_srgb8(float linear);

/// A camera in the form of the sidecars that read_json_camera() reads, with "frame"; values as {"frame", "values"}.
std::string to_json(const Item& item, std::int64_t frame);
/// Writes a text file. Throws Error(frame).
void write_text(const std::string& text, const std::filesystem::path& file);

}  // namespace quell
