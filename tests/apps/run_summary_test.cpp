#include "run_summary.h"

#include <gmock/gmock.h>

namespace quell::app::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

FrameReport report(std::int64_t frame, std::vector<std::string> warnings) {
  FrameReport result;
  result.frame = frame;
  result.warnings = std::move(warnings);
  return result;
}

TEST(RunSummary, AddsUpCountsOfTheSameWarning) {
  EXPECT_THAT(
      sum_up_warnings({report(1, {"color: 3 values were bad"}), report(2, {"color: 40 values were bad", "id: 1 value was bad"}),
                       report(3, {}), report(5, {"color: 2 values were bad"})}),
      ElementsAre("color: 45 values were bad (frames 1-2,5)", "id: 1 value was bad (frame 2)"));
}

TEST(RunSummary, TellsOtherWarningsOnceWithTheirFrames) {
  EXPECT_THAT(sum_up_warnings({report(1, {"strange"}), report(2, {"strange"}), report(3, {"file.0001.exr: 2x2"})}),
              ElementsAre("file.0001.exr: 2x2 (frame 3)", "strange (frames 1-2)"));
  EXPECT_THAT(sum_up_warnings({}), IsEmpty());
}

}  // namespace
}  // namespace quell::app::testing
