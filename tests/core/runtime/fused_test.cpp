// What is told of nodes that run together, and what becomes of a pass that does not keep its promise. That the results are those
// of nodes that run one by one is tested on random graphs (schedule_random_test.cpp) and on those that ship.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <sstream>
#include <thread>

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
/// Its first call takes 300 ms, the others 1 ms.
class Slow final : public Half {
 public:
  using Half::Half;
  static inline std::atomic<int> calls = 0;
  int loop_height(int height) const override {
    std::this_thread::sleep_for(std::chrono::milliseconds(calls++ == 0 ? 300 : 1));
    return height;
  }
};
template <class ConcretePass>
const quell_pass_desc* describe_pass(const char* id) {
  return detail::Descriptor::make<ConcretePass, NoParams>(
             {.id = id, .source = "test", .inputs = {{"color", kColor}}, .outputs = {{.name = "color", .same_as = "color"}}})
      .get();
}

// Does not ask what became of its loop.
const quell_pass_desc* deaf() {
  static quell_pass_desc desc = *describe_pass<Half>("half");
  desc.id = "deaf";
  desc.process = [](const void*, const quell_host* host, const quell_exec*) {
    host->parallel_for(
        host, 0, 7, 1, [](void*, std::int64_t, std::int64_t, std::int64_t, std::uint32_t) { return QUELL_OK; }, nullptr);
    return QUELL_OK;
  };
  return &desc;
}

std::shared_ptr<const Graph> chain(const char* second, const char* third = "half") {
  static const Registry registry = [] {
    Registry passes;
    const quell_pass_desc* all[] = {describe_pass<Half>("half"), describe_pass<Liar>("liar"), describe_pass<Slow>("slow"),
                                    deaf()};
    passes.add(all, 4);
    return passes;
  }();
  const std::string text = R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"a": {"pass": "half", "in": {"color": "color"}}, "b": {"pass": ")" +
                           std::string(second) + R"(", "in": {"color": "a.color"}},
              "c": {"pass": ")" +
                           third + R"(", "in": {"color": "a.color"}}},
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

TEST(Fused, NodesHaveNothingOfTheTimeOfARunThatWasCancelled) {
  Ones source;
  Nowhere sink;
  std::atomic<bool> cancels = true;
  Session session(chain("slow", "slow"), {.threads = 1, .cancelled = [&] { return cancels && Slow::calls > 0; }});
  EXPECT_TRUE(session.run({1}, source, sink).empty());
  cancels = false;
  const std::vector<FrameReport> reports = session.run({2}, source, sink);
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_GT(reports[0].node_seconds[2], reports[0].node_seconds[1] / 4) << "both do the same, as often";
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

TEST(Fused, PassThatDoesNotMindWhatBecameOfItsLoopFailsTheSame) {
  Ones source;
  Nowhere sink;
  const std::vector<FrameReport> reports = Session(chain("deaf"), {.threads = 2}).run({1}, source, sink);
  EXPECT_FALSE(reports[0].ok) << "or rows would be handed out that nobody has written";
  EXPECT_EQ(reports[0].node, "b");
}

}  // namespace
}  // namespace quell
