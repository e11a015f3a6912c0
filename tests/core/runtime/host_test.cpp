#include "quell/runtime/host.h"

#include <gtest/gtest.h>

#include <mutex>
#include <stdexcept>
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

}  // namespace
}  // namespace quell
