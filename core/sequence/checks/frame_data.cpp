#include "quell/sequence/checks/frame_data.h"

#include <algorithm>

namespace quell {

std::vector<const CheckedImage*> list_images(const FrameData& frame) {
  std::vector<const CheckedImage*> images;
  for (const auto* image :
       {&frame.color, &frame.albedo, &frame.alpha, &frame.normal, &frame.position, &frame.depth, &frame.id, &frame.motion})
    if (*image) images.push_back(&**image);
  for (const CheckedImage& image : frame.others) images.push_back(&image);
  return images;
}

namespace {

/// The camera of the whole image, of one that was fitted to a part of it.
std::shared_ptr<const Camera> camera_of_whole(const std::shared_ptr<const Camera>& camera, const CheckedImage& part) {
  if (!camera || part.whole == Size{}) return camera;
  Camera whole = *camera;
  whole.size = part.whole;
  for (std::size_t k = 0; k < 4; ++k) {
    whole.world_to_screen[k] += part.x * camera->world_to_screen[12 + k];
    whole.world_to_screen[4 + k] += part.y * camera->world_to_screen[12 + k];
  }
  return std::make_shared<const Camera>(whole);
}

}  // namespace

Image reread(const CheckedImage& from, const Conventions& conventions, const FrameData& frame) {
  BufferPool pool;
  Image image(from.image.type(), from.stored.size(), pool);
  const FloatImage stored = from.stored.floats();
  const FloatOutput out = image.writable_floats();
  for (int c = 0; c < out.channels; ++c)
    for (int y = 0; y < out.height; ++y) std::copy_n(stored.row(y, c), out.width, out.row(y, c));
  ConversionContext context;
  context.whole = from.whole, context.x = from.x, context.y = from.y;
  context.camera = [&](int frames_back) { return camera_of_whole(frames_back == 0 ? frame.camera : frame.previous, from); };
  context.note = [](const std::string&) {};
  to_meaning(image, conventions, context);
  return image;
}

Image make_error_map(Size size) {
  BufferPool pool;
  Image map(QUELL_TYPE_SCALAR, size, pool);
  for (int y = 0; y < size.height; ++y) std::fill_n(map.writable_floats().row(y), size.width, -1.0F);
  return map;
}

}  // namespace quell
