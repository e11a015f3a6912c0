#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "noise.h"
#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "quell/text/error.h"

namespace quell {
namespace {

const std::vector<Size> kSizes{{1, 1}, {1, 7}, {16, 2}, {19, 9}, {37, 18}};

int half(int size) { return (size + 1) / 2; }

TEST(Scale, HalvesByTheMeanOfWhatExists) {
  for (const Size size : kSizes) {
    PassTest pass("scale");
    pass.input("image", test_image(QUELL_TYPE_COLOR, size, scene::color));
    pass.run();
    const FloatImage out = pass.output("image");
    ASSERT_EQ(out.width, half(size.width));
    ASSERT_EQ(out.height, half(size.height));
    for (int c = 0; c < 3; ++c)
      for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
          double sum = 0, count = 0;
          for (int qy = 2 * y; qy < std::min(2 * y + 2, size.height); ++qy)
            for (int qx = 2 * x; qx < std::min(2 * x + 2, size.width); ++qx) sum += scene::color(qx, qy, c), count += 1;
          ASSERT_NEAR(out.at(x, y, c), sum / count, 3e-7) << x << "," << y;
        }
  }
}

TEST(Scale, TakesTheFirstPixelOfGuidesAndHalvesMotion) {
  constexpr Size kSize{37, 18};
  PassTest depth("scale"), ids("scale"), motion("scale");
  depth.input("image", test_image(QUELL_TYPE_DEPTH, kSize, scene::depth)).run();
  ids.input_ids("image", kSize, scene::id).run();
  motion.input("image", test_image(QUELL_TYPE_MOTION, kSize, scene::color)).run();
  for (int y = 0; y < half(kSize.height); ++y)
    for (int x = 0; x < half(kSize.width); ++x) {
      ASSERT_EQ(depth.output("image").at(x, y), scene::depth(2 * x, 2 * y, 0));
      ASSERT_EQ(ids.output_ids("image").at(x, y), scene::id(2 * x, 2 * y));
      ASSERT_EQ(motion.output("image").at(x, y, 1), scene::color(2 * x, 2 * y, 1) / 2);
    }
}

TEST(Scale, DoublesGuidesByRepetitionAndDoublesMotion) {
  constexpr Size kSize{19, 9};
  PassTest ids("scale"), motion("scale");
  ids.set("to", "double").input_ids("image", kSize, scene::id).run();
  motion.set("to", "double").input("image", test_image(QUELL_TYPE_MOTION, kSize, scene::color)).run();
  for (int y = 0; y < 2 * kSize.height; ++y)
    for (int x = 0; x < 2 * kSize.width; ++x) {
      ASSERT_EQ(ids.output_ids("image").at(x, y), scene::id(x / 2, y / 2));
      ASSERT_EQ(motion.output("image").at(x, y, 1), scene::color(x / 2, y / 2, 1) * 2);
    }
}

// 19 x 9 pixels become 57 x 18: threefold along the rows, twice as many rows.
TEST(Scale, ScalesMotionWithThePixels) {
  for (const char* method : {"nearest", "average"}) {
    PassTest pass("scale");
    pass.set("to", "double").set("method", method);
    pass.input("image", test_image(QUELL_TYPE_MOTION, {19, 9}, [](int, int, int c) { return c == 0 ? 1.5F : -2.0F; }));
    pass.input("full_depth", test_image(QUELL_TYPE_DEPTH, {57, 18}, scene::depth)).run();
    EXPECT_NEAR(pass.output("image").at(30, 9, 0), 4.5, 1e-6) << method;
    EXPECT_EQ(pass.output("image").at(30, 9, 1), -4.0F) << method;
  }
}

struct Case {
  Size full;
  bool with_depth = true, with_normal = true;
  double sigma_z = 0.05, sigma_n = 32;
};

float small_depth(int x, int y, int) { return scene::depth(2 * x, 2 * y, 0); }
float small_normal(int x, int y, int c) { return scene::normal(2 * x, 2 * y, c); }

// The formula of the documentation. `small` is the size of the image.
double expected(const Case& c, Size small, int x, int y, int channel) {
  const auto place = [](int at, int from, int to) { return (at + 0.5) * (half(to) == from ? 0.5 : double(from) / to) - 0.5; };
  const double px = place(x, small.width, c.full.width), py = place(y, small.height, c.full.height);
  double sum = 0, weights = 0;
  for (int dy = 0; dy < 2; ++dy)
    for (int dx = 0; dx < 2; ++dx) {
      const int floor_x = static_cast<int>(std::floor(px)) + dx, floor_y = static_cast<int>(std::floor(py)) + dy;
      const double tent = (1 - std::abs(px - floor_x)) * (1 - std::abs(py - floor_y));
      const int qx = std::clamp(floor_x, 0, small.width - 1), qy = std::clamp(floor_y, 0, small.height - 1);
      double like = 1;
      if (c.with_depth) {
        const double z = scene::depth(x, y, 0);
        like *= std::exp(-std::abs(z - small_depth(qx, qy, 0)) / (c.sigma_z * z));
      }
      if (c.with_normal) {
        double cosine = 0;
        for (int k = 0; k < 3; ++k) cosine += double{scene::normal(x, y, k)} * small_normal(qx, qy, k);
        like *= std::pow(std::max(cosine, 0.0), c.sigma_n);
      }
      const double w = tent * (like + 1e-6);
      sum += w * scene::color(qx, qy, channel), weights += w;
    }
  return sum / weights;
}

// A weight errs by 4e-6 (2^x), and by a power of up to 32 of a cosine's rounding, 1e-7; so does a mean of values up to 2, twice;
// next to weights that are 1e-6 all over, more of that counts: up to 4e-6 of that 2^x is left of weights that should vanish.
TEST(Scale, DoublesByJointBilateralUpsampling) {
  const std::array<Case, 6> cases{Case{{38, 18}},           {{37, 17}},
                                  {{38, 18}, false, true},  {{38, 18}, true, false, 0.5},
                                  {{38, 18}, false, false}, {{50, 30}, true, true, 0.5, 4}};
  constexpr Size kSmall{19, 9};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& c = cases[i];
    PassTest pass("scale");
    pass.set("to", "double").set("sigma_z", c.sigma_z).set("sigma_n", c.sigma_n);
    pass.input("image", test_image(QUELL_TYPE_COLOR, kSmall, scene::color));
    if (c.with_depth) {
      pass.input("depth", test_image(QUELL_TYPE_DEPTH, kSmall, small_depth));
      pass.input("full_depth", test_image(QUELL_TYPE_DEPTH, c.full, scene::depth));
    }
    if (c.with_normal) {
      pass.input("normal", test_image(QUELL_TYPE_NORMAL, kSmall, small_normal));
      pass.input("full_normal", test_image(QUELL_TYPE_NORMAL, c.full, scene::normal));
    }
    pass.run();
    const FloatImage out = pass.output("image");
    ASSERT_EQ(out.width, c.full.width);
    ASSERT_EQ(out.height, c.full.height);
    for (int k = 0; k < 3; ++k)
      for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x)
          ASSERT_NEAR(out.at(x, y, k), expected(c, kSmall, x, y, k), 1e-4) << "case " << i << " at " << x << "," << y;
  }
}

