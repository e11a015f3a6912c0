// What accumulation over time must do where history ends, and where it must not: small scenes whose motion is whole pixels, so
// that every pixel is known exactly.
#include <gtest/gtest.h>

#include "quell/runtime/session.h"
#include "tests/graphs/temporal_scene.h"

namespace quell::scene {
namespace {

constexpr double kAlpha = 0.25;  // sums of a few frames' whole numbers are exact

// Plane c. What is too bright counts as black.
double expected(const Scene& scene, Pixel at, std::int64_t frame, int c) {
  const double now = is_firefly(scene, at, frame) ? 0 : double{light(at, frame)} + c;
  if (!has_history(scene, at, frame)) return now;
  return kAlpha * now + (1 - kAlpha) * expected(scene, at + scene.see(at, frame).motion, frame - 1, c);
}

const std::string kReproject = R"(
    "reproject": { "pass": "reproject", "in": {
      "history": [{ "from": "blend.color", "delay": 1, "initial": "none" }], "motion": "MOTION",
      "id": "id", "previous_id": { "from": "id", "delay": 1, "initial": "none" } } },
    "blend": { "pass": "temporal_blend",
      "in": { "color": "COLOR", "history": "reproject.history[0]", "valid": "reproject.valid" },
      "params": { "alpha": 0.25, "clamp": "none" } } },
  "outputs": { "color": "blend.color" })";

std::string reproject(const std::string& motion, const std::string& color = "color") {
  std::string text = kReproject;
  text.replace(text.find("MOTION"), 6, motion);
  return text.replace(text.find("COLOR"), 5, color);
}

// Motion comes with the frames.
const std::string kGiven =
    R"({ "quell": 1, "inputs": { "color": "color", "motion": "motion", "id": "id" }, "nodes": {)" + reproject("motion") + "}";
// The same, and a number tells where a shot begins.
const std::string kGivenWithCut =
    R"({ "quell": 1, "inputs": { "color": "color", "motion": "motion", "id": "id", "cut": "value" }, "reset": "cut", "nodes": {)" +
    reproject("motion") + "}";
// Fireflies are taken out, and a frame that has one begins anew.
const std::string kGuarded = R"({ "quell": 1, "inputs": { "color": "color", "motion": "motion", "id": "id" },
  "reset": "guard.count",
  "nodes": { "guard": { "pass": "sanitize", "in": { "color": "color" }, "params": { "max": 1000 } },)" +
                             reproject("motion", "guard.color") + "}";
// Motion is found from positions and matrices.
const std::string kFound = R"({ "quell": 1,
  "inputs": { "color": "color", "position": "position", "id": "id", "camera": "camera" },
  "nodes": { "motion": { "pass": "back_project", "in": { "position": "position", "id": "id", "camera": "camera",
      "previous_camera": { "from": "camera", "delay": 1, "initial": "none" } } },)" +
                           reproject("motion.motion") + "}";

std::shared_ptr<const Graph> parse(const std::string& text) {
  static const Registry passes = load_plugins();
  return parse_graph(std::make_shared<const SourceText>(SourceText{"scene.json", text}), passes);
}

// Plain means of colors, of luminance and its square, and how many frames they are of.
const std::string kMeans = R"({ "quell": 1, "inputs": { "color": "color", "motion": "motion", "id": "id", "cut": "value" },
  "reset": "cut",
  "nodes": {
    "seen": { "pass": "reproject", "in": { "history": [{ "from": "blend.color", "delay": 1, "initial": "none" }],
      "motion": "motion", "id": "id", "previous_id": { "from": "id", "delay": 1, "initial": "none" } } },
    "counted": { "pass": "reproject", "in": { "history": [{ "from": "blend.length", "delay": 1, "initial": "none" }],
      "motion": "motion", "id": "id", "previous_id": { "from": "id", "delay": 1, "initial": "none" } } },
    "integrated": { "pass": "reproject", "in": { "history": [{ "from": "moments.moments", "delay": 1, "initial": "none" }],
      "motion": "motion", "id": "id", "previous_id": { "from": "id", "delay": 1, "initial": "none" } } },
    "blend": { "pass": "temporal_blend",
      "in": { "color": "color", "history": "seen.history[0]", "valid": "seen.valid", "length": "counted.history[0]" },
      "params": { "alpha": 0, "max_length": 64, "clamp": "none" } },
    "moments": { "pass": "moments",
      "in": { "color": "color", "history": "integrated.history[0]", "valid": "seen.valid", "length": "counted.history[0]" },
      "params": { "alpha": 0, "max_length": 64 } } },
  "outputs": { "mean": "blend.color", "length": "blend.length", "moments": "moments.moments" } })";

