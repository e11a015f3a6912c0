// What the checks look at: the images and cameras of one frame.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "quell/image/item.h"
#include "quell/sequence/conventions.h"
#include "quell/sequence/image_file.h"

namespace quell {

/// One image, twice.
struct CheckedImage {
  std::string name;                     ///< of the input
  Image image;                          ///< as its type means it; none for ids that are no integers
  Image stored;                         ///< as the file holds it, ids as a scalar; none where that cannot be had
  Conventions read_as = {};             ///< how `image` was made of `stored`
  std::optional<Numbers> numbers = {};  ///< of the file
  Size whole = {};                      ///< of the display window, of which this may be a part; 0 x 0: it is the whole
  int x = 0, y = 0;                     ///< where in the whole the pixel (0, 0) lies
  std::string layer = {};               ///< what an --in option names to choose it in its file; "" for the file's only image
};

/// A frame's inputs, as far as they are there.
struct FrameData {
  std::int64_t frame = 0;
  std::optional<CheckedImage> color, albedo, alpha, normal, position, depth, id, motion;
  std::vector<CheckedImage> others;  ///< further ones, of any type
  std::shared_ptr<const Camera> camera;
  std::shared_ptr<const Camera> previous;  ///< of the frame before
};

/// All images of a frame.
std::vector<const CheckedImage*> list_images(const FrameData& frame);

/// The image as it would be, had it been read by other conventions. Needs `stored`.
Image reread(const CheckedImage& from, const Conventions& conventions, const FrameData& frame);

/// A scalar image of -1: nothing tested yet.
Image make_error_map(Size size);

}  // namespace quell