// A step of color at a step of depth, down and up again: it is where it was, to the pixel.
TEST(Scale, KeepsAnEdgeThatTheGuidesHave) {
  constexpr Size kFull{40, 12};
  constexpr int kEdge = 21;
  const auto step = [](float left, float right) { return [=](int x, int, int) { return x < kEdge ? left : right; }; };
  const Image depth = test_image(QUELL_TYPE_DEPTH, kFull, step(2, 9));
  PassTest small("scale"), guide("scale"), large("scale");
  // The pair that holds the edge shows the side of its first pixel, as the guide's does.
  small.set("method", "nearest").input("image", test_image(QUELL_TYPE_COLOR, kFull, step(1, 5))).run();
  guide.input("image", depth).run();
  large.set("to", "double").input("image", small.output_item("image"));
  large.input("depth", guide.output_item("image")).input("full_depth", depth).run();
  for (int x = 0; x < kFull.width; ++x)
    EXPECT_NEAR(large.output("image").at(x, 5), x < kEdge ? 1 : 5, 2e-5) << x;  // 4 times weights of 1e-6
}

TEST(Scale, KeepsConstantsBitForBit) {
  const auto gray = [](int, int, int) { return 0.1F; };
  for (const char* to : {"half", "double"}) {
    PassTest pass("scale");
    pass.set("to", to).input("image", test_image(QUELL_TYPE_COLOR, {19, 9}, gray)).run();
    const FloatImage out = pass.output("image");
    for (int y = 0; y < out.height; ++y)
      for (int x = 0; x < out.width; ++x) ASSERT_EQ(out.at(x, y, 1), 0.1F) << to << " " << x << "," << y;
  }
}

TEST(Scale, RefusesGuidesOfTwoSizes) {
  PassTest pass("scale");
  pass.set("to", "double").input("image", test_image(QUELL_TYPE_COLOR, {19, 9}, scene::color));
  pass.input("full_depth", test_image(QUELL_TYPE_DEPTH, {38, 18}, scene::depth));
  pass.input("full_normal", test_image(QUELL_TYPE_NORMAL, {37, 18}, scene::normal));
  EXPECT_THROW(pass.run(), Error);
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(scale);
QUELL_CONFORMANCE_TEST(scale, .set("to", "double"));
QUELL_CONFORMANCE_TEST(scale, .set("to", "double").set("method", "nearest"));
