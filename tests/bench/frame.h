// A rendered frame of any size, as the benchmarks filter it.
#pragma once

#include <string>

#include "quell/image/item.h"

namespace quell::bench {

struct BenchFrame {
  Image color, normal, position, depth;
  Image variance;    ///< of the luminance of 3 x 3 pixels
  std::string from;  ///< where it comes from, for people
};

/// The frame of the course's box scene where the data lies beside the repository, else of the sample that ships. Where `size` is
/// not the frame's own, it is continued by its mirror images, so that pixels cost the same at any size.
BenchFrame make_frame(Size size);

}  // namespace quell::bench
