// Scenes in which history lasts, ends, or was never there, through the graphs that ship.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "quell/runtime/session.h"
#include "tests/graphs/temporal_scene.h"

namespace quell::scene {
namespace {

const std::string kGraphs = QUELL_SOURCE_DIR "/graphs/";
using Settings = std::vector<std::string>;

const Registry& passes() {
  static const Registry registry = load_plugins();
  return registry;
}
std::shared_ptr<const Graph> load(const std::string& name, const GraphOptions& options = {}) {
  return load_graph(kGraphs + name + ".json", passes(), options);
}

// The same, and a number tells where a shot begins.
std::shared_ptr<const Graph> load_with_reset(const std::string& name, const GraphOptions& options = {}) {
  std::string inputs = R"("cut": "value")", in;
  const auto graph = load(name);
  for (const GraphInput& input : graph->inputs) {
    inputs += ", \"" + input.name + "\": \"" + std::string(quell::name(input.type)) + "\"";
    in += (in.empty() ? "\"" : ", \"") + input.name + "\": \"" + input.name + "\"";
  }
  const std::string text = R"({ "quell": 1, "reset": "cut", "inputs": { )" + inputs + R"( },
    "nodes": { "all": { "graph": ")" +
                           name + R"(.json", "in": { )" + in + R"( } } }, "outputs": { "color": "all.color" } })";
  return parse_graph(std::make_shared<const SourceText>(SourceText{kGraphs + "with_reset.json", text}), passes(), options);
}

void run(const std::shared_ptr<const Graph>& graph, const Scene& scene, const std::vector<std::int64_t>& frames,
         const SessionOptions& options, KeepingSink& sink) {
  SceneSource source(scene);
  for (const FrameReport& report : Session(graph, options).run(frames, source, sink)) ASSERT_TRUE(report.ok) << report.error;
}

// A graph without what filters over space, and what it then is: a mean over time in which a frame's share is 1 / length, but at
// least alpha.
struct Temporal {
  std::string graph;
  double alpha, max_length;
  std::string length;  // the image that tells it
  GraphOptions options;
};
const Temporal kTemporalOnly{"temporal_only", 0, 32, "blend.length", {}};
const Temporal kSvgf{"svgf",
                     0.2,
                     32,
                     "moments.length",
                     {.set = {"variance.filter_color=false"}, .bypass = {"level4", "level3", "level2", "level1", "level0"}}};

// What is remembered of a pixel: the light's plane 0, since the others differ from it by 1 and 2 also in any mean.
struct Memory {
  double light = 0, length = 1;
};

// Frame after frame in double precision.
class Model {
 public:
  Model(const Scene& scene, const Temporal& temporal, bool rescue) : scene_(scene), temporal_(temporal), rescue_(rescue) {}

  // Of frames from 1 on, each of them once.
  void advance(std::int64_t frame) {
    const std::vector<Memory> before = now_;
    now_.clear();
    for_each_pixel([&](Pixel at) {
      const std::optional<Memory> history = look_back(before, at, frame);
      const double length = history ? std::min(temporal_.max_length, history->length + 1) : 1;
      const double alpha = history ? std::max(temporal_.alpha, 1 / length) : 1;
      now_.push_back({alpha * light(at, frame) + (history ? (1 - alpha) * history->light : 0), length});
    });
  }
  const Memory& at(Pixel pixel) const { return now_[index(pixel)]; }

  // Where the point was; or, where something else was seen there, the mean of the 3 x 3 pixels that show the same object.
  std::optional<Memory> look_back(const std::vector<Memory>& memories, Pixel at, std::int64_t frame) const {
    if (frame == 1 || scene_.cuts.contains(frame)) return std::nullopt;
    const Seen seen = scene_.see(at, frame);
    const Pixel before = at + seen.motion;
    const auto is_same = [&](Pixel tap) { return is_inside(tap) && scene_.see(tap, frame - 1).id == seen.id; };
    if (is_same(before)) return memories[index(before)];
    Memory sum{0, 0};
    int count = 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Pixel tap = before + Pixel{dx, dy};
        if (!rescue_ || !is_same(tap)) continue;
        sum.light += memories[index(tap)].light, sum.length += memories[index(tap)].length, ++count;
      }
    if (count == 0) return std::nullopt;
    return Memory{sum.light / count, sum.length / count};
  }

 private:
  static std::size_t index(Pixel at) { return static_cast<std::size_t>(at.y * kSize.width + at.x); }
  const Scene& scene_;
  const Temporal& temporal_;
  bool rescue_;
  std::vector<Memory> now_;
};

