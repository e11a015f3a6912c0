// Every graph that ships loads, plans and runs, on made-up frames of a size that fits no vector.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string_view>
#include <tuple>

#include "quell/graph/schema.h"
#include "quell/runtime/session.h"
#include "quell/testing/synthetic.h"
#include "tests/core/graph/graph_text.h"

namespace quell {
namespace {

std::vector<std::filesystem::path> shipped_graphs() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(QUELL_SOURCE_DIR "/graphs"))
    if (entry.path().extension() == ".json" && entry.path().filename() != kSchemaFileName) files.push_back(entry.path());
  return files;
}

class ShippedGraph : public ::testing::TestWithParam<std::filesystem::path> {};

class SyntheticFrames final : public FrameSource {
 public:
  explicit SyntheticFrames(const Graph& graph, Size size = {37, 29}) : graph_(graph), size_(size) {}
  std::optional<Shape> shape(std::string_view input) override { return shape_of(item(input, 0)); }
  Item read(std::string_view input, std::int64_t frame, BufferPool&) override { return item(input, frame); }

 private:
  Item item(std::string_view name, std::int64_t frame) const {
    const auto input = std::ranges::find(graph_.inputs, name, &GraphInput::name);
    return synthetic(input->type, size_, static_cast<std::uint32_t>(frame));
  }
  const Graph& graph_;
  Size size_;
};

class FiniteSink final : public FrameSink {
 public:
  void write(std::string_view output, std::int64_t frame, const Item& item) override {
    if (!item.image() || item.image()->type() == QUELL_TYPE_ID) return;
    const FloatImage image = item.image()->floats();
    for (int c = 0; c < image.channels; ++c)
      for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
          if (!std::isfinite(image.at(x, y, c))) ADD_FAILURE() << output << " of frame " << frame << " at " << x << ", " << y;
  }
};

TEST_P(ShippedGraph, RunsOverFramesAndStaysFinite) {
  const Registry passes = load_plugins();
  const auto graph = load_graph(GetParam(), passes);
  EXPECT_FALSE(graph->doc.empty()) << "a graph says what it does and where it comes from";
  SyntheticFrames frames(*graph);
  FiniteSink sink;
  for (const FrameReport& report : Session(graph).run({0, 1, 2}, frames, sink)) EXPECT_TRUE(report.ok) << report.error;
}

class KeepingSink final : public FrameSink {
 public:
  void write(std::string_view output, std::int64_t frame, const Item& item) override {
    const std::scoped_lock lock(mutex_);
    items[{std::string(output), frame}] = item;
  }
  std::map<std::pair<std::string, std::int64_t>, Item> items;

 private:
  std::mutex mutex_;
};

bool same_bits(const Item& a, const Item& b) {
  if (a.values()) return *a.values() == *b.values();
  const quell_image x = a.image()->raw(), y = b.image()->raw();
  for (std::uint32_t c = 0; c < x.channels; ++c)
    for (int row = 0; row < x.height; ++row) {
      const auto at = [&](const quell_image& image) {
        return static_cast<const float*>(image.data) + c * image.plane_stride + row * image.row_stride;
      };
      if (std::memcmp(at(x), at(y), static_cast<std::size_t>(x.width) * sizeof(float)) != 0) return false;
    }
  return x.width == y.width && x.height == y.height;
}

// Of a height that makes several bands of rows.
TEST_P(ShippedGraph, YieldsTheSameBitsFusedOrNot) {
  const Registry passes = load_plugins();
  const auto graph = load_graph(GetParam(), passes);
  KeepingSink fused, alone;
  for (const auto& [sink, fuse, threads] : {std::tuple(&alone, false, 1), std::tuple(&fused, true, 3)}) {
    SyntheticFrames frames(*graph, {37, 75});
    for (const FrameReport& report : Session(graph, {.threads = threads, .fuse = fuse}).run({0, 1, 2, 3}, frames, *sink))
      EXPECT_TRUE(report.ok) << report.error;
  }
  ASSERT_EQ(fused.items.size(), alone.items.size());
  for (const auto& [key, item] : alone.items)
    EXPECT_TRUE(same_bits(item, fused.items.at(key))) << key.first << " of frame " << key.second;
}

// Every parameter, set or not.
std::string all_params(const Graph& graph, std::string_view node) {
  const quell_pass_desc& pass = *test::node(graph, node).pass;
  std::string text = std::string(pass.id) + " " + std::to_string(pass.version);
  for (std::uint32_t i = 0; i < pass.param_count; ++i) {
    const std::string name = QUELL_AT(quell_param_desc, pass.params, i)->name;
    text += "\n" + name + ": " + test::param(graph, node, name);
  }
  return text;
}

// What validate shows must be what svgf does.
TEST(ValidateGraph, GoesByWhatSvgfGoesBy) {
  const Registry passes = load_plugins();
  const auto svgf = load_graph(QUELL_SOURCE_DIR "/graphs/svgf.json", passes);
  const auto validate = load_graph(QUELL_SOURCE_DIR "/graphs/validate.json", passes);
  for (const char* node : {"slope", "reproject", "moments"}) EXPECT_EQ(all_params(*validate, node), all_params(*svgf, node));
  const quell_pass_desc& reproject = *test::node(*svgf, "reproject").pass;
  for (std::uint32_t i = 0; i < reproject.input_count; ++i) {
    const std::string input = QUELL_AT(quell_port_desc, reproject.inputs, i)->name;
    if (input == "history") continue;  // where validate fetches albedo instead of light
    EXPECT_EQ(test::sources(*validate, "reproject", input), test::sources(*svgf, "reproject", input)) << input;
  }
  EXPECT_EQ(test::sources(*validate, "moments", "valid"), test::sources(*svgf, "moments", "valid"));
  EXPECT_EQ(test::sources(*validate, "moments", "length"), test::sources(*svgf, "moments", "length"));
}

TEST(ShippedGraphs, AreThere) { EXPECT_FALSE(shipped_graphs().empty()); }

INSTANTIATE_TEST_SUITE_P(All, ShippedGraph, ::testing::ValuesIn(shipped_graphs()),
                         [](const auto& file) { return file.param.stem().string(); });

}  // namespace
}  // namespace quell
