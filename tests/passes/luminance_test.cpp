#include <gtest/gtest.h>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"

namespace quell {
namespace {

TEST(Luminance, WeighsTheChannels) {
  PassTest pass("luminance");
  pass.input("color",
             test_image(QUELL_TYPE_COLOR, {37, 3}, [](int x, int y, int c) { return static_cast<float>(x + 10 * y * c); }));
  pass.run();
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 37; ++x)  // three roundings
      EXPECT_NEAR(pass.output("luminance").at(x, y), 0.2126 * x + 0.7152 * (x + 10 * y) + 0.0722 * (x + 20 * y),
                  2e-7 * (x + 20 * y));
}

TEST(Luminance, OfWhiteIsOne) {
  PassTest pass("luminance");
  pass.input("color", test_image(QUELL_TYPE_COLOR, {5, 5}, [](int, int, int) { return 1.0F; }));
  pass.run();
  EXPECT_NEAR(pass.output("luminance").at(4, 4), 1, 1.2e-7);
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(luminance);
