// Graphs that look for a pixel in frames before and after, and beside what hid it: motion is whole pixels, so that every pixel is
// known exactly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "quell/runtime/session.h"

namespace quell {
namespace {

constexpr Size kSize{24, 5};
constexpr int kFrames = 6;  // from 1 on

// A screen that shows world (x, y, 0) at (x - offset, y); object 2 has moved by `bar`.
Camera flat_camera(double offset, double bar) {
  Camera camera;
  camera.size = kSize;
  camera.world_to_camera = {1, 0, 0, -offset, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  camera.world_to_screen = camera.world_to_camera;
  camera.object_to_world[2] = {1, 0, 0, bar, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  return camera;
}

// Of pixel (x, y) in a frame.
struct Scene {
  std::function<Camera(std::int64_t frame)> camera;
  std::function<std::uint32_t(int x, int y, std::int64_t frame)> id;
  std::function<float(int x, int y, std::int64_t frame)> color;
  std::function<double(int x, std::int64_t frame)> world_x;
};

class SceneSource final : public FrameSource {
 public:
  explicit SceneSource(const Scene& scene) : scene_(scene) {}

  std::optional<Shape> shape(std::string_view input) override { return shape_of(read(input, 1, pool_)); }
  Item read(std::string_view input, std::int64_t frame, BufferPool& pool) override {
    if (input == "camera") return scene_.camera(frame);
    Image image(*port_type(input), kSize, pool);
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) fill(image, x, y, frame);
    return image;
  }

 private:
  void fill(Image& image, int x, int y, std::int64_t frame) const {
    if (image.type() == QUELL_TYPE_ID) {
      image.writable_ids().at(x, y) = scene_.id(x, y, frame);
      return;
    }
    for (int c = 0; c < 3; ++c)
      image.writable_floats().at(x, y, c) = image.type() == QUELL_TYPE_COLOR ? scene_.color(x, y, frame) + static_cast<float>(c)
                                            : c == 0                         ? static_cast<float>(scene_.world_x(x, frame) + 0.5)
                                            : c == 1                         ? static_cast<float>(y) + 0.5F
                                                                             : 0.0F;
  }
  const Scene& scene_;
  BufferPool pool_;
};

class KeepingSink final : public FrameSink {
 public:
  void write(std::string_view output, std::int64_t frame, const Item& item) override {
    const std::scoped_lock lock(mutex_);
    images_[{std::string(output), frame}] = *item.image();
  }
  FloatImage image(const std::string& output, std::int64_t frame) const { return images_.at({output, frame}).floats(); }

 private:
  std::map<std::pair<std::string, std::int64_t>, Image> images_;
  std::mutex mutex_;
};

void run(const std::string& text, const Scene& scene, KeepingSink& sink) {
  static const Registry passes = load_plugins();
  const auto graph = parse_graph(std::make_shared<const SourceText>(SourceText{"scene.json", text}), passes);
  SceneSource source(scene);
  std::vector<std::int64_t> frames;
  for (int frame = 1; frame <= kFrames; ++frame) frames.push_back(frame);
  for (const FrameReport& report : Session(graph, {.threads = 2, .frames_in_flight = 3}).run(frames, source, sink))
    ASSERT_TRUE(report.ok) << report.error;
}

constexpr const char* kInputs =
    R"({ "quell": 1, "inputs": { "color": "color", "position": "position", "id": "id", "camera": "camera" }, "nodes": {)";

std::string delayed(const std::string& input, int delay, const std::string& initial = "\"none\"") {
  return R"({ "from": ")" + input + R"(", "delay": )" + std::to_string(delay) + R"(, "initial": )" + initial + " }";
}

// The frame that is `delay` frames ago, at this frame's pixels.
std::string aligned(const std::string& name, int delay) {
  return "\"motion_" + name + R"(": { "pass": "back_project", "in": { "position": "position", "id": "id", "camera": "camera",
      "previous_camera": )" +
         delayed("camera", delay) + " } }, \"" + name + R"(": { "pass": "reproject", "in": { "history": [)" +
         delayed("color", delay) + R"(], "motion": "motion_)" + name + R"(.motion", "id": "id", "previous_id": )" +
         delayed("id", delay) + " } },";
}

// The camera passes a wall by two pixels a frame; the wall's light is another in each.
TEST(BothWays, TheWindowIsTheMeanOfAllFramesThatShowThePoint) {
  const auto light = [](double x, int y, std::int64_t frame) {
    return static_cast<float>((7 * static_cast<int>(x) + 13 * y + 29 * static_cast<int>(frame)) % 64);
  };
  const auto world_x = [](int x, std::int64_t frame) { return x + 2.0 * static_cast<double>(frame); };
  const Scene scene{.camera = [](std::int64_t frame) { return flat_camera(2.0 * static_cast<double>(frame), 0); },
                    .id = [](int, int, std::int64_t) { return 1U; },
                    .color = [&](int x, int y, std::int64_t frame) { return light(world_x(x, frame), y, frame); },
                    .world_x = world_x};
  const std::string text = kInputs + aligned("before2", 2) + aligned("before1", 1) + aligned("after1", -1) +
                           aligned("after2", -2) + R"("window": { "pass": "window", "in": { "color": "color",
      "frames": ["before2.history[0]", "before1.history[0]", "after1.history[0]", "after2.history[0]"],
      "valid": ["before2.valid", "before1.valid", "after1.valid", "after2.valid"] } } },
    "outputs": { "color": "window.color", "length": "window.length" } })";
  KeepingSink sink;
  run(text, scene, sink);
  for (int frame = 1; frame <= kFrames; ++frame)
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        double sum = 0, count = 0;
        for (int other = std::max(frame - 2, 1); other <= std::min(frame + 2, kFrames); ++other) {
          const int there = x + 2 * (frame - other);
          if (there < 0 || there >= kSize.width) continue;
          sum += light(world_x(x, frame), y, other), count += 1;
        }
        // Two roundings of up to 66.
        ASSERT_NEAR(sink.image("color", frame).at(x, y, 2), sum / count + 2, 1.2e-5) << frame << ": " << x << "," << y;
        ASSERT_EQ(sink.image("length", frame).at(x, y), count) << frame << ": " << x << "," << y;
      }
}

