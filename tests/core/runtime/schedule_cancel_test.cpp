// A run that is cancelled at any moment reports whole frames only, and the session goes on from there.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "tests/core/runtime/memory_stream.h"
#include "tests/core/runtime/schedule_run.h"

namespace quell::test {
namespace {

#ifdef __SANITIZE_THREAD__
constexpr unsigned kRuns = 30;
#else
constexpr unsigned kRuns = 150;
#endif

Scene scene_of_twelve() {
  Scene scene;
  for (int frame = 1; frame <= 12; ++frame) scene.frames.push_back(frame);
  return scene;
}

// What an outcome has of these frames.
Outcome only(const Outcome& outcome, const std::vector<std::int64_t>& frames) {
  const auto has = [&](std::int64_t frame) { return std::ranges::find(frames, frame) != frames.end(); };
  Outcome some = outcome;
  std::erase_if(some.reports, [&](const FrameReport& report) { return !has(report.frame); });
  std::erase_if(some.pictures, [&](const auto& entry) { return !has(entry.first.second); });
  return some;
}

std::vector<std::int64_t> frames_of(const std::vector<FrameReport>& reports) {
  std::vector<std::int64_t> frames;
  for (const FrameReport& report : reports) frames.push_back(report.frame);
  return frames;
}

// From the first frame that is not reported: later ones may have been done already.
std::vector<std::int64_t> rest_of(const std::vector<std::int64_t>& frames, const std::vector<std::int64_t>& reported) {
  const auto first = std::ranges::mismatch(frames, reported).in1;
  return {first, frames.end()};
}

// What comes of `later` after a serial run that ended before the frame `end`.
Outcome go_on_serially(const std::shared_ptr<const Graph>& graph, FrameSource& source, const std::vector<std::int64_t>& frames,
                       std::int64_t end, const std::vector<std::int64_t>& later) {
  std::int64_t next = frames.front();
  SessionOptions options = serial();
  options.cancelled = [&] { return next == end; };
  options.on_frame = [&](const FrameReport& report) { next = report.frame + 1; };
  Session session(graph, options);
  RecordingSink sink;
  session.run(frames, source, sink);
  sink.take();
  next = end + 1;
  Outcome outcome;
  outcome.reports = session.run(later, source, sink);
  outcome.pictures = sink.take();
  return outcome;
}

// Cancels at a certain event: the nth question whether it is cancelled, or the nth read or write that begins.
class Canceller {
 public:
  enum class At { question, read, write };
  Canceller(At at, int event) : at_(at), left_(event) {}
  bool asked() {
    happens(At::question);
    return cancelled_;
  }
  void happens(At event) {
    if (event == at_ && --left_ == 0) cancelled_ = true;
  }
  bool is_cancelled() const { return cancelled_; }
  void relent() { cancelled_ = false; }

 private:
  const At at_;
  std::atomic<int> left_;
  std::atomic<bool> cancelled_ = false;
};

TEST(CancelledRun, ReportsWholeFramesAndGoesOnWhereItEnded) {
  int cut_short = 0;
  for (unsigned seed = 0; seed < kRuns; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Dice dice(seed);
    const Scene scene = scene_of_twelve();
    const TestGraph graph = random_graph(300 + seed % 20, {4, 9});
    const auto checked = load(graph);
    const Outcome want = run(checked, graph.inputs, scene, serial());

    const auto at = static_cast<Canceller::At>(dice.below(3));
    Canceller canceller(at, at == Canceller::At::question ? dice.from(1, 400) : dice.from(1, 20));
    PatternSource source(graph.inputs, scene);
    source.on_read = [&](std::string_view, std::int64_t) { canceller.happens(Canceller::At::read); };
    RecordingSink sink;
    sink.on_write = [&](std::string_view, std::int64_t) { canceller.happens(Canceller::At::write); };
    const Setting chosen = setting(dice.below(kSettings));
    SCOPED_TRACE(describe(chosen));
    SessionOptions options = dice.chance(15) ? serial() : concurrent(chosen);
    options.cancelled = [&] { return canceller.asked(); };
    Session session(checked, options);
    session.pool().fill(0xff);

    Outcome got{{}, session.run(scene.frames, source, sink)};
    got.pictures = sink.take();
    const std::vector<std::int64_t> reported = frames_of(got.reports);
    cut_short += reported.size() < scene.frames.size();
    EXPECT_TRUE(canceller.is_cancelled() || reported.size() == scene.frames.size());
    expect_same(got, only(want, reported));

    canceller.relent();
    const std::vector<std::int64_t> rest = rest_of(scene.frames, reported);
    if (seed % 2 == 0) {
      const auto again = session.run(rest, source, sink);
      expect_same({sink.take(), again}, only(want, rest));
    } else if (rest.size() > 2) {
      // Of what was begun and not finished nothing is left.
      const std::vector<std::int64_t> later(scene.frames.end() - dice.from(1, static_cast<int>(rest.size()) - 1),
                                            scene.frames.end());
      const auto again = session.run(later, source, sink);
      expect_same({sink.take(), again}, go_on_serially(checked, source, scene.frames, rest[0], later));
    }
    if (HasFailure()) {
      ADD_FAILURE() << "again from frame " << (rest.empty() ? 0 : rest[0]) << "\n" << to_json(graph, testing::TempDir());
      return;
    }
  }
  EXPECT_GE(cut_short, static_cast<int>(kRuns / 3)) << "the runs must be long enough to be cut short";
}

TEST(CancelledRun, BeforeItBeginsDoesNothing) {
  for (const SessionOptions& base : {serial(), concurrent({4, 4})}) {
    SessionOptions options = base;
    options.cancelled = [] { return true; };
    MemorySource source;
    MemorySink sink;
    EXPECT_TRUE(Session(test_graph(kSumGraph), options).run({1, 2, 3}, source, sink).empty());
    EXPECT_TRUE(sink.items.empty());
  }
}

TEST(CancelledRun, FromACallbackEndsSoon) {
  for (int number = 0; number < kSettings; ++number) {
    SCOPED_TRACE(describe(setting(number)));
    std::atomic<bool> stop = false;
    std::vector<std::int64_t> told;
    SessionOptions options = concurrent(setting(number));
    options.cancelled = [&] { return stop.load(); };
    options.on_frame = [&](const FrameReport& report) {
      told.push_back(report.frame);
      if (report.frame == 5) stop = true;
    };
    std::vector<std::int64_t> frames;
    for (std::int64_t frame = 1; frame <= 500; ++frame) frames.push_back(frame);
    MemorySource source;
    MemorySink sink;
    const auto reports = Session(test_graph(kSumGraph), options).run(frames, source, sink);
    EXPECT_GE(reports.size(), 5U);
    EXPECT_EQ(told.size(), reports.size());
    EXPECT_EQ(sink.items.size(), reports.size());
  }
}

}  // namespace
}  // namespace quell::test
