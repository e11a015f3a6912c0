// Runs that follow each other: what is computed, what is kept, and what makes all of it be computed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>

#include "quell/runtime/rerun.h"
#include "tests/core/runtime/memory_stream.h"

namespace quell {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Two filters side by side; a loop of delay 3 behind one of them, and a node behind that.
std::string graph_text(int first = 1, int second = 2, int loop = 3, int last = 4, const std::string& more = "") {
  const auto node = [](const std::string& name, int salt, const std::string& in) {
    return "\"" + name + R"(": { "pass": "stir", "params": { "salt": )" + std::to_string(salt) + R"( }, "in": { )" + in +
           " } },\n";
  };
  return R"({ "quell": 1, "inputs": { "a": "color", "b": "color" }, "nodes": {)" + node("first", first, R"("color": "a")") +
         node("second", second, R"("color": "b")") +
         node("loop", loop,
              R"("color": "first.color", "other": { "from": "echo.color", "delay": 3, "initial": { "from": "second.color" } })") +
         node("echo", 0, R"("color": "loop.color")") + node("last", last, R"("color": "echo.color")") +
         R"(}, "outputs": { "color": "last.color", "second": "second.color")" + more + " } }";
}

class Reruns : public testing::Test {
 protected:
  RerunReport run(const std::string& text, std::vector<std::int64_t> frames = {1, 2, 3, 4, 5, 6}) {
    sink = std::make_unique<MemorySink>();
    return rerun.run(test_graph(text), frames, source, *sink, options);
  }
  // Of the nodes first, second, loop, echo and last.
  static std::vector<int> counts(const RerunReport& report) {
    std::map<std::string, int> by_name;
    for (std::size_t i = 0; i < report.nodes.size(); ++i) by_name[report.nodes[i]] = report.computed[i];
    return {by_name["first"], by_name["second"], by_name["loop"], by_name["echo"], by_name["last"]};
  }
  // As a run of its own would hand it out.
  std::map<std::pair<std::string, std::int64_t>, float> pixels_of(const MemorySink& of) const {
    std::map<std::pair<std::string, std::int64_t>, float> all;
    for (const auto& [key, item] : of.items) all[key] = item.image()->floats().at(1, 1);
    return all;
  }
  std::map<std::pair<std::string, std::int64_t>, float> whole(const std::string& text) {
    MemorySink all;
    Session(test_graph(text), options).run({1, 2, 3, 4, 5, 6}, source, all);
    return pixels_of(all);
  }

  MemorySource source;
  std::unique_ptr<MemorySink> sink;
  SessionOptions options;
  Rerun rerun;
};

TEST_F(Reruns, ComputeTheLastNodeAloneOnceAFrameWhenItsParameterChanged) {
  EXPECT_THAT(counts(run(graph_text())), ElementsAre(6, 6, 6, 6, 6));
  source.reads.clear();
  const RerunReport report = run(graph_text(1, 2, 3, 40));
  EXPECT_THAT(counts(report), ElementsAre(0, 0, 0, 0, 6));
  EXPECT_THAT(report.results, ElementsAre("color"));
  EXPECT_THAT(report.no_room, IsEmpty());
  EXPECT_EQ(report.all_anew, "");
  EXPECT_THAT(source.reads, IsEmpty());
  for (const auto& [key, pixel] : pixels_of(*sink)) EXPECT_EQ(pixel, whole(graph_text(1, 2, 3, 40)).at(key)) << key.second;
  EXPECT_EQ(sink->items.size(), 6U);
}

TEST_F(Reruns, ComputeALoopAndWhatFollowsButNothingBeforeIt) {
  run(graph_text());
  const RerunReport report = run(graph_text(1, 2, 30, 4));
  EXPECT_THAT(counts(report), ElementsAre(0, 0, 6, 6, 6));
  auto want = whole(graph_text(1, 2, 30, 4));
  for (const auto& [key, pixel] : pixels_of(*sink)) EXPECT_EQ(pixel, want.at(key)) << key.second;
}

TEST_F(Reruns, FollowInitialValuesAndDelays) {
  run(graph_text());
  EXPECT_THAT(counts(run(graph_text(1, 20, 3, 4))), ElementsAre(0, 6, 6, 6, 6));
  std::string text = graph_text(1, 20, 3, 4);
  text.replace(text.find("\"delay\": 3"), 10, "\"delay\": 2");
  EXPECT_THAT(counts(run(text)), ElementsAre(0, 0, 6, 6, 6));
}

TEST_F(Reruns, ComputeNothingWhereNothingChanged) {
  run(graph_text());
  std::string text = graph_text();
  text.insert(1, R"("doc": "Other words.", )");
  const RerunReport report = run(text);
  EXPECT_THAT(counts(report), ElementsAre(0, 0, 0, 0, 0));
  EXPECT_THAT(report.results, IsEmpty());
  EXPECT_THAT(report.frames, IsEmpty());
}

TEST_F(Reruns, HandOutANewResultFromWhatIsKept) {
  run(graph_text());
  const RerunReport report = run(graph_text(1, 2, 3, 4, R"(, "new": "loop.color", "input": "a")"));
  EXPECT_THAT(counts(report), ElementsAre(0, 0, 0, 0, 0));
  EXPECT_THAT(report.results, ElementsAre("new", "input"));
  EXPECT_EQ(report.frames.size(), 6U);
  auto want = whole(graph_text(1, 2, 3, 4, R"(, "new": "loop.color", "input": "a")"));
  for (const auto& [key, pixel] : pixels_of(*sink)) EXPECT_EQ(pixel, want.at(key));
  EXPECT_EQ(sink->items.size(), 12U);
}

TEST_F(Reruns, HandOutAllResultsOfAFrameWhereTheyGoTogether) {
  Rerun together(true);
  MemorySink first, second;
  together.run(test_graph(graph_text()), {1, 2}, source, first);
  const RerunReport report = together.run(test_graph(graph_text(1, 2, 3, 40)), {1, 2}, source, second);
  EXPECT_THAT(report.results, ElementsAre("color", "second"));
  EXPECT_EQ(second.items.size(), 4U);
  EXPECT_THAT(counts(report), ElementsAre(0, 0, 0, 0, 2));
}

TEST_F(Reruns, HandOutAgainWhatHasAnotherLabel) {
  const auto results = [&](const std::string& text, std::map<std::string, std::string> labels) {
    sink = std::make_unique<MemorySink>();
    return rerun.run(test_graph(text), {1, 2, 3, 4, 5, 6}, source, *sink, options, std::move(labels)).results;
  };
  results(graph_text(), {{"color", "x"}, {"second", "y"}});
  EXPECT_THAT(results(graph_text(), {{"color", "x"}, {"second", "y"}}), IsEmpty());
  EXPECT_THAT(results(graph_text(), {{"color", "x"}, {"second", "z"}}), ElementsAre("second"));
  EXPECT_THAT(results(graph_text(1, 2, 3, 40), {{"color", "w"}, {"second", "z"}}), ElementsAre("color"));
  EXPECT_THAT(results(graph_text(1, 2, 3, 40), {}), ElementsAre("color", "second"));
  const auto want = whole(graph_text(1, 2, 3, 40));
  EXPECT_EQ(pixels_of(*sink), want);
}

TEST_F(Reruns, AreWholeWhereFramesOrInputsAreOthers) {
  run(graph_text());
  EXPECT_THAT(counts(run(graph_text(), {1, 2, 3})), ElementsAre(3, 3, 3, 3, 3));
  source.size = {4, 4};
  const RerunReport report = run(graph_text(), {1, 2, 3});
  EXPECT_THAT(counts(report), ElementsAre(3, 3, 3, 3, 3));
  EXPECT_EQ(report.all_anew, "the input 'a' has another size or type");
  rerun.forget();
  EXPECT_THAT(counts(run(graph_text(), {1, 2, 3})), ElementsAre(3, 3, 3, 3, 3));
}

TEST_F(Reruns, AreWholeAfterFramesThatCannotBeReadOrHaveAnotherSize) {
  source.unreadable = {3};
  run(graph_text());
  RerunReport report = run(graph_text(1, 2, 3, 40));
  EXPECT_THAT(counts(report), ElementsAre(5, 5, 5, 5, 5));
  EXPECT_EQ(report.all_anew, "an input could not be read in every frame, or changed its size");
  source.unreadable.clear();
  source.odd_size[4] = {3, 3};
  run(graph_text(1, 2, 3, 4));
  report = run(graph_text(1, 2, 3, 40));
  EXPECT_THAT(counts(report), ElementsAre(6, 6, 6, 6, 6));
}

TEST_F(Reruns, TellWhenFramesThatWereToldAreToldAgain) {
  run(graph_text());
  int restarts = 0;
  std::vector<std::int64_t> told;
  options.on_frame = [&](const FrameReport& report) { told.push_back(report.frame); };
  rerun.on_restart([&] { ++restarts, told.clear(); });
  source.unreadable = {5};
  EXPECT_THAT(counts(run(graph_text(1, 20))), ElementsAre(5, 5, 5, 5, 5));
  EXPECT_EQ(restarts, 1);
  EXPECT_THAT(told, ElementsAre(1, 2, 3, 4, 5, 6));
  run(graph_text(1, 21));
  EXPECT_EQ(restarts, 1);
}

TEST_F(Reruns, NoticeThatANewlyReadInputIsNotThereInEveryFrame) {
  const auto text = [](const std::string& input) {
    return R"({ "quell": 1, "inputs": { "a": "color", "b": "color" }, "nodes": {
      "x": { "pass": "stir", "in": { "color": "a", "other": { "from": "x.color", "delay": 1, "initial": "none" } } },
      "y": { "pass": "stir", "in": { "color": "x.color", "other": ")" +
           input + R"(" } } }, "outputs": { "y": "y.color" } })";
  };
  class HalfSource final : public FrameSource {
   public:
    std::optional<Shape> shape(std::string_view) override { return Shape{QUELL_TYPE_COLOR, {4, 4}, 0, true}; }
    Item read(std::string_view input, std::int64_t frame, BufferPool& pool) override {
      if (input == "b" && frame == 3) throw Error(Fault::input, "b.3.exr", "no such file");
      return flat_color({4, 4}, static_cast<float>(frame), pool);
    }
  } half;
  MemorySink got, want;
  rerun.run(test_graph(text("a")), {1, 2, 3, 4}, half, got);
  const RerunReport report = rerun.run(test_graph(text("b")), {1, 2, 3, 4}, half, got);
  EXPECT_THAT(report.all_anew, HasSubstr("'b' cannot be read in every frame"));
  EXPECT_EQ(report.computed, (std::vector<int>{3, 3}));
  Session(test_graph(text("b"))).run({1, 2, 3, 4}, half, want);
  EXPECT_EQ(got.pixel("y", 4), want.pixel("y", 4));  // the history of x is absent there
}