// Every pixel of every frame, node after node and with everything at a time.
void expect_exact(const std::string& text, const Scene& scene, std::vector<std::int64_t> cuts = {}) {
  const auto graph = parse(text);
  SessionOptions serial{.threads = 1, .schedule = Schedule::serial, .cuts = cuts};
  SessionOptions concurrent{.threads = 4, .frames_in_flight = 4, .cuts = cuts};
  for (const SessionOptions& options : {serial, concurrent}) {
    SceneSource source(scene);
    KeepingSink sink;
    const std::vector<std::int64_t> frames = first_frames(kFrames);
    for (const FrameReport& report : Session(graph, options).run(frames, source, sink)) ASSERT_TRUE(report.ok) << report.error;
    for (const std::int64_t frame : frames)
      for_each_pixel([&](Pixel at) {
        for (int c = 0; c < 3; ++c)
          EXPECT_EQ(sink.at("color", frame, at, c), static_cast<float>(expected(scene, at, frame, c)))
              << "frame " << frame << ", pixel " << at.x << ", " << at.y << ", plane " << c;
      });
    if (testing::Test::HasFailure()) return;
  }
}

struct Sums {
  double length = 0, color = 0, luminance = 0, square = 0;
};
// Of all frames in which the point was seen.
Sums sum(const Scene& scene, Pixel at, std::int64_t frame) {
  Sums sums;
  if (has_history(scene, at, frame)) sums = sum(scene, at + scene.see(at, frame).motion, frame - 1);
  const double value = light(at, frame), l = value + 0.7152 + 2 * 0.0722;  // the planes are value + 0, 1, 2
  return {sums.length + 1, sums.color + value, sums.luminance + l, sums.square + l * l};
}

// Of a frame's four roundings (1 - a, two products, a sum) the error E is n E(n) <= (n - 1) E(n - 1) + 4 n 2^-24, so that E(n) is
// at most n 2^-23; and a luminance and its square have up to four of their own.
constexpr double relative_error(int frames) { return frames * 0x1p-23 + 0x1p-22; }

void expect_means(const Scene& scene, int count = kFrames) {
  SceneSource source(scene);
  KeepingSink sink;
  const std::vector<std::int64_t> frames = first_frames(count);
  for (const FrameReport& report : Session(parse(kMeans), {.threads = 2}).run(frames, source, sink))
    ASSERT_TRUE(report.ok) << report.error;
  const double error = relative_error(count);
  for (const std::int64_t frame : frames)
    for_each_pixel([&](Pixel at) {
      const Sums want = sum(scene, at, frame);
      const std::string where =
          "frame " + std::to_string(frame) + ", pixel " + std::to_string(at.x) + ", " + std::to_string(at.y);
      const auto expect_near = [&](float got, double mean) { EXPECT_NEAR(got, mean, error * mean) << where; };
      EXPECT_EQ(sink.at("length", frame, at), want.length) << where;
      expect_near(sink.at("mean", frame, at), want.color / want.length);
      expect_near(sink.at("moments", frame, at, 0), want.luminance / want.length);
      expect_near(sink.at("moments", frame, at, 1), want.square / want.length);
    });
}

