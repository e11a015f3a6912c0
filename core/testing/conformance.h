// The rules that every pass keeps, checked on made-up frames. One line gives a pass all of them:
//
//   QUELL_CONFORMANCE_TEST(invert);
//   QUELL_CONFORMANCE_TEST(tonemap, .set("operator", "aces"));   // with other parameters than the defaults
//
// Write it once for every mode of a pass that runs other code.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "quell/testing/conformance_checks.h"

#define QUELL_CONFORMANCE_CASE_(suite, pass_id, name, check, ...)       \
  TEST(suite, name) {                                                   \
    const auto make = [] {                                              \
      quell::PassTest pass(pass_id);                                    \
      (void)(pass __VA_ARGS__);                                         \
      return pass;                                                      \
    };                                                                  \
    EXPECT_THAT(quell::conformance::check(make), ::testing::IsEmpty()); \
  }
#define QUELL_CONFORMANCE_JOIN_(a, b) a##b
#define QUELL_CONFORMANCE_SUITE_(pass, line) QUELL_CONFORMANCE_JOIN_(pass##_conformance_, line)
#define QUELL_CONFORMANCE_TESTS_(suite, id, ...)                                                        \
  QUELL_CONFORMANCE_CASE_(suite, id, IsDescribedWhole, check_description, __VA_ARGS__)                  \
  QUELL_CONFORMANCE_CASE_(suite, id, RunsOnEverySize, check_sizes, __VA_ARGS__)                         \
  QUELL_CONFORMANCE_CASE_(suite, id, ReadsNoFartherThanItSays, check_radius, __VA_ARGS__)               \
  QUELL_CONFORMANCE_CASE_(suite, id, KeepsBadValuesWithinItsRadius, check_bad_values, __VA_ARGS__)      \
  QUELL_CONFORMANCE_CASE_(suite, id, GivesTheSameBitsInPlace, check_in_place, __VA_ARGS__)              \
  QUELL_CONFORMANCE_CASE_(suite, id, GivesTheSameBitsForAnyStrides, check_strides, __VA_ARGS__)         \
  QUELL_CONFORMANCE_CASE_(suite, id, GivesTheSameBitsForAnyThreadsAndChunks, check_chunks, __VA_ARGS__) \
  QUELL_CONFORMANCE_CASE_(suite, id, GivesTheSameBitsRowByRow, check_rows, __VA_ARGS__)                 \
  QUELL_CONFORMANCE_CASE_(suite, id, KeepsNothingBetweenFrames, check_purity, __VA_ARGS__)              \
  QUELL_CONFORMANCE_CASE_(suite, id, RunsOrRefusesWithoutOptionalInputs, check_optional_inputs, __VA_ARGS__)

/// All rules for one pass that is linked into this test program. What follows the name is applied to its PassTest.
#define QUELL_CONFORMANCE_TEST(pass, ...) QUELL_CONFORMANCE_TESTS_(QUELL_CONFORMANCE_SUITE_(pass, __LINE__), #pass, __VA_ARGS__)
