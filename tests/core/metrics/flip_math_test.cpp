// The functions of flip_math-inl.h against double, on every vector unit.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/core/metrics/flip_math_test.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes it visible again for every vector unit.
#include "quell/metrics/flip_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace quell::flip_math_test::HWY_NAMESPACE {
using namespace flip_math::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

template <class Function>
void apply(const std::vector<float>& in, std::vector<float>& out, Function function) {
  const D d;
  HWY_ALIGN float buffer[simd::HWY_NAMESPACE::kMaxLanes];
  for (std::size_t i = 0; i < in.size(); ++i) {
    hn::Store(function(set(in[i])), d, buffer);
    out.push_back(buffer[0]);
  }
}
void CubeRoot(const std::vector<float>& in, std::vector<float>& out) {
  apply(in, out, [](V t) HWY_ATTR { return cube_root(t); });
}
void Log2(const std::vector<float>& in, std::vector<float>& out) {
  apply(in, out, [](V t) HWY_ATTR { return log2_of(t); });
}
void Log2Nearly1(const std::vector<float>& in, std::vector<float>& out) {
  apply(in, out, [](V t) HWY_ATTR { return log2_of_nearly_1(t); });
}
void Exp2(const std::vector<float>& in, std::vector<float>& out) {
  apply(in, out, [](V t) HWY_ATTR { return exp2_of(t); });
}

}  // namespace quell::flip_math_test::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "tests/core/metrics/test_pairs.h"

namespace quell::flip_math_test {

HWY_EXPORT(CubeRoot);
HWY_EXPORT(Log2);
HWY_EXPORT(Log2Nearly1);
HWY_EXPORT(Exp2);

namespace {

class FlipMathOnTarget : public ::testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { test::use_vector_unit(GetParam()); }
  void TearDown() override { test::use_best_vector_unit(); }
};
INSTANTIATE_TEST_SUITE_P(All, FlipMathOnTarget, ::testing::ValuesIn(test::vector_units()),
                         [](const auto& target) { return test::name_of_vector_unit(target.param); });

std::vector<float> spread(double from, double to) {
  std::vector<float> values;
  for (int i = 0; i <= 100000; ++i) values.push_back(static_cast<float>(from + i * 1e-5 * (to - from)));
  return values;
}

// The error of each result, given the argument, must be at most `allowed`.
void check(const std::vector<float>& in, const std::vector<float>& out, const std::function<double(double)>& function,
           const std::function<double(double)>& allowed) {
  ASSERT_EQ(out.size(), in.size());
  for (std::size_t i = 0; i < in.size(); ++i) {
    const double want = function(in[i]);
    ASSERT_NEAR(out[i], want, allowed(want)) << in[i];
  }
}

// The fit's error and the roundings of t r^2 and of u, a third of which counts twice.
TEST_P(FlipMathOnTarget, CubeRootsAreAccurate) {
  const std::vector<float> in = spread(216.0 / 24389, 1);
  std::vector<float> out;
  HWY_DYNAMIC_DISPATCH(CubeRoot)(in, out);
  check(
      in, out, [](double t) { return std::cbrt(t); }, [](double want) { return (2 * 8.4e-9 + 4e-7) * want; });
}

TEST_P(FlipMathOnTarget, LogarithmsAreAccurate) {
  for (const auto& in : {spread(1e-30, 1e-28), spread(1e-3, 1), spread(0.9, 1.1), spread(1, 400)}) {
    std::vector<float> out;
    HWY_DYNAMIC_DISPATCH(Log2)(in, out);
    check(
        in, out, [](double t) { return std::log2(t); }, [](double want) { return 3.1e-7 + 1.2e-7 + 6e-8 * std::abs(want); });
  }
}

TEST_P(FlipMathOnTarget, LogarithmsOfWhatIsNearly1AreAccurate) {
  const std::vector<float> in = spread(0, 0.05);
  std::vector<float> out;
  HWY_DYNAMIC_DISPATCH(Log2Nearly1)(in, out);
  check(
      in, out, [](double x) { return std::log2(1 - x); }, [](double want) { return (1.1e-6 + 2e-7) * std::abs(want); });
  EXPECT_EQ(out[0], 0);
}

TEST_P(FlipMathOnTarget, PowersOf2AreAccurate) {
  const std::vector<float> in = spread(-126, 9);
  std::vector<float> out;
  HWY_DYNAMIC_DISPATCH(Exp2)(in, out);
  check(
      in, out, [](double x) { return std::exp2(x); }, [](double want) { return (9.2e-8 + 2.4e-7) * want; });
  out.clear();
  HWY_DYNAMIC_DISPATCH(Exp2)({0, -126.6F, -1e30F}, out);
  EXPECT_EQ(out, (std::vector<float>{1, 0, 0}));
}

}  // namespace
}  // namespace quell::flip_math_test
#endif