Camera flat_camera(double x) {
  Camera camera;
  camera.size = kSize;
  camera.world_to_camera = {1, 0, 0, -x, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  camera.world_to_screen = camera.world_to_camera;
  return camera;
}

TEST(TemporalScenes, TheFirstFrameIsWhatWasRendered) {
  const Scene scene{at_rest};
  EXPECT_EQ(count_new(scene, 1), kSize.width * kSize.height);
  expect_exact(kGiven, scene);
  expect_means(scene);
}

TEST(TemporalScenes, AStaticSceneHasTheGeometricMeanOfItsFrames) {
  const Scene scene{at_rest};
  EXPECT_EQ(count_new(scene, 2), 0);
  double sum = light({4, 3}, 1);
  for (int frame = 2; frame <= kFrames; ++frame) sum = sum * 0.75 + 0.25 * light({4, 3}, frame);
  EXPECT_EQ(expected(scene, {4, 3}, kFrames, 0), sum);
  expect_exact(kGiven, scene);
  expect_means(scene);
}

TEST(TemporalScenes, AStaticSceneOf64FramesHasTheirMean) {
  const Scene scene{at_rest};
  static_assert(relative_error(64) < 1e-5);
  expect_means(scene, 64);
}

TEST(TemporalScenes, AMovingCameraKeepsHistoryAndBeginsAnewWhereItWasOffTheScreen) {
  const Scene scene{[](Pixel, std::int64_t) { return Seen{1, {2, -1}}; }};
  EXPECT_EQ(count_new(scene, 2), 2 * kSize.height + kSize.width - 2) << "two columns on the right, and the uppermost row";
  expect_exact(kGiven, scene);
  expect_means(scene);
}

TEST(TemporalScenes, AMovingCameraIsFoundFromItsMatrices) {
  const Scene scene{.see =
                        [](Pixel, std::int64_t) {
                          return Seen{1, {2, 0}};
                        },
                    .camera = [](std::int64_t frame) { return flat_camera(2.0 * static_cast<double>(frame)); },
                    .position =
                        [](Pixel at, std::int64_t frame) {
                          return std::array{static_cast<float>(at.x) + 0.5F + 2 * static_cast<float>(frame),
                                            static_cast<float>(at.y) + 0.5F, 5.0F};
                        }};
  EXPECT_EQ(count_new(scene, 2), 2 * kSize.height);
  expect_exact(kFound, scene);
}

TEST(TemporalScenes, AMovingObjectTakesItsHistoryAlongAndUncoversWhatHasNone) {
  const Scene scene{see_moving_object};
  EXPECT_EQ(count_new(scene, 2), 2) << "the pixels that the object has left: what is there was not seen before";
  expect_exact(kGiven, scene);
  expect_means(scene);
}

TEST(TemporalScenes, AMovingObjectIsFoundFromItsMatrix) {
  const auto camera = [](std::int64_t frame) {
    Camera still = flat_camera(0);
    still.object_to_world[1] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    still.object_to_world[2] = {1, 0, 0, static_cast<double>(frame), 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    return still;
  };
  const Scene scene{.see = see_moving_object, .camera = camera, .position = [](Pixel at, std::int64_t) {
                      return std::array{static_cast<float>(at.x) + 0.5F, static_cast<float>(at.y) + 0.5F, 5.0F};
                    }};
  expect_exact(kFound, scene);
}

TEST(TemporalScenes, AnotherObjectInTheSamePlaceHasNoHistory) {
  const Scene scene{[](Pixel at, std::int64_t frame) { return Seen{at.x < 5 && frame >= 4 ? 7U : 1U, {0, 0}}; }};
  EXPECT_EQ(count_new(scene, 4), 5 * kSize.height);
  EXPECT_EQ(count_new(scene, 5), 0);
  expect_exact(kGiven, scene);
  expect_means(scene);
}

TEST(TemporalScenes, NothingLastsBeyondACut) {
  const Scene scene{.see = see_moving_object, .cuts = {4}};
  EXPECT_EQ(count_new(scene, 4), kSize.width * kSize.height);
  expect_exact(kGiven, scene, {4});
}

TEST(TemporalScenes, NothingLastsBeyondTheFrameWhoseNumberSaysSo) {
  const Scene scene{.see = see_moving_object, .cuts = {3, 5}};
  expect_exact(kGivenWithCut, scene);
  expect_means(scene);
  const Scene uncut{see_moving_object};
  expect_exact(kGivenWithCut, uncut);
}

TEST(TemporalScenes, NothingLastsBeyondAFrameInWhichPixelsHadToBeReplaced) {
  const Scene scene{.see = see_moving_object, .cuts = {3, 5}, .fireflies = {3, 5}};
  expect_exact(kGuarded, scene);
  const Scene clean{see_moving_object};
  expect_exact(kGuarded, clean);
}

}  // namespace
}  // namespace quell::scene
