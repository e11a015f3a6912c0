#include "quell/runtime/host.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace quell {
namespace {

struct Chunks {
  std::mutex mutex;
  std::vector<std::pair<std::int64_t, std::int64_t>> bounds;
  std::int64_t failing = -10;
};

quell_status record(void* context, std::int64_t chunk, std::int64_t begin, std::int64_t end, std::uint32_t) {
  auto& chunks = *static_cast<Chunks*>(context);
  const std::scoped_lock lock(chunks.mutex);
  if (chunks.bounds.size() <= static_cast<std::size_t>(chunk)) chunks.bounds.resize(static_cast<std::size_t>(chunk) + 1);
  chunks.bounds[static_cast<std::size_t>(chunk)] = {begin, end};
  if (chunk == chunks.failing + 2) return QUELL_CANCELLED;
  return chunk == chunks.failing ? QUELL_FAILED : QUELL_OK;
}

class HostTest : public ::testing::Test {
 protected:
  std::unique_ptr<Executor> executor = make_executor(3);
  HostServices services{executor.get(), {}, {}};
};

TEST_F(HostTest, CutsChunksByTheGrainAlone) {
  const Host host(services);
  Chunks chunks;
  EXPECT_EQ(host.raw().parallel_for(&host.raw(), 5, 26, 8, record, &chunks), QUELL_OK);
  EXPECT_EQ(chunks.bounds, (std::vector<std::pair<std::int64_t, std::int64_t>>{{5, 13}, {13, 21}, {21, 26}}));
}

TEST_F(HostTest, ReturnsTheStatusOfTheLowestChunkThatFailed) {
  const Host host(services);
  Chunks chunks;
  chunks.failing = 4;
  EXPECT_EQ(host.raw().parallel_for(&host.raw(), 0, 100, 1, record, &chunks), QUELL_FAILED);
  EXPECT_EQ(chunks.bounds.size(), 100U) << "all chunks run";
}

TEST_F(HostTest, StopsAnExceptionOfAPluginThatBreaksTheRules) {
  Host host(services);
  const quell_chunk_fn thrower = [](void*, std::int64_t, std::int64_t, std::int64_t, std::uint32_t) -> quell_status {
    throw std::runtime_error("out of a chunk");
  };
  EXPECT_EQ(host.raw().parallel_for(&host.raw(), 0, 10, 1, thrower, nullptr), QUELL_FAILED);
  EXPECT_EQ(host.take_error(), "an exception left a chunk of a parallel loop");
}

TEST_F(HostTest, DoesNothingForAnEmptyRange) {
  const Host host(services);
  Chunks chunks;
  EXPECT_EQ(host.raw().parallel_for(&host.raw(), 3, 3, 8, record, &chunks), QUELL_OK);
  EXPECT_TRUE(chunks.bounds.empty());
}

TEST_F(HostTest, TreatsAGrainOfZeroAsOne) {
  const Host host(services);
  Chunks chunks;
  EXPECT_EQ(host.raw().parallel_for(&host.raw(), 0, 3, 0, record, &chunks), QUELL_OK);
  EXPECT_EQ(chunks.bounds.size(), 3U);
}

TEST_F(HostTest, PassesMessagesOnAndForgetsAnErrorOnceTaken) {
  std::string said;
  services.log = [&](int level, const std::string& message) { said = std::to_string(level) + message; };
  Host host(services);
  host.raw().log(&host.raw(), QUELL_LOG_WARNING, "careful");
  EXPECT_EQ(said, "2careful");
  host.raw().set_error(&host.raw(), "no");
  EXPECT_EQ(host.take_error(), "no");
  EXPECT_EQ(host.take_error(), "");
  EXPECT_EQ(host.raw().cancelled(&host.raw()), 0);
}

TEST_F(HostTest, LeavesOutTheRestOfALoopOnceCancelled) {
  executor = make_executor(1);
  services.executor = executor.get();
  int chunks = 0;
  services.cancelled = [&] { return chunks == 4; };
  const quell_chunk_fn count = [](void* context, std::int64_t, std::int64_t, std::int64_t, std::uint32_t) -> quell_status {
    ++*static_cast<int*>(context);
    return QUELL_FAILED;
  };
  Host host(services);
  EXPECT_EQ(host.raw().parallel_for(&host.raw(), 0, 100, 1, count, &chunks), QUELL_CANCELLED);
  EXPECT_EQ(chunks, 4);
  EXPECT_TRUE(host.was_cancelled());
  chunks = 0;
  EXPECT_EQ(host.raw().parallel_for(&host.raw(), 0, 100, 1, count, &chunks), QUELL_CANCELLED);
  EXPECT_EQ(chunks, 0) << "who was told so once is told so until the next frame";
  host.begin(2);
  EXPECT_FALSE(host.was_cancelled());
  services.cancelled = {};
  EXPECT_EQ(host.raw().parallel_for(&host.raw(), 0, 100, 1, count, &chunks), QUELL_FAILED);
  EXPECT_EQ(chunks, 100);
}

TEST_F(HostTest, StopsAnExceptionOfWhoIsAskedForCancellation) {
  services.cancelled = []() -> bool { throw std::runtime_error("from the caller"); };
  const Host host(services);
  Chunks chunks;
  EXPECT_EQ(host.raw().parallel_for(&host.raw(), 0, 10, 1, record, &chunks), QUELL_FAILED);
}

// The threads that ran a chunk, each of which waits for a second thread to come.
struct Crew {
  std::mutex mutex;
  std::set<std::thread::id> members;
  std::size_t chunks = 0;

