#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "noise.h"
#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "window_statistics.h"

namespace quell {
namespace {

constexpr Size kSize{37, 17};

bool is_valid(int x, int y) { return (x + 3 * y) % 5 != 0; }

struct Case {
  std::string box = "rounded", limit = "clip";
  double alpha = 0.1, k = 1;
  bool weigh = true, with_valid = true;
  Size size = kSize;
};

PassTest make(const Case& c) {
  PassTest pass("taa");
  pass.set("alpha", c.alpha).set("box", c.box).set("limit", c.limit).set("k", c.k).set("weigh", c.weigh);
  pass.input("color", test_image(QUELL_TYPE_COLOR, c.size, scene::color));
  pass.input("history", test_image(QUELL_TYPE_COLOR, c.size, scene::other_color));
  if (c.with_valid)
    pass.input("valid", test_image(QUELL_TYPE_MASK, c.size, [](int x, int y, int) { return is_valid(x, y) ? 1.0F : 0.0F; }));
  return pass;
}

struct Box {
  double lower, upper;
};

Box box_of(const Case& c, int x, int y, std::size_t component) {
  std::vector<double> square, cross;
  scene::around(c.size, x, y, 1, [&](int qx, int qy) {
    const double value = scene::to_ycocg(scene::at(scene::color, qx, qy))[component];
    square.push_back(value);
    if (std::abs(qx - x) + std::abs(qy - y) <= 1) cross.push_back(value);
  });
  if (c.box == "variance") {
    const scene::MeanAndDeviation s = scene::statistics(square);
    return {s.mean - c.k * s.deviation, s.mean + c.k * s.deviation};
  }
  const Box wide{*std::ranges::min_element(square), *std::ranges::max_element(square)};
  if (c.box == "range") return wide;
  return {(wide.lower + *std::ranges::min_element(cross)) / 2, (wide.upper + *std::ranges::max_element(cross)) / 2};
}

scene::Color limited(const Case& c, int x, int y) {
  scene::Color history = scene::to_ycocg(scene::at(scene::other_color, x, y));
  if (c.limit == "none") return history;
  double farthest = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const Box box = box_of(c, x, y, i);
    if (c.limit == "clamp") history[i] = std::clamp(history[i], box.lower, box.upper);
    farthest = std::max(farthest, std::abs(history[i] - (box.lower + box.upper) / 2) / ((box.upper - box.lower) / 2));
  }
  if (c.limit == "clip" && farthest > 1)
    for (std::size_t i = 0; i < 3; ++i) {
      const Box box = box_of(c, x, y, i);
      const double center = (box.lower + box.upper) / 2;
      history[i] = center + (history[i] - center) / farthest;
    }
  return history;
}

// The formula of the documentation.
scene::Color expected(const Case& c, int x, int y) {
  const scene::Color frame = scene::at(scene::color, x, y), ycocg = limited(c, x, y), history = scene::from_ycocg(ycocg);
  if (c.with_valid && !is_valid(x, y)) return frame;
  const auto weight = [&](double luma) { return c.weigh ? 1 / (1 + std::max(luma, 0.0)) : 1; };
  const double now = c.alpha * weight(scene::luma(frame)), before = (1 - c.alpha) * weight(ycocg[0]);
  scene::Color result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = (now * frame[i] + before * history[i]) / (now + before);
  return result;
}

// A few roundings of values up to 6.
TEST(Taa, EqualsItsFormulaInDouble) {
  std::vector<Case> cases{{.alpha = 0.5, .weigh = false, .with_valid = false}, {.alpha = 0}, {.alpha = 1}, {.limit = "none"}};
  for (const char* box : {"range", "rounded", "variance"})
    for (const char* limit : {"clip", "clamp"}) cases.push_back({.box = box, .limit = limit, .k = 0.8});
  for (const Size size : {Size{1, 1}, Size{5, 16}, Size{16, 3}}) cases.push_back({.box = "variance", .size = size});
  for (const Case& c : cases) {
    PassTest pass = make(c);
    pass.run();
    for (int y = 0; y < c.size.height; ++y)
      for (int x = 0; x < c.size.width; ++x) {
        const scene::Color want = expected(c, x, y);
        for (int i = 0; i < 3; ++i)
          ASSERT_NEAR(pass.output("color").at(x, y, i), want[static_cast<std::size_t>(i)], 5e-6)
              << c.box << " " << c.limit << " at " << x << "," << y;
      }
  }
}

TEST(Taa, TakesTheFrameWithoutAHistory) {
  PassTest pass("taa");
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, scene::color));
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) ASSERT_EQ(pass.output("color").at(x, y, 1), scene::color(x, y, 1));
}

TEST(Taa, LeavesOutWhatIsNotValidWhateverItIs) {
  PassTest pass = make({});
  pass.input("history", test_image(QUELL_TYPE_COLOR, kSize, [](int x, int y, int c) {
               return is_valid(x, y) ? scene::other_color(x, y, c) : std::numeric_limits<float>::quiet_NaN();
             }));
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      if (is_valid(x, y))
        ASSERT_TRUE(std::isfinite(pass.output("color").at(x, y))) << x << "," << y;
      else
        ASSERT_EQ(pass.output("color").at(x, y), scene::color(x, y, 0)) << x << "," << y;
    }
}

// Where all neighbors are alike the box is a point, and nothing of another history passes.
TEST(Taa, LetsNothingPassABoxWithoutSides) {
  for (const char* box : {"range", "rounded", "variance"})
    for (const char* limit : {"clip", "clamp"}) {
      PassTest pass("taa");
      pass.set("box", box).set("limit", limit);
      pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int c) { return 0.25F * static_cast<float>(c + 1); }));
      pass.input("history", test_image(QUELL_TYPE_COLOR, kSize, [](int x, int, int) { return x % 2 ? 3e8F : 0.0F; }));
      pass.run();
      for (int x = 0; x < kSize.width; ++x)
        for (int c = 0; c < 3; ++c)
          // Roundings of a color of three components.
          ASSERT_NEAR(pass.output("color").at(x, 8, c), 0.25 * (c + 1), 3e-7) << box << " " << limit << " " << x;
    }
}

// A pixel that flickers between 0 and 99: weighted, it settles near the dark end, where tone mapping would put its mean.
TEST(Taa, WeighsBrightSamplesDown) {
  const auto settle = [](bool weigh) {
    PassTest pass("taa");
    pass.set("limit", "none").set("weigh", weigh).feed_back("color", "history");
    float result = 0;
    for (int frame = 0; frame < 200; ++frame) {
      pass.input("color", test_image(QUELL_TYPE_COLOR, {4, 4}, [=](int, int, int) { return frame % 2 ? 99.0F : 0.0F; }));
      pass.run();
      result = pass.output("color").at(2, 2);
    }
    return result;
  };
  // The plain average swings around 49.5: after a bright frame it is 99 / (2 - alpha).
  EXPECT_NEAR(settle(false), 99 / 1.9, 1e-3);
  EXPECT_LT(settle(true), 5);
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(taa);
QUELL_CONFORMANCE_TEST(taa, .set("box", "variance").set("limit", "clamp").set("weigh", false));
QUELL_CONFORMANCE_TEST(taa, .set("limit", "none"));