TEST_F(Reruns, ComputeAgainWhatFailed) {
  const auto text = [](const std::string& frames, int salt) {
    return R"({ "quell": 1, "inputs": { "a": "color" }, "nodes": {
      "x": { "pass": "stir", "in": { "color": "a" } },
      "f": { "pass": "falter", "in": { "color": "x.color" }, "params": { "frames": )" +
           frames + R"( } },
      "l": { "pass": "stir", "params": { "salt": )" +
           std::to_string(salt) + R"( }, "in": { "color": "f.color" } } }, "outputs": { "l": "l.color", "x": "x.color" } })";
  };
  EXPECT_EQ(run(text("[]", 0), {1, 2, 3}).computed, (std::vector<int>{3, 3, 3}));
  RerunReport report = run(text("[2]", 0), {1, 2, 3});
  EXPECT_EQ(report.computed, (std::vector<int>{0, 3, 2}));
  EXPECT_EQ(report.frames[1].node, "f");
  EXPECT_FALSE(report.frames[1].ok);
  report = run(text("[2]", 5), {1, 2, 3});  // nothing of f is kept
  EXPECT_EQ(report.computed, (std::vector<int>{0, 3, 2}));
  report = run(text("[]", 5), {1, 2, 3});
  EXPECT_EQ(report.computed, (std::vector<int>{0, 3, 3}));
  EXPECT_THAT(report.results, ElementsAre("l"));
}

TEST_F(Reruns, ComputeAgainWhatYieldsInfinity) {
  source.paint = [](Image& image, std::int64_t) {
    for (int c = 0; c < 3; ++c) image.writable_floats().at(0, 0, c) = 3e38F;
  };
  const std::string text = R"({ "quell": 1, "inputs": { "color": "color" }, "nodes": {
    "sum": { "pass": "accumulate", "in": { "color": "color", "history": { "from": "sum.color", "delay": 1, "initial": "none" } } },
    "last": { "pass": "accumulate", "in": { "color": "sum.color" } } }, "outputs": { "color": "last.color" } })";
  run(text, {1, 2, 3});
  EXPECT_TRUE(std::isinf(sink->pixel("color", 3)));
  std::string other = text;
  const std::string last = R"("color": "sum.color")";
  other.replace(other.find(last), last.size(), last + R"(, "history": { "from": "color", "delay": 1, "initial": "none" })");
  const RerunReport report = run(other, {1, 2, 3});
  EXPECT_EQ(report.computed, (std::vector<int>{3, 3}));
}

