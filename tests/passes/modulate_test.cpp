#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "quell/text/error.h"

namespace quell {
namespace {

constexpr Size kSize{37, 5};

float light(int x, int y, int c) { return 0.25F + 0.1F * static_cast<float>(x) + static_cast<float>(y * c); }
float reflectance(int x, int y, int c) { return x % 5 == 0 ? 0.0F : 0.05F * static_cast<float>((x + y + c) % 20); }
float glow(int x, int, int c) { return x == 7 ? 2.0F + static_cast<float>(c) : 0.0F; }

Image image(PortType type, const std::function<float(int, int, int)>& value) { return test_image(type, kSize, value); }

TEST(Modulate, AddsUpLightsTimesAlbedoAndEmission) {
  PassTest pass("modulate");
  pass.set("floor", 0.0).input("color", image(QUELL_TYPE_COLOR, light)).input("color", image(QUELL_TYPE_COLOR, glow));
  pass.input("albedo", image(QUELL_TYPE_ALBEDO, reflectance));
  pass.input("albedo", image(QUELL_TYPE_ALBEDO, [](int, int, int) { return 0.5F; }));
  pass.input("emission", image(QUELL_TYPE_COLOR, glow));
  pass.run();
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        const double want = double{light(x, y, c)} * reflectance(x, y, c) + 1.5 * glow(x, y, c);
        ASSERT_NEAR(pass.output("color").at(x, y, c), want, 3e-7 * std::max(1.0, want)) << x << "," << y;
      }
}

// (c - e) / a times a plus e: a rounding each.
TEST(Modulate, IsTheInverseOfDemodulateWhateverTheAlbedo) {
  const Image color = image(QUELL_TYPE_COLOR, [](int x, int y, int c) { return light(x, y, c) + glow(x, y, c); });
  PassTest there("demodulate"), back("modulate");
  there.input("color", color)
      .input("albedo", image(QUELL_TYPE_ALBEDO, reflectance))
      .input("emission", image(QUELL_TYPE_COLOR, glow));
  there.run();
  back.input("color", there.output_item("color")).input("albedo", image(QUELL_TYPE_ALBEDO, reflectance));
  back.input("emission", image(QUELL_TYPE_COLOR, glow));
  back.run();
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x)
        ASSERT_NEAR(back.output("color").at(x, y, c), color.floats().at(x, y, c), 2.5e-7 * color.floats().at(x, y, c))
            << x << "," << y;
}

TEST(Modulate, LetsWhatHasNoAlbedoReflectNothingWithoutAFloor) {
  PassTest pass("modulate");
  pass.set("floor", 0.0).input("color", image(QUELL_TYPE_COLOR, light));
  pass.input("albedo", image(QUELL_TYPE_ALBEDO, [](int, int, int) { return 0.0F; }));
  pass.run();
  EXPECT_EQ(pass.output("color").at(3, 3), 0.0F);
}

TEST(Modulate, RefusesAlbedosThatDoNotFitTheColors) {
  PassTest pass("modulate");
  pass.input("color", image(QUELL_TYPE_COLOR, light));
  for (int i = 0; i < 2; ++i) pass.input("albedo", image(QUELL_TYPE_ALBEDO, reflectance));
  EXPECT_THROW(pass.run(), Error);
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(modulate);
