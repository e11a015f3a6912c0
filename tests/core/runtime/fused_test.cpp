// What is told of nodes that run together, and what becomes of a pass that does not keep its promise. That the results are those
// of nodes that run one by one is tested on random graphs (schedule_random_test.cpp) and on those that ship.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "quell/runtime/session.h"
#include "quell/sdk/pass.h"

namespace quell {
namespace {

using ::testing::HasSubstr;

struct NoParams {};

class Half : public Pass {
 public:
  explicit Half(const NoParams&) {}
  void infer(Inference& about) const override { about.set_by_rows(); }
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color");
    const FloatOutput out = frame.output("color");
    frame.parallel_rows(loop_height(out.height), [&](int y0, int y1) {
      for (int c = 0; c < out.channels; ++c)
        for (int y = y0; y < y1; ++y)
          for (int x = 0; x < out.width; ++x) out.at(x, y, c) = color.at(x, y, c) / 2;
    });
  }
  virtual int loop_height(int height) const { return height; }
};
class Liar final : public Half {
 public:
  using Half::Half;
  int loop_height(int height) const override { return height / 2; }
};
template <class ConcretePass>
const quell_pass_desc* describe_pass(const char* id) {
  return detail::Descriptor::make<ConcretePass, NoParams>(
             {.id = id, .source = "test", .inputs = {{"color", kColor}}, .outputs = {{.name = "color", .same_as = "color"}}})
      .get();
}

std::shared_ptr<const Graph> chain(const char* second) {
  static const Registry registry = [] {
    Registry passes;
    const quell_pass_desc* all[] = {describe_pass<Half>("half"), describe_pass<Liar>("liar")};
    passes.add(all, 2);
    return passes;
  }();
  const std::string text = R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"a": {"pass": "half", "in": {"color": "color"}}, "b": {"pass": ")" +
                           std::string(second) + R"(", "in": {"color": "a.color"}},
              "c": {"pass": "half", "in": {"color": "a.color"}}},
    "outputs": {"b": "b.color", "c": "c.color"}})";
  return parse_graph(std::make_shared<const SourceText>(SourceText{"chain.json", text}), registry);
}

class Ones final : public FrameSource {
 public:
  std::optional<Shape> shape(std::string_view) override { return Shape{QUELL_TYPE_COLOR, {40, 100}}; }
  Item read(std::string_view, std::int64_t, BufferPool& pool) override {
    Image image(QUELL_TYPE_COLOR, {40, 100}, pool);
    for (int c = 0; c < 3; ++c)
      for (int y = 0; y < 100; ++y) std::fill_n(image.writable_floats().row(y, c), 40, 1.0F);
    return image;
  }
};

class Nowhere final : public FrameSink {
 public:
  void write(std::string_view, std::int64_t, const Item&) override {}
};

TEST(Fused, NodesEachHaveTheirTime) {
  Ones source;
  Nowhere sink;
  Session session(chain("half"), {.threads = 2});
  const std::vector<FrameReport> reports = session.run({1}, source, sink);
  ASSERT_EQ(session.plan()->turns.size(), 1u);
  ASSERT_EQ(reports[0].node_seconds.size(), 3u);
  double sum = 0;
  for (const double seconds : reports[0].node_seconds) {
    EXPECT_GT(seconds, 0);
    sum += seconds;
  }
  EXPECT_LE(sum, reports[0].seconds) << "which has room for nothing else";
}

TEST(Fused, NodesAreOneSliceOfTheTrace) {
  std::ostringstream text;
  Trace trace(text);
  Ones source;
  Nowhere sink;
  Session(chain("half"), {.threads = 1, .trace = &trace}).run({1}, source, sink);
  trace.finish();
  EXPECT_THAT(text.str(), HasSubstr("\"a + b + c\""));
}

TEST(Fused, PassThatDoesNotWorkRowByRowIsTold) {
  Ones source;
  Nowhere sink;
  const std::vector<FrameReport> reports = Session(chain("liar"), {.threads = 2}).run({1}, source, sink);
  EXPECT_FALSE(reports[0].ok);
  EXPECT_EQ(reports[0].node, "b");
  EXPECT_EQ(reports[0].error, "b: it said that it works row by row, but its loop does not go over the 100 rows of its outputs");
}

}  // namespace
}  // namespace quell