// Nothing is negative, so that errors are relative. A frame adds at most: of the mean of nine pixels, ten roundings in light and
// in length, and of the blend four; then two in the color.
constexpr double relative_error(int frames) { return (24 * frames + 2) * 0x1p-24; }

void expect_color(float got, const Scene& scene, const Memory& want, int c, int frames) {
  const double color = (want.light + c) * scene.albedo + scene.emission;
  if (want.length == 1)
    EXPECT_EQ(got, color);
  else
    EXPECT_NEAR(got, color, relative_error(frames) * color);
}

void expect_model(const Scene& scene, Temporal temporal, bool rescue, const SessionOptions& session, bool with_reset) {
  if (!rescue) temporal.options.set.push_back("reproject.rescue=none");
  SessionOptions options = session;
  options.dumps = {temporal.length};
  if (with_reset) {
    for (std::string& set : temporal.options.set) set = "all." + set;
    for (std::string& node : temporal.options.bypass) node = "all." + node;
    options.dumps = {"all." + temporal.length};
  }
  KeepingSink sink;
  const auto graph = with_reset ? load_with_reset(temporal.graph, temporal.options) : load(temporal.graph, temporal.options);
  ASSERT_NO_FATAL_FAILURE(run(graph, scene, first_frames(kFrames), options, sink));
  Model model(scene, temporal, rescue);
  for (int frame = 1; frame <= kFrames; ++frame) {
    model.advance(frame);
    for_each_pixel([&](Pixel at) {
      SCOPED_TRACE("frame " + std::to_string(frame) + ", pixel " + std::to_string(at.x) + ", " + std::to_string(at.y));
      const Memory& want = model.at(at);
      for (int c = 0; c < 3; ++c) expect_color(sink.at("color", frame, at, c), scene, want, c, frame);
      EXPECT_NEAR(sink.at(options.dumps[0], frame, at), want.length, relative_error(frame) * want.length);
    });
    if (testing::Test::HasFailure()) return;
  }
}

// In both graphs, with and without the rescue, told by each guide alone. Albedo and emission are such that light is exact.
void expect_model(Scene scene, const SessionOptions& options = {}, bool with_reset = false) {
  scene.albedo = 0.5F, scene.emission = 3;
  for (const char* guide : {"id", "depth", "normal"})
    for (const Temporal& temporal : {kTemporalOnly, kSvgf})
      for (const bool rescue : {true, false}) {
        SCOPED_TRACE(temporal.graph + ", told by " + guide + (rescue ? ", with rescue" : ""));
        scene.told_by = {guide};
        expect_model(scene, temporal, rescue, options, with_reset);
        if (testing::Test::HasFailure()) return;
      }
}

TEST(ShippedScenes, AStaticSceneBeginsWithItsFirstFrameAndHasTheMeanOfAll) { expect_model({at_rest}); }

TEST(ShippedScenes, TheMeanReachesBackAsFarAsItIsTold) {
  Temporal three = kTemporalOnly;
  three.options.set = {"max_length=3"}, three.max_length = 3;
  expect_model({at_rest}, three, true, {}, false);
}

TEST(ShippedScenes, AStaticSceneOf64FramesHasTheirMean) {
  const Scene scene{at_rest};
  KeepingSink sink;
  ASSERT_NO_FATAL_FAILURE(run(load("temporal_only", {.set = {"max_length=64"}}), scene, first_frames(64), {}, sink));
  for_each_pixel([&](Pixel at) {
    double sum = 0;
    for (const std::int64_t frame : first_frames(64)) sum += light(at, frame);
    EXPECT_NEAR(sink.at("color", 64, at), sum / 64, 1e-5 * sum / 64) << at.x << ", " << at.y;
  });
}

TEST(ShippedScenes, AMovingCameraBeginsAnewWhereItWasOffTheScreen) {
  const Scene scene{[](Pixel, std::int64_t) { return Seen{1, {2, -2}}; }};
  EXPECT_EQ(count_new(scene, 2), 2 * kSize.height + 2 * kSize.width - 4)
      << "two columns on the right, and the two uppermost rows";
  expect_model(scene);
}

TEST(ShippedScenes, AMovingObjectTakesItsHistoryAlong) {
  const Scene scene{see_moving_object};
  EXPECT_EQ(count_new(scene, 2), 2) << "the pixels that the object has left";
  expect_model(scene);
}

