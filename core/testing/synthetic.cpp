#include "quell/testing/synthetic.h"

#include <array>
#include <cmath>
#include <limits>

#include "quell/testing/pass_test.h"

namespace quell {
namespace {

// A well-mixed 32-bit hash (the finalizer of MurmurHash3), as a number in 0..1.
float noise(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  std::uint32_t h = a * 0x9e3779b9u ^ (b + 0x7f4a7c15u) * 0x85ebca6bu ^ (c + 1) * 0xc2b2ae35u ^ (d + 1) * 0x27d4eb2fu;
  h ^= h >> 16, h *= 0x85ebca6bu, h ^= h >> 13, h *= 0xc2b2ae35u, h ^= h >> 16;
  return static_cast<float>(h >> 8) / static_cast<float>(1 << 24);
}

// The scene: which surface a pixel shows, and where.
struct Scene {
  Size size;
  std::uint32_t seed;

  bool background(int x) const { return size.width >= 16 && x >= size.width - size.width / 8; }
  int surface(int x, int y) const { return 2 * y > size.height ? 2 : (2 * x > size.width ? 1 : 0); }
  float noise_at(int x, int y, int c) const {
    return noise(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(c), seed);
  }
  std::array<float, 3> normal(int x, int y) const {
    static constexpr std::array<std::array<double, 3>, 3> kNormals{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    if (background(x)) return {0, 0, 0};
    std::array<double, 3> n = kNormals[static_cast<std::size_t>(surface(x, y))];
    double squared = 0;
    for (int c = 0; c < 3; ++c) n[static_cast<std::size_t>(c)] += 0.1 * (noise_at(x, y, c + 10) - 0.5);
    for (const double v : n) squared += v * v;
    std::array<float, 3> unit{};
    for (std::size_t c = 0; c < 3; ++c) unit[c] = static_cast<float>(n[c] / std::sqrt(squared));
    return unit;
  }
  std::array<float, 3> position(int x, int y) const {
    if (background(x)) return {0, 0, 0};
    const float u = static_cast<float>(x) * 0.05F, v = static_cast<float>(y) * 0.05F;
    switch (surface(x, y)) {
      case 0:
        return {-1.0F, u, v};
      case 1:
        return {u, -1.0F, v};
      default:
        return {u, v, 0.5F};
    }
  }
};

float value(PortType type, const Scene& scene, int x, int y, int c) {
  const auto channel = static_cast<std::size_t>(c);
  switch (type) {
    case QUELL_TYPE_COLOR:
      return scene.background(x) ? 0.2F : 0.3F + 0.5F * static_cast<float>(scene.surface(x, y)) + scene.noise_at(x, y, c);
    case QUELL_TYPE_NORMAL:
      return scene.normal(x, y)[channel];
    case QUELL_TYPE_POSITION:
      return scene.position(x, y)[channel];
    case QUELL_TYPE_DEPTH:
      return scene.background(x) ? QUELL_NO_SURFACE_DEPTH : 3.0F + 0.05F * static_cast<float>(y + scene.surface(x, y));
    case QUELL_TYPE_MOTION:
      return (scene.noise_at(x / 4, y / 4, c) - 0.5F) * 4.0F;
    case QUELL_TYPE_MOMENTS:
      return 0.5F + scene.noise_at(x, y, 0) * (c == 0 ? 1.0F : 2.0F);
    case QUELL_TYPE_MASK:
      return scene.noise_at(x, y, c) < 0.8F ? 1.0F : 0.0F;
    default:
      return scene.noise_at(x, y, c);
  }
}

Camera camera(Size size, std::uint32_t seed) {
  Camera result;
  result.size = size;
  const double shift = 0.01 * seed;
  result.world_to_camera = {1, 0, 0, shift, 0, 1, 0, 0, 0, 0, 1, -4, 0, 0, 0, 1};
  // A pinhole that looks along -z: x and y in pixels after division by w = -z_camera.
  const double w = size.width, h = size.height;
  result.world_to_screen = {w, 0, -w / 2, w * shift + 2 * w, 0, -h, -h / 2, 2 * h, 0, 0, -1, 4, 0, 0, -1, 4};
  for (std::uint32_t id = 0; id < 3; ++id) {
    result.object_to_world[id] = kIdentity;
    result.object_to_world[id][3] = 0.02 * seed * id;
  }
  return result;
}

Image copy(const Image& image, int spare_lines) {
  if (info(image.type()).format == QUELL_FORMAT_U32)
    return test_ids(
        image.size(), [&](int x, int y) { return image.ids().at(x, y); }, spare_lines);
  return test_image(
      image.type(), image.size(), [&](int x, int y, int c) { return image.floats().at(x, y, c); }, spare_lines);
}

}  // namespace

Item synthetic(PortType type, Size size, std::uint32_t seed, int spare_lines) {
  const Scene scene{size, seed};
  if (type == QUELL_TYPE_CAMERA) return camera(size, seed);
  if (type == QUELL_TYPE_VALUE) return Values{1.0 + seed};
  if (type == QUELL_TYPE_ID)
    return test_ids(
        size, [&](int x, int y) { return scene.background(x) ? QUELL_NO_ID : static_cast<std::uint32_t>(scene.surface(x, y)); },
        spare_lines);
  return test_image(
      type, size, [&](int x, int y, int c) { return value(type, scene, x, y, c); }, spare_lines);
}

Item with_other_pixel(const Item& item, int x, int y, int spare_lines) {
  Image image = copy(*item.image(), spare_lines);
  if (image.type() == QUELL_TYPE_ID) {
    image.writable_ids().at(x, y) = image.ids().at(x, y) == 1 ? 0 : 1;
    return image;
  }
  const FloatOutput pixels = image.writable_floats();
  if (image.type() == QUELL_TYPE_NORMAL) {  // another direction, still of unit length
    const float old_x = pixels.at(x, y, 0);
    pixels.at(x, y, 0) = pixels.at(x, y, 1), pixels.at(x, y, 1) = pixels.at(x, y, 2), pixels.at(x, y, 2) = old_x;
    return image;
  }
  for (int c = 0; c < pixels.channels; ++c) {
    float& v = pixels.at(x, y, c);
    v = image.type() == QUELL_TYPE_MASK ? 1.0F - v : 0.75F * v + 0.125F;
  }
  return image;
}

Item with_bad_pixel(const Item& item, int x, int y) {
  Image image = copy(*item.image(), 0);
  const FloatOutput pixels = image.writable_floats();
  for (int c = 0; c < pixels.channels; ++c)
    pixels.at(x, y, c) = c == 1 ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
  return image;
}

}  // namespace quell
