#include <OpenColorIO/OpenColorIO.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <string>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "quell/text/error.h"

namespace quell {
namespace {

namespace ocio = OCIO_NAMESPACE;
using testing::AllOf;
using testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Radiance from 2^-12 to 2^12 along x, other in every channel.
float radiance(int x, int, int c) { return std::exp2(0.25F * static_cast<float>(x) - 12 + 0.1F * static_cast<float>(c)); }
Image ramp() { return test_image(QUELL_TYPE_COLOR, {97, 3}, radiance); }

float mapped(PassTest& pass, float value) {
  pass.input("color", test_image(QUELL_TYPE_COLOR, {1, 1}, [=](int, int, int) { return value; }));
  pass.run();
  return pass.output("color").at(0, 0);
}

struct Curve {
  const char* name;
  double (*formula)(double);
};
const Curve kCurves[] = {{"linear", [](double x) { return x; }},
                         {"reinhard", [](double x) { return x / (1 + x); }},
                         {"exponential", [](double x) { return 1 - std::exp(-x); }},
                         {"aces", [](double x) { return (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14); }}};

void PrintTo(const Curve& curve, std::ostream* out) { *out << curve.name; }

class EveryCurve : public testing::TestWithParam<Curve> {};
INSTANTIATE_TEST_SUITE_P(Tonemap, EveryCurve, testing::ValuesIn(kCurves), [](const auto& test) { return test.param.name; });

TEST_P(EveryCurve, FollowsThePublishedFormula) {
  for (const double exposure : {0.0, 1.5, -2.0}) {
    PassTest pass("tonemap");
    pass.set("operator", GetParam().name).set("exposure", exposure);
    pass.input("color", ramp());
    pass.run();
    for (int c = 0; c < 3; ++c)
      for (int x = 0; x < 97; ++x) {
        const double want = std::clamp(GetParam().formula(radiance(x, 0, c) * std::exp2(exposure)), 0.0, 1.0);
        // At most 8 roundings of 6e-8 each in the rational curves; expm1 is good to a unit in the last place.
        ASSERT_NEAR(pass.output("color").at(x, 1, c), want, 5e-7 * want) << radiance(x, 0, c);
      }
  }
}

TEST_P(EveryCurve, StaysWithinZeroAndOneWhateverComes) {
  PassTest pass("tonemap");
  pass.set("operator", GetParam().name);
  EXPECT_EQ(mapped(pass, 0), 0.0F);
  EXPECT_EQ(mapped(pass, -1), 0.0F);  // where x / (1 + x) has its pole
  EXPECT_EQ(mapped(pass, -3), 0.0F);
  EXPECT_EQ(mapped(pass, kNan), 0.0F);
  EXPECT_EQ(mapped(pass, kInfinity), 1.0F);
  EXPECT_EQ(mapped(pass, -kInfinity), 0.0F);
  EXPECT_EQ(mapped(pass, std::numeric_limits<float>::max()), 1.0F);
  pass.set("exposure", 64.0);
  EXPECT_EQ(mapped(pass, std::numeric_limits<float>::max()), 1.0F);
}

TEST_P(EveryCurve, NeverFalls) {
  PassTest pass("tonemap");
  pass.set("operator", GetParam().name);
  pass.input("color", ramp());
  pass.run();
  for (int x = 1; x < 97; ++x) EXPECT_GE(pass.output("color").at(x, 0), pass.output("color").at(x - 1, 0)) << x;
}

TEST(Tonemap, IsLinearAndClippedByDefault) {
  PassTest pass("tonemap");
  EXPECT_EQ(mapped(pass, 0.18F), 0.18F);
  EXPECT_EQ(mapped(pass, 1.5F), 1.0F);
}

TEST(Tonemap, MapsWhiteToOneInReinhardsSecondForm) {
  PassTest pass("tonemap");
  pass.set("operator", "reinhard").set("white", 4.0);
  EXPECT_FLOAT_EQ(mapped(pass, 4), 1.0F);
  EXPECT_FLOAT_EQ(mapped(pass, 1), (1 + 1 / 16.0F) / 2);
  EXPECT_EQ(mapped(pass, 10), 1.0F);
  EXPECT_EQ(mapped(pass, kInfinity), 1.0F);
  pass.set("white", 1e-6);  // its inverse square is large, and still no NaN comes of it
  EXPECT_EQ(mapped(pass, 0), 0.0F);
  EXPECT_EQ(mapped(pass, kInfinity), 1.0F);
}

TEST(Tonemap, MayBeDoneInPlace) {
  PassTest pass("tonemap");
  pass.input("color", ramp());
  EXPECT_EQ(pass.in_place_of("color"), "color");
  EXPECT_EQ(pass.radius("color"), 0);
}

// IEC 61966-2-1, from code value to light.
double decode_srgb(double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); }

// What OpenColorIO itself gives for one pixel, as light. Clipping to 0..1 is the picture's.
std::array<double, 3> light(const ocio::ConstProcessorRcPtr& processor, int x) {
  float pixel[3] = {radiance(x, 0, 0), radiance(x, 0, 1), radiance(x, 0, 2)};
  processor->getDefaultCPUProcessor()->applyRGB(pixel);
  std::array<double, 3> result{};
  for (std::size_t c = 0; c < 3; ++c) result[c] = decode_srgb(std::clamp(double{pixel[c]}, 0.0, 1.0));
  return result;
}

void expect_light(const PassTest& pass, const ocio::ConstProcessorRcPtr& processor) {
  for (int x = 0; x < 97; ++x) {
    const std::array<double, 3> want = light(processor, x);
    // Float decoding: the code's own rounding, times the steepest relative slope 2.4, and powf: below 5e-7.
    for (int c = 0; c < 3; ++c)
      for (int y = 0; y < 3; ++y)
        ASSERT_NEAR(pass.output("color").at(x, y, c), want[static_cast<std::size_t>(c)], 5e-7) << x << "," << y << "," << c;
  }
}

ocio::ConstProcessorRcPtr builtins(const std::vector<std::pair<std::string, bool>>& styles) {
  const auto chain = ocio::GroupTransform::Create();
  for (const auto& [style, inverse] : styles) {
    const auto transform = ocio::BuiltinTransform::Create();
    transform->setStyle(style.c_str());
    if (inverse) transform->setDirection(ocio::TRANSFORM_DIR_INVERSE);
    chain->appendTransform(transform);
  }
  return ocio::Config::CreateRaw()->getProcessor(chain);
}

TEST(TonemapOcio, AppliesTheBuiltInAcesVideoTransformForSrgbByDefault) {
  PassTest pass("tonemap");
  pass.set("operator", "ocio");
  pass.input("color", ramp());
  pass.run();
  expect_light(pass, builtins({{"UTILITY - ACES-AP1_to_LINEAR-REC709_BFD", true},
                               {"ACEScg_to_ACES2065-1", false},
                               {"ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0", false},
                               {"DISPLAY - CIE-XYZ-D65_to_sRGB", false}}));
}

TEST(TonemapOcio, AppliesAnyOtherBuiltInOutputAndDisplay) {
  PassTest pass("tonemap");
  pass.set("operator", "ocio").set("ocio_view", "SDR-CINEMA_1.0").set("ocio_display", "G2.6-P3-D65");
  pass.input("color", ramp());
  pass.run();
  expect_light(pass, builtins({{"UTILITY - ACES-AP1_to_LINEAR-REC709_BFD", true},
                               {"ACEScg_to_ACES2065-1", false},
                               {"ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-CINEMA_1.0", false},
                               {"DISPLAY - CIE-XYZ-D65_to_G2.6-P3-D65", false}}));
}

TEST(TonemapOcio, ShowsMiddleGrayWhereAcesPutsIt) {
  // The ACES 1.0 reference rendering puts 0.18 at 4.8 cd/m^2 of a 48 cd/m^2 cinema, whose black is 0.02: (4.8 - 0.02) / (48 -
  // 0.02) of its range. For a dim surround luminance takes the power 0.9811. OpenColorIO's tables are good to about 0.1 %.
  const double want = std::pow((4.8 - 0.02) / (48 - 0.02), 0.9811);
  PassTest pass("tonemap");
  pass.set("operator", "ocio");
  pass.input("color", test_image(QUELL_TYPE_COLOR, {1, 1}, [](int, int, int) { return 0.18F; }));
  pass.run();
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(pass.output("color").at(0, 0, c), want, 0.002 * want);
}

TEST(TonemapOcio, ScalesByTheExposureFirst) {
  PassTest pass("tonemap"), brighter("tonemap");
  pass.set("operator", "ocio");
  brighter.set("operator", "ocio").set("exposure", 2.0);
  EXPECT_EQ(mapped(brighter, 0.1F), mapped(pass, 0.4F));
}

class TonemapConfig : public testing::Test {
 protected:
  void SetUp() override {
    file_ = testing::TempDir() + "quell_tonemap_test_" + testing::UnitTest::GetInstance()->current_test_info()->name() + ".ocio";
    std::ofstream(file_) << R"(ocio_profile_version: 2
roles: {default: raw, scene_linear: light}
file_rules:
  - !<Rule> {name: Default, colorspace: default}
displays:
  monitor:
    - !<View> {name: gamma, colorspace: gamma22}
    - !<View> {name: plain, colorspace: light}
  printer:
    - !<View> {name: half, colorspace: halved}
colorspaces:
  - !<ColorSpace> {name: raw, isdata: true}
  - !<ColorSpace> {name: light}
  - !<ColorSpace>
    name: gamma22
    from_scene_reference: !<ExponentTransform> {value: 2.2, direction: inverse}
  - !<ColorSpace>
    name: halved
    from_scene_reference: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}
)";
  }
  void TearDown() override { std::remove(file_.c_str()); }

  PassTest make() const {
    PassTest pass("tonemap");
    pass.set("operator", "ocio").set("ocio_config", file_);
    return pass;
  }
  std::string file_;
};

