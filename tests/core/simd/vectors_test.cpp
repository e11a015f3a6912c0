// Each function of the vocabulary against double precision, on every vector unit of this machine, with the bound that stands
// beside it in the header.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/core/simd/vectors_test.cpp"
#include <hwy/foreach_target.h>

#include "quell/simd/vectors-inl.h"

#ifndef QUELL_VECTORS_TEST_SHARED
#define QUELL_VECTORS_TEST_SHARED
namespace quell {
enum class Function { exp2, exp2_gain, reciprocal, pow128, add_log, angle_narrow, angle_wide };
}  // namespace quell
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

HWY_INLINE V call(Function function, V x) {
  switch (function) {
    case Function::exp2:
      return exp2(hn::Neg(x));
    case Function::exp2_gain:
      return exp2_negative(x, set(0.375F), set(127.0F / 0.375F));
    case Function::reciprocal:
      return reciprocal(x);
    case Function::pow128:
      return pow128(x);
    case Function::add_log:
      return add_log_narrow(x, set(1.0F), zero());
    case Function::angle_narrow:
      return angle_ratio_narrow(x, set(1.0F));
    case Function::angle_wide:
      return squared_angle_wide(x);
  }
  return x;
}
// `count` is a multiple of 16.
void Map(Function function, float* values, std::size_t count) {
  for (std::size_t i = 0; i < count; i += static_cast<std::size_t>(lanes()))
    hn::StoreU(call(function, hn::LoadU(D(), values + i)), D(), values + i);
}
// Planes of 16 pixels: r, g, b and a, b, c become luminance and dot, in planes 0 and 1.
void Products(float* planes) {
  for (int x = 0; x < 16; x += lanes()) {
    const V3 a = load(planes + x, 16), b = load(planes + 48 + x, 16);
    hn::StoreU(luminance(a), D(), planes + x);
    hn::StoreU(dot(a, b), D(), planes + 16 + x);
  }
}
bool IsInRange(int offset, int center, int radius, int size) {
  const TapRange range = clamped_taps(center, radius, size);
  return range.first <= offset && offset <= range.last;
}
int StoreSome(float* to, int count) {
  store(set(7.0F), count, to);
  return lanes();
}

}  // namespace quell::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace quell {
namespace {

HWY_EXPORT(Map);
HWY_EXPORT(Products);
HWY_EXPORT(StoreSome);
HWY_EXPORT(IsInRange);

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Floats from `first` to `last`, both at least 0, equally many for every exponent, and both ends.
std::vector<float> floats_between(float first, float last) {
  const auto begin = std::bit_cast<std::uint32_t>(first), end = std::bit_cast<std::uint32_t>(last);
  std::vector<float> all;
  for (std::uint64_t bits = begin; bits < end; bits += 1777)
    all.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
  do all.push_back(last);
  while (all.size() % 16 != 0);
  return all;
}
// Equally spaced ones, where those matter.
std::vector<float> spaced_between(float first, float last) {
  std::vector<float> all(1 << 20);
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = first + (last - first) * static_cast<float>(i) / static_cast<float>(all.size() - 1);
  return all;
}

// Compares with double precision, calling error(got, want, x).
template <class Want, class Error>
double worst(Function function, const std::vector<float>& inputs, const Want& want, const Error& error) {
  std::vector<float> got = inputs;
  HWY_DYNAMIC_DISPATCH(Map)(function, got.data(), got.size());
  double largest = 0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const double e = error(double{got[i]}, want(double{inputs[i]}));
    if (!(e <= largest)) largest = e;  // NaN included
    if (std::isnan(e)) break;
  }
  return largest;
}
double relative(double got, double want) { return got == want ? 0 : std::abs(got - want) / std::abs(want); }
double absolute(double got, double want) { return std::abs(got - want); }

float call_one(Function function, float x) {
  std::vector<float> values(16, x);
  HWY_DYNAMIC_DISPATCH(Map)(function, values.data(), values.size());
  return values[0];
}

std::vector<std::int64_t> targets() {
  std::vector<std::int64_t> bits;
  for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS; left != 0; left &= left - 1) bits.push_back(left & -left);
  return bits;
}
class VectorsOnTarget : public ::testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { hwy::SetSupportedTargetsForTest(GetParam()); }
  void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};

TEST_P(VectorsOnTarget, TakesPowersOfTwoOfEveryNegativeNumber) {
  const float last = std::nextafter(126.5F, 0.0F);
  const auto want = [](double e) { return std::exp2(-e); };
  for (const auto& inputs : {floats_between(0, last), spaced_between(0, last)})
    EXPECT_LT(worst(Function::exp2, inputs, want, relative), 3.8e-6);
  const auto nothing = [](double) { return 0; };
  EXPECT_LE(worst(Function::exp2, floats_between(126.5F, 150), nothing, absolute), 0x1p-126);
  EXPECT_EQ(worst(Function::exp2, floats_between(150, kInfinity), nothing, absolute), 0);
  EXPECT_EQ(call_one(Function::exp2, 0), 1);
  EXPECT_EQ(call_one(Function::exp2, 3), 0.125F);
}

