// Images whose size or type changes on the way, and outputs that nobody reads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/core/runtime/memory_stream.h"

namespace quell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const char* const kLookingAhead = R"({"quell": 1, "inputs": {"color": "color"},
  "nodes": {"sum": {"pass": "accumulate", "in": {"color": "color", "history": {"from": "color", "delay": -1, "initial": "none"}}}},
  "outputs": {"color": "sum.color"}})";

TEST(SessionShapes, FrameAheadOfAnotherSizeCountsAsAbsent) {
  MemorySource source;
  source.odd_size[3] = {5, 3};
  MemorySink sink;
  Session session(test_graph(kLookingAhead));
  const auto reports = session.run({1, 2, 3, 4}, source, sink);
  for (const FrameReport& report : reports) EXPECT_TRUE(report.ok) << report.error;
  EXPECT_EQ(sink.pixel("color", 1), 3.0F);
  EXPECT_EQ(sink.pixel("color", 2), 2.0F);
  EXPECT_EQ(sink.pixel("color", 3), 3.0F);
  EXPECT_EQ(source.reads.size(), 4U) << "every frame is read once";
}

TEST(SessionShapes, ConstantForWhatIsNeverThereHasTheSizeOfTheOtherInputs) {
  MemorySource source;
  source.absent = {"extra"};
  MemorySink sink;
  Session session(test_graph(R"({"quell": 1, "inputs": {"color": "color", "extra": {"type": "color", "optional": true}},
    "nodes": {"soft": {"pass": "mix", "in": {"color": "extra"}},
              "half": {"pass": "halve", "in": {"color": "color", "other": {"from": "soft.color", "delay": 1, "initial": {"constant": [2]}}}}},
    "outputs": {"color": "half.color", "width": "half.width"}})"));
  const auto reports = session.run({7}, source, sink);
  ASSERT_TRUE(reports[0].ok) << reports[0].error;
  EXPECT_EQ(sink.pixel("color", 7, 3, 2), 9.0F);
  EXPECT_THAT(*sink.items.at({"width", 7}).values(), ElementsAre(8.0));
}

TEST(SessionShapes, OutputThatNobodyReadsIsLetGo) {
  MemorySource source;
  MemorySink sink;
  Session session(test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"half": {"pass": "halve", "in": {"color": "color"}}}, "outputs": {"width": "half.width"}})"));
  const auto reports = session.run({1, 2}, source, sink);
  for (const FrameReport& report : reports) EXPECT_TRUE(report.ok) << report.error;
  EXPECT_EQ(sink.items.size(), 2U);
  sink.items.clear();
  EXPECT_EQ(session.pool().usage().in_use, 0U);
}

// Serves ids that are 5 everywhere, and keeps none of them.
class IdSource final : public FrameSource {
 public:
  std::optional<Shape> shape(std::string_view) override { return Shape{QUELL_TYPE_ID, {3, 2}, 0, true}; }
  Item read(std::string_view, std::int64_t, BufferPool& pool) override {
    Image image(QUELL_TYPE_ID, {3, 2}, pool);
    for (int y = 0; y < 2; ++y) std::fill_n(image.writable_ids().row(y), 3, 5U);
    return image;
  }
};

TEST(SessionShapes, NumbersOfOneFormatAreNotWrittenOverThoseOfAnother) {
  IdSource source;
  MemorySink sink;
  Session session(test_graph(R"({"quell": 1, "inputs": {"id": "id"},
    "nodes": {"weigh": {"pass": "weigh", "in": {"id": "id"}}}, "outputs": {"weight": "weigh.weight"}})"));
  session.run({1}, source, sink);
  EXPECT_EQ(sink.pixel("weight", 1, 2, 1), 5.0F);
}

TEST(SessionShapes, EveryPushedImageMustBeOfItsInputsType) {
  BufferPool pool;
  Session session(test_graph(kSumGraph));
  session.push(1, {{"color", flat_color({4, 4}, 1.0F, pool)}});
  EXPECT_THAT(
      [&] {
        session.push(2, {{"color", Image(QUELL_TYPE_DEPTH, {4, 4}, pool)}});
      },
      ::testing::ThrowsMessage<Error>(HasSubstr("the input 'color' is of type color, but the source gives depth")));
}

TEST(SessionShapes, MemoryOfTheFormerSizeIsGivenBack) {
  MemorySource source;
  source.odd_size[2] = {200, 100};
  Session session(test_graph(kSumGraph));
  for (const std::int64_t frame : {1, 2, 3}) {
    MemorySink sink;
    session.run({frame}, source, sink);
  }
  EXPECT_LT(session.pool().usage().idle, Image::bytes_needed(QUELL_TYPE_COLOR, {200, 100}));
}

}  // namespace
}  // namespace quell
