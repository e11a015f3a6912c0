#include "quell/testing/conformance.h"

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

QUELL_CONFORMANCE_TEST(running_sum);
QUELL_CONFORMANCE_TEST(running_sum, .set("gain", 2.0).set("negate", true));
QUELL_CONFORMANCE_TEST(offender);

namespace quell::conformance {
namespace {

MakePass offender(const char* offence) {
  return [offence] {
    PassTest pass("offender");
    pass.set("offence", offence);
    return pass;
  };
}

TEST(Conformance, FindsAPassThatReadsFartherThanItSays) {
  EXPECT_THAT(check_radius(offender("radius")),
              Contains(HasSubstr(
                  "color[0] changes at (5, 3), 1 pixels away, when another value is put into a pixel of 'color' at (4, 3); "
                  "the declared radius is 0")));
  EXPECT_THAT(check_bad_values(offender("radius")), Contains(HasSubstr("when NaN and infinity are put into a pixel of 'color'")));
}

TEST(Conformance, FindsAPassThatReadsFartherInAnArray) {
  EXPECT_THAT(check_radius(offender("array")),
              Contains(HasSubstr("when another value is put into a pixel of 'extra' at (4, 3)")));
}

TEST(Conformance, FindsAPixelThatIsNotWritten) {
  EXPECT_THAT(check_sizes(offender("pixels")),
              Contains(HasSubstr("color[0] is not written, or not finite, at (16, 8) on 17 x 9 pixels")));
  EXPECT_THAT(check_sizes([] { return PassTest("forgetful"); }),
              Contains("id[0] differs at (16, 8) when fresh memory holds something else, on 17 x 9 pixels"));
}

TEST(Conformance, FindsADependenceOnTheBands) {
  EXPECT_THAT(check_chunks(offender("chunks")), Contains(HasSubstr("with chunks of 1 rows")));
}

TEST(Conformance, FindsAPassThatDoesNotWorkRowByRow) {
  for (const char* rows : {"1", "3"})
    EXPECT_THAT(check_rows(offender("rows")), Contains(HasSubstr("when it runs on " + std::string(rows) + " rows at a time")));
}

TEST(Conformance, FindsADependenceOnTheOrderOfThreads) {
  // Bands in other numbers are found for certain, bands in another order most of the time.
  EXPECT_THAT(check_chunks(offender("threads")), ::testing::Not(IsEmpty()));
}

TEST(Conformance, FindsRowsTakenForDense) {
  EXPECT_THAT(check_strides(offender("strides")), Contains(HasSubstr("when the rows and planes of 'color' lie farther apart")));
}

TEST(Conformance, FindsAPassThatCannotWorkInPlace) {
  EXPECT_THAT(check_in_place(offender("in_place")), Contains(HasSubstr("when 'color' takes over the memory of 'color'")));
}

TEST(Conformance, FindsAPassThatRemembers) {
  EXPECT_THAT(check_purity(offender("memory")), Contains(HasSubstr("when the same frame is computed again after another one")));
}

TEST(Conformance, FindsAPassThatNeedsItsOptionalInput) {
  EXPECT_THAT(check_optional_inputs(offender("optional")),
              Contains(HasSubstr("fails without 'history' instead of refusing before it runs: pass: no history")));
}

TEST(Conformance, FindsWhatIsNotDocumented) {
  const auto found = check_description([] { return PassTest("undocumented"); });
  EXPECT_THAT(found, Contains("the summary is not documented"));
  EXPECT_THAT(found, Contains("the source (paper and equations) is not documented"));
  EXPECT_THAT(found, Contains("input 'color' is not documented"));
}

}  // namespace
}  // namespace quell::conformance
