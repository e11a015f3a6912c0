// Every pass that ships, on every vector unit that the machine has: it keeps all rules there, gives the same bits for any threads
// and chunks, and agrees with the best one but for the last digits.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "quell/simd/isa.h"
#include "quell/testing/conformance_frames.h"
#include "quell/text/error.h"

namespace quell::conformance {
namespace {

/// A pass, and one of its parameters that choose, of an enum or bool, with a value that is not its default; or none.
struct Mode {
  const quell_pass_desc* pass;
  std::string param, value;
  bool is_enum = false;

  PassTest make() const {
    PassTest test(*pass);
    if (!param.empty()) test.set_json(param, is_enum ? '"' + value + '"' : value);
    return test;
  }
  std::string name() const { return pass->id + (param.empty() ? "" : "_" + param + "_" + value); }
};

void PrintTo(const Mode& mode, std::ostream* stream) { *stream << mode.name(); }

std::vector<Mode> modes() {
  std::uint32_t count = 0;
  const quell_pass_desc* const* passes = quell_plugin_passes(&count);
  std::vector<Mode> all;
  for (std::uint32_t i = 0; i < count; ++i) {
    all.push_back({passes[i]});
    for (std::uint32_t p = 0; p < passes[i]->param_count; ++p) {
      const quell_param_desc& param = *QUELL_AT(quell_param_desc, passes[i]->params, p);
      for (std::uint32_t e = 0; e < param.enum_count; ++e)
        if (*param.default_value->data.ints != e) all.push_back({passes[i], param.name, param.enum_values[e], true});
      if (param.type == QUELL_PARAM_BOOL && !param.is_array)
        all.push_back({passes[i], param.name, *param.default_value->data.bools ? "false" : "true"});
    }
  }
  return all;
}

class EveryIsa : public ::testing::TestWithParam<Mode> {
 protected:
  void SetUp() override { pin_isa("best", "test"); }  // whatever QUELL_ISA says, and a test before

  /// What the pass computes on the unit that is pinned, on an image of several tiles.
  static Results compute(int grain = 0, int threads = 1) {
    PassTest pass = GetParam().make();
    connect(pass, {150, 43});
    pass.grain(grain).threads(threads);
    return run(pass.next_frame(0));
  }
};

// Weights err by up to 1e-4 on any unit, as the passes say of themselves; two units by twice that. The absolute part is for
// values that are differences, such as variances and motion, of numbers around 1.
bool agree(float a, float b) { return a == b || std::abs(a - b) <= 2e-4F * std::max(std::abs(a), std::abs(b)) + 2e-5F; }

void expect_close(const Image& want, const Image& got, const std::string& what) {
  ASSERT_EQ(want.size(), got.size());
  if (info(want.type()).format != QUELL_FORMAT_F32) {
    find_difference(want, got, [&](int x, int y) {
      ADD_FAILURE() << what << " has another id at " << at(x, y);
      return true;
    });
    return;
  }
  const FloatImage a = want.floats(), b = got.floats();
  for (int c = 0; c < a.channels; ++c)
    for (int y = 0; y < a.height; ++y)
      for (int x = 0; x < a.width; ++x)
        ASSERT_TRUE(agree(a.at(x, y, c), b.at(x, y, c)))
            << what << " at " << at(x, y) << ": " << a.at(x, y, c) << " and " << b.at(x, y, c);
}

TEST_P(EveryIsa, KeepsAllRules) {
  const MakePass make = [] { return GetParam().make(); };
  for (const std::string& isa : isas()) {
    pin_isa(isa, "test");
    for (const auto check : {check_sizes, check_radius, check_bad_values, check_in_place, check_strides, check_chunks,
                             check_purity, check_optional_inputs})
      EXPECT_THAT(check(make), ::testing::IsEmpty()) << isa;
    ASSERT_EQ(current_isa(), isa);
  }
}

TEST_P(EveryIsa, GivesTheSameBitsForAnyThreadsAndChunks) {
  for (const std::string& isa : isas()) {
    pin_isa(isa, "test");
    const Results want = compute(1 << 20);
    Violations violations;
    for (const int grain : {1, 3, 8, 13})
      for (const int threads : {1, 3})
        expect_same(want, compute(grain, threads),
                    "with chunks of " + std::to_string(grain) + " rows and " + std::to_string(threads) + " threads on " + isa,
                    violations);
    EXPECT_THAT(violations, ::testing::IsEmpty());
  }
}

TEST_P(EveryIsa, AgreesWithTheBest) {
  const Results want = compute();
  for (const std::string& isa : isas()) {
    pin_isa(isa, "test");
    const Results got = compute();
    ASSERT_EQ(got.size(), want.size());
    for (std::size_t i = 0; i < want.size(); ++i)
      if (want[i].second.image()) expect_close(*want[i].second.image(), *got[i].second.image(), want[i].first + " on " + isa);
  }
}

INSTANTIATE_TEST_SUITE_P(Passes, EveryIsa, ::testing::ValuesIn(modes()), [](const auto& mode) {
  std::string name = mode.param.name();
  std::ranges::replace_if(
      name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
});

}  // namespace
}  // namespace quell::conformance
