// What is read as it was meant passes every check with figures near zero, and every other reading is caught and mended.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "quell/sequence/checks/checks.h"
#include "tests/core/sequence/scene.h"

namespace quell {

// For messages of failed tests.
void PrintTo(const Remedy& remedy, std::ostream* out) { *out << remedy.input << ":" << describe(remedy.settings); }

namespace {

using test::Scene;
using testing::HasSubstr;

Finding find(const std::vector<Finding>& findings, std::string_view subject) {
  for (const Finding& finding : findings)
    if (finding.subject == subject) return finding;
  ADD_FAILURE() << "no finding says: " << subject;
  return {};
}

bool has(const std::vector<Finding>& findings, std::string_view subject) {
  return std::any_of(findings.begin(), findings.end(), [&](const Finding& finding) { return finding.subject == subject; });
}

double figure_of(const std::vector<Finding>& findings, std::string_view subject, std::string_view name) {
  const auto value = figure(find(findings, subject), name);
  EXPECT_TRUE(value) << subject << ": " << name;
  return value.value_or(1e30);
}

std::vector<Conventions> motion_conventions() {
  std::vector<Conventions> all;
  for (const MotionSign sign : {MotionSign::previous_minus_current, MotionSign::current_minus_previous})
    for (const MotionUnit unit : {MotionUnit::pixels, MotionUnit::uv, MotionUnit::ndc})
      for (const YDirection y : {YDirection::down, YDirection::up}) {
        Conventions c;
        c.sign = sign, c.unit = unit, c.y = y;
        all.push_back(c);
      }
  return all;
}

std::vector<Conventions> depth_conventions() {
  std::vector<Conventions> all(3);
  all[0].depth = DepthMeasure::axis, all[1].depth = DepthMeasure::ray, all[2].depth = DepthMeasure::reciprocal;
  return all;
}

std::vector<Conventions> normal_conventions() {
  std::vector<Conventions> all;
  for (const Space space : {Space::world, Space::camera})
    for (const Encoding encoding : {Encoding::signed_numbers, Encoding::unsigned_numbers}) {
      Conventions c;
      c.space = space, c.encoding = encoding;
      all.push_back(c);
    }
  return all;
}

// ------------------------------------------------------------------------------------------------- what is right is right

void expect_all_right(const std::vector<Finding>& findings) {
  for (const Finding& finding : findings) {
    EXPECT_EQ(finding.verdict, Verdict::ok) << finding.subject << ": " << finding.text;
    EXPECT_FALSE(finding.remedy) << finding.subject;
  }
  // Numbers are float32: 6e-8 of coordinates up to 10, seen at 72 px from a distance of at least 2, is 2e-5 px.
  EXPECT_LT(figure_of(findings, kPositionSubject, "max_px"), 1e-4);
  EXPECT_LT(figure_of(findings, kMotionSubject, "max_px"), 1e-4);
  EXPECT_EQ(figure_of(findings, kMotionSubject, "agreeing_share"), 1);
  EXPECT_EQ(figure_of(findings, kSkyMotionSubject, "disagreeing_share"), 0);
  EXPECT_LT(figure_of(findings, kDepthSubject, "median_relative"), 1e-5);
  EXPECT_EQ(figure_of(findings, kDepthSubject, "outside_share"), 0);
  EXPECT_LT(figure_of(findings, kNormalSurfaceSubject, "median_degrees"), 0.1);
  EXPECT_EQ(figure_of(findings, kNormalLengthSubject, "outside_share"), 0);
  EXPECT_EQ(figure_of(findings, kNormalFacingSubject, "away_share"), 0);
  EXPECT_EQ(figure_of(findings, kIdSubject, "without_matrix"), 0);
  EXPECT_EQ(figure_of(findings, kBackgroundSubject, "differing_share"), 0);
  EXPECT_EQ(figure_of(findings, kFiniteSubject, "count"), 0);
}

TEST(RightData, IsFoundRightWithFiguresNearZero) {
  for (const int frame : {1, 2, 5}) {
    SCOPED_TRACE(frame);
    const auto findings = check_frame(Scene().read(frame, {}, {}));
    expect_all_right(findings);
    EXPECT_EQ(findings.front().frame, frame);
  }
}

TEST(RightData, IsFoundRightUnderEveryConventionThatItIsReadBy) {
  for (const Conventions& motion : motion_conventions())
    for (const Conventions& normal : normal_conventions()) {
      const Conventions c = motion.or_else(normal);
      SCOPED_TRACE(describe(c));
      expect_all_right(check_frame(Scene().read(2, c, c)));
    }
  for (const Conventions& c : depth_conventions()) {
    SCOPED_TRACE(describe(c));
    expect_all_right(check_frame(Scene().read(2, c, c)));
  }
}

TEST(RightData, IsFoundRightWithJitterThatMotionHoldsOrLeavesOut) {
  const Scene scene({.jitter = {0.3, -0.2}});
  Conventions included;
  included.jitter = Jitter::included;
  expect_all_right(check_frame(scene.read(2, {}, {})));
  expect_all_right(check_frame(scene.read(2, included, included)));
}

TEST(RightData, NeedsNoPositionsForMotionAndNormals) {
  FrameData frame = Scene().read(2, {}, {});
  frame.position.reset();  // points are made of depth
  const auto findings = check_frame(frame);
  EXPECT_FALSE(has(findings, kPositionSubject));
  EXPECT_EQ(find(findings, kDepthSubject).verdict, Verdict::not_tested);
  EXPECT_LT(figure_of(findings, kMotionSubject, "max_px"), 1e-4);
  EXPECT_LT(figure_of(findings, kNormalSurfaceSubject, "median_degrees"), 0.1);
}

// -------------------------------------------------------------------------------------- what is wrong is caught and mended

/// The first subject is wrong, and the remedy leads from `guess` to what reads the data rightly.
void expect_caught(const Scene& scene, const Conventions& truth, const Conventions& guess, std::string_view subject) {
  SCOPED_TRACE("stored as " + describe(truth) + ", read as " + describe(guess));
  const FrameData frame = scene.read(2, truth, guess);
  const Finding finding = find(check_frame(frame), subject);
  EXPECT_EQ(finding.verdict, Verdict::wrong) << finding.text;
  ASSERT_TRUE(finding.remedy) << finding.text;
  EXPECT_EQ(finding.remedy->settings.or_else(guess), truth) << describe(finding.remedy->settings);
  FrameData mended = frame;
  apply(*finding.remedy, mended);
  EXPECT_EQ(find(check_frame(mended), subject).verdict, Verdict::ok);
}

TEST(WrongMotion, IsCaughtForEverySignUnitAndDirection) {
  const Scene scene;
  for (const Conventions& truth : motion_conventions())
    for (const Conventions& guess : motion_conventions())
      if (!(truth == guess)) expect_caught(scene, truth, guess, kMotionSubject);
}

TEST(WrongMotion, IsCaughtForJitter) {
  const Scene scene({.jitter = {0.4, -0.3}});
  Conventions included, excluded;
  included.jitter = Jitter::included, excluded.jitter = Jitter::excluded;
  expect_caught(scene, included, excluded, kMotionSubject);
  expect_caught(scene, excluded, included, kMotionSubject);
}

TEST(WrongMotion, NamesWhatHasToBeStated) {
  Conventions truth;
  truth.sign = MotionSign::current_minus_previous;
  const Finding finding = find(check_frame(Scene().read(2, truth, {})), kMotionSubject);
  ASSERT_TRUE(finding.remedy);
  EXPECT_EQ(finding.remedy->input, "motion");
  EXPECT_EQ(describe(finding.remedy->settings), "sign=current-previous");
  EXPECT_THAT(finding.text, HasSubstr("of what moves agrees"));
}

TEST(WrongMotion, OfAnotherFrameIsWrongWithoutARemedy) {
  FrameData frame = Scene().read(2, {}, {});
  const FrameData other = Scene().read(7, {}, {});
  frame.motion->stored = other.motion->stored, frame.motion->image = other.motion->image;
  const Finding finding = find(check_frame(frame), kMotionSubject);
  EXPECT_EQ(finding.verdict, Verdict::wrong);
  EXPECT_FALSE(finding.remedy) << describe(finding.remedy->settings);
  EXPECT_THAT(finding.text, HasSubstr("no other reading agrees"));
}

TEST(WrongDepth, IsCaughtForEveryMeasure) {
  for (const Conventions& truth : depth_conventions())
    for (const Conventions& guess : depth_conventions())
      if (!(truth == guess)) expect_caught(Scene(), truth, guess, kDepthSubject);
}

TEST(WrongDepth, InAnotherUnitIsToldByItsFactor) {
  FrameData frame = Scene().read(2, {}, {});
  const FloatOutput depth = frame.depth->image.writable_floats();
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x)
      if (depth.at(x, y) < 1e9F) depth.at(x, y) *= 100;
  const Finding finding = find(check_frame(frame), kDepthSubject);
  EXPECT_EQ(finding.verdict, Verdict::wrong);
  EXPECT_THAT(finding.text, HasSubstr("100 times as far as the positions"));
}

TEST(WrongNormals, AreCaughtForEverySpaceAndEncoding) {
  for (const Conventions& truth : normal_conventions())
    for (const Conventions& guess : normal_conventions()) {
      if (truth == guess) continue;
      SCOPED_TRACE("stored as " + describe(truth) + ", read as " + describe(guess));
      FrameData frame = Scene().read(2, truth, guess);
      frame.position->stored = Scene().stored(QUELL_TYPE_POSITION, 2, {});
      frame.position->read_as = {}, frame.position->image = frame.position->stored;
      Conventions mended = guess;
      for (const char* subject : {kNormalLengthSubject, kNormalSurfaceSubject}) {
        const Finding finding = find(check_frame(frame), subject);
        const bool concerns = subject == kNormalLengthSubject ? truth.encoding != guess.encoding : truth.space != guess.space;
        EXPECT_EQ(finding.verdict, concerns ? Verdict::wrong : Verdict::ok) << subject << ": " << finding.text;
        EXPECT_EQ(finding.remedy.has_value(), concerns) << subject;
        if (finding.remedy) mended = finding.remedy->settings.or_else(mended);
      }
      EXPECT_EQ(mended, truth);
    }
}

TEST(WrongNormals, ThatPointInwardAreWrong) {
  FrameData frame = Scene().read(2, {}, {});
  const FloatOutput normals = frame.normal->image.writable_floats();
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < normals.height; ++y)
      for (int x = 0; x < normals.width; ++x) normals.at(x, y, c) = -normals.at(x, y, c);
  const Finding finding = find(check_frame(frame), kNormalSurfaceSubject);
  EXPECT_EQ(finding.verdict, Verdict::wrong);
  EXPECT_THAT(finding.text, HasSubstr("into the surfaces"));
}