TEST_F(Reruns, KeepWhatMemoryHasRoomForAndSayWhatNot) {
  const auto limit = [&](std::size_t bytes) { options.memory = bytes; };
  source.size = {64, 64};  // 49152 bytes and some an image, six frames
  limit(std::size_t{1} << 20);
  class NowhereSink final : public FrameSink {  // unlike the other, it does not hold what it gets
    void write(std::string_view, std::int64_t, const Item&) override {}
  } nowhere;
  const RerunReport first = rerun.run(test_graph(graph_text()), {1, 2, 3, 4, 5, 6}, source, nowhere, options);
  EXPECT_THAT(first.no_room, ElementsAre("first", "second", "loop", "echo"));
  EXPECT_LE(first.remembered_bytes, options.memory / 2);
  EXPECT_GT(first.remembered_bytes, 0U);
  EXPECT_LE(first.peak_bytes, options.memory);
  EXPECT_THAT(counts(run(graph_text(1, 2, 3, 40))), ElementsAre(6, 6, 6, 6, 6));
  limit(std::size_t{100} << 20);
  EXPECT_THAT(run(graph_text(1, 2, 3, 4)).no_room, IsEmpty());
  EXPECT_THAT(counts(run(graph_text(1, 2, 3, 40))), ElementsAre(0, 0, 0, 0, 6));
}

