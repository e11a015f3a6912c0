#include "quell/simd/isa.h"

#include <gmock/gmock.h>
#include <hwy/highway.h>

#include <cstdlib>

#include "quell/text/error.h"

namespace quell {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class Isas : public ::testing::Test {
 protected:
  void TearDown() override { pin_isa("best", "test"); }
};

/// What a kernel compiled here would be dispatched to.
std::int64_t dispatched() { return hwy::SupportedTargets() & HWY_TARGETS & -(hwy::SupportedTargets() & HWY_TARGETS); }

TEST_F(Isas, BeginWithTheBestThatTheMachineHas) {
  EXPECT_EQ(current_isa(), isas().front());
  EXPECT_EQ(isas().size(), static_cast<std::size_t>(
                               __builtin_popcountll(static_cast<unsigned long long>(hwy::SupportedTargets() & HWY_TARGETS))));
}

TEST_F(Isas, AreWhatKernelsRunOnOncePinned) {
  std::int64_t before = 0;
  for (const std::string& name : isas()) {
    pin_isa(name, "test");
    EXPECT_EQ(current_isa(), name);
    EXPECT_GT(dispatched(), before) << name << " is no other than the one before";
    before = dispatched();
  }
  pin_isa("best", "test");
  EXPECT_EQ(current_isa(), isas().front());
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
