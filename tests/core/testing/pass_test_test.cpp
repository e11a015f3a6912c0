#include "quell/testing/pass_test.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "quell/text/error.h"

namespace quell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Image ramp(Size size = {4, 3}) {
  return test_image(QUELL_TYPE_COLOR, size, [](int x, int y, int c) { return static_cast<float>(x + 10 * y + 100 * c); });
}

TEST(PassTest, RunsAPassOnOneFrame) {
  PassTest pass("running_sum");
  pass.set("gain", 2.0).input("color", ramp());
  pass.run();
  EXPECT_EQ(pass.output("color").at(3, 2, 1), 2.0F * 123.0F);
}

TEST(PassTest, FeedsHistoryBackOverFrames) {
  PassTest pass("running_sum");
  pass.feed_back("color", "history").input("color", ramp());
  for (int frame = 0; frame < 4; ++frame) pass.run();
  EXPECT_EQ(pass.output("color").at(1, 1, 0), 4 * 11.0F);
  EXPECT_THAT(pass.output_values("frame"), ElementsAre(3.0));
}

TEST(PassTest, TakesNewInputsForEachFrame) {
  PassTest pass("running_sum");
  pass.feed_back("color", "history");
  pass.input("color", test_image(QUELL_TYPE_COLOR, {2, 2}, [](int, int, int) { return 1.0F; })).run();
  pass.input("color", test_image(QUELL_TYPE_COLOR, {2, 2}, [](int, int, int) { return 5.0F; })).run();
  EXPECT_EQ(pass.output("color").at(0, 0), 6.0F);
}

TEST(PassTest, ConnectsPortArrays) {
  PassTest pass("running_sum");
  pass.input("color", ramp());
  pass.input("extra", ramp()).input("extra", test_image(QUELL_TYPE_MOTION, {4, 3}, [](int x, int, int) {
                                      return static_cast<float>(-x);
                                    }));
  pass.run();
  EXPECT_EQ(pass.output("copies", 0).at(3, 2, 1), 123.0F);
  EXPECT_EQ(pass.output("copies", 1).at(3, 2, 1), -3.0F);
}

TEST(PassTest, KnowsWhatThePassDeclares) {
  PassTest pass("running_sum");
  pass.input("color", ramp());
  EXPECT_EQ(pass.radius("color"), 0);
  EXPECT_EQ(pass.in_place_of("color"), "color");
}

TEST(PassTest, SaysWhatAUserWouldRead) {
  PassTest pass("running_sum");
  pass.input("color", ramp());
  EXPECT_THAT([&] { pass.input("colour", ramp()); },
              ThrowsMessage<Error>(HasSubstr("the pass has no port 'colour'; did you mean 'color'?")));
  EXPECT_THAT([&] { PassTest("running_som"); },
              ThrowsMessage<Error>(HasSubstr("no pass 'running_som' is linked into this program")));
  pass.set("gain", 20.0);
  EXPECT_THAT([&] { pass.run(); }, ThrowsMessage<Error>(HasSubstr("gain")));
}

TEST(PassTest, SaysWhatAnOutputDoesNotCarry) {
  PassTest pass("running_sum");
  pass.input("color", ramp()).run();
  EXPECT_THAT([&] { pass.output("frame"); }, ThrowsMessage<Error>("frame: the output carries no image of float planes"));
  EXPECT_THAT([&] { pass.output_ids("color"); }, ThrowsMessage<Error>("color: the output carries no image of ids"));
  EXPECT_THAT([&] { pass.output_values("color"); }, ThrowsMessage<Error>("color: the output carries no values"));
  EXPECT_THAT([&] { pass.input("color", {}); }, ThrowsMessage<Error>(HasSubstr("there is nothing in the item")));
}

TEST(PassTest, LeavesInputsAlone) {
  PassTest pass("running_sum");
  const Image image = ramp();
  pass.set("gain", 3.0).input("color", image);
  pass.run();
  EXPECT_EQ(image.floats().at(3, 2, 1), 123.0F);
}

}  // namespace
}  // namespace quell