TEST_F(Reruns, KeepWhatIsRightWhenARunIsCancelled) {
  run(graph_text());
  std::atomic<bool> stop{false};
  options.on_frame = [&](const FrameReport& report) { stop = report.frame == 2; };
  options.cancelled = [&] { return stop.load(); };
  options.schedule = Schedule::serial;
  EXPECT_LT(run(graph_text(1, 2, 3, 40)).frames.size(), 6U);
  options = {};
  const RerunReport report = run(graph_text(1, 2, 3, 40));
  EXPECT_THAT(counts(report), ElementsAre(0, 0, 0, 0, 6));
  auto want = whole(graph_text(1, 2, 3, 40));
  for (const auto& [key, pixel] : pixels_of(*sink)) EXPECT_EQ(pixel, want.at(key));
}

TEST_F(Reruns, AGraphThatCannotBePlannedChangesNothing) {
  run(graph_text());
  options.dumps = {"nobody.color"};
  EXPECT_THROW(run(graph_text(1, 2, 3, 40)), Error);
  options.dumps.clear();
  EXPECT_THAT(counts(run(graph_text(1, 2, 3, 40))), ElementsAre(0, 0, 0, 0, 6));
}

TEST_F(Reruns, InputsThatTakeTimeToReadAreReadOnce) {
  class SlowSource final : public FrameSource {
   public:
    explicit SlowSource(MemorySource& source) : source_(source) {}
    std::optional<Shape> shape(std::string_view input) override { return source_.shape(input); }
    Item read(std::string_view input, std::int64_t frame, BufferPool& pool) override { return source_.read(input, frame, pool); }
    bool uses_processor() const override { return true; }

   private:
    MemorySource& source_;
  } slow(source);
  MemorySink all;
  rerun.run(test_graph(graph_text()), {1, 2, 3}, slow, all);
  EXPECT_EQ(source.reads.size(), 6U);
  const RerunReport report = rerun.run(test_graph(graph_text(10, 20)), {1, 2, 3}, slow, all);
  EXPECT_THAT(counts(report), ElementsAre(3, 3, 3, 3, 3));
  EXPECT_EQ(source.reads.size(), 6U);
}

}  // namespace
}  // namespace quell
