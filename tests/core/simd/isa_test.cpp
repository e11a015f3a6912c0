#include "quell/simd/isa.h"

#include <gmock/gmock.h>

#include <cstdlib>

#include "quell/text/error.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/core/simd/isa_test.cpp"  // from the repository root
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace quell::HWY_NAMESPACE {
std::int64_t Target() { return HWY_TARGET; }
}  // namespace quell::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace quell {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class Isas : public ::testing::Test {
 protected:
  void TearDown() override { pin_isa("best", "test"); }
};

HWY_EXPORT(Target);
std::int64_t dispatched() { return HWY_DYNAMIC_DISPATCH(Target)(); }

TEST_F(Isas, BeginWithTheBestThatTheMachineHas) {
  EXPECT_EQ(current_isa(), isas().front());
  const auto targets = static_cast<unsigned long long>(hwy::SupportedTargets() & HWY_TARGETS);
  EXPECT_EQ(isas().size(), static_cast<std::size_t>(__builtin_popcountll(targets)));
}

TEST_F(Isas, AreWhatKernelsRunOnOncePinned) {
  std::int64_t before = 0;
  for (const std::string& name : isas()) {
    pin_isa(name, "test");
    EXPECT_EQ(current_isa(), name);
    EXPECT_GT(dispatched(), before) << name << " is no worse than the one before";
    before = dispatched();
  }
  pin_isa("best", "test");
  EXPECT_EQ(current_isa(), isas().front());
}

TEST_F(Isas, StayPinnedWhoeverAsksForTheMachines) {
  pin_isa(isas().back(), "test");
  const std::int64_t pinned = dispatched();
  EXPECT_EQ(current_isa(), isas().back());
  EXPECT_NE(hwy::SupportedTargets(), 0);
  EXPECT_EQ(dispatched(), pinned);
}

TEST_F(Isas, StayThoseOfTheMachineWhenOneIsPinned) {
  const std::vector<std::string> before = isas();
  pin_isa(before.back(), "test");
  EXPECT_EQ(isas(), before);
}

TEST_F(Isas, AreListedWhenThereIsNoneOfThatName) {
  EXPECT_THAT([] { pin_isa("best_of_all", "--isa"); },
              ThrowsMessage<Error>(AllOf(HasSubstr("--isa: 'best_of_all' is no vector unit"), HasSubstr("choose 'best'"),
                                         HasSubstr("'" + isas().back() + "'"))));
  const std::string foreign = HWY_ARCH_X86 ? "neon" : "avx2";
  EXPECT_THAT([&] { pin_isa(foreign, "QUELL_ISA"); },
              ThrowsMessage<Error>(HasSubstr("QUELL_ISA: this machine has no '" + foreign + "'; choose 'best', ")));
  EXPECT_EQ(current_isa(), isas().front()) << "a refused name changes nothing";
}

TEST_F(Isas, AreNotTakenFromTheEnvironmentOnceOneIsPinned) {
  pin_isa(isas().back(), "test");
  setenv("QUELL_ISA", "nonsense", 1);
  pin_isa_from_environment();
  unsetenv("QUELL_ISA");
  EXPECT_EQ(current_isa(), isas().back());
}

}  // namespace
}  // namespace quell
#endif
