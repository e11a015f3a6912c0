#include <gtest/gtest.h>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "quell/text/error.h"

using namespace quell;

QUELL_CONFORMANCE_TEST(invert);

TEST(Invert, TakesColorsHalfWayAtAmountHalf) {
  PassTest pass("invert");
  pass.set("amount", 0.5);
  pass.input("color", test_image(QUELL_TYPE_COLOR, {4, 3}, [](int x, int y, int c) { return float(x + y + c); }));
  pass.run();
  const FloatImage out = pass.output("color");
  EXPECT_EQ(out.at(0, 0, 0), 0.5f);  // 0 + 0.5 (1 - 0)
  EXPECT_EQ(out.at(3, 2, 2), 0.5f);  // 7 + 0.5 (1 - 14)
}

TEST(Invert, SaysWhichAmountsItTakes) {
  PassTest pass("invert");
  EXPECT_THROW(pass.set("amount", 2.0).run(), Error);
}