TEST(WrongPositions, AreCaughtForTheOtherSpace) {
  std::vector<Conventions> spaces(2);
  spaces[0].space = Space::world, spaces[1].space = Space::camera;
  expect_caught(Scene(), spaces[0], spaces[1], kPositionSubject);
  expect_caught(Scene(), spaces[1], spaces[0], kPositionSubject);
}

TEST(WrongPositions, DoNotMakeTheOthersLookWrong) {
  Conventions camera, world;
  camera.space = Space::camera;
  FrameData frame = Scene().read(2, {}, {});
  frame.position->stored = Scene().stored(QUELL_TYPE_POSITION, 2, camera);
  frame.position->image = frame.position->stored;
  for (const Finding& finding : check_frame(frame))
    EXPECT_EQ(finding.verdict, finding.subject == kPositionSubject ? Verdict::wrong : Verdict::ok)
        << finding.subject << ": " << finding.text;
}

// ------------------------------------------------------------------------------------------------------------ the camera

Finding positions_seen_by(const std::function<void(Camera&)>& change) {
  FrameData frame = Scene().read(2, {}, {});
  Camera camera = *frame.camera;
  change(camera);
  frame.camera = std::make_shared<Camera>(camera);
  return find(check_frame(frame), kPositionSubject);
}

TEST(WrongCamera, ForRowVectorsIsNamed) {
  const Finding finding = positions_seen_by([](Camera& camera) {
    Matrix turned{};
    for (std::size_t i = 0; i < 16; ++i) turned[i] = camera.world_to_screen[4 * (i % 4) + i / 4];
    camera.world_to_screen = turned;
  });
  EXPECT_EQ(finding.verdict, Verdict::wrong);
  EXPECT_THAT(finding.text, HasSubstr("for row vectors"));
}

