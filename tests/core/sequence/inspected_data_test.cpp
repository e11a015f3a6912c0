// The checks on real data: the sample that ships, and the larger sequences beside the repository where they are there.
#include <gtest/gtest.h>

#include "quell/sequence/checks/checks.h"
#include "quell/sequence/checks/load_frame.h"

namespace quell {
namespace {

namespace fs = std::filesystem;

const fs::path kSample = fs::path(QUELL_SOURCE_DIR) / "graphs/sample";
const fs::path kData = fs::path(QUELL_SOURCE_DIR) / "../shared/data";

#define SKIP_WITHOUT(folder) \
  if (!fs::is_directory(folder)) GTEST_SKIP() << (folder) << " is not there; it is too large to be part of the repository"

/// Checks some frames; none may find anything wrong.
std::vector<Finding> check(const fs::path& path, const std::vector<std::int64_t>& frames) {
  const auto sequence = Sequence::open(path);
  BufferPool pool;
  std::vector<Finding> all;
  for (const std::int64_t frame : frames) {
    const FrameData data = load_frame(*sequence, frame, pool, all);
    for (Finding& finding : check_frame(data)) all.push_back(std::move(finding));
  }
  for (const Finding& finding : all) EXPECT_NE(finding.verdict, Verdict::wrong) << finding.subject << ": " << finding.text;
  return worst_of(all);
}

double figure_of(const std::vector<Finding>& findings, std::string_view subject, std::string_view name) {
  for (const Finding& finding : findings)
    if (finding.subject == subject)
      if (const auto value = figure(finding, name)) return *value;
  ADD_FAILURE() << subject << " has no " << name;
  return 1e30;
}

Verdict verdict_of(const std::vector<Finding>& findings, std::string_view subject) {
  for (const Finding& finding : findings)
    if (finding.subject == subject) return finding.verdict;
  return Verdict::not_tested;
}

// Samples lie within 0.005 px of the pixel's center, and positions are snapped to 2^-14 m: see real_data_test.cpp.
TEST(InspectedSample, LandsAndMovesAsItsMatricesSay) {
  const auto findings = check(kSample, {1, 2, 3});
  EXPECT_LT(figure_of(findings, kPositionSubject, "p99_px"), 0.01);
  EXPECT_LT(figure_of(findings, kMotionSubject, "p99_px"), 0.05);
  for (const char* subject : {kPositionSubject, kMotionSubject, kDepthSubject, kNormalLengthSubject, kNormalSurfaceSubject,
                              kNormalFacingSubject, kIdSubject, kBackgroundSubject, kCameraSubject, kSizesSubject})
    EXPECT_EQ(verdict_of(findings, subject), Verdict::ok) << subject;
}

TEST(InspectedRoom, MotionAgreesWithTheMatricesWithin005Pixels) {
  SKIP_WITHOUT(kData / "room");
  const auto findings = check(kData / "room", {2, 3, 7});
  EXPECT_LT(figure_of(findings, kPositionSubject, "p99_px"), 0.02);
  EXPECT_LT(figure_of(findings, kMotionSubject, "p99_px"), 0.05);
}

// The box filter of these files puts a sample anywhere in its pixel, up to 0.5 px from the center along an axis.
TEST(InspectedRoom, PositionsOfTheMultilayerFilesLandWithin06Pixels) {
  SKIP_WITHOUT(kData / "room/multilayer");
  const auto findings = check(kData / "room/multilayer/multi.%04d.exr", {1, 2});
  EXPECT_LT(figure_of(findings, kPositionSubject, "max_px"), kLandingTolerance);
  EXPECT_EQ(verdict_of(findings, kMotionSubject), Verdict::ok);
}

TEST(InspectedCourse, PositionsLandWithin06Pixels) {
  SKIP_WITHOUT(kData / "games202-box");
  const auto findings = check(kData / "games202-box", {0, 1, 11});
  EXPECT_LT(figure_of(findings, kPositionSubject, "max_px"), kLandingTolerance);
  EXPECT_EQ(verdict_of(findings, kNormalSurfaceSubject), Verdict::ok);
  EXPECT_EQ(verdict_of(findings, kDepthSubject), Verdict::ok);
}

}  // namespace
}  // namespace quell
