#include "report_pixels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <zlib.h>

#include <cmath>
#include <limits>

#include "report_page.h"

namespace quell::app::testing {
namespace {

using ::testing::ElementsAre;

/// By the definition of the format, in double.
double half_value(std::uint32_t bits) {
  const int exponent = static_cast<int>(bits >> 10 & 31), fraction = static_cast<int>(bits & 1023);
  const double size = exponent == 31  ? fraction != 0 ? std::nan("") : HUGE_VAL
                      : exponent == 0 ? std::ldexp(fraction, -24)
                                      : std::ldexp(1024 + fraction, exponent - 25);
  return (bits & 0x8000) != 0 ? -size : size;
}

TEST(ToHalf, KeepsEveryHalfFloat) {
  for (std::uint32_t bits = 0; bits < 65536; ++bits) {
    const double value = half_value(bits);
    if (std::isnan(value))
      EXPECT_TRUE(std::isnan(half_value(to_half(static_cast<float>(value))))) << bits;
    else
      EXPECT_EQ(to_half(static_cast<float>(value)), bits);
  }
}

TEST(ToHalf, TakesTheNearestAndOfTwoTheEven) {
  for (std::uint32_t bits = 0; bits < 0x7bff; ++bits) {
    const double low = half_value(bits), high = half_value(bits + 1);
    const auto middle = static_cast<float>((low + high) / 2);  // exact
    EXPECT_EQ(to_half(middle), bits % 2 == 0 ? bits : bits + 1) << bits;
    EXPECT_EQ(to_half(std::nextafter(middle, 0.0F)), bits) << bits;
    EXPECT_EQ(to_half(-std::nextafter(middle, 1e9F)), (bits + 1) | 0x8000) << bits;
  }
  EXPECT_EQ(half_value(to_half(65519)), 65504);
  EXPECT_EQ(half_value(to_half(65520)), HUGE_VAL);
  EXPECT_EQ(half_value(to_half(std::numeric_limits<float>::infinity())), HUGE_VAL);
  EXPECT_TRUE(std::isnan(half_value(to_half(std::nanf("")))));
}

std::vector<std::uint8_t> unpack(const PackedImage& packed, std::size_t bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> deflated;
  EXPECT_EQ(packed.text.size() % 4, 0U);
  for (std::size_t i = 0; i < packed.text.size(); i += 4) {
    std::uint32_t group = 0;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t digit = digits.find(packed.text[i + k]);
      group = group << 6 | (digit == std::string::npos ? 0U : static_cast<std::uint32_t>(digit));
      count += digit == std::string::npos ? 0 : 1;
    }
    for (std::size_t k = 0; k + 1 < count; ++k) deflated.push_back(static_cast<std::uint8_t>(group >> (16 - 8 * k)));
  }
  std::vector<std::uint8_t> planes(bytes + 1);
  uLongf size = planes.size();
  EXPECT_EQ(uncompress(planes.data(), &size, deflated.data(), deflated.size()), Z_OK);
  EXPECT_EQ(size, bytes);
  planes.resize(bytes);
  return planes;
}

TEST(Pack, HalvesLieInPlanesOfBytesChannelAfterChannel) {
  BufferPool pool;
  Image image(QUELL_TYPE_MOTION, {2, 1}, pool);
  const FloatOutput pixels = image.writable_floats();
  pixels.at(0, 0, 0) = 1, pixels.at(1, 0, 0) = -2, pixels.at(0, 0, 1) = 1 + 1.0F / 1024, pixels.at(1, 0, 1) = 0;
  const PackedImage packed = pack(image);
  EXPECT_EQ(packed.format, "f16");
  EXPECT_EQ(packed.channels, 2);
  EXPECT_THAT(unpack(packed, 8), ElementsAre(0x00, 0x00, 0x01, 0x00, 0x3c, 0xc0, 0x3c, 0x00));
}

TEST(Pack, WhatIsBeyondHalvesStaysFloat) {
  BufferPool pool;
  Image depth(QUELL_TYPE_DEPTH, {1, 1}, pool);
  depth.writable_floats().at(0, 0, 0) = 1e10F;  // 0x501502f9
  const PackedImage packed = pack(depth);
  EXPECT_EQ(packed.format, "f32");
  EXPECT_THAT(unpack(packed, 4), ElementsAre(0xf9, 0x02, 0x15, 0x50));
}

TEST(Pack, ExactlyKeepsFloatsThatNoHalfEquals) {
  BufferPool pool;
  Image image(QUELL_TYPE_SCALAR, {1, 1}, pool);
  const auto format = [&](float value) {
    image.writable_floats().at(0, 0, 0) = value;
    return pack(image, Precision::exact).format;
  };
  for (std::uint32_t bits = 0; bits < 65536; bits += 7) {
    const auto value = static_cast<float>(half_value(bits));
    ASSERT_EQ(format(value), "f16") << value;
    if (std::isfinite(value)) { ASSERT_EQ(format(std::nextafter(value, 1e9F)), "f32") << value; }
  }
}

TEST(Pack, Ids) {
  BufferPool pool;
  Image ids(QUELL_TYPE_ID, {1, 1}, pool);
  ids.writable_ids().at(0, 0, 0) = 0x01020304;
  EXPECT_EQ(pack(ids).format, "u32");
  EXPECT_THAT(unpack(pack(ids), 4), ElementsAre(4, 3, 2, 1));
}

TEST(Pack, EqualImagesAreKeptOnce) {
  BufferPool pool;
  PackedImages images;
  const auto add = [&](Size size, std::uint32_t id) {
    Image ids(QUELL_TYPE_ID, size, pool);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) ids.writable_ids().at(x, y, 0) = id;
    return images.add(pack(ids));
  };
  EXPECT_EQ(add({2, 1}, 7), 0);
  EXPECT_EQ(add({2, 1}, 8), 1);
  EXPECT_EQ(add({1, 2}, 7), 2);  // the same bytes in another shape
  EXPECT_EQ(add({2, 1}, 7), 0);
  EXPECT_EQ(images.all().size(), 3U);
}

TEST(ReportPage, NoStringEndsTheScriptThatHoldsIt) {
  const std::string text = script_json(make_json("</script><!--"));
  EXPECT_EQ(text.find('<'), std::string::npos);
  EXPECT_EQ(text, "\"\\u003c/script>\\u003c!--\"\n");
}

}  // namespace
}  // namespace quell::app::testing