TEST_F(TonemapConfig, TakesTheDefaultDisplayAndView) {
  PassTest pass = make();
  EXPECT_NEAR(mapped(pass, 0.3F), decode_srgb(std::pow(0.3, 1 / 2.2)), 5e-6);  // OpenColorIO's fast power
}

TEST_F(TonemapConfig, TakesANamedViewDisplayAndColorSpace) {
  PassTest plain = make(), half = make(), halved_source = make();
  plain.set("ocio_view", "plain");
  half.set("ocio_display", "printer");
  halved_source.set("ocio_view", "plain").set("ocio_colorspace", "halved");
  EXPECT_NEAR(mapped(plain, 0.3F), decode_srgb(0.3), 1e-7);
  EXPECT_NEAR(mapped(half, 0.3F), decode_srgb(0.15), 1e-7);
  EXPECT_NEAR(mapped(halved_source, 0.3F), decode_srgb(0.6), 2e-7);
}

void expect_refusal(PassTest pass, const testing::Matcher<std::string>& words) {
  try {
    mapped(pass, 1);
    FAIL() << "the parameters were accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::usage);
    EXPECT_THAT(std::string(error.what()), words);
  }
}

TEST_F(TonemapConfig, TellsTheChoicesWhenADisplayViewOrColorSpaceIsMissing) {
  PassTest display = make(), view = make(), colorspace = make();
  display.set("ocio_display", "tv");
  view.set("ocio_view", "film");
  colorspace.set("ocio_colorspace", "log");
  expect_refusal(std::move(display), HasSubstr("ocio_display: there is no 'tv'; there are 'monitor', 'printer'"));
  expect_refusal(std::move(view), HasSubstr("ocio_view: there is no 'film'; there are 'gamma', 'plain'"));
  expect_refusal(std::move(colorspace), AllOf(HasSubstr("ocio_colorspace: there is no 'log'"), HasSubstr("'gamma22'")));
}

