#include "tests/graphs/temporal_scene.h"

namespace quell::scene {

bool is_inside(Pixel at) { return at.x >= 0 && at.y >= 0 && at.x < kSize.width && at.y < kSize.height; }

void for_each_pixel(const std::function<void(Pixel)>& call) {
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) call({x, y});
}

float light(Pixel at, std::int64_t frame) { return static_cast<float>((7 * at.x + 13 * at.y + 29 * frame) % 64); }

bool has_history(const Scene& scene, Pixel at, std::int64_t frame) {
  const Seen seen = scene.see(at, frame);
  const Pixel before = at + seen.motion;
  return frame > 1 && !scene.cuts.contains(frame) && is_inside(before) && scene.see(before, frame - 1).id == seen.id;
}

bool is_firefly(const Scene& scene, Pixel at, std::int64_t frame) {
  return at.x == kFirefly.x && at.y == kFirefly.y && scene.fireflies.contains(frame);
}

int count_new(const Scene& scene, std::int64_t frame) {
  int count = 0;
  for_each_pixel([&](Pixel at) { count += has_history(scene, at, frame) ? 0 : 1; });
  return count;
}

Seen see_moving_object(Pixel at, std::int64_t frame) {
  const bool is_object = at.x >= frame && at.x < frame + 3 && (at.y == 2 || at.y == 3);
  return is_object ? Seen{2, {-1, 0}} : Seen{1, {0, 0}};
}

std::vector<std::int64_t> first_frames(int count) {
  std::vector<std::int64_t> frames;
  for (int frame = 1; frame <= count; ++frame) frames.push_back(frame);
  return frames;
}

Item SceneSource::read(std::string_view input, std::int64_t frame, BufferPool& pool) {
  if (input == "cut") return Values{scene_.cuts.contains(frame) ? 1.0 : 0.0};
  if (input == "camera") return scene_.camera(frame);
  if (input == "id") {
    Image image(QUELL_TYPE_ID, kSize, pool);
    for_each_pixel(
        [&](Pixel at) { image.writable_ids().at(at.x, at.y) = scene_.told_by.contains("id") ? scene_.see(at, frame).id : 1; });
    return image;
  }
  Image image(input == "emission" ? QUELL_TYPE_COLOR : *port_type(input), kSize, pool);
  const FloatOutput to = image.writable_floats();
  for_each_pixel([&](Pixel at) {
    for (int c = 0; c < to.channels; ++c) to.at(at.x, at.y, c) = number(input, at, frame, c);
  });
  return image;
}

float SceneSource::number(std::string_view input, Pixel at, std::int64_t frame, int c) const {
  if (input == "color" && is_firefly(scene_, at, frame)) return 1e6F;
  if (input == "color") return (light(at, frame) + static_cast<float>(c)) * scene_.albedo + scene_.emission;
  if (input == "albedo") return scene_.albedo;
  if (input == "emission") return scene_.emission;
  if (input == "position") return scene_.position(at, frame)[static_cast<std::size_t>(c)];
  const Seen seen = scene_.see(at, frame);
  const std::uint32_t object = scene_.told_by.contains(input) ? seen.id : 1;
  if (input == "depth") return 4 * static_cast<float>(object);
  if (input == "normal") return static_cast<int>(object % 3) == c ? 1 : 0;
  return static_cast<float>(c == 0 ? seen.motion.x : seen.motion.y);
}

void KeepingSink::write(std::string_view output, std::int64_t frame, const Item& item) {
  const std::scoped_lock lock(mutex_);
  images_[{std::string(output), frame}] = *item.image();
}

float KeepingSink::at(const std::string& output, std::int64_t frame, Pixel pixel, int c) const {
  return images_.at({output, frame}).floats().at(pixel.x, pixel.y, c);
}

}  // namespace quell::scene
