#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "quell/metrics/comparison.h"
#include "quell/text/error.h"
#include "tests/core/metrics/test_pairs.h"

namespace quell {
namespace {

using namespace test;
using ::testing::ThrowsMessage;

constexpr Size kSize{4, 3};

Image of_type(PortType type, Size size = kSize) {
  return test_image(type, size, [](int, int, int) { return 0.0F; });
}

void expect_refused(const CompareInput& input, const char* message) {
  EXPECT_THAT([&] { score(input, Metric::psnr); }, ThrowsMessage<Error>(message));
  try {
    score(input, Metric::psnr);
  } catch (const Error& error) { EXPECT_EQ(error.fault(), Fault::input); }
}

TEST(Compare, RefusesImagesOfOtherSizes) {
  expect_refused({{gray(kSize, 0), gray({4, 2}, 0)}, {}, {}},
                 "the image is color of 4 x 2, the reference color of 4 x 3; both must have one size");
  const ImagePair pair{gray(kSize, 0), gray(kSize, 0)};
  expect_refused({pair, ImagePair{gray({5, 3}, 0), gray(kSize, 0)}, {}},
                 "the reference of the frame before is color of 5 x 3, the reference color of 4 x 3; both must have one size");
  expect_refused({pair, ImagePair{gray(kSize, 0), gray({8, 6}, 0)}, {}},
                 "the image of the frame before is color of 8 x 6, the reference color of 4 x 3; both must have one size");
  expect_refused({pair, {}, of_type(QUELL_TYPE_MOTION, {2, 2})},
                 "the motion is motion of 2 x 2, the reference color of 4 x 3; both must have one size");
}

TEST(Compare, RefusesWhatIsNoColor) {
  expect_refused({{of_type(QUELL_TYPE_DEPTH), gray(kSize, 0)}, {}, {}}, "the reference is depth of 4 x 3; metrics compare color");
  expect_refused({{gray(kSize, 0), test_ids(kSize, [](int, int) { return 1U; })}, {}, {}},
                 "the image is id of 4 x 3; metrics compare color");
  const ImagePair pair{gray(kSize, 0), gray(kSize, 0)};
  expect_refused({pair, ImagePair{of_type(QUELL_TYPE_ALBEDO), gray(kSize, 0)}, {}},
                 "the reference of the frame before is albedo of 4 x 3; metrics compare color");
  expect_refused({pair, ImagePair{gray(kSize, 0), of_type(QUELL_TYPE_ALBEDO)}, {}},
                 "the image of the frame before is albedo of 4 x 3; metrics compare color");
  expect_refused({pair, {}, of_type(QUELL_TYPE_MOMENTS)}, "the motion is moments of 4 x 3; motion of two planes is needed");
}

TEST(Compare, RefusesAPairOfOne) {
  expect_refused({{gray(kSize, 0), {}}, {}, {}}, "there is no image to compare");
  expect_refused({{{}, gray(kSize, 0)}, {}, {}}, "there is no reference to compare");
}

}  // namespace
}  // namespace quell
