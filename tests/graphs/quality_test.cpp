// How near the graphs that ship come to a reference, and what fireflies do to the best of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "quell/metrics/comparison.h"
#include "quell/runtime/session.h"
#include "quell/sequence/sequence.h"

namespace quell {
namespace {

namespace fs = std::filesystem;

const fs::path kRoom = QUELL_SOURCE_DIR "/../shared/data/room";
const fs::path kSample = QUELL_SOURCE_DIR "/graphs/sample";

class ColorSink final : public FrameSink {
 public:
  std::map<std::int64_t, Image> colors;
  void write(std::string_view output, std::int64_t frame, const Item& item) override {
    if (output == "color") colors[frame] = *item.image();
  }
};

// One pixel in a thousand of the color is 1000, elsewhere in each frame.
class Fireflies final : public FrameSource {
 public:
  explicit Fireflies(FrameSource& source) : source_(source) {}
  std::optional<Shape> shape(std::string_view input) override { return source_.shape(input); }
  Item read(std::string_view input, std::int64_t frame, BufferPool& pool) override {
    const Item item = source_.read(input, frame, pool);
    if (input != "color") return item;
    Image bright(QUELL_TYPE_COLOR, item.image()->size(), pool);
    const FloatImage from = item.image()->floats();
    const FloatOutput to = bright.writable_floats();
    for (int c = 0; c < from.channels; ++c)
      for (int y = 0; y < from.height; ++y)
        for (int x = 0; x < from.width; ++x) to.at(x, y, c) = is_firefly(x, y, frame) ? 1000.0F : from.at(x, y, c);
    return bright;
  }
  static bool is_firefly(int x, int y, std::int64_t frame) {
    std::uint64_t hash =
        (static_cast<std::uint64_t>(frame) << 40) ^ (static_cast<std::uint64_t>(y) << 20) ^ static_cast<std::uint64_t>(x);
    for (int i = 0; i < 3; ++i) hash = (hash ^ (hash >> 29)) * 0x9e3779b97f4a7c15U;
    return (hash >> 32) % 1000 == 0;
  }

 private:
  FrameSource& source_;
};

// From a frame on there is a quarter of the light: in what is rendered and in what it should be.
class Dimmed final : public FrameSource {
 public:
  static constexpr std::int64_t kFirst = 5;
  explicit Dimmed(FrameSource& source) : source_(source) {}
  std::optional<Shape> shape(std::string_view input) override { return source_.shape(input); }
  Item read(std::string_view input, std::int64_t frame, BufferPool& pool) override {
    Item item = source_.read(input, frame, pool);
    if (frame < kFirst || !item.image() || item.image()->type() != QUELL_TYPE_COLOR) return item;
    Image dark(QUELL_TYPE_COLOR, item.image()->size(), pool);
    const FloatImage from = item.image()->floats();
    const FloatOutput to = dark.writable_floats();
    for (int c = 0; c < from.channels; ++c)
      for (int y = 0; y < from.height; ++y)
        for (int x = 0; x < from.width; ++x) to.at(x, y, c) = 0.25F * from.at(x, y, c);
    return dark;
  }

