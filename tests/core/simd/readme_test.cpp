// The kernel that passes/README.md shows is built and run here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "quell/sdk/types.h"

namespace fade {
void fade_rows(const quell::FloatImage& in, float knee, const quell::FloatOutput& out, int y0, int y1);
}

namespace quell {
namespace {

std::string read_all(const std::string& file) {
  std::ifstream stream(std::string(QUELL_SOURCE_DIR) + "/" + file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(PassesReadme, ShowsTheKernelThatIsBuiltHere) {
  const std::string kernel = read_all("tests/core/simd/fade_kernel.cpp");
  ASSERT_FALSE(kernel.empty());
  EXPECT_THAT(read_all("passes/README.md"), ::testing::HasSubstr("```cpp\n" + kernel + "```\n"));
}

TEST(FadeKernel, DarkensWhatIsBrightAndStaysInItsRows) {
  constexpr int kWidth = 21, kHeight = 3, kStride = 48, kPlane = kHeight * kStride;
  std::vector<float> from(3 * kPlane + 16), to(3 * kPlane + 16, -1.0F);
  for (std::size_t i = 0; i < from.size(); ++i) from[i] = static_cast<float>(i % 37) / 8;
  const FloatImage in{kWidth, kHeight, 3, kStride, kPlane, from.data()};
  const FloatOutput out{kWidth, kHeight, 3, kStride, kPlane, to.data()};
  fade::fade_rows(in, 2, out, 0, 2);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kStride; ++x) {
      const double l = 0.2126 * in.at(x, y, 0) + 0.7152 * in.at(x, y, 1) + 0.0722 * in.at(x, y, 2);
      for (int c = 0; c < 3; ++c) {
        const double want = y < 2 && x < kWidth ? in.at(x, y, c) * std::exp2(-l / 2) : -1;
        ASSERT_NEAR(out.at(x, y, c), want, 1e-5 * std::abs(want)) << x << "," << y;
      }
    }
}

}  // namespace
}  // namespace quell
