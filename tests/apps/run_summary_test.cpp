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

}  // namespace
}  // namespace quell::app::testing
