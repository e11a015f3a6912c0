// The graph that ships, over real frames from files: the same bits for any number of threads and frames in flight.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "quell/runtime/session.h"
#include "quell/sequence/sequence.h"

namespace quell {
namespace {

const std::filesystem::path kBox = QUELL_SOURCE_DIR "/../shared/data/games202-box";
#ifdef __SANITIZE_THREAD__
const std::vector<std::int64_t> kFrames{0, 1, 2};
const std::vector<int> kCounts{2, 8};  // of threads, and of frames in flight
#else
const std::vector<std::int64_t> kFrames{0, 1, 2, 3, 4};
const std::vector<int> kCounts{1, 2, 4, 8};
#endif

using Items = std::map<std::pair<std::string, std::int64_t>, Item>;  // by output and frame

class KeepingSink final : public FrameSink {
 public:
  void write(std::string_view output, std::int64_t frame, const Item& item) override {
    const std::scoped_lock lock(mutex_);
    items[{std::string(output), frame}] = item;
  }
  Items items;

 private:
  std::mutex mutex_;
};

Items run(const std::shared_ptr<const Graph>& graph, SessionOptions options) {
  const auto box = Sequence::open(kBox);
  for (const GraphInput& input : graph->inputs) box->expect(input.name, input.type);
  options.dumps = {"motion.motion", "reproject.history[0]", "reproject.valid"};
  KeepingSink sink;
  Session session(graph, options);
  for (const FrameReport& report : session.run(kFrames, *box, sink)) EXPECT_TRUE(report.ok) << report.error;
  return sink.items;
}

void expect_same_bits(const Items& got, const Items& want) {
  ASSERT_EQ(got.size(), want.size());
  for (const auto& [key, item] : want) {
    ASSERT_TRUE(got.contains(key)) << key.first << " of frame " << key.second;
    const FloatImage a = got.at(key).image()->floats(), b = item.image()->floats();
    for (int c = 0; c < b.channels; ++c)
      for (int y = 0; y < b.height; ++y)
        ASSERT_EQ(std::memcmp(a.row(y, c), b.row(y, c), sizeof(float) * static_cast<std::size_t>(b.width)), 0)
            << key.first << " of frame " << key.second << ", plane " << c << ", row " << y;
  }
}

TEST(Games202Schedule, DoesNotShowOnTheBox) {
  if (!std::filesystem::exists(kBox)) GTEST_SKIP() << "the course data is not there: " << kBox;
  const Registry passes = load_plugins();
  // The filter takes most of the time, and a small one is as good for this.
  const auto graph = load_graph(QUELL_SOURCE_DIR "/graphs/games202.json", passes, {.set = {"filter.radius=3"}});
  const Items want = run(graph, {.threads = 1, .schedule = Schedule::serial});
  ASSERT_EQ(want.size(), 4 * kFrames.size());
  for (const int threads : kCounts)
    for (const int frames : kCounts) {
      SCOPED_TRACE(std::to_string(threads) + " threads, " + std::to_string(frames) + " frames in flight");
      expect_same_bits(run(graph, {.threads = threads, .frames_in_flight = frames}), want);
      if (HasFailure()) return;
    }
}

}  // namespace
}  // namespace quell