 private:
  FrameSource& source_;
};

enum class Change { none, fireflies, dimmed };

struct Figures {
  double psnr, flip, warped;
};

// Of frames first to last of a run from frame 1 on.
Figures measure(const std::string& name, const fs::path& folder, std::int64_t first, std::int64_t last,
                Change change = Change::none) {
  const Registry passes = load_plugins();
  const auto graph = load_graph(QUELL_SOURCE_DIR "/graphs/" + name + ".json", passes);
  const auto sequence = Sequence::open(folder);
  for (const GraphInput& input : graph->inputs) sequence->expect(input.name, input.type);
  Fireflies fireflies(*sequence);
  Dimmed dimmed(*sequence);
  ColorSink sink;
  std::vector<std::int64_t> frames;
  for (std::int64_t frame = 1; frame <= last; ++frame) frames.push_back(frame);
  Session session(graph);
  FrameSource& shown = change == Change::dimmed ? static_cast<FrameSource&>(dimmed) : *sequence;
  FrameSource& source = change == Change::fireflies ? static_cast<FrameSource&>(fireflies) : shown;
  for (const FrameReport& report : session.run(frames, source, sink)) EXPECT_TRUE(report.ok) << report.error;

  BufferPool pool;
  const auto reference = [&](std::int64_t frame) { return *shown.read("reference", frame, pool).image(); };
  const CompareOptions options{.metrics = {Metric::psnr, Metric::flip, Metric::warped}, .display = DisplayTransform::reinhard};
  Score scores[3];
  for (std::int64_t frame = first; frame <= last; ++frame) {
    CompareInput input{{reference(frame), sink.colors.at(frame)}, {}, *sequence->read("motion", frame, pool).image()};
    if (frame > first) input.previous = ImagePair{reference(frame - 1), sink.colors.at(frame - 1)};
    const FrameScores frame_scores = compare(input, options, false, pool);
    for (std::size_t i = 0; i < 3; ++i) scores[i] += frame_scores.scores[i];
  }
  const Figures figures{value(Metric::psnr, scores[0]), value(Metric::flip, scores[1]), value(Metric::warped, scores[2])};
  const char* const titles[] = {"", " with fireflies", " dimmed"};
  std::printf("%s%s: %.2f dB, FLIP %.4f, warped %+.5f\n", name.c_str(), titles[static_cast<int>(change)], figures.psnr,
              figures.flip, figures.warped);
  return figures;
}

TEST(Quality, GraphsReachItOnTheRoom) {
  if (!fs::exists(kRoom)) GTEST_SKIP() << "the rendered room is not there: " << kRoom;
  const auto on_the_room = [](const char* graph) { return measure(graph, kRoom, 2, 12); };
  const Figures svgf = on_the_room("svgf"), best = on_the_room("best");
  EXPECT_GE(best.psnr, svgf.psnr + 1.5);
  EXPECT_LT(best.flip, svgf.flip);
  EXPECT_LT(std::abs(best.warped), std::abs(svgf.warped));
  EXPECT_GT(on_the_room("offline").psnr, best.psnr);
  EXPECT_LT(on_the_room("relax_lite").flip, svgf.flip);
}

// Nothing was tuned on these frames.
TEST(Quality, BestIsBestOnTheSampleToo) {
  EXPECT_GE(measure("best", kSample, 2, 8).psnr, measure("svgf", kSample, 2, 8).psnr + 1.5);
}

TEST(Quality, BestBearsFireflies) {
  int count = 0;
  for (int y = 0; y < 180; ++y)
    for (int x = 0; x < 320; ++x) count += Fireflies::is_firefly(x, y, 1) ? 1 : 0;
  EXPECT_NEAR(count, 57.6, 25) << "one in a thousand";
  const double clean = measure("best", kSample, 1, 8).psnr, with = measure("best", kSample, 1, 8, Change::fireflies).psnr;
  EXPECT_GE(with, clean - 0.5);
  EXPECT_LT(measure("svgf", kSample, 1, 8, Change::fireflies).psnr, clean - 3) << "the fireflies are there";
}

// Most of the light goes out at once. svgf needs some ten frames, since a fifth of each comes in; where nothing changes both are
// alike.
TEST(Quality, GraphsForChangingLightFollowIt) {
  const auto dimmed = [](const char* graph) { return measure(graph, kSample, Dimmed::kFirst, 8, Change::dimmed).psnr; };
  const double svgf = dimmed("svgf");
  EXPECT_GE(dimmed("asvgf_lite"), svgf + 5);
  EXPECT_GE(dimmed("relax_lite"), svgf + 5);
  EXPECT_GE(measure("asvgf_lite", kSample, 2, 8).psnr, measure("svgf", kSample, 2, 8).psnr - 0.1);
}

}  // namespace
}  // namespace quell
