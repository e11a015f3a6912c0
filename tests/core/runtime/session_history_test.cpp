// Frames that are computed again, or in another order than that of their numbers.
#include <gtest/gtest.h>

#include "tests/core/runtime/memory_stream.h"

namespace quell {
namespace {

TEST(SessionHistory, HoldsTheLatestResultOfAFrameThatIsComputedAgain) {
  BufferPool pool;
  Session session(test_graph(kSumGraph));
  session.push(1, {{"color", flat_color({4, 4}, 1.0F, pool)}});
  session.push(1, {{"color", flat_color({4, 4}, 10.0F, pool)}});
  const auto outputs = session.push(2, {{"color", flat_color({4, 4}, 2.0F, pool)}});
  EXPECT_EQ(outputs.at("color").image()->floats().at(0, 0), 12.0F);
}

TEST(SessionHistory, ForgetsAFrameThatIsComputedAgainAndFails) {
  BufferPool pool;
  bool stop = false;
  Session session(test_graph(kSumGraph), {.cancelled = [&] { return stop; }});
  session.push(1, {{"color", flat_color({4, 4}, 1.0F, pool)}});
  stop = true;
  EXPECT_THROW(session.push(1, {{"color", flat_color({4, 4}, 10.0F, pool)}}), Cancelled);
  stop = false;
  const auto outputs = session.push(2, {{"color", flat_color({4, 4}, 2.0F, pool)}});
  EXPECT_EQ(outputs.at("color").image()->floats().at(0, 0), 2.0F);
}

TEST(SessionHistory, StaysAsLongAsTheDelayWhenFramesDescend) {
  MemorySource source;
  Session session(test_graph(kSumGraph));
  for (std::int64_t frame = 50; frame > 0; --frame) {
    MemorySink sink;
    session.run({frame}, source, sink);
    EXPECT_EQ(sink.pixel("color", frame), static_cast<float>(frame)) << "the frame before was not computed yet";
  }
  EXPECT_EQ(session.pool().usage().in_use, Image::bytes_needed(QUELL_TYPE_COLOR, source.size));
}

TEST(SessionHistory, IsThatOfTheNewRunWhenARunStartsAgain) {
  MemorySource source;
  Session session(test_graph(kSumGraph));
  MemorySink first, second;
  session.run({1, 2, 3}, source, first);
  source.paint = [](Image& image, std::int64_t) { image.writable_floats().at(0, 0) = 100.0F; };
  session.run({1, 2, 3, 4}, source, second);
  EXPECT_EQ(second.pixel("color", 4), 400.0F);
}

}  // namespace
}  // namespace quell
