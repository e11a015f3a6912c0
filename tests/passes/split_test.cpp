#include <gtest/gtest.h>

#include "noise.h"
#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "window_statistics.h"

namespace quell {
namespace {

constexpr Size kSize{37, 5};

TEST(Split, GivesThePlanesBitForBit) {
  for (const PortType type : {QUELL_TYPE_COLOR, QUELL_TYPE_NORMAL, QUELL_TYPE_MOTION}) {
    PassTest pass("split");
    pass.input("image", test_image(type, kSize, scene::color));
    pass.run();
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        ASSERT_EQ(pass.output("first").at(x, y), scene::color(x, y, 0));
        ASSERT_EQ(pass.output("second").at(x, y), scene::color(x, y, 1));
        ASSERT_EQ(pass.output("third").at(x, y), type == QUELL_TYPE_MOTION ? 0 : scene::color(x, y, 2));
      }
  }
}

TEST(Split, GivesLumaAndDifferencesOfColor) {
  PassTest pass("split");
  pass.set("space", "ycocg").input("image", test_image(QUELL_TYPE_COLOR, kSize, scene::color));
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const scene::Color want = scene::to_ycocg(scene::at(scene::color, x, y));
      ASSERT_NEAR(pass.output("first").at(x, y), want[0], 2.5e-7);  // two roundings of values up to 2
      ASSERT_NEAR(pass.output("second").at(x, y), want[1], 2.5e-7);
      ASSERT_NEAR(pass.output("third").at(x, y), want[2], 2.5e-7);
    }
}

TEST(Split, FindsNoDifferenceInGray) {
  PassTest pass("split");
  pass.set("space", "ycocg").input("image", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 0.3F; }));
  pass.run();
  EXPECT_EQ(pass.output("first").at(7, 3), 0.3F);
  EXPECT_EQ(pass.output("second").at(7, 3), 0.0F);
  EXPECT_EQ(pass.output("third").at(7, 3), 0.0F);
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(split);
QUELL_CONFORMANCE_TEST(split, .set("space", "ycocg"));
