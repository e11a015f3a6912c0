// SVGF on diffuse and specular light apart, on what a renderer writes of both. Too large to be part of the repository: where it
// is absent, these tests are skipped.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "quell/metrics/comparison.h"
#include "quell/runtime/session.h"
#include "quell/sequence/sequence.h"

namespace quell {
namespace {

namespace fs = std::filesystem;

const fs::path kRoom = QUELL_SOURCE_DIR "/../shared/data/room";
const std::string kFiles = (kRoom / "multilayer/multi.%04d.exr").string();
constexpr Size kSize{320, 180};
const std::vector<std::int64_t> kFrames{1, 2};  // all that there are

void for_each_value(const std::function<void(int x, int y, int c)>& call) {
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) call(x, y, c);
}
int count_if(const std::function<bool(int x, int y, int c)>& is_it) {
  int count = 0;
  for_each_value([&](int x, int y, int c) { count += is_it(x, y, c) ? 1 : 0; });
  return count;
}
Image make_color(BufferPool& pool, const std::function<float(int x, int y, int c)>& value) {
  Image image(QUELL_TYPE_COLOR, kSize, pool);
  for_each_value([&](int x, int y, int c) { image.writable_floats().at(x, y, c) = value(x, y, c); });
  return image;
}

// The room as Blender writes it. Its passes hold light without albedo (DiffDir, DiffInd, ...) and albedo (DiffCol, ...), of which
// radiance is made here: Combined = (DiffDir + DiffInd) DiffCol + (GlossDir + GlossInd) GlossCol + Emit + Env (Blender's manual,
// render passes; nothing in the room transmits or scatters).
class SplitRoom final : public FrameSource {
 public:
  SplitRoom() : sequence_(Sequence::open(kFiles, {.in = layers()})) {}

  void expect(const Graph& graph) {
    for (const GraphInput& input : graph.inputs)
      if (!is_made(input.name)) sequence_->expect(input.name, input.type);
  }
  std::optional<Shape> shape(std::string_view input) override {
    return is_made(input) ? shape_of(read(input, 1, pool_)) : sequence_->shape(input);
  }
  Item read(std::string_view input, std::int64_t frame, BufferPool& pool) override {
    if (input == "diffuse") return light("Diff", frame, pool);
    if (input == "specular") return light("Gloss", frame, pool);
    if (input == "emission") return sum("Emit", "Env", frame, pool);
    return sequence_->read(input, frame, pool);
  }

 private:
  static bool is_made(std::string_view input) { return input == "diffuse" || input == "specular" || input == "emission"; }

  static std::vector<std::string> layers() {
    std::vector<std::string> in;
    for (const char* layer : {"DiffDir", "DiffInd", "GlossDir", "GlossInd", "Emit", "Env"})
      in.push_back(std::string(layer) + "=" + kFiles + ":ViewLayer." + layer + ":type=color");
    in.push_back("diffuse_albedo=" + kFiles + ":ViewLayer.DiffCol:type=albedo");
    in.push_back("specular_albedo=" + kFiles + ":ViewLayer.GlossCol:type=albedo");
    return in;
  }
  Image sum(const std::string& first, const std::string& second, std::int64_t frame, BufferPool& pool) {
    const Item a = sequence_->read(first, frame, pool), b = sequence_->read(second, frame, pool);
    return make_color(pool,
                      [&](int x, int y, int c) { return a.image()->floats().at(x, y, c) + b.image()->floats().at(x, y, c); });
  }
  Image light(const std::string& kind, std::int64_t frame, BufferPool& pool) {
    const Image both = sum(kind + "Dir", kind + "Ind", frame, pool);
    const Item albedo = sequence_->read(kind == "Diff" ? "diffuse_albedo" : "specular_albedo", frame, pool);
    return make_color(pool,
                      [&](int x, int y, int c) { return both.floats().at(x, y, c) * albedo.image()->floats().at(x, y, c); });
  }

