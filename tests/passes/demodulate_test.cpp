#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "quell/text/error.h"

namespace quell {
namespace {

constexpr Size kSize{37, 5};

float radiance(int x, int y, int c) { return 0.25F + 0.1F * static_cast<float>(x) + static_cast<float>(y * c); }
float reflectance(int x, int y, int c) { return x % 5 == 0 ? 0.0F : 0.05F * static_cast<float>((x + y + c) % 20); }
float glow(int x, int, int c) { return x == 7 ? 2.0F + static_cast<float>(c) : 0.0F; }

Image color(float scale = 1) {
  return test_image(QUELL_TYPE_COLOR, kSize, [=](int x, int y, int c) { return scale * radiance(x, y, c); });
}
Image albedo() { return test_image(QUELL_TYPE_ALBEDO, kSize, reflectance); }
Image flat_albedo(float value) {
  return test_image(QUELL_TYPE_ALBEDO, kSize, [=](int, int, int) { return value; });
}

TEST(Demodulate, DividesWhatIsNotEmittedByTheAlbedo) {
  PassTest pass("demodulate");
  pass.set("floor", 0.125).input("color", color()).input("albedo", albedo());
  pass.input("emission", test_image(QUELL_TYPE_COLOR, kSize, glow));
  pass.run();
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        const double want = (double{radiance(x, y, c)} - glow(x, y, c)) / std::max(double{reflectance(x, y, c)}, 0.125);
        ASSERT_NEAR(pass.output("color").at(x, y, c), want, 1.5e-7 * std::max(1.0, std::abs(want)) * 2) << x << "," << y;
      }
}

TEST(Demodulate, KeepsTheSign) {
  PassTest pass("demodulate");
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 1.0F; })).input("albedo", flat_albedo(0.5F));
  pass.input("emission", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 2.0F; }));
  pass.run();
  EXPECT_EQ(pass.output("color").at(3, 3), -2.0F);
}

TEST(Demodulate, GivesEachColorItsAlbedoOrAllTheSame) {
  PassTest each("demodulate");
  each.input("color", color()).input("color", color(2)).input("albedo", flat_albedo(0.5F)).input("albedo", flat_albedo(0.25F));
  each.run();
  PassTest shared("demodulate");
  shared.input("color", color()).input("color", color(2)).input("albedo", flat_albedo(0.5F));
  shared.run();
  for (int x = 0; x < kSize.width; ++x) {
    EXPECT_EQ(each.output("color", 0).at(x, 2), 2 * radiance(x, 2, 0));
    EXPECT_EQ(each.output("color", 1).at(x, 2), 8 * radiance(x, 2, 0));
    EXPECT_EQ(shared.output("color", 1).at(x, 2), 4 * radiance(x, 2, 0));
  }
}

TEST(Demodulate, TakesEmissionFromTheFirstColorAlone) {
  PassTest pass("demodulate");
  pass.input("color", color()).input("color", color()).input("albedo", flat_albedo(1));
  pass.input("emission", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 0.25F; }));
  pass.run();
  EXPECT_EQ(pass.output("color", 0).at(2, 0), radiance(2, 0, 0) - 0.25F);
  EXPECT_EQ(pass.output("color", 1).at(2, 0), radiance(2, 0, 0));
}

TEST(Demodulate, RefusesAlbedosThatDoNotFitTheColors) {
  PassTest pass("demodulate");
  pass.input("color", color()).input("albedo", albedo()).input("albedo", albedo());
  try {
    pass.run();
    FAIL() << "it ran";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("one albedo, or as many as there are colors"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(demodulate);
