// One item to one file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "quell/image/item.h"

namespace quell {

/// The names of a type's planes in a file: R,G,B for color and albedo, X,Y,Z for normal and position, and so on.
std::vector<std::string> channel_names(PortType type);

/// Writes an EXR file of half or float channels (ids: uint). With `half`, values beyond +-65504 are clamped to it; the number of
/// pixels in which that happened is returned. The same image gives the same bytes. Throws Error(frame).
std::uint64_t write_exr(const Image& image, const std::filesystem::path& file, bool half, const std::string& compression);

/// Whether a PNG can show the type: color, albedo, and single planes of floats (as gray).
bool png_can_hold(PortType type);
/// Writes an 8-bit PNG with the sRGB transfer curve; values are clamped to 0..1, NaN is 0. Throws Error(frame).
void write_png(const Image& image, const std::filesystem::path& file);
/// The sRGB transfer curve (IEC 61966-2-1), rounded to 8 bits.
std::uint8_t to_srgb8(float linear);

/// A camera in the form of the sidecars that read_json_camera() reads, with "frame"; values as {"frame", "values"}.
std::string to_json(const Item& item, std::int64_t frame);
/// Writes a text file. Throws Error(frame).
void write_text(const std::string& text, const std::filesystem::path& file);

}  // namespace quell
