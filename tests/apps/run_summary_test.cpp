#include "run_summary.h"

#include <gmock/gmock.h>

namespace quell::app::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

FrameReport report(std::int64_t frame, std::vector<ReplacedValues> replaced) {
  FrameReport result;
  result.frame = frame;
  result.replaced = std::move(replaced);
  return result;
}

TEST(RunSummary, AddsUpTheReplacedValuesOfEachInput) {
  EXPECT_THAT(sum_up_replaced({report(1, {{"color", QUELL_TYPE_COLOR, 3}}),
                               report(2, {{"color", QUELL_TYPE_COLOR, 40}, {"z", QUELL_TYPE_DEPTH, 1}}), report(3, {}),
                               report(5, {{"color", QUELL_TYPE_COLOR, 2}})}),
              ElementsAre("color: 45 values were NaN or infinite and count as 0 (frames 1-2,5)",
                          "z: 1 value was NaN or infinite and counts as 1e10 (no surface) (frame 2)"));
  EXPECT_THAT(sum_up_replaced({report(1, {})}), IsEmpty());
}

FrameReport report(std::int64_t frame, bool ok) {
  FrameReport result;
  result.frame = frame;
  result.ok = ok;
  return result;
}

TEST(RunSummary, FindsWhatWasNotComputedAmongAllFrames) {
  const FrameSets sets = sort_frames({1, 2, 3, 5, 8, 9}, {report(1, true), report(3, false), report(8, true)});
  EXPECT_THAT(sets.done, ElementsAre(1, 8));
  EXPECT_THAT(sets.failed, ElementsAre(3));
  EXPECT_THAT(sets.not_computed, ElementsAre(2, 5, 9));
}

TEST(RunSummary, TellsWhyARunEnded) {
  for (const bool stop_on_error : {false, true}) {
    EXPECT_EQ(ending_of({{1, 2}, {}, {}}, stop_on_error), Ending::done);
    EXPECT_EQ(ending_of({{1}, {2}, {}}, stop_on_error), Ending::failed) << "nothing was left to stop";
    EXPECT_EQ(ending_of({{1}, {}, {2}}, stop_on_error), Ending::interrupted);
    EXPECT_EQ(ending_of({{1}, {2}, {3}}, stop_on_error), stop_on_error ? Ending::stopped : Ending::interrupted);
  }
}

}  // namespace
}  // namespace quell::app::testing
