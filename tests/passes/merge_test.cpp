#include <gtest/gtest.h>

#include "noise.h"
#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "window_statistics.h"

namespace quell {
namespace {

constexpr Size kSize{37, 5};

Image plane(int c) {
  return test_image(QUELL_TYPE_SCALAR, kSize, [c](int x, int y, int) { return scene::color(x, y, c) - 0.5F; });
}

TEST(Merge, TakesPlanesAsTheyAre) {
  PassTest pass("merge");
  pass.input("first", plane(0)).input("third", plane(2));
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      ASSERT_EQ(pass.output("color").at(x, y, 0), scene::color(x, y, 0) - 0.5F);
      ASSERT_EQ(pass.output("color").at(x, y, 1), 0.0F) << "it is not connected";
      ASSERT_EQ(pass.output("color").at(x, y, 2), scene::color(x, y, 2) - 0.5F);
    }
}

TEST(Merge, TakesLumaAndDifferencesOfColor) {
  PassTest pass("merge");
  pass.set("space", "ycocg").input("first", plane(0)).input("second", plane(1)).input("third", plane(2));
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const scene::Color want =
          scene::from_ycocg({scene::color(x, y, 0) - 0.5F, scene::color(x, y, 1) - 0.5F, scene::color(x, y, 2) - 0.5F});
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(pass.output("color").at(x, y, c), want[static_cast<std::size_t>(c)], 6e-7);  // two roundings of up to 3
    }
}

TEST(Merge, IsTheInverseOfSplit) {
  for (const char* space : {"planes", "ycocg"}) {
    PassTest there("split"), back("merge");
    there.set("space", space).input("image", test_image(QUELL_TYPE_COLOR, kSize, scene::color));
    there.run();
    back.set("space", space);
    for (const char* port : {"first", "second", "third"}) back.input(port, there.output_item(port));
    back.run();
    for (int c = 0; c < 3; ++c)
      for (int y = 0; y < kSize.height; ++y)
        for (int x = 0; x < kSize.width; ++x)
          ASSERT_NEAR(back.output("color").at(x, y, c), scene::color(x, y, c), 8e-7) << space << " " << x << "," << y;
  }
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(merge);
QUELL_CONFORMANCE_TEST(merge, .set("space", "ycocg"));
