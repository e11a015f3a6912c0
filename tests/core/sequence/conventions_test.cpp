#include "quell/sequence/conventions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace quell {
namespace {

using testing::HasSubstr;

TEST(Conventions, EveryValueOfEveryKeyCanBeSetAndIsToldAgain) {
  for (const ConventionKey& key : convention_keys()) {
    const std::vector<std::string_view> values =
        key.values.empty() ? std::vector<std::string_view>{"-1", "0", "4294967295"} : key.values;
    std::set<std::string> told;
    for (const std::string_view value : values) {
      Conventions conventions;
      EXPECT_EQ(set_convention(conventions, key.key, value), std::nullopt) << key.key;
      EXPECT_EQ(describe(conventions), std::string(key.key) + "=" + std::string(value));
      EXPECT_NE(conventions, Conventions{});
      told.insert(describe(conventions));
      for (int type = 0; type < QUELL_TYPE_COUNT; ++type) {
        const bool has = std::find(key.types.begin(), key.types.end(), type) != key.types.end();
        EXPECT_EQ(find_misplaced(conventions, static_cast<PortType>(type)).has_value(), !has) << key.key << " of " << type;
      }
    }
    EXPECT_EQ(told.size(), values.size()) << key.key << ": values differ";
  }
}

// The names say what they say: told apart from the enums by hand, not by index.
TEST(Conventions, ValuesAreTheOnesTheyName) {
  Conventions c;
  for (const auto& [key, value] : std::initializer_list<std::pair<const char*, const char*>>{{"sign", "current-previous"},
                                                                                             {"unit", "ndc"},
                                                                                             {"y", "up"},
                                                                                             {"jitter", "included"},
                                                                                             {"depth", "reciprocal"},
                                                                                             {"space", "camera"},
                                                                                             {"encoding", "unsigned"},
                                                                                             {"background", "-7"},
                                                                                             {"alpha", "straight"},
                                                                                             {"transfer", "srgb"},
                                                                                             {"vectors", "column"},
                                                                                             {"ndc", "-1..1"},
                                                                                             {"w", "negative"}})
    ASSERT_EQ(set_convention(c, key, value), std::nullopt);
  EXPECT_EQ(c.sign, MotionSign::current_minus_previous);
  EXPECT_EQ(c.unit, MotionUnit::ndc);
  EXPECT_EQ(c.y, YDirection::up);
  EXPECT_EQ(c.jitter, Jitter::included);
  EXPECT_EQ(c.depth, DepthMeasure::reciprocal);
  EXPECT_EQ(c.space, Space::camera);
  EXPECT_EQ(c.encoding, Encoding::unsigned_numbers);
  EXPECT_EQ(c.background, -7);
  EXPECT_EQ(c.alpha, AlphaKind::straight);
  EXPECT_EQ(c.transfer, Transfer::srgb);
  EXPECT_EQ(c.vectors, VectorOrder::column);
  EXPECT_EQ(c.ndc, NdcRange::minus_one_to_one);
  EXPECT_EQ(c.w, SignOfW::negative);
  EXPECT_EQ(describe(c),
            "sign=current-previous, unit=ndc, y=up, jitter=included, depth=reciprocal, space=camera, encoding=unsigned, "
            "background=-7, alpha=straight, transfer=srgb, vectors=column, ndc=-1..1, w=negative");
}

TEST(Conventions, WhatIsStatedWinsOverWhatIsUsual) {
  const Conventions stated{.unit = MotionUnit::uv, .background = 3};
  const Conventions usual{.sign = MotionSign::current_minus_previous, .unit = MotionUnit::ndc, .background = 0};
  EXPECT_EQ(describe(stated.or_else(usual)), "sign=current-previous, unit=uv, background=3");
  EXPECT_EQ(Conventions{}.or_else(usual), usual);
  EXPECT_EQ(usual.or_else({}), usual);
}

TEST(Conventions, MistakesAreToldWithWhatIsPossible) {
  Conventions c;
  EXPECT_EQ(set_convention(c, "sign", "current-previos"),
            "sign must be 'previous-current' or 'current-previous', found 'current-previos'; did you mean 'current-previous'?");
  EXPECT_EQ(set_convention(c, "unit", "meters"), "unit must be 'pixels', 'uv' or 'ndc', found 'meters'");
  EXPECT_EQ(set_convention(c, "background", "1.5"), "background must be an integer, found '1.5'");
  EXPECT_EQ(set_convention(c, "background", "99999999999999999999"),
            "background must be an integer, found '99999999999999999999'");
  EXPECT_EQ(set_convention(c, "background", ""), "background must be an integer, found ''");
  EXPECT_THAT(*set_convention(c, "singn", "x"),
              HasSubstr("there is no convention 'singn'; did you mean 'sign'?; there are 'sign'"));
  EXPECT_EQ(c, Conventions{}) << "a mistake sets nothing";
  EXPECT_EQ(find_misplaced({.transfer = Transfer::srgb}, QUELL_TYPE_NORMAL),
            "transfer is a convention of color and albedo, not of normal");
}

TEST(Conventions, PicturesOfFewBitsHoldColorByTheSrgbCurveAndNormalsFromZeroToOne) {
  for (const char* format : {"png", "tiff"}) {
    for (const Numbers numbers : {Numbers::uint8, Numbers::uint16}) {
      EXPECT_EQ(describe(default_conventions(format, numbers, QUELL_TYPE_COLOR)), "alpha=straight, transfer=srgb");
      EXPECT_EQ(describe(default_conventions(format, numbers, QUELL_TYPE_ALBEDO)), "transfer=srgb");
      EXPECT_EQ(describe(default_conventions(format, numbers, QUELL_TYPE_NORMAL)), "encoding=unsigned");
      for (const PortType type : {QUELL_TYPE_DEPTH, QUELL_TYPE_ID, QUELL_TYPE_MASK, QUELL_TYPE_MOTION, QUELL_TYPE_ALPHA})
        EXPECT_EQ(describe(default_conventions(format, numbers, type)), "");
    }
  }
  for (const char* format : {"openexr", "tiff", "hdr", "pfm"})
    for (const Numbers numbers : {Numbers::half, Numbers::single, Numbers::uint32})
      for (int type = 0; type < QUELL_TYPE_COUNT; ++type)
        EXPECT_EQ(describe(default_conventions(format, numbers, static_cast<PortType>(type))), "");
}

}  // namespace
}  // namespace quell
