#include <gtest/gtest.h>

#include <cstdio>
#include <limits>
#include <memory>
#include <string>

#include "quell/metrics/flip.h"

namespace quell {
namespace {

using Color = std::array<std::uint8_t, 3>;

// Of bids.github.io/colormap, where the map was published.
TEST(FlipColor, GoesFromBlackOverMagentaToPaleYellow) {
  EXPECT_EQ(flip_color(0), (Color{0, 0, 4}));
  EXPECT_EQ(flip_color(128.0 / 255), (Color{183, 55, 121}) /* as magma(128) */);
  EXPECT_EQ(flip_color(1), (Color{252, 253, 191}));
}

TEST(FlipColor, TakesTheNearestOf256Colors) {
  EXPECT_EQ(flip_color(0.4 / 255), flip_color(0));
  EXPECT_EQ(flip_color(0.6 / 255), flip_color(1.0 / 255));
  EXPECT_NE(flip_color(0), flip_color(1.0 / 255));
}

TEST(FlipColor, ClampsErrorsAndTakesNoneForNan) {
  EXPECT_EQ(flip_color(-1), flip_color(0));
  EXPECT_EQ(flip_color(7), flip_color(1));
  EXPECT_EQ(flip_color(std::numeric_limits<double>::infinity()), flip_color(1));
  EXPECT_EQ(flip_color(std::numeric_limits<double>::quiet_NaN()), flip_color(0));
}

TEST(FlipColor, IsMatplotlibsMagma) {
  const char* const command = QUELL_PYTHON
      " -c 'import matplotlib.cm as m\n"
      "for i in range(256): print(*[round(255 * v) for v in m.magma(i)[:3]])' 2>/dev/null";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> colors(popen(command, "r"), pclose);
  int red = 0, green = 0, blue = 0, count = 0;
  while (std::fscanf(colors.get(), "%d %d %d", &red, &green, &blue) == 3) {
    const Color want{static_cast<std::uint8_t>(red), static_cast<std::uint8_t>(green), static_cast<std::uint8_t>(blue)};
    EXPECT_EQ(flip_color(count / 255.0), want) << count;
    ++count;
  }
  if (count == 0) GTEST_SKIP() << "matplotlib is not there for " QUELL_PYTHON;
  EXPECT_EQ(count, 256);
}

}  // namespace
}  // namespace quell
