// Several small pictures on one sheet, with titles and scales, as a PNG.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "quell/sdk/frame.h"

namespace quell {

using Rgb = std::array<std::uint8_t, 3>;  ///< as a display shows it (sRGB)

/// A raster of pixels for a display.
struct Raster {
  int width = 0, height = 0;
  std::vector<Rgb> pixels;

  Raster() = default;
  Raster(int w, int h, Rgb fill = {})
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), fill) {}
  Rgb& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
  const Rgb& at(int x, int y) const { return const_cast<Raster*>(this)->at(x, y); }  // NOLINT: the same, unchanged
};

struct Panel {
  std::string title;
  std::string note;  ///< below the picture
  Raster picture;    ///< all panels of a sheet are of one size
  /// Colors of a scale below the picture, from left to right, and what stands at its ends; empty: no scale.
  std::vector<Rgb> scale = {};
  std::string scale_begin = {}, scale_end = {};
};

/// Writes a raster as a PNG of the same bytes. The file appears under its name only when it is complete. Throws Error(frame).
void write_raster(const std::filesystem::path& file, const Raster& raster);

/// The size of a panel for an image: scaled down to at most `largest` pixels in width, or up by a whole factor to at least
/// `smallest`, and never higher than four times `largest`.
Size panel_size(Size image, int smallest, int largest);

/// Writes the panels, in rows of `columns`, under a heading. False when no font was found, so that nothing is labeled. The file
/// appears under its name only when it is complete. Throws Error(frame) when it cannot be written.
bool write_contact_sheet(const std::filesystem::path& file, const std::string& heading, const std::vector<Panel>& panels,
                         int columns);

}  // namespace quell