  std::unique_ptr<Sequence> sequence_;
  BufferPool pool_;
};

class ColorSink final : public FrameSink {
 public:
  std::map<std::int64_t, Image> colors;
  void write(std::string_view, std::int64_t frame, const Item& item) override {
    const std::scoped_lock lock(mutex_);
    colors[frame] = *item.image();
  }

 private:
  std::mutex mutex_;
};

std::map<std::int64_t, Image> run(const GraphOptions& options = {}) {
  const Registry passes = load_plugins();
  const auto graph = load_graph(QUELL_SOURCE_DIR "/graphs/svgf_split.json", passes, options);
  SplitRoom room;
  room.expect(*graph);
  ColorSink sink;
  Session session(graph);
  for (const FrameReport& report : session.run(kFrames, room, sink)) EXPECT_TRUE(report.ok) << report.error;
  return sink.colors;
}

Image noisy(std::int64_t frame, BufferPool& pool) { return *Sequence::open(kFiles)->read("color", frame, pool).image(); }

class SvgfSplit : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kRoom / "multilayer")) GTEST_SKIP() << "the rendered room is not there: " << kRoom;
  }
  BufferPool pool_;
};

// Every pass that filters is bypassed: what is left takes light apart and puts it together. No term is negative, so that errors
// are relative to the sum. Of the renderer's roundings and those here there are up to 16: each part is a sum over four samples
// there, a sum and a product in the test, a division and a product in the graph; then the parts are added.
TEST_F(SvgfSplit, GivesTheNoisyPictureWhereNothingIsFiltered) {
  GraphOptions unfiltered;
  for (const std::string part : {"diffuse", "specular"}) {
    for (const char* level : {"4", "3", "2", "1", "0"}) unfiltered.bypass.push_back(part + level);
    unfiltered.bypass.push_back(part + "_blend");
    unfiltered.set.push_back(part + "_variance.filter_color=false");
  }
  const auto got = run(unfiltered);
  for (const std::int64_t frame : kFrames) {
    const Image want = noisy(frame, pool_);
    const auto differs = [&](int x, int y, int c) {
      const double color = want.floats().at(x, y, c);
      return !(std::abs(got.at(frame).floats().at(x, y, c) - color) <= 16 * 0x1p-24 * color);
    };
    EXPECT_EQ(count_if(differs), 0) << "frame " << frame;
  }
}

// Of (x / (1 + x))^(1 / 2.2).
double psnr(const Image& reference, const Image& image, BufferPool& pool) {
  const CompareOptions options{.metrics = {Metric::psnr}, .display = DisplayTransform::reinhard};
  return value(Metric::psnr, compare({{reference, image}, {}, {}}, options, false, pool).scores[0]);
}

// Samples of the room's reference lie in the middle of pixels of half the size: four of them in each pixel.
Image reference(std::int64_t frame, BufferPool& pool) {
  const Item fine = Sequence::open(kRoom)->read("reference", frame, pool);
  const FloatImage samples = fine.image()->floats();
  return make_color(pool, [&](int x, int y, int c) {
    return (samples.at(2 * x, 2 * y, c) + samples.at(2 * x + 1, 2 * y, c) + samples.at(2 * x, 2 * y + 1, c) +
            samples.at(2 * x + 1, 2 * y + 1, c)) /
           4;
  });
}

// Measured: 30.9 and 30.8 dB, the input 24.9 dB.
TEST_F(SvgfSplit, IsFiveDecibelsNearerToTheReferenceThanItsInput) {
  const auto got = run();
  for (const std::int64_t frame : kFrames) {
    const Image& filtered = got.at(frame);
    EXPECT_EQ(count_if([&](int x, int y, int c) { return !std::isfinite(filtered.floats().at(x, y, c)); }), 0);
    const Image want = reference(frame, pool_);
    const double before = psnr(want, noisy(frame, pool_), pool_), after = psnr(want, filtered, pool_);
    std::printf("frame %d: %.2f dB of %.2f dB\n", static_cast<int>(frame), after, before);
    EXPECT_GE(after, before + 5) << "frame " << frame;
  }
}

}  // namespace
}  // namespace quell