TEST(ShippedScenes, WhatAnObjectUncoversIsRescuedByThePixelsAround) {
  const Scene scene{see_moving_object};
  KeepingSink sink;
  ASSERT_NO_FATAL_FAILURE(run(load("temporal_only"), scene, {1, 2}, {.dumps = {"blend.length"}}, sink));
  // Of those around (1, 2), the object was at (1, 2), (2, 2), (1, 3) and (2, 3).
  const double around = (light({0, 1}, 1) + light({1, 1}, 1) + light({2, 1}, 1) + light({0, 2}, 1) + light({0, 3}, 1)) / 5;
  const double want = (light({1, 2}, 2) + around) / 2;
  EXPECT_NEAR(sink.at("color", 2, {1, 2}), want, relative_error(2) * want);
  EXPECT_NEAR(sink.at("blend.length", 2, {1, 2}), 2, relative_error(2) * 2);
}

TEST(ShippedScenes, AnotherObjectInTheSamePlaceHasNoHistory) {
  const Scene scene{[](Pixel at, std::int64_t frame) { return Seen{at.x < 5 && frame >= 4 ? 2U : 1U, {0, 0}}; }};
  EXPECT_EQ(count_new(scene, 4), 5 * kSize.height);
  EXPECT_EQ(count_new(scene, 5), 0);
  expect_model(scene);
}

TEST(ShippedScenes, NothingLastsBeyondACut) { expect_model({.see = see_moving_object, .cuts = {4}}, {.cuts = {4}}); }

TEST(ShippedScenes, NothingLastsBeyondTheFrameWhoseNumberSaysSo) {
  expect_model({.see = see_moving_object, .cuts = {3, 5}}, {}, true);
  expect_model({see_moving_object}, {}, true);
}

// The whole graphs, filters over space included.
class WholeGraph : public testing::TestWithParam<const char*> {
 protected:
  // Whether the color of a frame is the same, bit for bit.
  static bool is_same(const KeepingSink& a, const KeepingSink& b, std::int64_t frame) {
    bool is_same = true;
    for_each_pixel([&](Pixel at) {
      for (int c = 0; c < 3; ++c) is_same = is_same && a.at("color", frame, at, c) == b.at("color", frame, at, c);
    });
    return is_same;
  }
  // Every frame is what it is when it is the first.
  static void expect_no_history(const Scene& scene) {
    KeepingSink sequence;
    ASSERT_NO_FATAL_FAILURE(run(load(GetParam()), scene, first_frames(kFrames), {}, sequence));
    for (const std::int64_t frame : first_frames(kFrames)) {
      KeepingSink alone;
      ASSERT_NO_FATAL_FAILURE(run(load(GetParam()), scene, {frame}, {}, alone));
      EXPECT_TRUE(is_same(sequence, alone, frame)) << "frame " << frame;
    }
  }
};
const std::set<std::string, std::less<>> kAll = {"id", "depth", "normal"};

TEST_P(WholeGraph, BeginsAnewAtACut) {
  const Scene scene{.see = see_moving_object, .cuts = {4}, .told_by = kAll};
  KeepingSink uncut, cut, reset, fresh;
  ASSERT_NO_FATAL_FAILURE(run(load(GetParam()), scene, first_frames(kFrames), {}, uncut));
  ASSERT_NO_FATAL_FAILURE(run(load(GetParam()), scene, first_frames(kFrames), {.cuts = {4}}, cut));
  ASSERT_NO_FATAL_FAILURE(run(load_with_reset(GetParam()), scene, first_frames(kFrames), {}, reset));
  ASSERT_NO_FATAL_FAILURE(run(load(GetParam()), scene, {4, 5, 6}, {}, fresh));
  for (const std::int64_t frame : {1, 2, 3}) {
    EXPECT_TRUE(is_same(cut, uncut, frame)) << "frame " << frame;
    EXPECT_TRUE(is_same(reset, uncut, frame)) << "frame " << frame;
  }
  for (const std::int64_t frame : {4, 5, 6}) {
    EXPECT_TRUE(is_same(cut, fresh, frame)) << "frame " << frame;
    EXPECT_TRUE(is_same(reset, fresh, frame)) << "frame " << frame;
    EXPECT_FALSE(is_same(uncut, fresh, frame)) << "frame " << frame;
  }
}

TEST_P(WholeGraph, HasNoHistoryOfWhatWasOffTheScreen) {
  expect_no_history({[](Pixel, std::int64_t) { return Seen{1, {kSize.width + 1, 0}}; }});
}

TEST_P(WholeGraph, HasNoHistoryOfOtherSurfaces) {
  const auto always_new = [](Pixel, std::int64_t frame) { return Seen{static_cast<std::uint32_t>(frame), {0, 0}}; };
  expect_no_history({.see = always_new, .told_by = {"normal"}});
}

INSTANTIATE_TEST_SUITE_P(Shipped, WholeGraph, testing::Values("svgf", "svgf_falcor", "temporal_only"),
                         [](const auto& graph) { return std::string(graph.param); });

}  // namespace
}  // namespace quell::scene