TEST(TonemapOcio, RefusesAMissingConfigAndUnknownBuiltIns) {
  PassTest config("tonemap"), view("tonemap"), display("tonemap"), colorspace("tonemap");
  for (PassTest* pass : {&config, &view, &display, &colorspace}) pass->set("operator", "ocio");
  config.set("ocio_config", "/nowhere/config.ocio");
  view.set("ocio_view", "film");
  display.set("ocio_display", "tv");
  colorspace.set("ocio_colorspace", "ACEScg");
  expect_refusal(std::move(config), AllOf(HasSubstr("ocio_config"), HasSubstr("/nowhere/config.ocio")));
  expect_refusal(std::move(view), AllOf(HasSubstr("ocio_view: there is no 'film'"), HasSubstr("'SDR-VIDEO_1.0'")));
  expect_refusal(std::move(display), AllOf(HasSubstr("ocio_display: there is no 'tv'"), HasSubstr("'sRGB'")));
  expect_refusal(std::move(colorspace), HasSubstr("without one the input is linear Rec.709"));
}

QUELL_CONFORMANCE_TEST(tonemap)
QUELL_CONFORMANCE_TEST(tonemap, .set("operator", "reinhard"))
QUELL_CONFORMANCE_TEST(tonemap, .set("operator", "exponential"))
QUELL_CONFORMANCE_TEST(tonemap, .set("operator", "aces"))
QUELL_CONFORMANCE_TEST(tonemap, .set("operator", "ocio"))

}  // namespace
}  // namespace quell