TEST(WrongCamera, ThatCountsFromTheBottomIsNamed) {
  const Finding finding = positions_seen_by([](Camera& camera) {
    for (std::size_t k = 0; k < 4; ++k)
      camera.world_to_screen[4 + k] = camera.size.height * camera.world_to_screen[12 + k] - camera.world_to_screen[4 + k];
  });
  EXPECT_EQ(finding.verdict, Verdict::wrong);
  EXPECT_THAT(finding.text, HasSubstr("upside down"));
}

TEST(WrongCamera, OfTheNextFrameIsNamed) {
  FrameData frame = Scene().read(2, {}, {});
  frame.previous = frame.camera;
  frame.camera = std::make_shared<Camera>(Scene().camera(3));
  const auto findings = check_frame(frame);
  EXPECT_EQ(find(findings, kPositionSubject).verdict, Verdict::wrong);
  EXPECT_THAT(find(findings, kPositionSubject).text, HasSubstr("camera of the frame before"));
  EXPECT_EQ(find(findings, kDepthSubject).verdict, Verdict::not_tested) << "positions that do not land tell nothing";
}

TEST(WrongCamera, HalfAPixelAsideIsSuspicious) {
  const Finding finding = positions_seen_by([](Camera& camera) {
    for (std::size_t k = 0; k < 4; ++k) {
      camera.world_to_screen[k] -= 0.5 * camera.world_to_screen[12 + k];
      camera.world_to_screen[4 + k] -= 0.5 * camera.world_to_screen[12 + k];
    }
  });
  EXPECT_EQ(finding.verdict, Verdict::suspicious);
  EXPECT_THAT(finding.text, HasSubstr("0.5 px left and 0.5 px above"));
}

