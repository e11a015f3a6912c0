#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "noise.h"
#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "quell/text/error.h"

namespace quell {
namespace {

constexpr Size kSize{37, 5};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Below 0 and above 1, too.
float share(int x, int y, int) { return static_cast<float>(1.6 * scene::noise(x, y, 77) - 0.3); }

PassTest make() {
  PassTest pass("mix");
  pass.input("a", test_image(QUELL_TYPE_COLOR, kSize, scene::color));
  pass.input("b", test_image(QUELL_TYPE_COLOR, kSize, scene::other_color));
  return pass;
}

// Roundings of values up to 6.
TEST(Mix, EqualsItsFormulaInDouble) {
  for (const double amount : {0.0, 0.25, 0.5, 0.9, 1.0})
    for (const bool by_image : {false, true}) {
      PassTest pass = make();
      pass.set("amount", amount);
      if (by_image) pass.input("t", test_image(QUELL_TYPE_SCALAR, kSize, share));
      pass.run();
      for (int c = 0; c < 3; ++c)
        for (int y = 0; y < kSize.height; ++y)
          for (int x = 0; x < kSize.width; ++x) {
            const double s = amount * (by_image ? std::clamp(double{share(x, y, 0)}, 0.0, 1.0) : 1);
            const double a = scene::color(x, y, c), b = scene::other_color(x, y, c);
            ASSERT_NEAR(pass.output("image").at(x, y, c), a + (b - a) * s, 2e-6) << x << "," << y;
          }
    }
}

TEST(Mix, ChoosesByAMaskWhateverTheOtherIs) {
  PassTest pass("mix");
  const auto is_b = [](int x, int y) { return (x + y) % 3 == 0; };
  pass.set("amount", 1.0);
  pass.input("a",
             test_image(QUELL_TYPE_COLOR, kSize, [&](int x, int y, int c) { return is_b(x, y) ? kNan : scene::color(x, y, c); }));
  pass.input("b", test_image(QUELL_TYPE_COLOR, kSize,
                             [&](int x, int y, int c) { return is_b(x, y) ? scene::other_color(x, y, c) : kNan; }));
  pass.input("t", test_image(QUELL_TYPE_MASK, kSize, [&](int x, int y, int) { return is_b(x, y) ? 1.0F : 0.0F; }));
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      ASSERT_EQ(pass.output("image").at(x, y, 2), is_b(x, y) ? scene::other_color(x, y, 2) : scene::color(x, y, 2));
}

TEST(Mix, KeepsWhatIsAlikeAndWhatIsFarDarkerThanTheOther) {
  PassTest pass("mix");
  pass.set("amount", 0.75);
  pass.input("a", test_image(QUELL_TYPE_COLOR, kSize, [](int x, int, int) { return x == 0 ? 0.1F : 1e8F; }));
  pass.input("b", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 0.1F; }));
  pass.run();
  EXPECT_EQ(pass.output("image").at(0, 0), 0.1F);
  EXPECT_NEAR(pass.output("image").at(1, 0), 0.25e8 + 0.075, 4);
}

TEST(Mix, IsAWithoutB) {
  PassTest pass = make();
  pass.disconnect("b").run();
  for (int x = 0; x < kSize.width; ++x) EXPECT_EQ(pass.output("image").at(x, 2, 1), scene::color(x, 2, 1));
}

TEST(Mix, RefusesImagesOfTwoTypes) {
  PassTest pass = make();
  pass.disconnect("b").input("b", test_image(QUELL_TYPE_MOTION, kSize, scene::color));
  EXPECT_THROW(pass.run(), Error);
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(mix);
