#include "quell/metrics/display.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "quell/image/image.h"
#include "quell/metrics/display_rows.h"
#include "quell/text/error.h"
#include "tests/core/metrics/test_pairs.h"

namespace quell {
namespace {

using test::name_of_vector_unit;
using test::vector_units;

TEST(DisplayTransforms, AreFoundByTheirNames) {
  for (const DisplayInfo& display : display_transforms()) {
    EXPECT_EQ(parse_display_transform(display.name, "--display"), display.transform);
    EXPECT_EQ(&info(display.transform), &display);
  }
}

TEST(DisplayTransforms, SayWhatAMisspeltNameMayHaveMeant) {
  EXPECT_THAT([] { parse_display_transform("reinhart", "--display"); },
              ::testing::ThrowsMessage<Error>("--display: there is no display transform 'reinhart'; did you mean 'reinhard'?; "
                                              "transforms are 'reinhard', 'gamma', 'srgb', 'aces' and 'none'"));
}

// Numbers by hand: 1/2 to the power 1/2.2; the standard's own 0.5 <-> 0.214041; Narkowicz' curve at 1 is 2.54 / 3.16.
TEST(DisplayTransforms, AreWhatTheyAreNamedAfter) {
  EXPECT_NEAR(to_display(DisplayTransform::reinhard, 1), 0.7297400528, 1e-10);
  EXPECT_NEAR(to_display(DisplayTransform::gamma, 0.5), 0.7297400528, 1e-10);
  EXPECT_NEAR(to_display(DisplayTransform::srgb, 0.2140411405), 0.5, 1e-9);
  EXPECT_NEAR(to_display(DisplayTransform::srgb, 0.001), 0.01292, 1e-15);
  EXPECT_NEAR(to_display(DisplayTransform::aces, 1), to_display(DisplayTransform::srgb, 2.54 / 3.16), 1e-12);
  EXPECT_EQ(to_display(DisplayTransform::none, 0.3), 0.3);
}

TEST(DisplayTransforms, KeepWithinWhatADisplayShows) {
  for (const DisplayInfo& display : display_transforms()) {
    EXPECT_EQ(to_display(display.transform, -3), 0) << display.name;
    EXPECT_EQ(to_display(display.transform, 0), 0) << display.name;
    EXPECT_GE(to_display(display.transform, 1e6), 1 - 1e-6) << display.name;
    EXPECT_LE(to_display(display.transform, static_cast<double>(std::numeric_limits<float>::max())), 1) << display.name;
  }
}

TEST(DisplayLight, UndoesTheSrgbCurve) {
  for (double x = 0; x <= 1; x += 1.0 / 64)
    EXPECT_NEAR(to_light(to_display(DisplayTransform::srgb, x)), x, 1e-7) << x;  // the standard's constants meet to that
}

// Every magnitude of float with many mantissas, the ends of the curves' parts, and what is beyond.
std::vector<float> many_floats() {
  std::vector<float> values{0.0F,
                            -0.0F,
                            -1.0F,
                            1.0F,
                            0.0031308F,
                            0.04045F,
                            7.24F,
                            std::numeric_limits<float>::max(),
                            std::numeric_limits<float>::lowest(),
                            std::numeric_limits<float>::denorm_min(),
                            std::numeric_limits<float>::min()};
  for (int exponent = -148; exponent < 128; ++exponent)
    for (int i = 0; i < 64; ++i) values.push_back(std::ldexp(1 + (static_cast<float>(i) + 0.37F) / 64, exponent));
  for (int i = 0; i <= 4000; ++i) values.push_back(static_cast<float>(i) / 4000);
  return values;
}

class DisplayRows : public ::testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { test::use_vector_unit(GetParam()); }
  void TearDown() override { test::use_best_vector_unit(); }
};

// The kernel's own budget is 4.5e-7, and 2e-6 is what display.h promises; half a rounding of float comes to either.
TEST_P(DisplayRows, EqualTheDefinitionOverAllOfFloat) {
  const std::vector<float> values = many_floats();
  const int width = static_cast<int>(values.size());
  const Image radiance = test_image(QUELL_TYPE_COLOR, {width, 1},
                                    [&](int x, int, int c) { return c == 1 ? 0 : values[static_cast<std::size_t>(x)]; });
  Image display = test_image(QUELL_TYPE_COLOR, {width, 1}, [](int, int, int) { return 0.0F; });
  for (const DisplayInfo& transform : display_transforms()) {
    detail::display_row(transform.transform, radiance.floats(), 0, display.writable_floats());
    for (int x = 0; x < width; ++x) {
      const float in = values[static_cast<std::size_t>(x)];
      const double want = to_display(transform.transform, static_cast<double>(in));
      ASSERT_NEAR(static_cast<double>(display.floats().at(x, 0, 0)), want, 5e-7) << transform.name << " of " << in;
      ASSERT_EQ(display.floats().at(x, 0, 2), display.floats().at(x, 0, 0));
      ASSERT_EQ(display.floats().at(x, 0, 1), 0.0F);
    }
  }
}

TEST_P(DisplayRows, EqualTheLightOfADisplay) {
  constexpr int kWidth = 10001;
  Image light = test_image(QUELL_TYPE_COLOR, {kWidth, 1}, [](int x, int, int) { return static_cast<float>(x) / (kWidth - 1); });
  detail::light_row(light.floats(), 0, light.writable_floats());
  for (int x = 0; x < kWidth; ++x) {
    const double want = to_light(static_cast<double>(static_cast<float>(x) / (kWidth - 1)));
    ASSERT_NEAR(static_cast<double>(light.floats().at(x, 0, 1)), want, 5e-7) << x;
  }
}

INSTANTIATE_TEST_SUITE_P(All, DisplayRows, ::testing::ValuesIn(vector_units()),
                         [](const auto& unit) { return name_of_vector_unit(unit.param); });

}  // namespace
}  // namespace quell