TEST(WrongCamera, WithTwoMatricesOfDifferentCamerasIsWrong) {
  FrameData frame = Scene().read(2, {}, {});
  EXPECT_EQ(find(check_frame(frame), kCameraSubject).verdict, Verdict::ok);
  Camera mixed = *frame.camera;
  mixed.world_to_camera = Scene().camera(6).world_to_camera;
  frame.camera = std::make_shared<Camera>(mixed);
  EXPECT_EQ(find(check_frame(frame), kCameraSubject).verdict, Verdict::wrong);
}

TEST(WrongCamera, OfAnotherSizeIsToldAndNotUsed) {
  FrameData frame = Scene().read(2, {}, {});
  Camera other = *frame.camera;
  other.size = {40, 30};
  frame.camera = std::make_shared<Camera>(other);
  const auto findings = check_frame(frame);
  EXPECT_EQ(find(findings, kSizesSubject).verdict, Verdict::wrong);
  EXPECT_THAT(find(findings, kSizesSubject).text, HasSubstr("camera is 40 x 30"));
  for (const char* subject : {kPositionSubject, kDepthSubject, kMotionSubject, kNormalSurfaceSubject})
    EXPECT_EQ(find(findings, subject).verdict, Verdict::not_tested) << subject;
}

// ---------------------------------------------------------------------------------------------- what the images cannot tell

TEST(Untestable, MotionWithoutMotionIsNotCalledRight) {
  const Finding finding = find(check_frame(Scene({.still = true}).read(2, {}, {})), kMotionSubject);
  EXPECT_EQ(finding.verdict, Verdict::not_tested);
  EXPECT_THAT(finding.text, HasSubstr("nothing moves"));
}

TEST(Untestable, MotionThatTheMatricesDoNotKnowIsWrong) {
  FrameData frame = Scene().read(2, {}, {});
  frame.previous = frame.camera;
  const Finding finding = find(check_frame(frame), kMotionSubject);
  EXPECT_EQ(finding.verdict, Verdict::wrong);
  EXPECT_THAT(finding.text, HasSubstr("by the matrices nothing moves"));
}

TEST(Untestable, MotionToTheSideDoesNotTellWhereYPoints) {
  const Finding finding = find(check_frame(Scene({.sideways_only = true}).read(2, {}, {})), kMotionSubject);
  EXPECT_EQ(finding.verdict, Verdict::ok);
  EXPECT_THAT(finding.text, HasSubstr("these frames do not tell whether y points down"));
}

TEST(Untestable, NarrowViewsDoNotTellAxisFromRay) {
  const Finding finding = find(check_frame(Scene({.narrow = 12}).read(2, {}, {})), kDepthSubject);
  EXPECT_EQ(finding.verdict, Verdict::ok);
  EXPECT_THAT(finding.text, HasSubstr("does not tell whether it is measured from the camera"));
}

