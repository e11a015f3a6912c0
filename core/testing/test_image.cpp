#include "quell/testing/pass_test.h"

namespace quell {
namespace {

BufferPool& image_pool() {
  static BufferPool pool;
  return pool;
}

}  // namespace

Image test_image(PortType type, Size size, const std::function<float(int, int, int)>& value, int spare_lines) {
  Image image(type, size, image_pool(), spare_lines);
  const FloatOutput pixels = image.writable_floats();
  for (int c = 0; c < pixels.channels; ++c)
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) pixels.at(x, y, c) = value(x, y, c);
  return image;
}

Image test_ids(Size size, const std::function<std::uint32_t(int, int)>& value, int spare_lines) {
  Image image(QUELL_TYPE_ID, size, image_pool(), spare_lines);
  const IdOutput pixels = image.writable_ids();
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) pixels.at(x, y) = value(x, y);
  return image;
}

}  // namespace quell