  static quell_status work(void* context, std::int64_t, std::int64_t, std::int64_t, std::uint32_t) {
    Crew& crew = *static_cast<Crew*>(context);
    const auto enter = [&] {
      const std::scoped_lock lock(crew.mutex);
      crew.members.insert(std::this_thread::get_id());
      return crew.members.size();
    };
    while (enter() < 2) std::this_thread::yield();
    const std::scoped_lock lock(crew.mutex);
    ++crew.chunks;
    return QUELL_OK;
  }
};

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

TEST_F(HostTest, TracesEachThreadThatHelpsInALoopOnce) {
  std::ostringstream text;
  Trace trace(text);
  services.trace = &trace;
  Host host(services, "smooth");
  host.begin(12);
  Crew crew;
  EXPECT_EQ(host.raw().parallel_for(&host.raw(), 0, 200, 1, Crew::work, &crew), QUELL_OK);
  trace.finish();
  EXPECT_EQ(crew.chunks, 200U);
  crew.members.erase(std::this_thread::get_id());
  EXPECT_GE(crew.members.size(), 1U);
  EXPECT_EQ(count(text.str(), R"("cat":"help","name":"smooth","args":{"frame":12})"), crew.members.size()) << text.str();
}

TEST_F(HostTest, RunsEveryChunkOnceWhenTracedThoughHelpersAreCalledAway) {
  std::ostringstream text;
  Trace trace(text);
  services.trace = &trace;
  Host host(services);
  std::atomic<bool> stop = false;
  const std::jthread reader([&] {
    while (!stop) {
      executor->budget().take();
      executor->budget().give_back();
    }
  });
  for (int round = 0; round < 50; ++round) {
    std::vector<std::atomic<int>> runs(300);
    const quell_chunk_fn mark = [](void* context, std::int64_t chunk, std::int64_t, std::int64_t, std::uint32_t) -> quell_status {
      ++(*static_cast<std::vector<std::atomic<int>>*>(context))[static_cast<std::size_t>(chunk)];
      std::this_thread::yield();
      return QUELL_OK;
    };
    EXPECT_EQ(host.raw().parallel_for(&host.raw(), 0, 300, 1, mark, &runs), QUELL_OK);
    EXPECT_TRUE(std::ranges::all_of(runs, [](const auto& times) { return times == 1; }));
  }
  stop = true;
}

}  // namespace
}  // namespace quell