TEST(Untestable, WithoutACameraOrTheOneBefore) {
  FrameData frame = Scene().read(2, {}, {});
  frame.previous = nullptr;
  const auto first = check_frame(frame);
  EXPECT_EQ(find(first, kMotionSubject).verdict, Verdict::not_tested);
  EXPECT_THAT(find(first, kMotionSubject).text, HasSubstr("camera of the frame before"));
  EXPECT_EQ(find(first, kPositionSubject).verdict, Verdict::ok);
  frame.camera = nullptr;
  const auto none = check_frame(frame);
  for (const char* subject : {kPositionSubject, kDepthSubject, kMotionSubject, kNormalSurfaceSubject}) {
    EXPECT_EQ(find(none, subject).verdict, Verdict::not_tested) << subject;
    EXPECT_EQ(find(none, subject).text, "there is no camera") << subject;
  }
}

TEST(Untestable, AFrameWithoutInputsSaysNothing) { EXPECT_TRUE(check_frame({}).empty()); }

// ------------------------------------------------------------------------------------------------------ objects and ids

TEST(Objects, WithoutAMatrixAreTold) {
  FrameData frame = Scene().read(2, {}, {});
  Camera camera = *frame.camera;
  camera.object_to_world.erase(1);
  frame.camera = std::make_shared<Camera>(camera);
  EXPECT_THAT(find(check_frame(frame), kIdSubject).text, HasSubstr("1 of them have no matrix"));
}

TEST(Objects, ThatMoveWithoutAMatrixAreToldByTheirMotion) {
  // The camera stands; the ball moves, and its matrix is of another object.
  FrameData frame = Scene({.still = true}).read(2, {}, {});
  const FloatOutput motion = frame.motion->image.writable_floats();
  std::size_t ball = 0;
  for (int y = 0; y < motion.height; ++y)
    for (int x = 0; x < motion.width; ++x)
      if (frame.id->image.ids().at(x, y) == 1) motion.at(x, y, 0) = 3, ++ball;
  ASSERT_GT(ball, 100U);
  frame.motion->stored = frame.motion->image;
  const Finding finding = find(check_frame(frame), kMotionSubject);
  EXPECT_EQ(finding.verdict, Verdict::suspicious) << "most stands still, and rightly";
  EXPECT_THAT(finding.text, HasSubstr("what moves deforms, or has no matrix"));
  const Finding moving_camera = [] {
    FrameData moving = Scene().read(2, {}, {});
    Camera now = *moving.camera;
    now.object_to_world.erase(1);
    moving.camera = std::make_shared<Camera>(now);
    return find(check_frame(moving), kMotionSubject);
  }();
  EXPECT_NE(moving_camera.verdict, Verdict::wrong) << "only the ball disagrees";
  EXPECT_LT(*figure(moving_camera, "agreeing_share"), 0.99);
}

TEST(WrongIds, WithAnotherBackgroundAreCaught) {
  Conventions truth, guess;
  truth.background = 255, guess.background = -1;
  const Finding as_object = find(check_frame(Scene().read(2, truth, guess)), kBackgroundSubject);
  EXPECT_EQ(as_object.verdict, Verdict::wrong);
  ASSERT_TRUE(as_object.remedy);
  EXPECT_EQ(as_object.remedy->settings.background, 255);
  guess.background = 0;  // the floor is lost, and what is no surface is one
  const Finding both = find(check_frame(Scene().read(2, truth, guess)), kBackgroundSubject);
  EXPECT_EQ(both.verdict, Verdict::wrong);
  ASSERT_TRUE(both.remedy);
  EXPECT_EQ(both.remedy->settings.background, 255);
}

TEST(WrongIds, ThatTakeAnObjectForTheBackgroundAreCaughtInsideARoom) {
  FrameData frame = Scene().read(2, {}, {});
  for (int y = 0; y < 60; ++y)  // a room: what was sky is a wall, object 2
    for (int x = 0; x < 80; ++x)
      if (frame.id->image.ids().at(x, y) == QUELL_NO_ID) {
        frame.id->stored.writable_floats().at(x, y) = 2, frame.id->image.writable_ids().at(x, y) = 2;
        frame.depth->image.writable_floats().at(x, y) = 50;
      } else if (frame.id->image.ids().at(x, y) == 0) {
        frame.id->image.writable_ids().at(x, y) = QUELL_NO_ID;  // as background=0 reads it
      }
  frame.position.reset();
  const Finding finding = find(check_frame(frame), kBackgroundSubject);
  EXPECT_EQ(finding.verdict, Verdict::wrong);
  ASSERT_TRUE(finding.remedy);
  EXPECT_EQ(finding.remedy->settings.background, -1);
}