TEST_P(VectorsOnTarget, TakesPowersOfTwoWithAGain) {
  const auto want = [](double e) { return std::exp2(-0.375 * e); };
  for (const auto& inputs : {floats_between(0, 334), spaced_between(0, 334)}) {
    const auto error = [](double got, double wanted) { return relative(got, wanted) / (3.8e-6 + 6e-8 * -std::log2(wanted)); };
    EXPECT_LT(worst(Function::exp2_gain, inputs, want, error), 1);
  }
  EXPECT_EQ(call_one(Function::exp2_gain, 0), 1);
  EXPECT_EQ(call_one(Function::exp2_gain, kInfinity), 0);
}

TEST_P(VectorsOnTarget, TakesReciprocals) {
  const auto want = [](double x) { return 1 / x; };
  std::vector<float> inputs = floats_between(1e-37F, 1e37F);
  EXPECT_LT(worst(Function::reciprocal, inputs, want, relative), 4e-7);
  for (float& x : inputs) x = -x;
  EXPECT_LT(worst(Function::reciprocal, inputs, want, relative), 4e-7);
}

TEST_P(VectorsOnTarget, RaisesToThePowerOf128) {
  const auto want = [](double x) { return std::pow(std::max(x, 0.0), 128); };
  const float smallest = 0.5832F;  // of which the power is above 1e-30
  for (const auto& inputs : {floats_between(smallest, 1.99F), spaced_between(smallest, 1.0F)})
    EXPECT_LT(worst(Function::pow128, inputs, want, relative), 8e-6);
  EXPECT_LT(worst(Function::pow128, spaced_between(-2, smallest), want, absolute), 1e-30);
  EXPECT_EQ(call_one(Function::pow128, -1), 0);
  EXPECT_EQ(call_one(Function::pow128, 1), 1);
}

TEST_P(VectorsOnTarget, TakesTheLogarithmOfWhatPowersOfACosineAreMadeOf) {
  for (const double k : {64.0, 128.0, 300.0, 1024.0}) {
    const auto power = [k](double minus_log, double cosine) { return std::abs(std::exp(-k * minus_log) - std::pow(cosine, k)); };
    const auto want = [](double t) { return std::max(0.0, 1 - t); };
    for (const auto& inputs : {floats_between(0, 2), spaced_between(0, 2)})
      EXPECT_LT(worst(Function::add_log, inputs, want, power), 1.5e-6) << k;
  }
}

TEST_P(VectorsOnTarget, TakesTheSquareOfTheAngleOfAChord) {
  const auto want = [](double chord) { return std::pow(2 * std::asin(std::min(1.0, std::sqrt(chord) / 2)), 2); };
  for (const auto& inputs : {floats_between(1e-30F, 4), spaced_between(1e-30F, 4)})
    EXPECT_LT(worst(Function::angle_wide, inputs, want, relative), 2.5e-6);
  EXPECT_EQ(call_one(Function::angle_wide, 0), 0);
  const auto ratio = [&](double chord) { return want(chord) / chord; };
  for (const auto& inputs : {floats_between(1e-30F, 1), spaced_between(1e-30F, 1)})
    EXPECT_LT(worst(Function::angle_narrow, inputs, ratio, relative), 4.3e-6);
}

TEST_P(VectorsOnTarget, TakesProductsAndLuminances) {
  for (unsigned seed = 0; seed < 2000; ++seed) {
    std::vector<float> planes(6 * 16 + 16);
    for (std::size_t i = 0; i < planes.size(); ++i)
      planes[i] = std::ldexp(static_cast<float>((seed * 7919 + i * 104729) % 65537), static_cast<int>((seed + i) % 40) - 30);
    const std::vector<float> in = planes;
    HWY_DYNAMIC_DISPATCH(Products)(planes.data());
    for (std::size_t x = 0; x < 16; ++x) {
      const double r = in[x], g = in[16 + x], b = in[32 + x];
      const double l = 0.2126 * r + 0.7152 * g + 0.0722 * b, d = r * in[48 + x] + g * in[64 + x] + b * in[80 + x];
      ASSERT_LE(relative(planes[x], l), 3e-7) << seed;
      ASSERT_LE(relative(planes[16 + x], d), 3e-7) << seed;
    }
  }
}

TEST_P(VectorsOnTarget, StoresNoMoreThanItIsTold) {
  for (int count = 0; count <= 16; ++count) {
    std::vector<float> memory(20, 1);
    const int lanes = HWY_DYNAMIC_DISPATCH(StoreSome)(memory.data(), count);
    const int stored = static_cast<int>(std::count(memory.begin(), memory.end(), 7.0F));
    EXPECT_TRUE(std::all_of(memory.begin() + stored, memory.end(), [](float v) { return v == 1; })) << count;
    EXPECT_EQ(stored, std::min(count, lanes));
  }
}

TEST_P(VectorsOnTarget, ClampsTapsToTheImage) {
  for (const int size : {1, 2, 7})
    for (const int radius : {0, 1, 3, 10})
      for (int center = 0; center < size; ++center)
        for (int offset = -radius; offset <= radius; ++offset)
          EXPECT_EQ(HWY_DYNAMIC_DISPATCH(IsInRange)(offset, center, radius, size),
                    center + offset >= 0 && center + offset < size);
}

INSTANTIATE_TEST_SUITE_P(All, VectorsOnTarget, ::testing::ValuesIn(targets()),
                         [](const auto& target) { return std::string(hwy::TargetName(target.param)); });

}  // namespace
}  // namespace quell
#endif
