// Small scenes for tests of what lasts over time: motion is whole pixels and colors are whole numbers, so that every pixel is
// known.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "quell/image/stream.h"

namespace quell::scene {

constexpr Size kSize{12, 6};
constexpr int kFrames = 6;  // from 1 on

struct Pixel {
  int x = 0, y = 0;
};
constexpr Pixel kFirefly{5, 3};
constexpr Pixel operator+(Pixel a, Pixel b) { return {a.x + b.x, a.y + b.y}; }
bool is_inside(Pixel at);
void for_each_pixel(const std::function<void(Pixel)>& call);

/// What is seen in a pixel: an object, and where its point was one frame ago, relative to the pixel.
struct Seen {
  std::uint32_t id = 1;
  Pixel motion;
};

struct Scene {
  std::function<Seen(Pixel, std::int64_t frame)> see;
  std::set<std::int64_t> cuts = {};                                        ///< where history has to end
  std::set<std::int64_t> fireflies = {};                                   ///< frames in which kFirefly is far too bright
  std::function<Camera(std::int64_t frame)> camera = {};                   ///< for graphs that find the motion themselves
  std::function<std::array<float, 3>(Pixel, std::int64_t)> position = {};  ///< the same
  /// Which inputs, of id, depth and normal, differ from object to object.
  std::set<std::string, std::less<>> told_by = {"id"};
  float albedo = 1, emission = 0;  ///< everywhere; the color is light times albedo, plus emission
};

/// The light that falls on what is seen, a whole number; that of plane c is higher by c.
float light(Pixel at, std::int64_t frame);
/// Whether the point was seen in the frame before.
bool has_history(const Scene& scene, Pixel at, std::int64_t frame);
bool is_firefly(const Scene& scene, Pixel at, std::int64_t frame);
/// How many pixels of a frame begin anew, so that a scene shows what it is about.
int count_new(const Scene& scene, std::int64_t frame);

inline Seen at_rest(Pixel, std::int64_t) { return {}; }
/// 3 x 2 pixels that move to the right by one pixel a frame, over a background at rest.
Seen see_moving_object(Pixel at, std::int64_t frame);

std::vector<std::int64_t> first_frames(int count);

class SceneSource final : public FrameSource {
 public:
  explicit SceneSource(const Scene& scene) : scene_(scene) {}
  std::optional<Shape> shape(std::string_view input) override { return shape_of(read(input, 1, pool_)); }
  Item read(std::string_view input, std::int64_t frame, BufferPool& pool) override;

 private:
  float number(std::string_view input, Pixel at, std::int64_t frame, int c) const;
  const Scene& scene_;
  BufferPool pool_;
};

class KeepingSink final : public FrameSink {
 public:
  void write(std::string_view output, std::int64_t frame, const Item& item) override;
  float at(const std::string& output, std::int64_t frame, Pixel pixel, int c = 0) const;

 private:
  std::map<std::pair<std::string, std::int64_t>, Image> images_;
  std::mutex mutex_;
};

}  // namespace quell::scene
