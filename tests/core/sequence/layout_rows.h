// What renderers write, row by row: a function that writes such a file, and what quell has to read. The table in core/README.md
// is made from these rows.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/core/sequence/test_files.h"

namespace quell::test {

/// Frame 1 of a sequence.
struct LayoutRow {
  std::string name;      ///< of the test, letters only
  std::string renderer;  ///< who writes this
  std::string writes;    ///< what, for the table
  std::string input;     ///< as which input it is read
  std::string told;      ///< what the sequence says of it, the conventions above all; "" for nothing
  std::function<void(const TempFolder&)> write;
  std::string sequence;  ///< SEQUENCE: a name in the folder; "" for the folder
  /// Plane after plane; an id without surface is 4294967295. Of a camera: where it sees (11, 21, 34) in pixels, and the depth.
  std::vector<double> expected;
  std::vector<std::string> in = {};  ///< --in options, where FOLDER stands for the folder
  Size size = {2, 1};
  float pixel_aspect = 1;
};

std::vector<LayoutRow> layout_rows();
/// Those about how files are built, and about cameras in headers; layout_rows() has them, too.
std::vector<LayoutRow> structure_rows();
/// The rows as a Markdown table.
std::string layout_table();

/// A channel with its two pixels.
struct TwoPixels {
  std::string channel;
  double left, right;
};
/// Writes an EXR of 2 x 1 pixels.
void make_channels(const std::filesystem::path& file, const std::vector<TwoPixels>& channels,
                   const std::string& format = "float");
/// A sidecar for such an image: x of the camera is y of the world, y is -x; a pixel is one unit wide at distance 1.
void make_turned_camera(const std::filesystem::path& file);

}  // namespace quell::test