// A bar of five pixels passes a wall by three pixels a frame. What it lays bare has no history of its own, and finds the wall
// that was beside the bar, which a frame ago was three pixels to the left.
TEST(BothWays, DualMotionFindsTheWallBesideWhatHidIt) {
  const auto is_bar = [](int x, std::int64_t frame) { return x >= 3 * frame && x < 3 * frame + 5; };
  const Scene scene{.camera = [](std::int64_t frame) { return flat_camera(0, 3.0 * static_cast<double>(frame)); },
                    .id = [&](int x, int, std::int64_t frame) { return is_bar(x, frame) ? 2U : 1U; },
                    .color = [](int x, int y, std::int64_t) { return static_cast<float>(x + 100 * y); },
                    .world_x = [](int x, std::int64_t) { return x; }};
  const std::string previous_id = delayed("id", 1);
  const std::string text =
      kInputs + aligned("first", 1) + R"("forward": { "pass": "back_project", "in": { "position": )" +
      delayed("position", 1, R"({ "from": "position" })") + R"(, "id": )" + delayed("id", 1, R"({ "from": "id" })") +
      R"(, "camera": )" + delayed("camera", 1, R"({ "from": "camera" })") + R"(, "previous_camera": "camera" } },
    "dual": { "pass": "dual_motion", "in": { "motion": "motion_first.motion", "valid": "first.valid",
      "forward_motion": "forward.motion", "previous_id": )" +
      previous_id + R"( } },
    "second": { "pass": "reproject", "in": { "history": [)" +
      delayed("color", 1) + R"(], "motion": "dual.motion", "id": "id", "previous_id": )" + previous_id + R"( } } },
    "outputs": { "color": "second.history[0]", "valid": "second.valid", "dual": "dual.dual", "first": "first.valid" } })";
  KeepingSink sink;
  run(text, scene, sink);
  for (int frame = 2; frame <= kFrames; ++frame)
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        const bool laid_bare = !is_bar(x, frame) && is_bar(x, frame - 1);
        const int there = is_bar(x, frame) || laid_bare ? x - 3 : x;
        ASSERT_EQ(sink.image("first", frame).at(x, y), laid_bare ? 0.0F : 1.0F) << frame << ": " << x << "," << y;
        ASSERT_EQ(sink.image("dual", frame).at(x, y), laid_bare ? 1.0F : 0.0F) << frame << ": " << x << "," << y;
        ASSERT_EQ(sink.image("valid", frame).at(x, y), 1.0F) << frame << ": " << x << "," << y;
        ASSERT_EQ(sink.image("color", frame).at(x, y), static_cast<float>(there + 100 * y)) << frame << ": " << x << "," << y;
      }
}

}  // namespace
}  // namespace quell