TEST(WrongIds, ThatAreAveragedAreToldWithAPixel) {
  FrameData frame = Scene().read(2, {}, {});
  frame.id->stored.writable_floats().at(3, 4) = 1.5F;
  frame.id->image = Image();
  const Finding finding = find(check_frame(frame), kIdSubject);
  EXPECT_EQ(finding.verdict, Verdict::wrong);
  EXPECT_THAT(finding.text, HasSubstr("1 pixel holds no integer: pixel (3, 4) holds 1.5"));
}

// ------------------------------------------------------------------------------------------------- color, and bad numbers

FrameData colored(const std::function<void(FloatOutput)>& change) {
  FrameData frame = Scene().read(2, {}, {});
  change(frame.color->image.writable_floats());
  return frame;
}

TEST(Colors, ThatAreNegativeBlackOrMadeForADisplayAreSuspicious) {
  EXPECT_EQ(find(check_frame(colored([](FloatOutput) {})), kColorSubject).verdict, Verdict::ok);
  const auto fill = [](float value) {
    return [value](FloatOutput out) {
      for (int c = 0; c < 3; ++c)
        for (int y = 0; y < out.height; ++y) std::fill_n(out.row(y, c), out.width, value);
    };
  };
  EXPECT_THAT(find(check_frame(colored(fill(0))), kColorSubject).text, HasSubstr("all black"));
  EXPECT_THAT(find(check_frame(colored(fill(-0.5F))), kColorSubject).text, HasSubstr("are negative"));
  const Finding clipped = find(check_frame(colored(fill(1))), kColorSubject);
  EXPECT_EQ(clipped.verdict, Verdict::suspicious);
  EXPECT_THAT(clipped.text, HasSubstr("made for a display"));
  FrameData bytes = colored(fill(0.5F));
  bytes.color->numbers = Numbers::uint8;
  const Finding of_bytes = find(check_frame(bytes), kColorSubject);
  EXPECT_EQ(of_bytes.verdict, Verdict::suspicious);
  ASSERT_TRUE(of_bytes.remedy);
  EXPECT_EQ(of_bytes.remedy->settings.transfer, Transfer::srgb);
  bytes.color->read_as.transfer = Transfer::srgb;
  EXPECT_EQ(find(check_frame(bytes), kColorSubject).verdict, Verdict::ok);
}

TEST(Colors, WhereAlphaIsZeroAreStraight) {
  FrameData frame = Scene().read(2, {}, {});
  BufferPool pool;
  frame.alpha = CheckedImage{"alpha", Image(QUELL_TYPE_ALPHA, {80, 60}, pool), Image()};
  const FloatOutput alpha = frame.alpha->image.writable_floats();
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x) alpha.at(x, y) = frame.id->image.ids().at(x, y) == QUELL_NO_ID ? 0.0F : 1.0F;
  const Finding straight = find(check_frame(frame), kAlphaSubject);
  EXPECT_EQ(straight.verdict, Verdict::suspicious);
  ASSERT_TRUE(straight.remedy);
  EXPECT_EQ(straight.remedy->settings.alpha, AlphaKind::straight);
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 80; ++x)
        if (alpha.at(x, y) == 0) frame.color->stored.writable_floats().at(x, y, c) = 0;
  EXPECT_EQ(find(check_frame(frame), kAlphaSubject).verdict, Verdict::ok);
}

TEST(BadNumbers, LeaveTheOtherPixelsToBeJudged) {
  FrameData frame = Scene().read(2, {}, {});
  for (auto* image : {&frame.position, &frame.normal, &frame.motion, &frame.depth})
    for (int c = 0; c < (*image)->image.channels(); ++c)
      (*image)->image.writable_floats().at(40, 40, c) = std::numeric_limits<float>::quiet_NaN();
  for (const Finding& finding : check_frame(frame)) EXPECT_EQ(finding.verdict, Verdict::ok) << finding.subject << finding.text;
}

}  // namespace
}  // namespace quell
