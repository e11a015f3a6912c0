// The search of `quell tune`, and where it searches, without a program.
#include "tuning.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "trial.h"
#include "tuned_params.h"

namespace quell::app {
namespace {

/// Where the cost was least.
std::vector<double> least_of(const std::vector<double>& start, const SearchOptions& options,
                             const std::function<double(const std::vector<double>&)>& cost, int* calls = nullptr) {
  std::vector<double> best;
  double least = HUGE_VAL;
  find_least(start, options, [&](const std::vector<double>& at) {
    if (calls) ++*calls;
    for (const double place : at) EXPECT_TRUE(place >= 0 && place <= 1) << place;
    const double here = cost(at);
    if (here < least) least = here, best = at;
    return here;
  });
  return best;
}

double bowl(const std::vector<double>& at) {
  return std::pow(at[0] - 0.3, 2) + 4 * std::pow(at[1] - 0.9, 2) + at[0] * at[1] / 10;
}

TEST(FindLeast, FindsTheBottomOfABowl) {
  // The gradient is 0 there: 2 (x - 0.3) + y / 10 and 8 (y - 0.9) + x / 10.
  const double y = (7.2 - 0.03) / (8 - 0.005), x = 0.3 - y / 20;
  const std::vector<double> best = least_of({0.5, 0.5}, {.evaluations = 200}, bowl);
  EXPECT_NEAR(best[0], x, 5e-3);
  EXPECT_NEAR(best[1], y, 5e-3);
}

TEST(FindLeast, FindsAnEdge) {
  EXPECT_NEAR(least_of({0.5}, {.evaluations = 100}, [](const std::vector<double>& at) { return at[0]; })[0], 0, 1e-3);
}

TEST(FindLeast, KeepsToItsEvaluationsAndIsTheSameEachTime) {
  int calls = 0;
  const std::vector<double> once = least_of({0.1, 0.1}, {.evaluations = 17}, bowl, &calls);
  EXPECT_LE(calls, 17);
  EXPECT_GE(calls, 10);
  EXPECT_EQ(least_of({0.1, 0.1}, {.evaluations = 17}, bowl), once);
}

TEST(FindLeast, LooksEverywhereWhenAsked) {
  // A shallow valley at 0.2, where the search begins, and a deep narrow one at 0.8.
  const auto cost = [](const std::vector<double>& at) {
    return 1 - 0.5 * std::exp(-std::pow((at[0] - 0.2) / 0.1, 2)) - std::exp(-std::pow((at[0] - 0.8) / 0.05, 2));
  };
  EXPECT_NEAR(least_of({0.2}, {.evaluations = 60}, cost)[0], 0.2, 0.01);
  EXPECT_NEAR(least_of({0.2}, {.evaluations = 60, .looks_everywhere = true}, cost)[0], 0.8, 0.01);
}

TEST(FindLeast, EndsWithWhatTheCostThrows) {
  int calls = 0;
  const auto fail = [&](const std::vector<double>&) -> double {
    if (++calls == 5) throw std::runtime_error("the fifth");
    return calls;
  };
  EXPECT_THROW(find_least({0.5, 0.5}, {.evaluations = 50}, fail), std::runtime_error);
  EXPECT_EQ(calls, 5);
}

TEST(TunedParam, GoesThroughItsRangeByStepsOrByFactors) {
  const TunedParam share{.name = "a", .low = 0, .high = 1};
  EXPECT_EQ(share.value(0.25), 0.25);
  EXPECT_EQ(share.place(0.25), 0.25);
  const TunedParam sigma{.name = "s", .low = 0.25, .high = 64, .is_geometric = true};
  EXPECT_EQ(sigma.value(0), 0.25);
  EXPECT_EQ(sigma.value(0.5), 4);
  EXPECT_EQ(sigma.value(1), 64);
  EXPECT_NEAR(sigma.place(16), 0.75, 1e-12);
  EXPECT_EQ(sigma.place(100), 1);
}

TEST(TunedParam, HasSixDigitsSoThatWhatIsWrittenIsWhatWasMeasured) {
  const TunedParam share{.name = "a", .low = 0, .high = 1};
  EXPECT_EQ(share.value(1.0 / 3), 0.333333);
  EXPECT_EQ(number_text(share.value(1.0 / 3)), "0.333333");
}

TEST(TunedParam, StaysWholeWhereItIs) {
  const TunedParam radius{.name = "r", .low = 1, .high = 8.5, .is_whole = true};
  EXPECT_EQ(radius.value(0), 1);
  EXPECT_EQ(radius.value(0.5), 5);
  EXPECT_EQ(radius.value(1), 8);
}

TEST(TunedParam, HasAPlaceForAStartOutsideOfItsRange) {
  const TunedParam sigma{.name = "s", .low = 0.25, .high = 64, .is_geometric = true};
  EXPECT_EQ(sigma.place(-1), 0);
  EXPECT_EQ(sigma.place(0), 0);
  EXPECT_EQ(sigma.place(1e9), 1);
}

TEST(Goal, TurnsFiguresIntoCosts) {
  EXPECT_LT(cost(parse_goal("psnr"), {31}, {30}), cost(parse_goal("psnr"), {30}, {30}));
  EXPECT_LT(cost(parse_goal("flip"), {0.1}, {0.2}), cost(parse_goal("flip"), {0.2}, {0.2}));
  // The geometric mean of 1/2, 1/4 and 1.
  EXPECT_NEAR(cost(parse_goal("mixed"), {1, 0.5, 0.1}, {2, 2, 0.1}), 0.5, 1e-12);
  EXPECT_NEAR(cost(parse_goal("mixed"), {2, 2, 0.1}, {2, 2, 0.1}), 1, 1e-12);
}

}  // namespace
}  // namespace quell::app
